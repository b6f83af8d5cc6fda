//! Every experiment of the suite with its latest result, those of its negative controls, and its
//! history.
//!
//! Runs may hold some experiments only: an experiment's latest result is that of the last run in
//! which it was. An experiment that was never run is listed all the same, with the command that
//! runs it.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::history::{Record, Run, Verdict, control};

/// Most points of an experiment's history that a page carries, the latest ones.
const POINTS: usize = 60;

/// An experiment of the suite.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Its name; of a negative control `control/DEFECT/NAME`.
    pub name: String,
    /// What it compares.
    pub description: String,
    /// Whether the quick suite has it; else only the full one.
    pub quick: bool,
}

/// A run without its records.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Head {
    time: u64,
    commit: String,
    machine: String,
    flags: String,
    seed: u64,
    effort: String,
    seconds: Option<f64>,
    false_alarm: Option<f64>,
    nominal: Option<f64>,
    unresolved: Option<f64>,
    /// Experiments that passed, failed, broke.
    counts: [usize; 3],
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    pub(crate) name: String,
    /// The defect, of a negative control.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) defect: Option<String>,
    pub(crate) description: String,
    /// `quick` or `full`; empty for what the suite no longer has.
    pub(crate) suite: &'static str,
    /// The command that runs it.
    pub(crate) command: String,
    /// The latest result and the index of its run.
    pub(crate) latest: Option<(usize, Record)>,
    /// In the order of time.
    pub(crate) history: Vec<Point>,
    /// Its negative controls.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) controls: Vec<Row>,
}

/// A point of a history.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Point {
    run: usize,
    verdict: Verdict,
    seconds: Option<f64>,
    interval: Option<[Option<f64>; 2]>,
    p: Option<f64>,
}

/// What the overview shows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Overview {
    pub(crate) runs: Vec<Head>,
    pub(crate) rows: Vec<Row>,
}

impl Overview {
    /// Of a plan in its order, and runs in theirs.
    pub(crate) fn new(plan: &[Planned], runs: &[Run]) -> Self {
        let mut results: BTreeMap<&str, Vec<(usize, &Record)>> = BTreeMap::new();
        for (index, run) in runs.iter().enumerate() {
            for record in &run.records {
                results.entry(&record.name).or_default().push((index, record));
            }
        }
        let mut all: Vec<Row> = plan
            .iter()
            .map(|planned| {
                let suite = if planned.quick { "quick" } else { "full" };
                let found = results.remove(planned.name.as_str()).unwrap_or_default();
                row(&planned.name, &planned.description, suite, &found)
            })
            .collect();
        // What is left is in histories alone.
        all.extend(results.iter().map(|(name, found)| row(name, "", "", found)));
        Self { runs: runs.iter().map(head).collect(), rows: nest(all) }
    }
}

/// Puts negative controls into the rows of their experiments, if these are there.
fn nest(all: Vec<Row>) -> Vec<Row> {
    let (controls, mut rows): (Vec<Row>, Vec<Row>) =
        all.into_iter().partition(|row| row.defect.is_some());
    for row in controls {
        let parent = control(&row.name).map(|(_, name)| name.to_owned());
        match rows.iter_mut().find(|candidate| Some(&candidate.name) == parent.as_ref()) {
            Some(parent) => parent.controls.push(row),
            None => rows.push(row),
        }
    }
    rows
}

fn row(name: &str, description: &str, suite: &'static str, found: &[(usize, &Record)]) -> Row {
    let full = if suite == "full" { " --full" } else { "" };
    let point = |&(run, record): &(usize, &Record)| Point {
        run,
        verdict: record.verdict,
        seconds: record.seconds,
        interval: record.interval,
        p: record.p,
    };
    Row {
        name: name.to_owned(),
        defect: control(name).map(|(defect, _)| defect.to_owned()),
        description: description.to_owned(),
        suite,
        command: format!("cargo xtask validate{full} --filter '{name}'"),
        latest: found.last().map(|&(run, record)| (run, record.clone())),
        history: found[found.len().saturating_sub(POINTS)..].iter().map(point).collect(),
        controls: Vec::new(),
    }
}

fn head(run: &Run) -> Head {
    let count = |verdict| run.records.iter().filter(|record| record.verdict == verdict).count();
    Head {
        time: run.time,
        commit: run.commit.clone(),
        machine: run.machine.clone(),
        flags: run.flags.clone(),
        seed: run.seed,
        effort: run.effort.clone(),
        seconds: run.seconds,
        false_alarm: run.false_alarm,
        nominal: run.nominal,
        unresolved: run.unresolved,
        counts: [Verdict::Passed, Verdict::Failed, Verdict::Broken].map(count),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planned(name: &str, quick: bool) -> Planned {
        Planned { name: name.into(), description: format!("about {name}"), quick }
    }

    fn run(time: u64, records: &[(&str, &str)]) -> Run {
        let records: Vec<String> = records
            .iter()
            .map(|(name, verdict)| format!(r#"{{"name":"{name}","verdict":"{verdict}"}}"#))
            .collect();
        let line =
            format!(r#"{{"time":{time},"commit":"c{time}","records":[{}]}}"#, records.join(","));
        serde_json::from_str(&line).unwrap()
    }

    #[test]
    fn every_experiment_has_its_latest_result_or_the_command_that_makes_one() {
        let plan = [
            planned("a/x", true),
            planned("control/late/a/x", true),
            planned("control/loss/a/x", false),
            planned("b/y", false),
        ];
        let runs = [
            run(1, &[("a/x", "failed"), ("control/late/a/x", "passed"), ("old", "passed")]),
            run(2, &[("a/x", "passed")]),
            run(3, &[("control/late/a/x", "broken"), ("control/late/gone", "passed")]),
        ];
        let overview = Overview::new(&plan, &runs);
        let names: Vec<_> =
            overview.rows.iter().map(|row| (row.name.as_str(), row.suite)).collect();
        let expected = [("a/x", "quick"), ("b/y", "full"), ("old", ""), ("control/late/gone", "")];
        assert_eq!(names, expected);
        let first = &overview.rows[0];
        let latest = first.latest.as_ref().unwrap();
        assert_eq!((latest.0, latest.1.verdict), (1, Verdict::Passed));
        let history: Vec<_> =
            first.history.iter().map(|point| (point.run, point.verdict)).collect();
        assert_eq!(history, [(0, Verdict::Failed), (1, Verdict::Passed)]);
        let controls: Vec<_> = first
            .controls
            .iter()
            .map(|row| (row.defect.as_deref().unwrap(), row.latest.as_ref().map(|l| l.1.verdict)))
            .collect();
        assert_eq!(controls, [("late", Some(Verdict::Broken)), ("loss", None)]);
        assert_eq!(overview.rows[1].latest, None);
        assert_eq!(overview.rows[1].command, "cargo xtask validate --full --filter 'b/y'");
        assert_eq!(overview.runs[0].counts, [2, 1, 0]);
    }

    #[test]
    fn long_histories_keep_their_end() {
        let runs: Vec<Run> = (0..100).map(|time| run(time, &[("a", "passed")])).collect();
        let history = &Overview::new(&[], &runs).rows[0].history;
        assert_eq!((history.len(), history[0].run, history[59].run), (60, 40, 99));
    }
}
