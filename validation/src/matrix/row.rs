//! One cell of the matrix with exact values: a player on a case in a medium.

use std::sync::Arc;

use super::cases::Case;
use super::medium::MatrixMedium;
use super::players::{Family, Player};
use crate::comparison::Comparison;
use crate::contrasts::{LinearContrast, standard};
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::BatchPlan;
use crate::sabotage::Sabotage;

/// Independent batches of every comparison in the matrix.
pub(super) const BATCHES: u64 = 64;

/// The comparison.
pub struct Row {
    /// What is seen.
    pub case: Arc<dyn Case>,
    /// In which medium.
    pub medium: &'static MatrixMedium,
    /// By whom.
    pub player: &'static Player,
}

/// The standard contrasts of each channel, named after it.
pub(super) fn contrasts(
    case: &dyn Case,
    medium: &MatrixMedium,
    player: &Player,
    shape: &Cube,
) -> Vec<LinearContrast> {
    let channels = medium.channels().len();
    let pixels = shape.pixels() / channels;
    (0..channels)
        .flat_map(|channel| {
            let place = |p: &usize| p + channel * pixels;
            let groups: Vec<(String, Vec<usize>)> = case
                .groups()
                .into_iter()
                .map(|(name, members)| (name, members.iter().map(place).collect()))
                .collect();
            let prefix = if channels == 1 { "" } else { ["red: ", "green: ", "blue: "][channel] };
            // Photons connected to the eye have the largest variance.
            let most = if player.family == Family::Light {
                3
            } else if channels == 3 {
                4
            } else {
                8
            };
            let shares = case.shares().min(most);
            let mut list = standard(shape, &groups, shares);
            if !player.is_right_in_time() {
                // Energy, and that of blocks of pixels.
                list.retain(|c| {
                    c.name == "energy" || groups.iter().any(|(name, _)| *name == c.name)
                });
            }
            list.into_iter()
                .map(move |c| LinearContrast { name: format!("{prefix}{}", c.name), ..c })
        })
        .collect()
}

/// Cubes of channels as one, the channels one below the other.
fn stacked(mut channels: Vec<Cube>) -> Cube {
    let mut all = channels.remove(0);
    for cube in channels {
        all.height += cube.height;
        all.values.extend(cube.values);
    }
    all
}

impl Row {
    /// The exact cubes, fine and coarse.
    fn expected(&self, radius: f64) -> Result<Vec<Cube>> {
        let blur = self.player.blur().map(|blur| (blur, radius));
        let channels = self.medium.channels();
        let all: Vec<_> =
            channels.iter().map(|c| self.case.expected(c, blur)).collect::<Result<_>>()?;
        let (fine, coarse) = all.into_iter().map(|e| (e.fine, e.coarse)).unzip();
        Ok(vec![stacked(fine), stacked(coarse)])
    }
}

impl Experiment for Row {
    fn name(&self) -> String {
        format!("matrix/{}/{}/{}", self.case.name(), self.medium.name, self.player.name)
    }

    fn description(&self) -> String {
        let target = match (self.player.blur(), self.case.is_blurred()) {
            (Some(_), true) => "expected blur",
            _ => "value",
        };
        format!("{}; against the exact {target}", self.case.question())
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        let all = self.case.twins(self.player, self.medium);
        all.into_iter().take(effort.pick(1, usize::MAX)).collect()
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (case, medium, player) = (&*self.case, self.medium, self.player);
        let name = self.name();
        let budget = case.budget(player, self.medium, context.effort);
        let scene = context.assemble(case.parts(&case.view(), medium))?;
        let expected = context
            .memory
            .recall(&format!("expected of {name}"), || self.expected(budget.radius))?;
        let contrasts = contrasts(case, medium, player, &expected[0]);
        let blurred = player.blur().is_some() && case.is_blurred();
        Comparison {
            scene: &scene,
            estimator: player.estimator(&budget),
            plan: BatchPlan { batches: BATCHES, passes: budget.passes, seed: context.seed },
            expected: &expected[0],
            coarser: Some(&expected[1]),
            contrasts: &contrasts,
            criterion: if blurred { context.blurred() } else { context.unbiased() },
            dropped: &case.dropped(),
        }
        .run_remembered(context, &name)
    }
}
