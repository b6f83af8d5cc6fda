//! Where caustics are compared: blocks of pixels about places of the room, over all time or while the
//! light arrives.

use std::ops::Range;

use glam::DVec3;
use tpb_scene::Scene;

use super::super::room::Room;
use crate::cube::Cube;
use crate::error::Result;
use crate::measure::layout;

/// Where light is compared.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Region {
    pub(in super::super) label: String,
    pub(in super::super) pixels: Vec<usize>,
    pub(in super::super) bins: Range<usize>,
}

/// Blocks about places of the room that have a pixel which the mask admits, and all that it admits.
pub(super) fn regions(room: &Room, scene: &Scene, mask: &[bool]) -> Result<Vec<Region>> {
    let Room { lamp, ball, floor, back, .. } = *room;
    let halfway = 0.5 * (room.poles()[1] + room.focus());
    let t_floor = room.through(floor);
    let t_halfway = room.through(halfway);
    let beside = floor + DVec3::new(0.0, 0.0, 0.5);
    let below = DVec3::new(lamp.x, floor.y, 0.3);
    let floor_window = window(scene, t_floor - 0.12, t_floor + 0.2)?.1;
    let (bins, fog_window) = window(scene, t_halfway - 0.16, t_halfway + 0.28)?;
    let whole = 0..bins;
    let list: [(&str, DVec3, f64, Range<usize>); 8] = [
        ("caustic on the floor, all time", floor, 0.16, whole.clone()),
        ("caustic on the floor, as it arrives", floor, 0.16, floor_window),
        ("focused light in fog, all time", halfway, 0.12, whole.clone()),
        ("focused light in fog, as it arrives", halfway, 0.12, fog_window),
        ("floor in front of the caustic", beside, 0.2, whole.clone()),
        ("floor below the lamp", below, 0.3, whole.clone()),
        ("back wall behind the lamp", back, 0.3, whole.clone()),
        (
            "fog and back wall above the ball",
            ball + DVec3::new(0.0, 0.75, -0.5),
            0.2,
            whole.clone(),
        ),
    ];
    let mut regions: Vec<Region> = list
        .into_iter()
        .filter_map(|(label, place, half, bins)| {
            let pixels = block(scene, place, half, mask);
            (!pixels.is_empty()).then(|| Region { label: label.to_owned(), pixels, bins })
        })
        .collect();
    let all: Vec<usize> = (0..mask.len()).filter(|&pixel| mask[pixel]).collect();
    regions.push(Region {
        label: "all pixels that look past mirrors, glass and lamp".to_owned(),
        pixels: all,
        bins: whole,
    });
    Ok(regions)
}

/// The film's bins, and those between two OPLs \[m\], at least one.
pub(in super::super) fn window(scene: &Scene, from: f64, to: f64) -> Result<(usize, Range<usize>)> {
    let axis = layout(&scene.film, 0.0)?.time;
    let (bins, width, start) =
        axis.map_or((0, 1.0, 0.0), |axis| (axis.bins, axis.bin_width_opl, axis.start_opl));
    let bin = |opl: f64| ((opl - start) / width).round().clamp(0.0, bins as f64) as usize;
    Ok((bins, bin(from)..bin(to).max(bin(from) + 1).min(bins)))
}

/// Pixels within `half` \[m\] of a place, across and along the image, that the mask admits.
fn block(scene: &Scene, place: DVec3, half: f64, mask: &[bool]) -> Vec<usize> {
    let eye = scene.sensor.position;
    let (width, height) = (scene.film.width, scene.film.height);
    let Some(centre) = scene.sensor.project(place - eye) else { return Vec::new() };
    let along = (place - eye).dot(scene.sensor.forward());
    let side = half / (along * scene.sensor.pixel_width());
    let range = |at: f64, end: usize| {
        let first = (at - side).round().max(0.0) as usize;
        first..((at + side).round().max(0.0) as usize).max(first + 1).min(end)
    };
    range(centre.y, height)
        .flat_map(|y| range(centre.x, width).map(move |x| y * width + x))
        .filter(|&pixel| mask[pixel])
        .collect()
}

impl Region {
    /// Mean over pixels of the energy within the window.
    pub(super) fn value(&self, cube: &Cube) -> f64 {
        let energy = |&pixel: &usize| cube.pixel_bins(pixel)[self.bins.clone()].iter().sum::<f64>();
        self.pixels.iter().map(energy).sum::<f64>() / self.pixels.len().max(1) as f64
    }
}
