//! What an experiment is: a name, a run, an outcome.
//!
//! An experiment asks one question about the programs and answers it with a verdict, an interval
//! of the measured error, and the probability that the verdict is a false alarm. Its budget is
//! fixed by the [`Effort`] (never by the clock, save in equal-time runs), its random numbers by
//! the seed: it repeats to the bit.
//!
//! A [`Twin`] is the same experiment on programs that were sabotaged on purpose, at the same
//! budget. It passes if and only if the sabotage is found to be a significant *difference*; being
//! unable to tell is not enough. Without twins, a suite that cannot fail would look like one that
//! never has to.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::equal_time::EqualTime;
use crate::error::Result;
use crate::statistics::{Contrast, Finding, Judgement};

/// How much work an experiment may do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Minutes for the whole suite.
    #[default]
    Quick,
    /// Tens of minutes: more batches, longer equal-time runs, more scenes.
    Full,
}

impl Effort {
    /// One of two values.
    pub fn pick<T>(self, quick: T, full: T) -> T {
        if self == Self::Quick { quick } else { full }
    }
}

/// What all experiments of a run share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Context {
    /// How much work to do.
    pub effort: Effort,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Where failing experiments leave their tables.
    pub out: PathBuf,
    /// Root of the workspace's validation data: scenes, tables, reference cubes.
    pub data: PathBuf,
}

impl Context {
    /// A context on the data that ship with this crate.
    pub fn new(effort: Effort, seed: u64, out: PathBuf) -> Self {
        Self { effort, seed, out, data: PathBuf::from(env!("CARGO_MANIFEST_DIR")) }
    }

    /// A shipped scene.
    pub fn scene_path(&self, name: &str) -> PathBuf {
        self.data.join("scenes").join(format!("{name}.json"))
    }

    /// The reference cube of a shipped scene.
    pub fn reference_path(&self, name: &str) -> PathBuf {
        self.data.join("references").join(format!("{name}.npz"))
    }
}

/// How an experiment ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// As it should be.
    Passed,
    /// Not as it should be.
    Failed,
    /// There is no result.
    Broken,
}

/// What an experiment found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// As a comparison sees it, before a twin turns it around.
    pub finding: Finding,
    /// How it ended.
    pub verdict: Verdict,
    /// The interval of the relative error that reaches farthest from 0, if errors are measured.
    pub interval: Option<[f64; 2]>,
    /// The smallest p value, corrected for the number of tests, if there are tests.
    pub worst_p: Option<f64>,
    /// Chance of calling something different, or biased, though nothing is wrong.
    pub false_alarm: f64,
    /// Chance that noise hides what is claimed, so that a sound program fails for lack of power.
    pub unresolved: f64,
    /// Chance of missing a difference of the size that was observed.
    pub miss: f64,
    /// Remarks for the reader.
    pub notes: Vec<String>,
    /// All contrasts.
    pub contrasts: Vec<Contrast>,
    /// The table of an equal-time run.
    pub equal_time: Option<EqualTime>,
    /// Deviations of all bins; written apart when the experiment fails.
    #[serde(skip)]
    pub z_map: Option<ZMap>,
}

/// (mean − expected)/standard error of every bin of every pixel. A picture of where an error is;
/// no verdict rests on it, for cells are correlated.
#[derive(Clone, Debug, PartialEq)]
pub struct ZMap {
    /// Pixels in a row of the image.
    pub width: usize,
    /// One row of bins for each pixel.
    pub rows: Vec<Vec<f64>>,
}

impl Outcome {
    /// Of an experiment that compares without chance: passed or not.
    pub fn exact(passed: bool, notes: Vec<String>) -> Self {
        let finding = if passed { Finding::Equivalent } else { Finding::Different };
        Self {
            finding,
            verdict: verdict(finding),
            interval: None,
            worst_p: None,
            false_alarm: 0.0,
            unresolved: 0.0,
            miss: 0.0,
            notes,
            contrasts: Vec::new(),
            equal_time: None,
            z_map: None,
        }
    }

    /// The same with the interval of the relative error.
    #[must_use]
    pub fn with_interval(mut self, interval: [f64; 2]) -> Self {
        self.interval = Some(interval);
        self
    }

    /// Adds a remark.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

impl From<Judgement> for Outcome {
    fn from(judgement: Judgement) -> Self {
        let mut notes = Vec::new();
        if judgement.finding != Finding::Equivalent {
            let worst = judgement.contrasts.iter().min_by(|a, b| a.p.total_cmp(&b.p));
            notes.extend(worst.map(|c| format!("most significant: {} (z = {:.1})", c.name, c.z)));
        }
        if judgement.finding == Finding::Unresolved {
            notes.push("too noisy for the margin: not significantly different either".into());
        }
        Self {
            finding: judgement.finding,
            verdict: verdict(judgement.finding),
            interval: Some(judgement.interval),
            worst_p: Some(judgement.worst_p),
            false_alarm: judgement.false_alarm,
            unresolved: judgement.unresolved,
            miss: judgement.miss,
            notes,
            contrasts: judgement.contrasts,
            equal_time: None,
            z_map: None,
        }
    }
}

fn verdict(finding: Finding) -> Verdict {
    if finding == Finding::Equivalent { Verdict::Passed } else { Verdict::Failed }
}

/// One question and its answer.
pub trait Experiment: Sync {
    /// Its name, by which filters find it: `group/case`.
    fn name(&self) -> String;

    /// What is compared with what, in one line.
    fn description(&self) -> String;

    /// Carries it out.
    fn run(&self, context: &Context) -> Result<Outcome>;
}

/// A deliberate defect of size given by its variant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sabotage {
    /// The scene's scattering coefficient times this factor (absorption unchanged).
    SigmaS(f64),
    /// The film's window later by this fraction of a bin.
    TimeShift(f64),
    /// The estimate of a kernel times this factor.
    KernelNormalisation(f64),
}

impl Sabotage {
    /// Factor on the scattering coefficient.
    pub fn sigma_s_factor(sabotage: Option<Self>) -> f64 {
        if let Some(Self::SigmaS(factor)) = sabotage { factor } else { 1.0 }
    }

    /// Shift of the window in bins.
    pub fn shift_bins(sabotage: Option<Self>) -> f64 {
        if let Some(Self::TimeShift(bins)) = sabotage { bins } else { 0.0 }
    }

    /// Factor on the estimate.
    pub fn estimate_factor(sabotage: Option<Self>) -> f64 {
        if let Some(Self::KernelNormalisation(factor)) = sabotage { factor } else { 1.0 }
    }

    fn label(self) -> &'static str {
        match self {
            Self::SigmaS(_) => "sigma-s",
            Self::TimeShift(_) => "time-shift",
            Self::KernelNormalisation(_) => "kernel-normalisation",
        }
    }
}

/// An experiment on sabotaged programs, which must be rejected.
pub struct Twin<E> {
    sabotage: Sabotage,
    inner: E,
}

impl<E: Experiment> Twin<E> {
    /// `inner` must have been made with `sabotage`.
    pub fn new(sabotage: Sabotage, inner: E) -> Self {
        Self { sabotage, inner }
    }
}

impl<E: Experiment> Experiment for Twin<E> {
    fn name(&self) -> String {
        format!("control/{}/{}", self.sabotage.label(), self.inner.name())
    }

    fn description(&self) -> String {
        format!("must be rejected: {:?} in {}", self.sabotage, self.inner.name())
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let mut outcome = self.inner.run(context)?;
        let rejected = outcome.finding == Finding::Different;
        outcome.verdict = if rejected { Verdict::Passed } else { Verdict::Failed };
        (outcome.false_alarm, outcome.unresolved) = (0.0, outcome.miss);
        outcome.notes = vec![if rejected {
            "rejected, as it must be".to_owned()
        } else {
            format!("NOT rejected: {:?}", outcome.finding)
        }];
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Fixed(Finding);

    impl Experiment for Fixed {
        fn name(&self) -> String {
            "fixed".into()
        }

        fn description(&self) -> String {
            String::new()
        }

        fn run(&self, _: &Context) -> Result<Outcome> {
            Ok(Outcome { finding: self.0, ..Outcome::exact(true, vec![]) })
        }
    }

    #[test]
    fn a_twin_passes_only_when_the_sabotage_is_found() {
        let context = Context::new(Effort::Quick, 1, PathBuf::new());
        for (finding, verdict) in [
            (Finding::Different, Verdict::Passed),
            (Finding::Unresolved, Verdict::Failed),
            (Finding::Equivalent, Verdict::Failed),
        ] {
            let twin = Twin::new(Sabotage::SigmaS(1.01), Fixed(finding));
            assert_eq!(twin.run(&context).unwrap().verdict, verdict, "{finding:?}");
        }
    }
}
