//! Running experiments one after another, and adding up what they found.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::artefacts;
use crate::error::{Result, ValidationError};
use crate::experiment::{Context, Experiment, Outcome, Verdict};
use crate::experiments::calibration::Rate;
use crate::pages;

/// The nominal false-alarm probability of a whole suite.
pub const SUITE_LEVEL: f64 = 1e-6;

/// One experiment's line in the results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Its name.
    pub name: String,
    /// What it compares.
    pub description: String,
    /// How it ended.
    pub verdict: Verdict,
    /// Wall time \[s\].
    pub seconds: f64,
    /// What it found; `None` if it broke.
    pub outcome: Option<Outcome>,
    /// Why it broke.
    pub error: Option<String>,
    /// The command that repeats it.
    pub repeat: String,
    /// Tables that it left.
    pub files: Vec<PathBuf>,
}

/// Where and how a suite was run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Circumstances {
    /// Commit of the sources.
    pub commit: String,
    /// Processor, number of threads, system.
    pub machine: String,
    /// Options.
    pub flags: String,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// The results of a suite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SuiteResult {
    /// Where and how it was run.
    pub circumstances: Circumstances,
    /// All records.
    pub records: Vec<Record>,
    /// Wall time \[s\].
    pub seconds: f64,
    /// Sum of the experiments' false-alarm probabilities.
    pub false_alarm: f64,
    /// Nominal level of that sum.
    pub nominal: f64,
    /// Sum of the chances that noise hides what is claimed.
    pub unresolved: f64,
}

impl SuiteResult {
    /// Whether everything passed.
    pub fn passed(&self) -> bool {
        self.records.iter().all(|record| record.verdict == Verdict::Passed)
    }

    /// The observed rates of false alarms.
    pub fn rates(&self) -> impl Iterator<Item = &Rate> {
        let outcomes = self.records.iter().filter_map(|record| record.outcome.as_ref());
        outcomes.flat_map(|outcome| &outcome.calibration)
    }
}

/// Runs experiments, telling `each` record as it is made. `repeat` makes the command that repeats
/// the experiment of a name.
pub fn run_suite(
    experiments: &[Arc<dyn Experiment>],
    context: &Context,
    circumstances: Circumstances,
    repeat: impl Fn(&str) -> String,
    mut each: impl FnMut(&Record),
) -> SuiteResult {
    let started = Instant::now();
    let mut records = Vec::new();
    for experiment in experiments {
        let record = run_one(&**experiment, context, &repeat);
        each(&record);
        records.push(record);
    }
    let sum = |of: fn(&Outcome) -> f64| {
        records.iter().filter_map(|record| record.outcome.as_ref()).map(of).sum()
    };
    SuiteResult {
        false_alarm: sum(|outcome| outcome.false_alarm),
        unresolved: sum(|outcome| outcome.unresolved),
        nominal: SUITE_LEVEL,
        seconds: started.elapsed().as_secs_f64(),
        circumstances,
        records,
    }
}

fn run_one(
    experiment: &dyn Experiment,
    context: &Context,
    repeat: &impl Fn(&str) -> String,
) -> Record {
    let name = experiment.name();
    let started = Instant::now();
    let result = experiment.run(context);
    let seconds = started.elapsed().as_secs_f64();
    let mut record = Record {
        repeat: repeat(&name),
        description: experiment.description(),
        verdict: Verdict::Broken,
        seconds,
        outcome: None,
        error: None,
        files: Vec::new(),
        name,
    };
    match result {
        Ok(outcome) => {
            record.verdict = outcome.verdict;
            record.outcome = Some(outcome);
        }
        Err(error) => record.error = Some(chain(&error)),
    }
    if record.verdict == Verdict::Failed {
        match artefacts::leave(&record, context) {
            Ok(files) => record.files = files,
            Err(error) => record.error = Some(chain(&error)),
        }
    }
    record
}

/// An error with its causes, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}

/// Writes the results as JSON.
pub fn write_json(result: &SuiteResult, path: &Path) -> Result<()> {
    let text = serde_json::to_string_pretty(result)
        .map_err(|error| ValidationError::unusable("results", error))?;
    write(path, &(text + "\n"))
}

/// That results can be written into a folder, which is made if need be.
pub fn probe(folder: &Path) -> Result<()> {
    let probe = folder.join(".probe");
    write(&probe, "")?;
    fs::remove_file(&probe).map_err(|error| ValidationError::io(&probe, error))
}

/// Writes the results as `results.json` and as the page `report.md` into a folder.
pub fn write_results(result: &SuiteResult, folder: &Path) -> Result<()> {
    write_json(result, &folder.join("results.json"))?;
    write(&folder.join("report.md"), &pages::report(result))
}

fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|error| ValidationError::io(folder, error))?;
    }
    fs::write(path, text).map_err(|error| ValidationError::io(path, error))
}

/// Whether a name matches a pattern of `*` (any text) and `?` (one character). A pattern
/// without either matches names that contain it.
pub fn matches(pattern: &str, name: &str) -> bool {
    if !pattern.contains(['*', '?']) {
        return name.contains(pattern);
    }
    glob(&pattern.chars().collect::<Vec<_>>(), &name.chars().collect::<Vec<_>>())
}

fn glob(pattern: &[char], name: &[char]) -> bool {
    match (pattern.first(), name.first()) {
        (None, None) => true,
        (Some('*'), _) => {
            glob(&pattern[1..], name) || !name.is_empty() && glob(pattern, &name[1..])
        }
        (Some('?'), Some(_)) => glob(&pattern[1..], &name[1..]),
        (Some(a), Some(b)) if a == b => glob(&pattern[1..], &name[1..]),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::Effort;
    use crate::statistics::Finding;

    #[test]
    fn globs_and_plain_text_select() {
        for (pattern, name, expected) in [
            ("single-scatter/*", "single-scatter/path", true),
            ("*/path", "single-scatter/path", true),
            ("*/path", "single-scatter/path/hg0.6", false),
            ("sphere-order-?/*", "sphere-order-3/path", true),
            ("sphere", "control/time-shift/sphere-order-3/path", true),
            ("", "anything", true),
            ("*x*", "abc", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }

    struct Scripted(&'static str, Option<Finding>);

    impl Experiment for Scripted {
        fn name(&self) -> String {
            self.0.into()
        }

        fn description(&self) -> String {
            "scripted".into()
        }

        fn run(&self, _: &Context) -> Result<Outcome> {
            let broken = || ValidationError::unusable("script", "broken");
            let finding = self.1.ok_or_else(broken)?;
            let mut outcome = Outcome::exact(finding == Finding::Equivalent, vec![]);
            outcome.false_alarm = 1e-8;
            Ok(outcome)
        }
    }

    #[test]
    fn what_fails_leaves_tables_and_what_breaks_says_why() {
        let out = std::env::temp_dir().join(format!("tpb-suite-{}", std::process::id()));
        let context = Context::new(Effort::Quick, 1, out.clone());
        let experiments: Vec<Arc<dyn Experiment>> = vec![
            Arc::new(Scripted("a/sound", Some(Finding::Equivalent))),
            Arc::new(Scripted("a/wrong", Some(Finding::Different))),
            Arc::new(Scripted("a/broken", None)),
        ];
        let mut told = 0;
        let repeat = |name: &str| format!("run {name}");
        let result =
            run_suite(&experiments, &context, Circumstances::default(), repeat, |_| told += 1);
        assert_eq!(told, 3);
        assert!(!result.passed() && (result.false_alarm - 2e-8).abs() < 1e-20);
        assert_eq!(result.records[1].repeat, "run a/wrong");
        assert!(result.records[1].files.iter().all(|file| file.exists()));
        assert_eq!(result.records[2].error.as_deref(), Some("script: broken"));
        write_results(&result, &out).unwrap();
        let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        let back: SuiteResult = serde_json::from_str(&read("results.json")).unwrap();
        assert!(read("report.md").contains("| a/wrong | FAILED |"));
        fs::remove_dir_all(&out).unwrap();
        assert_eq!(back, result);
    }
}
