//! A furnace: the inside of a diffuse sphere whose whole wall emits.
//!
//! Wherever one looks, light that was reflected n times has the radiance L ρⁿ: a diffuse wall with
//! albedo ρ sees L from all sides. It left the wall n chords before the last leg, from the wall to
//! the camera at the centre: arrival is 1 + n chords of a unit sphere with Lambertian ends
//! (`tpb_reference::diffuse_sphere::sphere_chords_cdf`). Depth n + 1 isolates n.
//!
//! This is the test of emitters that have an area: of their radiance, of the densities of
//! connections and of chance hits, and of the weights between the two.

use std::sync::Arc;

use tpb_optics::Rgb;
use tpb_reference::diffuse_sphere::{SphereChords, sphere_chords_cdf};
use tpb_scene::TimeSpec;

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::experiments::screen::blocks;
use crate::experiments::sphere::Insider;
use crate::measure::BatchPlan;
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, diffuse_sphere_parts, only_depth};

const ALBEDO: f64 = 0.6;
const RADIANCE: f64 = 3.0;
const TIME: TimeSpec = TimeSpec { start_opl: 0.95, bin_width_opl: 0.2, bins: 22 };
const SIDE: usize = 8;

/// One order of reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Furnace {
    /// Who looks.
    pub who: Insider,
    /// Number of reflections.
    pub reflections: u32,
}

/// One and two reflections.
pub fn all(effort: Effort) -> Experiments {
    let one = |who, reflections| Arc::new(Furnace { who, reflections }) as _;
    let mut list: Experiments = vec![one(Insider::Path, 1)];
    if effort == Effort::Full {
        list.extend([one(Insider::Path, 2), one(Insider::Light, 1)]);
        list.extend([one(Insider::Beams, 1), one(Insider::Beams, 2)]);
    }
    list
}

impl Furnace {
    fn expected(self) -> Result<Cube> {
        let total = RADIANCE * ALBEDO.powi(self.reflections.cast_signed());
        let arrived = |opl: f64| {
            let x = (0.5 * (opl - 1.0)).max(0.0); // in diameters
            sphere_chords_cdf(&SphereChords { chords: self.reflections, x })
                .map(|share| total * share)
        };
        let edge = |i: usize| TIME.start_opl + i as f64 * TIME.bin_width_opl;
        let mut cube = Cube::zero(SIDE, SIDE, TIME.bins);
        for bin in 0..TIME.bins {
            let energy = arrived(edge(bin + 1))? - arrived(edge(bin))?;
            for pixel in 0..cube.pixels() {
                cube.pixel_mut(pixel)[1 + bin] = energy;
            }
        }
        Ok(cube)
    }
}

impl Experiment for Furnace {
    fn name(&self) -> String {
        format!("furnace/{}-reflections/{}", self.reflections, self.who.name())
    }

    fn description(&self) -> String {
        "a diffuse sphere whose wall emits: radiance and arrival against the exact law".into()
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        effort.pick(vec![Sabotage::LOSS], vec![Sabotage::LOSS, Sabotage::LATE])
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let integrator = only_depth(self.reflections + 1);
        let view = View { pixels: SIDE, fov: 80.0, time: Some(TIME), integrator };
        let mut parts = diffuse_sphere_parts(&view, ALBEDO);
        parts.emitters.clear();
        parts.shapes[0].radiance = Some(Rgb::splat(RADIANCE));
        let scene = context.assemble(parts)?;
        let expected = self.expected()?;
        // What is connected to the lamp has no blur, whoever does it.
        let blurred = self.who == Insider::Beams && self.reflections > 1;
        let passes = match (self.who, self.reflections) {
            (Insider::Light, _) => 4,
            (Insider::Beams, 1) => 12,
            _ => 2,
        };
        Comparison {
            scene: &scene,
            estimator: self.who.estimator(600, 100_000),
            plan: BatchPlan { batches: 80, passes, seed: context.seed },
            expected: &expected,
            coarser: None,
            contrasts: &standard(&expected, &blocks((SIDE, SIDE), (2, 1)), 3),
            criterion: if blurred { context.blurred() } else { context.unbiased() },
            dropped: &[],
        }
        .run_remembered(context, &self.name())
    }
}
