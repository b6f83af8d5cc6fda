//! The variance that a film reports against the spread of its passes.
//!
//! The same passes are rendered into one film that keeps the variance, and each into a film of its
//! own. Cell by cell, what the first reports must be the sample variance of the others, made in two
//! sweeps, over their number: s²/n.

use std::sync::Arc;

use tpb_beams::BeamOptions;
use tpb_film::FilmOptions;
use tpb_light::LightOptions;
use tpb_path::PathOptions;
use tpb_render::{Budget, RunSettings};
use tpb_scene::Plan;

use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::measure::{Estimator, layout, render, render_keeping};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::smaller;
use crate::statistics::worse;

/// Arrays are f32, and so is what the two sweeps read.
const TOLERANCE: f64 = 1e-5;
const PASSES: u64 = 8;
const SIZE: usize = 16;

/// One method.
struct StandardError(Estimator);

/// Path and light tracing, whose passes are alike, and beams, whose radius shrinks.
pub fn all() -> Experiments {
    let path = Estimator::Path(PathOptions { samples_per_pass: 4.try_into().ok() });
    let beams = Estimator::Beams(BeamOptions {
        photons_per_pass: Some(4000),
        radius: Some(0.1),
        surface_radius: Some(0.1),
        ..BeamOptions::default()
    });
    let light = Estimator::Light(LightOptions { photons_per_pass: Some(4000) });
    [path, light, beams].map(|estimator| Arc::new(StandardError(estimator)) as _).to_vec()
}

impl Experiment for StandardError {
    fn name(&self) -> String {
        format!("energy/standard-error/{}", self.0.name())
    }

    fn description(&self) -> String {
        "the variance that the film reports against the spread of its passes".into()
    }

    fn kind(&self) -> Kind {
        Kind::Exact
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        vec![Sabotage::LOSS]
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = smaller(&context.scene_path("cornell-blocks"), SIZE)?;
        let plan = Plan::new(&scene, &scene.integrator);
        let method = self.0.prepare::<1>(&scene, &plan, scene.integrator)?;
        let layout = layout(&scene.film, 0.0)?;
        let settings = |passes, first_pass| RunSettings {
            seed: context.seed,
            budget: Budget::Passes(passes),
            first_pass,
        };
        let keeping = FilmOptions { variance: true, ..FilmOptions::default() };
        let reported = render_keeping(&*method, layout, keeping, &settings(PASSES, 0))?.0;
        let passes = (0..PASSES)
            .map(|pass| Ok(render(&*method, layout, &settings(1, pass))?.0.transient))
            .collect::<Result<Vec<_>>>()?;
        let (mut worst, mut cells) = (0.0_f64, 0_usize);
        for (cell, &variance) in reported.variance.iter().flatten().enumerate() {
            let values = || passes.iter().map(|pass| f64::from(pass[cell]));
            let n = PASSES as f64;
            let mean = values().sum::<f64>() / n;
            let squares = values().map(|value| (value - mean) * (value - mean)).sum::<f64>();
            let expected = squares / (n * (n - 1.0));
            if expected == 0.0 {
                worst = worse(worst, f64::from(variance));
            } else {
                let reported = f64::from(variance) * context.estimate_factor();
                worst = worse(worst, (reported / expected - 1.0).abs());
                cells += 1;
            }
        }
        let passed = worst <= TOLERANCE && cells > 1000;
        let note = format!("{cells} lit cells of {PASSES} passes, off by {worst:.1e}");
        Ok(Outcome::exact(passed, vec![note]).with_interval([-worst, worst]))
    }
}
