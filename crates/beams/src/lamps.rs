//! More rays for pixels that see lamps.
//!
//! A lamp is brighter than all around it, and its edge is sharp: where it is seen straight, in mirrors
//! or through smooth glass, the few paths of a pixel that serve for dim, blurred light leave more noise
//! than everything else together. Looking for lamps alone is cheap, so such pixels get more rays that do
//! nothing else.
//!
//! Which pixels those are is decided before the first pass, by rays of a fixed grid, each pixel with its
//! neighbours. Numbers of rays thus do not depend on what they find: the estimate is unbiased, also where
//! the grid has missed a lamp.

use glam::DVec3;
use rayon::prelude::*;
use tpb_film::Tile;
use tpb_optics::quasi::Points;
use tpb_optics::{Stream, seed_of};
use tpb_render::PassId;
use tpb_scene::{Flight, Plan, Scene, Vertex};
use tpb_transport::{Carrier, Encounter, Response, Sampler};

use crate::camera::{Camera, Path};
use crate::kernel::RayBeamKernel;
use crate::stream_item;

/// Rays along a pixel's edge.
const GRID: usize = 2;
/// Mirrors and glass that such a ray follows at most.
const MOST_TURNS: usize = 8;

/// The pixels that see lamps.
pub(crate) struct LampPixels {
    /// Of each pixel of the film; empty if none does.
    seen: Vec<bool>,
    /// Rays that each of them gets in a pass.
    samples: u32,
}

impl LampPixels {
    /// `samples` rays at most for each, and `all_samples` for all pixels on average.
    pub(crate) fn new(scene: &Scene, plan: &Plan, samples: u32, all_samples: u32) -> Self {
        let (width, height) = (scene.film.width, scene.film.height);
        if !plan.lamp_rays || samples == 0 {
            return Self { seen: vec![], samples: 0 };
        }
        let found: Vec<bool> =
            (0..width * height).into_par_iter().map(|pixel| sees_lamp(scene, pixel)).collect();
        let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        let near = |pixel: usize| {
            let (column, row) = (pixel % width, pixel / width);
            around(row, height).any(|y| around(column, width).any(|x| found[y * width + x]))
        };
        let seen: Vec<bool> = (0..width * height).into_par_iter().map(near).collect();
        let count = seen.iter().filter(|&&seen| seen).count();
        if count == 0 {
            return Self { seen: vec![], samples: 0 };
        }
        let fair = u64::from(all_samples) * (width * height) as u64 / count as u64;
        Self { seen, samples: samples.min(u32::try_from(fair).unwrap_or(u32::MAX)) }
    }

    /// The part of a lamp's light that a pixel's other `paths` bring.
    pub(crate) fn part_of_others(&self, pixel: usize, paths: u32) -> f64 {
        f64::from(paths) / f64::from(paths + self.samples(pixel))
    }

    /// Rays that a pixel gets in a pass.
    fn samples(&self, pixel: usize) -> u32 {
        if self.seen.get(pixel).is_some_and(|&seen| seen) { self.samples } else { 0 }
    }
}

/// Whether a ray of a pixel's grid sees a lamp.
fn sees_lamp(scene: &Scene, pixel: usize) -> bool {
    let (column, row) = (pixel % scene.film.width, pixel / scene.film.width);
    // Not the numbers of any pass.
    let mut rng = Stream::new(0, u64::MAX, stream_item::lamp(pixel));
    (0..GRID * GRID).any(|ray| {
        let at = |start: usize, step: usize| start as f64 + (step as f64 + 0.5) / GRID as f64;
        let direction = scene.sensor.direction(at(column, ray % GRID), at(row, ray / GRID));
        leads_to_lamp(scene, direction, &mut rng)
    })
}

fn leads_to_lamp(scene: &Scene, mut direction: DVec3, rng: &mut Stream) -> bool {
    let mut vertex = scene.eye();
    for _ in 0..=MOST_TURNS {
        let flight = scene.fly(&vertex, direction);
        let Some(hit) = flight.hit else { return false };
        if scene.emitted::<1>(&hit, direction).is_some() {
            return true;
        }
        let encounter = Encounter::new(scene, &flight, &hit, Carrier::Importance);
        let Response::Turned(turn) = encounter.respond(rng) else { return false };
        direction = turn.direction;
        let (position, primitive) = (hit.position, Some(hit.primitive));
        vertex = Vertex { position, primitive, region: turn.region };
    }
    false
}

impl<const C: usize, K: RayBeamKernel> Camera<'_, C, K> {
    /// All rays of a tile that look for lamps alone; a pixel's are spread evenly over it.
    pub(crate) fn look_for_lamps(&self, id: PassId, tile: &mut Tile<'_, C>) {
        let width = tile.columns().len();
        let corner = (tile.columns().start, tile.rows().start);
        let pixels: Vec<_> = tile.pixels().collect();
        for (place, pixel) in pixels.into_iter().enumerate() {
            let samples = self.lamps.samples(pixel);
            if samples == 0 {
                continue;
            }
            let item = stream_item::lamp(pixel);
            let mut rng = Stream::new(id.seed, id.index, item);
            let points = Points::new(seed_of(seed_of(id.seed, id.index), item));
            let share = 1.0 / f64::from(samples + self.settings.surface_samples);
            for sample in 0..samples {
                let [u, v] = match self.settings.sampler {
                    Sampler::Independent => [rng.uniform(), rng.uniform()],
                    Sampler::Sobol => {
                        let [u, v, ..] = points.at(u64::from(sample), 0, &mut rng);
                        [u, v]
                    }
                };
                let (x, y) = (corner.0 + place % width, corner.1 + place / width);
                let direction = self.scene.sensor.direction(x as f64 + u, y as f64 + v);
                let flight = self.scene.fly(&self.scene.eye(), direction);
                self.follow_to_lamp(
                    Path::new(self.scene.eye(), (place, 0), points, &flight),
                    flight,
                    share,
                    (&mut rng, tile),
                );
            }
        }
    }

    /// Along mirrors and smooth glass.
    fn follow_to_lamp(
        &self,
        mut path: Path<C>,
        mut flight: Flight,
        share: f64,
        (rng, tile): (&mut Stream, &mut Tile<'_, C>),
    ) {
        while let Some(hit) = flight.hit {
            path.arrive(self.scene, &flight, &hit);
            self.emission(&mut path, &hit, share, tile);
            let encounter = Encounter::new(self.scene, &flight, &hit, Carrier::Importance);
            let Response::Turned(turn) = encounter.respond(rng) else { return };
            path.turn(&turn);
            path.events += 1;
            let deeper = self.integrator.reaches(path.events + 1) && !path.throughput.is_zero();
            if !(deeper && self.survives(&mut path, rng)) {
                return;
            }
            flight = self.scene.fly(&path.vertex, path.direction);
        }
    }
}
