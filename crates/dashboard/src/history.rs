//! Runs of the validation suite over time: one JSON line per run.
//!
//! | field | meaning |
//! | --- | --- |
//! | `time` | end of the run, seconds since 1970 (UTC) |
//! | `commit` | commit of the sources, with `-dirty` if they differed from it |
//! | `machine`, `flags`, `seed`, `effort` | processor, threads, system; command line; `quick` or `full` |
//! | `seconds` | wall time |
//! | `false_alarm`, `nominal`, `unresolved` | as `tpb_validation` reports them |
//! | `records` | one for each experiment that was run |
//!
//! A record has `name`, `verdict`, `seconds`, `interval` (relative error), `p`, `batches`,
//! `contrasts` (their number), `notes`, `table` (lines of one), and, where it did not pass, `error`,
//! `repeat` and `files`.
//! Fields that are missing are empty, those that are unknown are left out, and numbers that are not
//! finite are `null`: lines of older and newer versions are read alike.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

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

/// A run of the suite, or of some of its experiments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Its end \[s since 1970, UTC\].
    pub time: u64,
    /// Commit of the sources.
    pub commit: String,
    /// Processor, threads, system.
    #[serde(default)]
    pub machine: String,
    /// Command line.
    #[serde(default)]
    pub flags: String,
    /// Seed of all random numbers.
    #[serde(default)]
    pub seed: u64,
    /// `quick` or `full`.
    #[serde(default)]
    pub effort: String,
    /// Wall time \[s\].
    #[serde(default)]
    pub seconds: Option<f64>,
    /// Sum of the experiments' false-alarm probabilities.
    #[serde(default)]
    pub false_alarm: Option<f64>,
    /// Nominal level of that sum for a whole suite.
    #[serde(default)]
    pub nominal: Option<f64>,
    /// Sum of the chances that noise hides what is claimed.
    #[serde(default)]
    pub unresolved: Option<f64>,
    /// What was run.
    pub records: Vec<Record>,
}

/// An experiment's part of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Its name; of a negative control `control/DEFECT/NAME`.
    pub name: String,
    /// How it ended.
    pub verdict: Verdict,
    /// Wall time \[s\].
    #[serde(default)]
    pub seconds: Option<f64>,
    /// The interval of the relative error that reaches farthest from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<[Option<f64>; 2]>,
    /// The smallest p value after correction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub p: Option<f64>,
    /// Independent batches.
    #[serde(default)]
    pub batches: usize,
    /// Number of contrasts.
    #[serde(default)]
    pub contrasts: usize,
    /// Remarks for the reader.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// A table in letters of one width, such as that of an equal-time comparison.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<String>,
    /// Why it broke.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// The command that repeats it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<String>,
    /// Tables and plots that it left, below the root of the workspace if they are there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<PathBuf>,
}

/// Runs of several files in the order of time, each once.
pub fn merge(runs: impl IntoIterator<Item = Run>) -> Vec<Run> {
    let mut all: Vec<Run> = runs.into_iter().collect();
    all.sort_by(|a, b| (a.time, &a.commit, &a.flags).cmp(&(b.time, &b.commit, &b.flags)));
    all.dedup_by(|a, b| a == b);
    all
}

/// Defect and experiment of a negative control's name.
pub fn control(name: &str) -> Option<(&str, &str)> {
    name.strip_prefix("control/")?.split_once('/')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_other_versions_are_read() {
        let line = r#"{"time":7,"commit":"c","new":[1],"records":[{"name":"a","verdict":"passed",
            "interval":[null,0.5],"seconds":null,"p":null}]}"#;
        let run: Run = serde_json::from_str(line).unwrap();
        assert_eq!(run.records[0].interval, Some([None, Some(0.5)]));
        assert_eq!((run.records[0].p, run.effort.as_str()), (None, ""));
        let again: Run = serde_json::from_str(&serde_json::to_string(&run).unwrap()).unwrap();
        assert_eq!(again, run);
    }

    #[test]
    fn runs_of_several_files_are_kept_once_and_in_order() {
        let run = |time, commit: &str| -> Run {
            let line = format!(r#"{{"time":{time},"commit":"{commit}","records":[]}}"#);
            serde_json::from_str(&line).unwrap()
        };
        let merged = merge([run(3, "c"), run(1, "a"), run(3, "c"), run(3, "b")]);
        assert_eq!(merged, [run(1, "a"), run(3, "b"), run(3, "c")]);
    }

    #[test]
    fn controls_name_their_experiment() {
        assert_eq!(control("control/late/matrix/lamp/path"), Some(("late", "matrix/lamp/path")));
        assert_eq!(control("matrix/lamp/path"), None);
    }
}
