//! A diffuse sphere that is lit in one spot of its wall.
//!
//! From the spot light goes to any point of the wall and is reflected a second time; what then meets
//! a third point, at the angle γ from the spot, has a law of its own, with a front, a logarithmic
//! pole and a step (`tpb_reference::diffuse_sphere`): the two chords must end where the camera looks.
//! A camera at the centre sees the third reflection over a wide range of γ, per bin.
//!
//! For beams and light tracing a laser lights the spot. No camera path can connect to a laser: the
//! path tracer gets a small round lamp there, of the power that the spot would reflect. Spot and disc
//! are 0.02 and 0.04 radii wide, which changes the expectation by parts of 1e-3 of a bin's width.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;
use tpb_optics::Rgb;
use tpb_reference::diffuse_sphere::{SpotBin, sphere_spot_irradiance_bins};
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{Bsdf, EmitterKind, EmitterPart, Primitive, Scene, ShapePart, TimeSpec};

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::experiments::screen::{Sequence, blocks};
use crate::experiments::sights::lamp;
use crate::experiments::sphere::Insider;
use crate::measure::BatchPlan;
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, diffuse_sphere_parts, only_depth};

const ALBEDO: f64 = 0.7;
const SPOT: f64 = 0.02;
/// The spot, seen from the centre; the camera looks along +z.
const TOWARDS: DVec3 = DVec3::X;
/// The laser's distance from the spot.
const LASER: f64 = 0.9;
const SIDE: usize = 8;
const FOV: f64 = 80.0;
const POINTS: usize = 32;
const TIME: TimeSpec = TimeSpec { start_opl: 1.55, bin_width_opl: 0.1, bins: 54 };

/// Two hops from a spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SphereSpot {
    /// Who looks.
    pub who: Insider,
}

/// Each method.
pub fn all(effort: Effort) -> Experiments {
    let one = |who| Arc::new(SphereSpot { who }) as _;
    let mut list: Experiments = vec![one(Insider::Path)];
    if effort == Effort::Full {
        list.extend([Insider::Beams, Insider::Light].map(one));
    }
    list
}

impl SphereSpot {
    fn scene(self, context: &Context) -> Result<Scene> {
        // Beyond the spot: two reflections, of which the camera sees the last.
        let events = if self.who == Insider::Path { 2 } else { 3 };
        let integrator = only_depth(events + 1);
        let view = View { pixels: SIDE, fov: FOV, time: Some(TIME), integrator };
        let mut parts = diffuse_sphere_parts(&view, ALBEDO);
        parts.emitters.clear();
        if self.who == Insider::Path {
            let (u, v) = (-TOWARDS).any_orthonormal_pair();
            let centre = (1.0 - SPOT * SPOT).sqrt() * TOWARDS;
            let disc = Planar::new(centre, SPOT * u, SPOT * v, Outline::Ellipse);
            let disc = if disc.normal.dot(TOWARDS) < 0.0 {
                disc
            } else {
                Planar::new(centre, SPOT * v, SPOT * u, Outline::Ellipse)
            };
            let shape = ShapePart {
                name: "spot".into(),
                primitives: vec![Primitive::Planar(disc)],
                bsdf: Bsdf::Null,
                boundary: None,
                radiance: None,
            };
            parts.shapes.push(lamp(shape, ALBEDO / (PI * PI * SPOT * SPOT)));
        } else {
            let kind = EmitterKind::Laser {
                position: (1.0 - LASER) * TOWARDS,
                axis: TOWARDS,
                radius: SPOT,
                power: Rgb::ONE,
            };
            parts.emitters = vec![EmitterPart { name: "laser".into(), kind, stated_medium: None }];
        }
        context.assemble(parts)
    }

    fn expected(self, scene: &Scene, points: usize) -> Result<Cube> {
        // From the laser to the spot, and from the wall to the camera.
        let legs = if self.who == Insider::Path { 1.0 } else { 1.0 + LASER };
        let mut cube = Cube::zero(SIDE, SIDE, TIME.bins);
        let pixel = |pixel: usize| -> Result<Vec<f64>> {
            let mut bins = vec![0.0; TIME.bins];
            let sequence = Sequence::new(2, pixel);
            let (column, row) = ((pixel % SIDE) as f64, (pixel / SIDE) as f64);
            for point in 0..points {
                let (x, y) = (column + sequence.at(point, 0), row + sequence.at(point, 1));
                let cos_gamma = scene.sensor.direction(x, y).dot(TOWARDS);
                for (index, bin) in bins.iter_mut().enumerate() {
                    let edge =
                        |i: usize| (TIME.start_opl + i as f64 * TIME.bin_width_opl - legs).max(0.0);
                    let irradiance = sphere_spot_irradiance_bins(&SpotBin {
                        energy: 1.0,
                        albedo: ALBEDO,
                        radius: 1.0,
                        speed: 1.0,
                        cos_gamma,
                        order: 2,
                        t0: edge(index),
                        t1: edge(index + 1),
                    })?;
                    *bin += ALBEDO / PI * irradiance / points as f64;
                }
            }
            Ok(bins)
        };
        let rows: Vec<Vec<f64>> =
            (0..SIDE * SIDE).into_par_iter().map(pixel).collect::<Result<_>>()?;
        for (pixel, bins) in rows.iter().enumerate() {
            cube.pixel_mut(pixel)[1..=TIME.bins].copy_from_slice(bins);
        }
        Ok(cube)
    }
}

impl Experiment for SphereSpot {
    fn name(&self) -> String {
        format!("sphere-spot/{}", self.who.name())
    }

    fn description(&self) -> String {
        "two hops from a spot of a diffuse sphere to where the camera looks, per bin".into()
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        if effort == Effort::Full { vec![Sabotage::LATE] } else { vec![] }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = self.scene(context)?;
        let (expected, coarser) =
            (self.expected(&scene, POINTS)?, self.expected(&scene, POINTS / 2)?);
        let path = self.who == Insider::Path;
        let shares = if path { 8 } else { 3 };
        let contrasts = standard(&expected, &blocks((SIDE, SIDE), (2, 1)), shares);
        Comparison {
            scene: &scene,
            estimator: self.who.estimator(1200, 200_000),
            plan: BatchPlan { batches: 80, passes: 1, seed: context.seed },
            expected: &expected,
            coarser: Some(&coarser),
            contrasts: &contrasts,
            // The spot is not a point.
            criterion: context.blurred(),
            dropped: &[],
        }
        .run(context)
    }
}
