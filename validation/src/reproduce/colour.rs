//! From numbers to colours: one exposure for all frames, and two false-colour scales.
//!
//! Display white is the luminance that 99 % of the reference's lit cells, among the frames shown, do
//! not exceed; what is brighter is white ([`tpb_film::white_level`]). Then the sRGB curve
//! ([`tpb_film::srgb`]).

use tpb_film::{Arrays, white_level};
use tpb_optics::spectrum::LUMINANCE;

/// Part of the lit cells that is not brighter than display white.
const WHITE: f64 = 0.99;

/// Display white of a set of luminances.
pub fn white(luminances: impl Iterator<Item = f64>) -> f64 {
    white_level(luminances, WHITE)
}

/// Luminances of one bin of a cube.
pub fn frame_luminances(arrays: &Arrays, bin: usize) -> impl Iterator<Item = f64> + '_ {
    let channels = arrays.channels;
    (0..arrays.pixels()).map(move |pixel| {
        let cell = &arrays.pixel(pixel)[bin * channels..(bin + 1) * channels];
        luminance(cell.iter().map(|&v| f64::from(v)))
    })
}

/// The luminance of three channels, or the only channel.
pub fn luminance(channels: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = channels.collect();
    match values.as_slice() {
        [r, g, b] => r * LUMINANCE[0] + g * LUMINANCE[1] + b * LUMINANCE[2],
        [grey, ..] => *grey,
        [] => 0.0,
    }
}

/// Black over purple and orange to white, of lightness that rises evenly: anchors of a cubehelix
/// (Green 2011: start 0.5, −0.8 rotations, hue 1.2).
pub fn sequential(at: f64) -> [u8; 3] {
    let at = if at.is_nan() { 0.0 } else { at.clamp(0.0, 1.0) };
    let angle = std::f64::consts::TAU * (0.5 / 3.0 + 1.0 - 0.8 * at);
    let amplitude = 1.2 * at * (1.0 - at) / 2.0;
    let (sine, cosine) = angle.sin_cos();
    [(-0.14861, 1.78277), (-0.29227, -0.90649), (1.97294, 0.0)].map(|(c, s)| {
        let value: f64 = at + amplitude * (c * cosine + s * sine);
        (255.0 * value.clamp(0.0, 1.0)).round() as u8
    })
}

/// Blue at −1, white at 0, orange at 1: told apart with any kind of colour vision.
pub fn diverging(at: f64) -> [u8; 3] {
    const LOW: [f64; 3] = [0.0, 90.0, 181.0];
    const HIGH: [f64; 3] = [200.0, 80.0, 0.0];
    let at = if at.is_nan() { 0.0 } else { at.clamp(-1.0, 1.0) };
    let end = if at < 0.0 { LOW } else { HIGH };
    end.map(|end| (255.0 + (end - 255.0) * at.abs()).round() as u8)
}

/// What has no value.
pub const GREY: [u8; 3] = [128; 3];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_run_from_end_to_end_and_grow_lighter() {
        assert_eq!((sequential(0.0), sequential(1.0)), ([0; 3], [255; 3]));
        let luma = |c: [u8; 3]| {
            0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2])
        };
        let lumas: Vec<f64> = (0..=50).map(|i| luma(sequential(f64::from(i) / 50.0))).collect();
        assert!(lumas.windows(2).all(|pair| pair[0] < pair[1]), "{lumas:?}");
        assert_eq!((diverging(0.0), diverging(-3.0)), ([255; 3], [0, 90, 181]));
    }
}
