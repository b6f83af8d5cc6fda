//! Caustics through a narrow camera, so that every camera path goes where the caustic is.
//!
//! A path finds the lamp through the ball, or in a mirror, only by chance: of the whole room's camera
//! paths one in a hundred begins at the caustic, and a few dozen of those find its light. The same eye
//! with a field of view of a few degrees spends all of them there, and the three methods can be
//! compared with errors of a few per cent or less.

use glam::DVec3;
use tpb_scene::Scene;

use super::caustics::regions::{Region, window};
use super::room::Room;
use crate::error::Result;

/// Pixels on a side, at most.
pub(super) const PIXELS: usize = 16;

/// What the narrow camera looks at.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CloseUp {
    /// In names of files.
    pub(super) key: &'static str,
    /// For people.
    pub(super) label: &'static str,
    /// The middle of the picture \[m\].
    pub(super) place: DVec3,
    /// Half its width there \[m\].
    pub(super) half: f64,
    /// OPLs between which the caustic arrives \[m\].
    pub(super) arrives: [f64; 2],
}

impl CloseUp {
    /// The caustic on the floor, and the light in fog between the ball and its focus.
    pub(super) fn all(room: &Room) -> [Self; 2] {
        let fog = 0.5 * (room.poles()[1] + room.focus());
        let close_up = |key, label, place, half, before: f64, after: f64| {
            let arrival = room.through(place);
            Self { key, label, place, half, arrives: [arrival - before, arrival + after] }
        };
        [
            close_up("floor", "the caustic on the floor", room.floor, 0.12, 0.12, 0.2),
            close_up("fog", "the focused light in fog", fog, 0.12, 0.16, 0.28),
        ]
    }

    /// Changes of a scene that turn its camera there; the eye stays where it is.
    pub(super) fn changes(&self, eye: DVec3) -> [String; 2] {
        let DVec3 { x, y, z } = self.place;
        let angle = 2.0 * (self.half / self.place.distance(eye)).atan().to_degrees();
        [format!("sensor.fov={angle}"), format!("sensor.to_world.0.look_at.target=[{x},{y},{z}]")]
    }

    /// The picture over all time, as the caustic arrives, and its middle half as it arrives.
    pub(super) fn regions(&self, scene: &Scene, mask: &[bool]) -> Result<Vec<Region>> {
        let [from, to] = self.arrives;
        let (bins, arrives) = window(scene, from, to)?;
        let (width, height) = (scene.film.width, scene.film.height);
        let inner = |at: usize, end: usize| (end / 4..end - end / 4).contains(&at);
        let all: Vec<usize> = (0..mask.len()).filter(|&pixel| mask[pixel]).collect();
        let middle = all.iter().copied();
        let middle = middle.filter(|p| inner(p % width, width) && inner(p / width, height));
        let middle = middle.collect();
        let region = |what: &str, pixels: Vec<usize>, bins| Region {
            label: format!("{}{what}", self.label),
            pixels,
            bins,
        };
        Ok(vec![
            region(", all time", all.clone(), 0..bins),
            region(", as it arrives", all, arrives.clone()),
            region(", its middle, as it arrives", middle, arrives),
        ])
    }
}
