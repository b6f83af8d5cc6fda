//! The floor of the chapel as an image, made from a formula: a compass rose of marble among tiles.
//!
//! `cargo xtask meshes` writes it as `scenes/textures/compass.png`, and a test keeps that file equal
//! to what is made here. The image covers a floor of 3.2 m x 2.6 m, its columns along the first; the
//! star stands 0.35 m that way from the middle. Each texel is the mean of 4 x 4 samples of the linear
//! reflectance, coded by sRGB's curve (IEC 61966-2-1).

use std::f64::consts::TAU;
use std::io::Cursor;

use glam::DVec2;
use tpb_film::srgb;

/// Width and height of the image.
const SIZE: [usize; 2] = [448, 364];
/// What it covers \[m\].
const FLOOR: DVec2 = DVec2::new(3.2, 2.6);
/// The middle of the star, from the middle of the floor \[m\].
const CENTRE: DVec2 = DVec2::new(0.35, 0.0);
/// Samples along each side of a texel.
const SAMPLES: usize = 4;
/// Edge of a tile \[m\].
const TILE: f64 = 0.2;
/// Width of what fills the joints \[m\].
const JOINT: f64 = 0.01;
/// Inner and outer radius of the dial around the star \[m\].
const DIAL: [f64; 2] = [0.92, 1.02];

const IVORY: [f64; 3] = [0.76, 0.72, 0.65];
const SAND: [f64; 3] = [0.58, 0.52, 0.43];
const CLAY: [f64; 3] = [0.5, 0.26, 0.17];
const SLATE: [f64; 3] = [0.13, 0.15, 0.19];

/// The points of the star: how many, the angle of the first in their own steps, their length, and
/// the radius where two neighbours meet \[m\]; those before cover those behind.
const POINTS: [(u32, f64, f64, f64); 3] =
    [(4, 0.0, 0.88, 0.19), (4, 0.5, 0.66, 0.22), (8, 0.5, 0.5, 0.34)];

/// The bytes of the file.
pub fn png() -> Vec<u8> {
    let [width, height] = SIZE;
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("the size is sound");
    writer.write_image_data(&texels()).expect("memory takes it all");
    writer.finish().expect("memory takes it all");
    bytes.into_inner()
}

/// The texels, row by row.
fn texels() -> Vec<u8> {
    let [width, height] = SIZE;
    let size = DVec2::new(width as f64, height as f64);
    let texel = |index: usize| {
        let corner = DVec2::new((index % width) as f64, (index / width) as f64);
        let mut sum = [0.0; 3];
        for sample in 0..SAMPLES * SAMPLES {
            let at = DVec2::new((sample % SAMPLES) as f64, (sample / SAMPLES) as f64) + 0.5;
            let uv = (corner + at / SAMPLES as f64) / size;
            let colour = colour((uv - 0.5) * FLOOR);
            sum.iter_mut().zip(colour).for_each(|(sum, value)| *sum += value);
        }
        sum.map(|sum| srgb(sum / (SAMPLES * SAMPLES) as f64))
    };
    (0..width * height).flat_map(texel).collect()
}

/// Reflectance at a place from the middle of the floor \[m\].
fn colour(place: DVec2) -> [f64; 3] {
    let from_centre = place - CENTRE;
    let radius = from_centre.length();
    let turn = from_centre.to_angle() / TAU;
    if radius > DIAL[1] + JOINT {
        tiles(place)
    } else if radius > DIAL[1] || (DIAL[0] - JOINT..DIAL[0]).contains(&radius) {
        SLATE
    } else if radius >= DIAL[0] {
        // A dial of 72 marks.
        if (turn * 72.0).rem_euclid(2.0) < 1.0 { CLAY } else { IVORY }
    } else {
        POINTS.iter().find_map(|points| star(radius, turn, points)).unwrap_or(SAND)
    }
}

/// The colour of one of these points of the star, dark on one side of its ridge, if it is there.
fn star(
    radius: f64,
    turn: f64,
    &(count, first, length, meet): &(u32, f64, f64, f64),
) -> Option<[f64; 3]> {
    let step = TAU / f64::from(count);
    // Angle from the nearest point's ridge.
    let from_first = turn * TAU - first * step;
    let angle = from_first - step * (from_first / step).round();
    let (along, across) = (radius * angle.cos(), radius * angle.sin().abs());
    let (foot, width) = (meet * (0.5 * step).cos(), meet * (0.5 * step).sin());
    // The edge runs from the tip to where it meets the neighbour's.
    let inside = across * (length - foot) <= width * (length - along);
    let dark = if count == 8 { CLAY } else { SLATE };
    inside.then_some(if angle > 0.0 { dark } else { IVORY })
}

/// Tiles of two colours, with joints.
fn tiles(place: DVec2) -> [f64; 3] {
    let tile = (place / TILE).floor();
    let within = place - tile * TILE;
    if within.min_element() < JOINT {
        SLATE
    } else if (tile.x + tile.y).rem_euclid(2.0) < 1.0 {
        IVORY
    } else {
        SAND
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// Decoded, because other versions of the encoder may write other bytes.
    #[test]
    fn the_tracked_image_is_what_is_made_here() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/textures/compass.png");
        let bytes = std::fs::read(&file).expect("the tracked image");
        assert!(bytes.len() < 100_000, "{} bytes", bytes.len());
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
        let info = reader.info();
        assert_eq!([info.width as usize, info.height as usize], SIZE);
        let mut found = vec![0; reader.output_buffer_size().expect("it fits memory")];
        reader.next_frame(&mut found).expect("its only frame");
        assert!(found == texels(), "the image differs: `cargo xtask meshes` writes it");
    }

    #[test]
    fn the_star_has_its_points_and_its_sides() {
        let at = |angle: f64, radius: f64| colour(CENTRE + radius * DVec2::from_angle(angle));
        let side = 0.01;
        assert_eq!(at(side, 0.8), SLATE);
        assert_eq!(at(-side, 0.8), IVORY);
        assert_eq!(at(TAU / 8.0 + side, 0.6), SLATE);
        assert_eq!(at(TAU / 8.0 - side, 0.6), IVORY);
        assert_eq!(at(TAU / 16.0 + side, 0.45), CLAY);
        assert_eq!(at(TAU / 16.0, 0.8), SAND);
        assert_eq!(at(0.01, 0.97), CLAY);
        assert_eq!(at(-0.01, 0.97), IVORY);
    }
}
