//! A laser through a ball lens, onto a diffuse screen.
//!
//! A ray at the impact h is bent into the ball and out of it, and lands where and when
//! `tpb_reference::interfaces` says; both faces are met at the same angle, so that (1 − R)² of it is
//! left. The laser has a width: rays over its disc land around the middle one, and the expectation is
//! their sum, over a low-discrepancy sequence. The screen is seen by a camera in front of it. Of a
//! flat screen seen straight on, a pixel's area is a rectangle, and light ΔΦ that lands in it adds
//! ρ/π ΔΦ/A to its mean radiance. Beams spread each photon evenly over their disc, and shift its
//! time by ω·(x − p); both are part of the expectation.
//!
//! No camera path can connect to a laser, nor meet it: the path tracer has no part in this.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use tpb_optics::Rgb;
use tpb_reference::interfaces::{
    BallLens, SlabEcho, ball_lens_landing, ball_lens_time, slab_echo_weight_unpolarised,
};
use tpb_scene::geometry::Sphere;
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, FovAxis, Primitive, Reflector, Scene, Sensor, ShapePart,
    TimeSpec,
};

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::experiments::mirrors::Finder;
use crate::experiments::screen::{Sequence, blocks, disc};
use crate::experiments::sights::{across, glass};
use crate::measure::{BatchPlan, Estimator};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth};

const ETA: f64 = 1.5;
/// The laser starts at z = −L, the screen is at z = L, the ball of radius 1 at the origin.
const L: f64 = 4.0;
const EYE_Z: f64 = 2.5;
const LASER: f64 = 0.05;
const BLUR: f64 = 0.06;
const ALBEDO: f64 = 0.8;
const PIXELS: usize = 8;
const FOV: f64 = 30.0;
const POINTS: usize = 1 << 17;

/// A laser through a ball lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaserThroughBall {
    /// Who looks.
    pub who: Finder,
    /// Height of its middle over the axis.
    pub impact: f64,
}

/// Each method and impact.
pub fn all(effort: Effort) -> Experiments {
    let one = |who, impact| Arc::new(LaserThroughBall { who, impact }) as _;
    let mut list: Experiments = vec![one(Finder::Light, 0.6)];
    if effort == Effort::Full {
        list.extend([one(Finder::Beams, 0.6), one(Finder::Light, 0.3), one(Finder::Light, 0.7)]);
    }
    list
}

/// Where, when, from where and how much of a ray lands.
struct Landing {
    place: DVec2,
    opl: f64,
    direction: DVec3,
    left: f64,
}

/// The ray that starts at this place across the axis.
fn landing(start: DVec2) -> Result<Landing> {
    let impact = start.length();
    let ray = BallLens { impact, eta: ETA, radius: 1.0, distance: L, speed: 1.0 };
    let cos_incidence = ((1.0 - impact) * (1.0 + impact)).sqrt();
    let face = SlabEcho { eta: ETA, cos_incidence, echo: 0, thickness: 1.0, speed: 1.0 };
    let deviation = 2.0 * (impact.asin() - (impact / ETA).asin());
    let outwards = start / impact;
    Ok(Landing {
        place: ball_lens_landing(&ray)? * outwards,
        opl: ball_lens_time(&ray)?,
        direction: (-deviation.sin() * outwards).extend(deviation.cos()),
        left: slab_echo_weight_unpolarised(&face)?,
    })
}

impl LaserThroughBall {
    fn middle(self) -> Result<Landing> {
        landing(self.impact * DVec2::X)
    }

    fn estimator(self) -> Estimator {
        let mut estimator = self.who.estimator(1, 60_000, BLUR);
        if let Estimator::Beams(options) = &mut estimator {
            // The light is in few places of the image, which camera paths must find.
            options.surface_samples = Some(200);
            options.photons_per_pass = Some(20_000);
        }
        estimator
    }

    fn scene(self, context: &Context) -> Result<Scene> {
        let middle = self.middle()?;
        let start = middle.opl + (L - EYE_Z) - 0.4;
        let time = TimeSpec { start_opl: start, bin_width_opl: 0.02, bins: 60 };
        // Into the ball, out of it, and off the screen.
        let view = View { pixels: PIXELS, fov: FOV, time: Some(time), integrator: only_depth(4) };
        let mut parts = view.parts();
        let to_world = DAffine3::from_translation(middle.place.extend(EYE_Z));
        parts.sensor = Sensor::perspective(to_world, FOV, FovAxis::X, PIXELS, PIXELS);
        let ball = Sphere { centre: DVec3::ZERO, radius: 1.0, flipped: false };
        let front = Reflector::Diffuse(Rgb::splat(ALBEDO));
        parts.shapes = vec![
            ShapePart {
                name: "ball".into(),
                primitives: vec![Primitive::Sphere(ball)],
                bsdf: glass(ETA),
                boundary: None,
                radiance: None,
            },
            across("screen", L, -1.0, Bsdf::Opaque { front, back: Reflector::Black }),
        ];
        let kind = EmitterKind::Laser {
            position: DVec3::new(self.impact, 0.0, -L),
            axis: DVec3::Z,
            radius: LASER,
            power: Rgb::ONE,
        };
        parts.emitters = vec![EmitterPart { name: "laser".into(), kind, stated_medium: None }];
        context.assemble(parts)
    }

    fn expected(self, scene: &Scene, points: usize) -> Result<Cube> {
        let time = scene.film.time.expect("the scene has a time axis");
        let eye = scene.sensor.position;
        let side = 2.0 * (L - EYE_Z) * (0.5 * FOV.to_radians()).tan();
        let pixel_area = (side / PIXELS as f64).powi(2);
        let blur = self.who.blur(BLUR);
        let sequence = Sequence::new(4, 0);
        let mut cube = Cube::zero(PIXELS, PIXELS, time.bins);
        for index in 0..points {
            let u = |k| sequence.at(index, k);
            let start = self.impact * DVec2::X + LASER * disc(u(0), u(1));
            let ray = landing(start)?;
            let aside = blur * disc(u(2), u(3));
            let x = (ray.place + aside).extend(L);
            let lag = ray.direction.dot(aside.extend(0.0));
            let opl = ray.opl + lag + (x - eye).length();
            // The camera's +x is on the left, its +y at the top.
            let film = (x - eye).truncate() / side;
            let place = |offset: f64| ((0.5 - offset) * PIXELS as f64).floor();
            let (column, row) = (place(film.x), place(film.y));
            let inside = |k: f64| (0.0..PIXELS as f64).contains(&k);
            if !(inside(column) && inside(row)) {
                continue;
            }
            let cell = ((opl - time.start_opl) / time.bin_width_opl).floor() + 1.0;
            let cell = cell.clamp(0.0, time.bins as f64 + 1.0) as usize;
            let energy = ALBEDO / PI * ray.left / (points as f64 * pixel_area);
            cube.pixel_mut(row as usize * PIXELS + column as usize)[cell] += energy;
        }
        Ok(cube)
    }
}

impl Experiment for LaserThroughBall {
    fn name(&self) -> String {
        format!("ball-lens/impact-{}/{}", self.impact, self.who.name())
    }

    fn description(&self) -> String {
        "a laser through a ball lens onto a screen: where and when it lands, and how much".into()
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        if self.who == Finder::Beams { vec![Sabotage::KERNEL] } else { vec![Sabotage::LATE] }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = self.scene(context)?;
        let (expected, coarser) =
            (self.expected(&scene, POINTS)?, self.expected(&scene, POINTS / 2)?);
        let contrasts = standard(&expected, &blocks((PIXELS, PIXELS), (2, 1)), 2);
        Comparison {
            scene: &scene,
            estimator: self.estimator(),
            plan: BatchPlan { batches: 80, passes: 1, seed: context.seed },
            expected: &expected,
            coarser: Some(&coarser),
            contrasts: &contrasts,
            criterion: context.blurred(),
            dropped: &[],
        }
        .run(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    #[test]
    fn all_light_that_is_left_lands_within_film_and_window() {
        let context = Context::new(Effort::Quick, 1, PathBuf::new());
        for impact in [0.6, 0.3, 0.7] {
            let case = LaserThroughBall { who: Finder::Beams, impact };
            let scene = case.scene(&context).unwrap();
            let cube = case.expected(&scene, 4096).unwrap();
            let side = 2.0 * (L - EYE_Z) * (0.5 * FOV.to_radians()).tan();
            let mean = ALBEDO / PI / (side * side);
            let bins: f64 = (0..PIXELS * PIXELS).flat_map(|p| cube.pixel_bins(p)).sum();
            let seen = bins / (PIXELS * PIXELS) as f64 / mean;
            let left = case.middle().unwrap().left;
            assert!((seen / left - 1.0).abs() < 0.02, "{impact}: {seen} {left}");
        }
    }
}
