//! Sum of bins + before + after = steady image, for the same random numbers.
//!
//! The same method renders the same passes into a film whose window cuts through the light, and
//! into one without a time axis. Pixel by pixel the sums agree to rounding: of f64 for the steady
//! image that the transient film keeps, of f32 for the arrays.

use std::sync::Arc;

use tpb_beams::BeamOptions;
use tpb_film::{Layout, TimeAxis};
use tpb_light::LightOptions;
use tpb_path::PathOptions;
use tpb_render::{Budget, RunSettings};
use tpb_scene::Plan;

use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::measure::{Estimator, render};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::smaller;
use crate::statistics::worse;

const F64_TOLERANCE: f64 = 1e-11;
const F32_TOLERANCE: f64 = 2e-6;

/// One method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SumOfBins {
    /// The path tracer.
    Path,
    /// The light tracer.
    Light,
    /// Photon beams.
    Beams,
}

/// Each method.
pub fn all() -> Experiments {
    vec![Arc::new(SumOfBins::Path), Arc::new(SumOfBins::Light), Arc::new(SumOfBins::Beams)]
}

impl SumOfBins {
    fn estimator(self) -> Estimator {
        match self {
            Self::Path => Estimator::Path(PathOptions { samples_per_pass: 16.try_into().ok() }),
            Self::Light => Estimator::Light(LightOptions { photons_per_pass: Some(20_000) }),
            Self::Beams => Estimator::Beams(BeamOptions {
                photons_per_pass: Some(20_000),
                radius: Some(0.05),
                surface_radius: Some(0.05),
                ..BeamOptions::default()
            }),
        }
    }
}

impl Experiment for SumOfBins {
    fn name(&self) -> String {
        format!("energy/sum-of-bins/{}", self.estimator().name())
    }

    fn description(&self) -> String {
        "bins + before + after against the steady render of the same seed".into()
    }

    fn kind(&self) -> Kind {
        Kind::Exact
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        vec![Sabotage::LOSS]
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = smaller(&context.scene_path("cornell-blocks"), 24)?;
        let plan = Plan::new(&scene, &scene.integrator);
        let method = self.estimator().prepare::<1>(&scene, &plan, scene.integrator)?;
        let settings = RunSettings { seed: context.seed, budget: Budget::Passes(2), first_pass: 0 };
        let window = TimeAxis { start_opl: 4.5, bin_width_opl: 0.11, bins: 30 };
        let resolved = render(&*method, Layout::new(24, 24, Some(window))?, &settings)?.0;
        let steady = render(&*method, Layout::new(24, 24, None)?, &settings)?.0.steady;
        let mut cube = Cube::of(&resolved);
        cube.scale(context.estimate_factor());
        let relative = |a: f64, b: f64| if a == b { 0.0 } else { (a - b).abs() / b.abs() };
        let (mut of_f64, mut of_f32, mut outside) = (0.0_f64, 0.0_f64, 0.0);
        for (pixel, &expected) in steady.iter().enumerate() {
            let cells = cube.pixel(pixel);
            of_f64 = worse(of_f64, relative(resolved.steady[pixel], expected));
            of_f32 = worse(of_f32, relative(cells.iter().sum(), expected));
            outside += cells[0] + cells[cells.len() - 1];
        }
        let share = outside / steady.iter().sum::<f64>();
        let passed = of_f64 <= F64_TOLERANCE && of_f32 <= F32_TOLERANCE && share > 0.01;
        let note = format!(
            "off by {of_f64:.1e} (f64), {of_f32:.1e} (f32 arrays); {:.0} % of the light outside the window",
            100.0 * share
        );
        Ok(Outcome::exact(passed, vec![note]).with_interval([-of_f32, of_f32]))
    }
}
