//! Benchmarks over time: one JSON line per (commit, machine, benchmark).
//!
//! | field | meaning |
//! | --- | --- |
//! | `time` | when it was measured, seconds since 1970 (UTC) |
//! | `commit` | commit of the sources |
//! | `commit_by` | `run`: told by who ran it; `time`: the last commit before the measurement, for sources that may have differed from it |
//! | `machine` | processor, threads, system |
//! | `bench` | its whole name, `group/function/parameter` |
//! | `nanoseconds`, `interval`, `confidence` | per iteration, with its confidence interval |
//! | `statistic` | what was estimated: `slope` (of time against iterations) or `mean` |
//! | `elements`, `bytes` | work of one iteration, where it is known |
//!
//! The last line of a (commit, machine, benchmark) counts. [`collect`] makes lines of what
//! Criterion.rs left (`new/estimates.json` and `new/benchmark.json` of each benchmark; times in ns);
//! whoever runs benchmarks may write the same lines himself.
//!
//! Not handled: throughputs in other units than elements and bytes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::DashboardError;

/// Where a commit is known from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CommitBy {
    /// From who ran the benchmark.
    Run,
    /// From the time of the measurement.
    #[default]
    Time,
}

/// A measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Benchmark {
    /// When it was measured \[s since 1970, UTC\].
    pub time: u64,
    /// Commit of the sources.
    pub commit: String,
    /// Where that is known from.
    #[serde(default)]
    pub commit_by: CommitBy,
    /// Processor, threads, system.
    #[serde(default)]
    pub machine: String,
    /// Its whole name.
    pub bench: String,
    /// Time of an iteration \[ns\].
    pub nanoseconds: f64,
    /// Its confidence interval \[ns\].
    pub interval: [f64; 2],
    /// Confidence of the interval.
    pub confidence: f64,
    /// `slope` or `mean`.
    #[serde(default)]
    pub statistic: String,
    /// Elements of an iteration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<u64>,
    /// Bytes of an iteration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
}

/// The last line of each (commit, machine, benchmark), in the order of time.
pub fn merge(lines: impl IntoIterator<Item = Benchmark>) -> Vec<Benchmark> {
    let mut last: BTreeMap<[String; 3], Benchmark> = BTreeMap::new();
    for line in lines {
        let key = [line.commit.clone(), line.machine.clone(), line.bench.clone()];
        match last.get(&key) {
            Some(kept) if kept.time > line.time => {}
            _ => drop(last.insert(key, line)),
        }
    }
    let mut all: Vec<Benchmark> = last.into_values().collect();
    all.sort_by(|a, b| (a.time, &a.bench).cmp(&(b.time, &b.bench)));
    all
}

/// What Criterion.rs left below a folder and `known` does not have yet, as lines of `machine`.
/// `commit` tells the sources' commit from the time of a measurement \[s since 1970\].
///
/// # Errors
/// [`DashboardError::Io`] if a folder cannot be read; one that does not exist has no benchmarks.
/// Files that are no estimates are left out.
pub fn collect(
    folder: &Path,
    known: &[Benchmark],
    machine: &str,
    mut commit: impl FnMut(u64) -> (String, CommitBy),
) -> Result<Vec<Benchmark>, DashboardError> {
    let mut files = Vec::new();
    estimates(folder, &mut files)?;
    files.sort();
    let mut found = Vec::new();
    for file in files {
        let Some(measured) = measurement(&file) else { continue };
        let there = |line: &Benchmark| {
            line.bench == measured.bench
                && line.time == measured.time
                && line.nanoseconds == measured.nanoseconds
        };
        if known.iter().any(there) {
            continue;
        }
        let (commit, commit_by) = commit(measured.time);
        found.push(Benchmark { commit, commit_by, machine: machine.to_owned(), ..measured });
    }
    Ok(found)
}

/// All files `new/estimates.json` below a folder.
fn estimates(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), DashboardError> {
    if !folder.is_dir() {
        return Ok(());
    }
    let io = |error| DashboardError::io(folder, error);
    for entry in fs::read_dir(folder).map_err(io)? {
        let path = entry.map_err(io)?.path();
        if path.is_dir() && !path.is_symlink() {
            let file = path.join("estimates.json");
            if path.ends_with("new") && file.is_file() {
                found.push(file);
            } else {
                estimates(&path, found)?;
            }
        }
    }
    Ok(())
}

#[derive(Deserialize)]
struct Name {
    full_id: String,
    throughput: Option<BTreeMap<String, u64>>,
}

#[derive(Deserialize)]
struct Estimates {
    mean: Estimate,
    slope: Option<Estimate>,
}

#[derive(Deserialize)]
struct Estimate {
    point_estimate: f64,
    confidence_interval: Interval,
}

#[derive(Deserialize)]
struct Interval {
    confidence_level: f64,
    lower_bound: f64,
    upper_bound: f64,
}

/// A measurement of Criterion.rs, still without commit and machine.
fn measurement(file: &Path) -> Option<Benchmark> {
    let changed = file.metadata().and_then(|found| found.modified()).ok()?;
    let estimates: Estimates = serde_json::from_slice(&fs::read(file).ok()?).ok()?;
    let name: Name =
        serde_json::from_slice(&fs::read(file.with_file_name("benchmark.json")).ok()?).ok()?;
    let work = |unit: &str| name.throughput.as_ref().and_then(|all| all.get(unit)).copied();
    let (statistic, estimate) = match estimates.slope {
        Some(slope) => ("slope", slope),
        None => ("mean", estimates.mean),
    };
    let interval = estimate.confidence_interval;
    Some(Benchmark {
        time: seconds(changed),
        commit: String::new(),
        commit_by: CommitBy::Time,
        machine: String::new(),
        nanoseconds: estimate.point_estimate,
        interval: [interval.lower_bound, interval.upper_bound],
        confidence: interval.confidence_level,
        statistic: statistic.to_owned(),
        elements: work("Elements"),
        bytes: work("Bytes"),
        bench: name.full_id,
    })
}

/// Whole seconds since 1970.
pub(crate) fn seconds(time: SystemTime) -> u64 {
    time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64) -> String {
        format!(
            r#"{{"confidence_interval":{{"confidence_level":0.95,"lower_bound":{},"upper_bound":{}}},"point_estimate":{value},"standard_error":1.0}}"#,
            0.9 * value,
            1.2 * value
        )
    }

    fn leave(folder: &Path, name: &str, slope: bool) {
        let new = folder.join(name.replace('/', "_")).join("case/new");
        fs::create_dir_all(&new).unwrap();
        let slope = if slope { estimate(100.0) } else { "null".to_owned() };
        let text = format!(r#"{{"mean":{},"slope":{slope}}}"#, estimate(110.0));
        fs::write(new.join("estimates.json"), text).unwrap();
        let text = format!(r#"{{"full_id":"{name}","throughput":{{"Elements":50}},"x":null}}"#);
        fs::write(new.join("benchmark.json"), text).unwrap();
    }

    #[test]
    fn what_criterion_left_is_collected_once() {
        let folder = tempfile::tempdir().unwrap();
        let none = collect(&folder.path().join("none"), &[], "m", |_| unreachable_commit());
        assert_eq!(none.unwrap(), []);
        leave(folder.path(), "gather/tiles", true);
        leave(folder.path(), "paths", false);
        // A folder that was torn, one without a name, and the measurement before the last.
        for (path, text) in [("torn/new", "{\"mean\":"), ("gather_tiles/case/base", "{}")] {
            fs::create_dir_all(folder.path().join(path)).unwrap();
            fs::write(folder.path().join(path).join("estimates.json"), text).unwrap();
        }
        let commit = |_| ("abc".to_owned(), CommitBy::Time);
        let lines = collect(folder.path(), &[], "m", commit).unwrap();
        let told: Vec<_> = lines
            .iter()
            .map(|l| (l.bench.as_str(), l.statistic.as_str(), l.nanoseconds, l.interval))
            .collect();
        let expected = [
            ("gather/tiles", "slope", 100.0, [90.0, 120.0]),
            ("paths", "mean", 110.0, [99.0, 132.0]),
        ];
        assert_eq!(told, expected);
        assert!(
            lines
                .iter()
                .all(|l| l.elements == Some(50) && l.commit == "abc" && l.time > 1_000_000_000)
        );
        assert_eq!(collect(folder.path(), &lines, "m", commit).unwrap(), []);
        assert_eq!(collect(folder.path(), &lines[..1], "m", commit).unwrap(), lines[1..]);
    }

    fn unreachable_commit() -> (String, CommitBy) {
        panic!("nobody asks for the commit of nothing")
    }

    #[test]
    fn the_last_line_of_a_commit_and_machine_counts() {
        let line = |time, commit: &str, machine: &str| Benchmark {
            time,
            commit: commit.into(),
            commit_by: CommitBy::Run,
            machine: machine.into(),
            bench: "b".into(),
            nanoseconds: time as f64,
            interval: [0.0, 1.0],
            confidence: 0.95,
            statistic: "mean".into(),
            elements: None,
            bytes: None,
        };
        let merged =
            merge([line(5, "b", "m"), line(2, "a", "m"), line(1, "a", "m"), line(3, "a", "n")]);
        assert_eq!(merged, [line(2, "a", "m"), line(3, "a", "n"), line(5, "b", "m")]);
        let back: Benchmark =
            serde_json::from_str(&serde_json::to_string(&merged[0]).unwrap()).unwrap();
        assert_eq!(back, merged[0]);
    }
}
