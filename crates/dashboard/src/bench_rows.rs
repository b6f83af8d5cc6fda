//! Cases of benchmark runs as the page shows them: each with its change since the run before.

use serde::Serialize;

use crate::bench_runs::{BenchRun, Cost, changes};

/// Most runs of a case that a page carries, the latest ones.
const RUNS: usize = 60;

/// All that the page shows of runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct BenchRuns {
    /// In the order of the latest run's cases, then of time.
    pub(crate) rows: Vec<Row>,
    /// The latest run that has costs: its time, commit, and they.
    costs: Option<(u64, String, Vec<CostRow>)>,
}

/// A case of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    case: String,
    time: u64,
    commit: String,
    machine: String,
    command: String,
    cpu_seconds: f64,
    cpu_change: Option<f64>,
    vectors: String,
    unit: Option<&'static str>,
    rate: Option<f64>,
    rate_change: Option<f64>,
    instructions: Option<f64>,
    instructions_change: Option<f64>,
    counted_vectors: Option<String>,
    /// Commit of the run that changes are against.
    before: Option<String>,
}

/// A cost with its ratio and verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct CostRow {
    #[serde(flatten)]
    cost: Cost,
    ratio: f64,
    met: Option<bool>,
}

impl BenchRuns {
    /// Of runs in the order of time.
    pub(crate) fn new(runs: &[BenchRun]) -> Self {
        let mut rows: Vec<Row> = Vec::new();
        for (index, run) in runs.iter().enumerate() {
            let changes = changes(run, &runs[..index]);
            rows.extend(run.cases.iter().zip(changes).map(|(case, change)| {
                let (rate, change) = (case.main_rate(), change.unwrap_or_default());
                let counted = case.counted.as_ref();
                Row {
                    case: case.name.clone(),
                    time: run.time,
                    commit: run.commit.clone(),
                    machine: run.machine.clone(),
                    command: case.command.clone(),
                    cpu_seconds: case.cpu_seconds,
                    cpu_change: change.cpu,
                    vectors: case.vectors.clone(),
                    unit: rate.map(|(unit, _)| unit),
                    rate: rate.map(|(_, rate)| rate),
                    rate_change: rate.and_then(|(unit, _)| change.rates.get(unit).copied()),
                    instructions: counted.map(|counted| counted.instructions),
                    instructions_change: change.instructions,
                    counted_vectors: counted.map(|counted| counted.vectors.clone()),
                    before: Some(change.commit).filter(|commit| !commit.is_empty()),
                }
            }));
        }
        // Cases of the latest runs first; all of a case together.
        let mut names: Vec<String> = Vec::new();
        for run in runs.iter().rev() {
            for case in &run.cases {
                if !names.contains(&case.name) {
                    names.push(case.name.clone());
                }
            }
        }
        let of = |name: &String| {
            let all: Vec<Row> = rows.iter().filter(|row| row.case == *name).cloned().collect();
            all[all.len().saturating_sub(RUNS)..].to_vec()
        };
        let costs = runs.iter().rev().find(|run| !run.costs.is_empty()).map(|run| {
            let rows = run.costs.iter().map(|cost| {
                let (ratio, met) = (cost.ratio(), cost.met());
                CostRow { cost: cost.clone(), ratio, met }
            });
            (run.time, run.commit.clone(), rows.collect())
        });
        Self { rows: names.iter().flat_map(of).collect(), costs }
    }

    /// How many cases there are.
    pub(crate) fn cases(&self) -> usize {
        let mut names: Vec<&str> = self.rows.iter().map(|row| row.case.as_str()).collect();
        names.dedup();
        names.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_runs::Case;

    fn run(time: u64, cases: &[(&str, f64)]) -> BenchRun {
        let case = |&(name, cpu_seconds): &(&str, f64)| {
            let rates = [("paths".to_owned(), 1.0 / cpu_seconds)].into();
            Case { name: name.to_owned(), cpu_seconds, rates, ..Case::default() }
        };
        let cases = cases.iter().map(case).collect();
        BenchRun { time, commit: format!("c{time}"), cases, ..BenchRun::default() }
    }

    #[test]
    fn each_case_has_its_history_with_changes() {
        let mut runs =
            vec![run(1, &[("gone", 1.0), ("a", 2.0)]), run(2, &[("b", 1.0), ("a", 1.0)])];
        runs[0].costs = vec![Cost { instructions: [3.0, 2.0], ..Cost::default() }];
        let found = BenchRuns::new(&runs);
        let told: Vec<_> = found
            .rows
            .iter()
            .map(|row| (row.case.as_str(), row.time, row.cpu_change, row.rate_change))
            .collect();
        let expected = [
            ("b", 2, None, None),
            ("a", 1, None, None),
            ("a", 2, Some(0.5), Some(2.0)),
            ("gone", 1, None, None),
        ];
        assert_eq!(told, expected);
        assert_eq!(found.rows[2].before.as_deref(), Some("c1"));
        assert_eq!(found.cases(), 3);
        let (time, _, costs) = found.costs.unwrap();
        assert_eq!((time, costs[0].ratio, costs[0].met), (1, 1.5, None));
    }

    #[test]
    fn long_histories_keep_their_end() {
        let runs: Vec<BenchRun> = (1..=100).map(|time| run(time, &[("a", 1.0)])).collect();
        let rows = BenchRuns::new(&runs).rows;
        assert_eq!((rows.len(), rows[0].time, rows[59].time), (60, 41, 100));
    }
}
