//! One cell of the matrix without exact values: a player against path tracing.
//!
//! Of batch i both methods have a value of each contrast, x_i and y_i, from independent random
//! numbers. Judged are x_i − y_i + ȳ against ȳ: the standard error is that of the difference, noise
//! of both included, with B − 1 degrees of freedom. Contrasts are chosen from the sum over all
//! batches of the baseline; what that choice owes to noise is far below the margin.

use std::sync::Arc;

use super::cases::Case;
use super::medium::MatrixMedium;
use super::players::{Family, Player};
use super::row::{BATCHES, contrasts};
use crate::contrasts::LinearContrast;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::{BatchPlan, batches};
use crate::memory::Cubes;
use crate::sabotage::Sabotage;
use crate::statistics::{Batches, Criterion, Target, judge};

/// Margin of methods without bias: both are noisy.
const UNBIASED: f64 = 0.01;
/// Margin of beams: what their radius blurs is in it.
const BLURRED: f64 = 0.015;

/// The comparison.
pub struct Pair {
    /// What is seen.
    pub case: Arc<dyn Case>,
    /// In which medium.
    pub medium: &'static MatrixMedium,
    /// Who is compared with path tracing.
    pub player: &'static Player,
}

impl Pair {
    fn margin(&self) -> f64 {
        if matches!(self.player.family, Family::Beams { .. }) { BLURRED } else { UNBIASED }
    }

    fn render(&self, player: &Player, seed: u64, context: &Context) -> Result<Cubes> {
        let budget = self.case.budget(player, self.medium, context.effort);
        let scene = context.assemble(self.case.parts(&self.case.view(), self.medium))?;
        let layout = context.layout(&scene.film)?;
        let plan = BatchPlan { batches: BATCHES, passes: budget.passes, seed };
        let key = format!(
            "{}/{}/{} {plan:?} {layout:?} {:?}",
            self.case.name(),
            self.medium.name,
            player.name,
            context.defect_of_the_scene()
        );
        context.memory.recall(&key, || {
            let mut cubes = Vec::new();
            batches(&scene, &player.estimator(&budget), layout, &plan, |cube| {
                cubes.push(cube.clone());
            })?;
            Ok(cubes)
        })
    }
}

fn mean(cubes: &[Cube]) -> Cube {
    let mut sum = cubes[0].clone();
    for cube in &cubes[1..] {
        sum.values.iter_mut().zip(&cube.values).for_each(|(sum, value)| *sum += value);
    }
    sum.scale(1.0 / cubes.len() as f64);
    sum
}

impl Experiment for Pair {
    fn name(&self) -> String {
        format!("matrix/{}/{}/{}", self.case.name(), self.medium.name, self.player.name)
    }

    fn description(&self) -> String {
        format!("{}; against path, within {} %", self.case.question(), 100.0 * self.margin())
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        let all = self.case.twins(self.player, self.medium);
        all.into_iter().take(effort.pick(1, usize::MAX)).collect()
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let sound = Context { sabotage: None, ..context.clone() };
        let baseline = self.render(Player::baseline(), context.seed, &sound)?;
        let ours = self.render(self.player, context.seed ^ 0xb1a5, context)?;
        let shape = mean(&baseline);
        let contrasts = contrasts(&*self.case, self.medium, self.player, &shape);
        let targets: Vec<Target> = contrasts
            .iter()
            .map(|c: &LinearContrast| Target {
                name: c.name.clone(),
                expected: c.value(&shape),
                error: 0.0,
            })
            .collect();
        let mut values = Batches::new();
        for (x, y) in ours.iter().zip(baseline.iter()) {
            let value = |(contrast, target): (&LinearContrast, &Target)| {
                context.estimate_factor() * contrast.value(x) - contrast.value(y) + target.expected
            };
            values.push(contrasts.iter().zip(&targets).map(value).collect());
        }
        let criterion = Criterion { margin: self.margin(), ..context.unbiased() };
        Ok(judge(&targets, &values, &criterion).into())
    }
}
