//! Equal time: photon beams against the path tracer, both against a long unbiased render.
//!
//! Three claims, each with its false-alarm probability:
//!
//! 1. the path tracer's bias is consistent with 0 (pixel-wise test, at the level of an experiment),
//!    and the same replicates with a defect made on purpose are found to be biased;
//! 2. where it is expected, beams have less NMSE · CPU s than the path tracer, one-sided at 1e-3;
//!    the chance to miss an advantage as large as the observed one is stated as unresolved;
//! 3. the beams' error is resolved: its relative standard error is below a quarter.
//!
//! Squared biases are reported. Fireflies (more than one replicate beyond three medians) add the
//! ratio of medians with a bootstrap interval.

use std::sync::Arc;
use std::time::Duration;

use tpb_beams::BeamOptions;
use tpb_path::PathOptions;

use crate::equal_time::{CONFIDENCE, CONTROL, EqualTime, EqualTimePlan, MethodResult};
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::measure::Estimator;
use crate::reference_cube::ReferenceCube;
use crate::registry::Experiments;
use crate::scenes::shipped;
use crate::statistics::{bootstrap, ratio::RATIO_LEVEL};

/// A scene for both methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EqualTimeRun {
    /// Name of the shipped scene.
    pub scene: &'static str,
    /// Wall time of a run in the full suite \[s\].
    pub full_seconds: u64,
    /// Whether beams are expected to win.
    pub beams_win: bool,
    /// Whether the path tracer finds all light, so that it may be tested for bias and its
    /// reference is the truth.
    pub path_complete: bool,
}

/// Each scene; caustics take long.
pub fn all(effort: Effort) -> Experiments {
    let mut list: Experiments = vec![Arc::new(EqualTimeRun {
        scene: "cornell-blocks",
        full_seconds: 8,
        beams_win: true,
        path_complete: true,
    })];
    if effort == Effort::Full {
        for (scene, path_complete) in [("mirror-caustic", true), ("mirror-caustic-point", false)] {
            list.push(Arc::new(EqualTimeRun {
                scene,
                full_seconds: 3,
                beams_win: false,
                path_complete,
            }));
        }
    }
    list
}

impl EqualTimeRun {
    fn compare(&self, context: &Context) -> Result<(EqualTime, Option<String>)> {
        let loaded = shipped(&context.scene_path(self.scene))?;
        let time = Duration::from_secs(40);
        let (reference, note) = ReferenceCube::of_shipped(&loaded, self.scene, context, time)?;
        let plan = EqualTimePlan {
            name: self.scene.into(),
            scene: &loaded.scene,
            reference: &reference,
            methods: vec![
                Estimator::Path(PathOptions::default()),
                Estimator::Beams(BeamOptions::default()),
            ],
            time: Duration::from_secs(context.effort.pick(6, self.full_seconds)),
            replicates: context.effort.pick(5, 8),
            seed: context.seed.wrapping_mul(1000),
        };
        Ok((plan.run()?, note))
    }
}

impl Experiment for EqualTimeRun {
    fn name(&self) -> String {
        format!("equal-time/{}", self.scene)
    }

    fn description(&self) -> String {
        format!("path and beams at equal time on {}, against a long path render", self.scene)
    }

    fn kind(&self) -> Kind {
        Kind::SelfControlled
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (result, note) = self.compare(context)?;
        let [path, beams] = result.methods.as_slice() else {
            return Ok(Outcome::exact(false, vec!["two methods are compared".into()]));
        };
        let bias_p = EqualTime::bias_p(path);
        let path_sound = !self.path_complete || bias_p > context.level;
        let control_p = EqualTime::control_p(path);
        let control_found = !self.path_complete || control_p <= context.level;
        let wins = result.factor.is_some_and(|factor| factor.p_at_most_one < RATIO_LEVEL);
        let resolved = beams.split.nmse.standard_error < 0.25 * beams.split.nmse.value;
        let mut notes: Vec<String> = note.into_iter().collect();
        notes.extend(remarks(path, beams, path_sound, wins, resolved));
        if self.path_complete {
            let end = if control_found { "rejected, as it must be" } else { "NOT rejected" };
            notes.push(format!(
                "control, all light of path times {CONTROL}: z = {:.1}, {end}",
                path.control_z()
            ));
        }
        let mut outcome = Outcome::exact(
            path_sound && control_found && resolved && (wins || !self.beams_win),
            notes,
        );
        outcome.worst_p = self.path_complete.then_some(bias_p);
        outcome.false_alarm = if self.path_complete { context.level } else { 0.0 };
        outcome.unresolved =
            if self.beams_win { result.factor.map_or(1.0, |factor| factor.miss) } else { 0.0 };
        outcome.equal_time = Some(result);
        Ok(outcome)
    }
}

fn remarks(
    path: &MethodResult,
    beams: &MethodResult,
    path_sound: bool,
    wins: bool,
    resolved: bool,
) -> Vec<String> {
    let mut notes = Vec::new();
    let relative = |interval: [f64; 2]| 100.0 * interval[1].max(0.0).sqrt();
    notes.push(format!(
        "relative bias of the cube, upper end of the 95 % interval: path {:.2} % (pixel-wise), beams {:.2} %",
        relative(path.pixel_bias.interval),
        relative(beams.split.squared_bias.interval)
    ));
    if !path_sound {
        notes.push(format!("the path tracer is BIASED: z = {:.1}", path.bias_z()));
    }
    if !wins {
        notes.push("beams are not better than path at equal time".into());
    }
    if !resolved {
        notes.push("the beams' error is not resolved".into());
    }
    if fireflies(path) || fireflies(beams) {
        let (ratio, [low, high]) =
            bootstrap::ratio_of_medians(&path.work(), &beams.work(), CONFIDENCE);
        notes.push(format!("fireflies: ratio of medians {ratio:.2} ({low:.2} to {high:.2})"));
    }
    notes
}

fn fireflies(method: &MethodResult) -> bool {
    let work = method.work();
    let median = bootstrap::median(&work);
    work.iter().any(|w| *w > 3.0 * median)
}
