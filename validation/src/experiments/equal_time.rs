//! Equal time: photon beams against an unbiased method, both against a long render of the latter:
//! the path tracer, or the light tracer where paths do not find all light.
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

use crate::equal_time::{CONFIDENCE, EqualTime, EqualTimePlan, MethodResult};
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::judged::Referee;
use crate::measure::Estimator;
use crate::reference_cube::ReferenceCube;
use crate::registry::Experiments;
use crate::scenes::shipped;
use crate::statistics::{bootstrap, ratio::RATIO_LEVEL};

/// A scene for both methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EqualTimeRun {
    /// Name of the shipped scene.
    pub scene: &'static str,
    /// Wall time of a run in the full suite \[s\].
    pub full_seconds: u64,
    /// Whether beams are expected to win.
    pub beams_win: bool,
    /// Whose long render is the truth; the path tracer's own runs are then tested for bias.
    pub referee: Referee,
    /// The defect of all light that this test must find.
    pub control: f64,
}

/// All of them; the first is part of the quick suite.
pub const RUNS: [EqualTimeRun; 3] = [
    EqualTimeRun {
        scene: "cornell-blocks",
        full_seconds: 8,
        beams_win: true,
        referee: Referee::Path,
        control: 1.1,
    },
    EqualTimeRun {
        scene: "mirror-caustic",
        full_seconds: 4,
        beams_win: true,
        referee: Referee::Path,
        control: 1.2,
    },
    // No path finds the caustics of its point lamp. They are sharper than any blur.
    EqualTimeRun {
        scene: "mirror-caustic-point",
        full_seconds: 4,
        beams_win: false,
        referee: Referee::Light,
        control: 1.1,
    },
];

/// Each scene; caustics take long.
pub fn all(effort: Effort) -> Experiments {
    let runs = if effort == Effort::Full { &RUNS[..] } else { &RUNS[..1] };
    runs.iter().map(|&run| Arc::new(run) as Arc<dyn Experiment>).collect()
}

impl EqualTimeRun {
    fn compare(&self, context: &Context) -> Result<(EqualTime, Option<String>)> {
        let loaded = shipped(&context.scene_path(self.scene))?;
        let time = Duration::from_secs(40);
        let (reference, note) =
            ReferenceCube::of_shipped(&loaded, self.scene, self.referee, context, time)?;
        let plan = EqualTimePlan {
            name: self.scene.into(),
            scene: &loaded.scene,
            reference: &reference,
            methods: vec![self.referee.estimator(), Estimator::Beams(BeamOptions::default())],
            control: self.control,
            time: Duration::from_secs(context.effort.pick(6, self.full_seconds)),
            replicates: context.effort.pick(5, 16),
            seed: context.seed,
        };
        Ok((plan.run()?, note))
    }
}

impl Experiment for EqualTimeRun {
    fn name(&self) -> String {
        format!("equal-time/{}", self.scene)
    }

    fn description(&self) -> String {
        let name = self.referee.estimator().name();
        format!("{name} and beams at equal time on {}, against a long {name} render", self.scene)
    }

    fn kind(&self) -> Kind {
        Kind::SelfControlled
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (result, note) = self.compare(context)?;
        let [baseline, beams] = result.methods.as_slice() else {
            return Ok(Outcome::exact(false, vec!["two methods are compared".into()]));
        };
        // Pixels of the light tracer share photons: the test is not for them.
        let tested = self.referee == Referee::Path;
        let bias_p = EqualTime::bias_p(baseline);
        let sound = !tested || bias_p > context.level;
        let control_found = !tested || EqualTime::control_p(baseline) <= context.level;
        let wins = result.factor.is_some_and(|factor| factor.p_at_most_one < RATIO_LEVEL);
        let resolved = beams.split.nmse.standard_error < 0.25 * beams.split.nmse.value;
        let mut notes: Vec<String> = note.into_iter().collect();
        notes.extend(remarks(baseline, beams, sound, wins, resolved));
        if tested {
            let end = if control_found { "rejected, as it must be" } else { "NOT rejected" };
            notes.push(format!(
                "control, all light of path times {}: z = {:.1}, {end}",
                self.control,
                baseline.control_z()
            ));
        }
        let mut outcome =
            Outcome::exact(sound && control_found && resolved && (wins || !self.beams_win), notes);
        outcome.worst_p = tested.then_some(bias_p);
        outcome.false_alarm = if tested { context.level } else { 0.0 };
        outcome.unresolved =
            if self.beams_win { result.factor.map_or(1.0, |factor| factor.miss) } else { 0.0 };
        outcome.equal_time = Some(result);
        Ok(outcome)
    }
}

fn remarks(
    baseline: &MethodResult,
    beams: &MethodResult,
    sound: bool,
    wins: bool,
    resolved: bool,
) -> Vec<String> {
    let mut notes = Vec::new();
    let relative = |interval: [f64; 2]| 100.0 * interval[1].max(0.0).sqrt();
    notes.push(format!(
        "relative bias of the cube, upper end of the 95 % interval: {} {:.2} % (pixel-wise), beams {:.2} %",
        baseline.method,
        relative(baseline.pixel_bias.interval),
        relative(beams.split.squared_bias.interval)
    ));
    if !sound {
        notes.push(format!("the path tracer is BIASED: z = {:.1}", baseline.bias_z()));
    }
    if !wins {
        notes.push(format!("beams are not better than {} at equal time", baseline.method));
    }
    if !resolved {
        notes.push("the beams' error is not resolved".into());
    }
    if fireflies(baseline) || fireflies(beams) {
        let (ratio, [low, high]) =
            bootstrap::ratio_of_medians(&baseline.work(), &beams.work(), CONFIDENCE);
        notes.push(format!("fireflies: ratio of medians {ratio:.2} ({low:.2} to {high:.2})"));
    }
    notes
}

fn fireflies(method: &MethodResult) -> bool {
    let work = method.work();
    let median = bootstrap::median(&work);
    work.iter().any(|w| *w > 3.0 * median)
}
