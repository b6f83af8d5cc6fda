//! What an experiment is: a name, a run, an outcome.
//!
//! An experiment asks one question about the programs and answers it with a verdict, an interval
//! of the measured error, and the probability that the verdict is a false alarm. Its budget is
//! fixed by the [`Effort`] (never by the clock, save in equal-time runs), its random numbers by
//! the seed: it repeats to the bit.
//!
//! The suite's false-alarm probability is shared out over all experiments that rest on chance before
//! any is run: [`Context::level`]. Each of them names its sabotaged twins
//! ([`crate::sabotage`]).

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use tpb_film::Layout;
use tpb_scene::{FilmSpec, Scene, SceneParts};

use crate::equal_time::EqualTime;
use crate::error::Result;
use crate::experiments::calibration::Rate;
use crate::measure;
use crate::memory::Memory;
use crate::registry;
use crate::sabotage::Sabotage;
use crate::statistics::{Contrast, Criterion, Finding, Judgement};

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
#[derive(Clone, Debug)]
pub struct Context {
    /// How much work to do.
    pub effort: Effort,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Where failing experiments leave their tables.
    pub out: PathBuf,
    /// Root of the workspace's validation data: scenes, tables, reference cubes.
    pub data: PathBuf,
    /// An experiment's share of the suite's false-alarm probability.
    pub level: f64,
    /// The defect that a twin's run must bring about.
    pub sabotage: Option<Sabotage>,
    /// Renders that are wanted again.
    pub memory: Arc<Memory>,
}

impl Context {
    /// A sound context on the data that ship with this crate.
    pub fn new(effort: Effort, seed: u64, out: PathBuf) -> Self {
        let data = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        Self {
            effort,
            seed,
            out,
            data,
            level: registry::level(effort),
            sabotage: None,
            memory: Arc::default(),
        }
    }

    /// What is asked of estimators without bias: a margin of 0.5 %.
    pub fn unbiased(&self) -> Criterion {
        Criterion { margin: 0.005, confidence: 0.99, level: self.level }
    }

    /// What is asked of blurred estimates against their exact expected blur: a margin of 1 %.
    pub fn blurred(&self) -> Criterion {
        Criterion { margin: 0.01, confidence: 0.99, level: self.level }
    }

    /// The scene, with the twin's defect if it acts there.
    pub fn assemble(&self, mut parts: SceneParts) -> Result<Scene> {
        if let Some(sabotage) = self.sabotage {
            sabotage.spoil(&mut parts);
        }
        Ok(Scene::assemble(parts)?)
    }

    /// The film that a scene asks for, with the twin's defect if it acts there.
    pub fn layout(&self, film: &FilmSpec) -> Result<Layout> {
        let width = film.time.map_or(0.0, |time| time.bin_width_opl);
        measure::layout(film, self.sabotage.map_or(0.0, |s| s.window_shift(width)))
    }

    /// The twin's defect if it acts on the scene, so that what is rendered differs.
    pub fn defect_of_the_scene(&self) -> Option<Sabotage> {
        self.sabotage.filter(|sabotage| sabotage.acts_on_the_scene())
    }

    /// The twin's factor on estimates; 1 if its defect acts elsewhere.
    pub fn estimate_factor(&self) -> f64 {
        self.sabotage.map_or(1.0, Sabotage::estimate_factor)
    }

    /// A shipped scene.
    pub fn scene_path(&self, name: &str) -> PathBuf {
        self.data.join("scenes").join(format!("{name}.json"))
    }

    /// The reference cube of a shipped scene.
    pub fn reference_path(&self, name: &str) -> PathBuf {
        self.data.join("references").join(format!("{name}.npz"))
    }

    /// The one that an earlier run made of a scene that ships without.
    pub fn made_reference_path(&self, name: &str) -> PathBuf {
        self.out.join("references").join(format!("{name}.npz"))
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
    /// Independent batches; 0 where there are none.
    pub batches: usize,
    /// All contrasts.
    pub contrasts: Vec<Contrast>,
    /// The table of an equal-time run.
    pub equal_time: Option<EqualTime>,
    /// Observed rates of false alarms.
    pub calibration: Vec<Rate>,
    /// Deviations of all bins; written apart when the experiment fails.
    #[serde(skip)]
    pub z_map: Option<ZMap>,
    /// The sum over pixels, bin by bin; likewise.
    #[serde(skip)]
    pub bins: Option<BinPlot>,
}

/// A time-resolved signal and its expectation.
#[derive(Clone, Debug, PartialEq)]
pub struct BinPlot {
    /// Middle of each bin \[m\].
    pub opl: Vec<f64>,
    /// Expectation of each.
    pub expected: Vec<f64>,
    /// Mean over batches.
    pub mean: Vec<f64>,
    /// Standard error of that mean.
    pub standard_error: Vec<f64>,
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
            batches: 0,
            contrasts: Vec::new(),
            equal_time: None,
            calibration: Vec::new(),
            z_map: None,
            bins: None,
        }
    }

    /// The same with the interval of the relative error.
    #[must_use]
    pub fn with_interval(mut self, interval: [f64; 2]) -> Self {
        self.interval = Some(interval);
        self
    }

    /// The contrast with the smallest p value.
    pub fn most_significant(&self) -> Option<&Contrast> {
        self.contrasts.iter().min_by(|a, b| a.p.total_cmp(&b.p))
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
        notes
            .extend(judgement.unfit.iter().map(|reason| format!("not fit to be judged: {reason}")));
        if judgement.finding == Finding::Unresolved && judgement.unfit.is_empty() {
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
            batches: judgement.batches,
            contrasts: judgement.contrasts,
            equal_time: None,
            calibration: Vec::new(),
            z_map: None,
            bins: None,
        }
    }
}

fn verdict(finding: Finding) -> Verdict {
    if finding == Finding::Equivalent { Verdict::Passed } else { Verdict::Failed }
}

/// How an experiment comes to its verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Without chance: to rounding.
    Exact,
    /// By tests at [`Context::level`]; has twins.
    Statistical,
    /// By tests at [`Context::level`], with a negative control of its own in the same run.
    SelfControlled,
    /// Must be rejected.
    Twin,
}

/// One question and its answer.
pub trait Experiment: Send + Sync {
    /// Its name, by which filters find it: `group/case`.
    fn name(&self) -> String;

    /// What is compared with what, in one line.
    fn description(&self) -> String;

    /// How it comes to its verdict.
    fn kind(&self) -> Kind {
        Kind::Statistical
    }

    /// The defects by which it must be rejected; at least one of a statistical experiment in
    /// [`Effort::Full`], a few representative ones in [`Effort::Quick`]. `run` brings them about
    /// (see [`crate::sabotage`]).
    fn twins(&self, _effort: Effort) -> Vec<Sabotage> {
        Vec::new()
    }

    /// Carries it out.
    fn run(&self, context: &Context) -> Result<Outcome>;
}
