//! Runs of `cargo xtask bench` over time: one JSON line per run.
//!
//! | field | meaning |
//! | --- | --- |
//! | `time` | end of the run, seconds since 1970 (UTC) |
//! | `commit` | commit of the sources, with `-dirty` if they differed from it |
//! | `machine`, `features` | processor, threads, system; instruction sets of the processor |
//! | `compiler`, `build` | version; profile and flags that programs were built with |
//! | `flags`, `seed` | command line; seed of all random numbers |
//! | `seconds`, `cpu_seconds` | wall and CPU time of all that was timed |
//! | `cases` | what was timed and counted, each alone on one thread |
//! | `costs` | instructions with and without what a scene may not need |
//! | `benchmarks` | what Criterion.rs measured: lines of [`crate::benchmarks`] |
//!
//! A case has `name`, `command`, `passes`, `cpu_seconds` and `wall_seconds` of the best turn,
//! `vectors` (the instructions that it used), `rates` per CPU second, and `counted`: `command`,
//! `instructions` of a pass (those of 2n passes less those of n, over n), `work` of a pass, the
//! `tool`, and the `vectors` used under it. Where a tool is missing, `counted` is `null`.
//!
//! Runs are compared where machine and build are the same, case by case where the command is.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::benchmarks::Benchmark;

/// A run of the benchmarks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BenchRun {
    /// Its end \[s since 1970, UTC\].
    pub time: u64,
    /// Commit of the sources.
    pub commit: String,
    /// Processor, threads, system.
    #[serde(default)]
    pub machine: String,
    /// Instruction sets of the processor.
    #[serde(default)]
    pub features: Vec<String>,
    /// Version of the compiler.
    #[serde(default)]
    pub compiler: String,
    /// Profile and flags of the build.
    #[serde(default)]
    pub build: String,
    /// Command line.
    #[serde(default)]
    pub flags: String,
    /// Seed of all random numbers.
    #[serde(default)]
    pub seed: u64,
    /// Wall time of all that was timed \[s\].
    #[serde(default)]
    pub seconds: f64,
    /// CPU time of the same \[s\].
    #[serde(default)]
    pub cpu_seconds: f64,
    /// What was timed and counted.
    #[serde(default)]
    pub cases: Vec<Case>,
    /// What is not needed, and what it costs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<Cost>,
    /// What Criterion.rs measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub benchmarks: Vec<Benchmark>,
}

/// Something that was timed and counted by itself, on one thread.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// The command that was timed.
    pub command: String,
    /// Passes that were timed.
    pub passes: u64,
    /// CPU time of the best turn \[s\].
    pub cpu_seconds: f64,
    /// Its wall time \[s\].
    pub wall_seconds: f64,
    /// Vector instructions that were used.
    #[serde(default)]
    pub vectors: String,
    /// Work per CPU second, by what was done: `pairs`, `segments`, `paths`, `photons`.
    #[serde(default)]
    pub rates: BTreeMap<String, f64>,
    /// Instructions, if they could be counted.
    #[serde(default)]
    pub counted: Option<Counted>,
}

/// Instructions of a pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counted {
    /// The command that was counted.
    pub command: String,
    /// Instructions of a pass, without start and end of the program.
    pub instructions: f64,
    /// Work of a pass, by what was done.
    #[serde(default)]
    pub work: BTreeMap<String, f64>,
    /// What counted.
    #[serde(default)]
    pub tool: String,
    /// Vector instructions that were used under it.
    #[serde(default)]
    pub vectors: String,
}

/// Instructions of two renders that differ in one thing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Its name.
    pub name: String,
    /// What the first does, and what the second.
    pub sides: [String; 2],
    /// Instructions of a pass of each.
    pub instructions: [f64; 2],
    /// The ratio may be at most this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// The ratio should be at least this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
}

impl Cost {
    /// Instructions of the first over those of the second.
    pub fn ratio(&self) -> f64 {
        self.instructions[0] / self.instructions[1]
    }

    /// Whether the ratio is where it should be; `None` where no goal is set.
    pub fn met(&self) -> Option<bool> {
        let ratio = self.ratio();
        let bounded = self.at_most.is_some() || self.at_least.is_some();
        bounded.then(|| {
            self.at_most.is_none_or(|most| ratio <= most)
                && self.at_least.is_none_or(|least| ratio >= least)
        })
    }
}

/// Units of work, the most telling first.
const UNITS: [&str; 5] = ["pairs", "segments", "connections", "paths", "photons"];

impl Case {
    /// The most telling of its rates: the unit, and how many per CPU second.
    pub fn main_rate(&self) -> Option<(&'static str, f64)> {
        UNITS.iter().find_map(|&unit| Some((unit, *self.rates.get(unit)?)))
    }
}

/// How a case differs from the last run that may be compared with it: new over old.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// Commit of that run.
    pub commit: String,
    /// CPU time.
    pub cpu: Option<f64>,
    /// Work per CPU second.
    pub rates: BTreeMap<String, f64>,
    /// Instructions.
    pub instructions: Option<f64>,
}

/// Runs of several files in the order of time, each once.
pub fn merge(runs: impl IntoIterator<Item = BenchRun>) -> Vec<BenchRun> {
    let mut all: Vec<BenchRun> = runs.into_iter().collect();
    all.sort_by(|a, b| (a.time, &a.commit, &a.flags).cmp(&(b.time, &b.commit, &b.flags)));
    all.dedup_by(|a, b| a == b);
    all
}

/// How each case of `run` differs from the last of `earlier` (in the order of time) that has the same
/// machine and build and timed or counted the same; `None` where there is none.
pub fn changes(run: &BenchRun, earlier: &[BenchRun]) -> Vec<Option<Change>> {
    let alike = |other: &&BenchRun| {
        other.machine == run.machine && other.features == run.features && other.build == run.build
    };
    let earlier: Vec<&BenchRun> = earlier.iter().filter(alike).collect();
    run.cases.iter().map(|case| change(case, &earlier)).collect()
}

fn change(case: &Case, earlier: &[&BenchRun]) -> Option<Change> {
    let before = |same: &dyn Fn(&Case) -> bool| {
        earlier.iter().rev().find_map(|run| {
            let found = run.cases.iter().find(|other| other.name == case.name && same(other))?;
            Some((run.commit.as_str(), found))
        })
    };
    let timed = before(&|other| other.command == case.command && other.passes == case.passes);
    let counted = before(&|other| match (&other.counted, &case.counted) {
        (Some(a), Some(b)) => a.command == b.command && a.vectors == b.vectors,
        _ => false,
    });
    let (commit, _) = timed.or(counted)?;
    let mut change = Change { commit: commit.to_owned(), ..Change::default() };
    if let Some((_, old)) = timed {
        change.cpu = ratio(case.cpu_seconds, old.cpu_seconds);
        change.rates = case
            .rates
            .iter()
            .filter_map(|(name, &new)| Some((name.clone(), ratio(new, *old.rates.get(name)?)?)))
            .collect();
    }
    if let (Some((_, old)), Some(new)) = (counted, &case.counted) {
        let old = old.counted.as_ref()?.instructions;
        change.instructions = ratio(new.instructions, old);
    }
    Some(change)
}

/// A ratio that means something.
fn ratio(new: f64, old: f64) -> Option<f64> {
    (old > 0.0 && new.is_finite()).then(|| new / old)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(name: &str, cpu: f64, instructions: Option<f64>) -> Case {
        Case {
            name: name.into(),
            command: format!("render {name}"),
            passes: 2,
            cpu_seconds: cpu,
            wall_seconds: cpu,
            vectors: "AVX-512".into(),
            rates: BTreeMap::from([("pairs".to_owned(), 100.0 / cpu)]),
            counted: instructions.map(|instructions| Counted {
                command: format!("count {name}"),
                instructions,
                tool: "callgrind".into(),
                vectors: "AVX2".into(),
                ..Counted::default()
            }),
        }
    }

    fn run(time: u64, machine: &str, cases: Vec<Case>) -> BenchRun {
        let commit = format!("c{time}");
        let build = "release".to_owned();
        BenchRun { time, commit, machine: machine.into(), build, cases, ..BenchRun::default() }
    }

    #[test]
    fn a_case_is_compared_with_the_last_of_its_kind_on_the_same_machine() {
        let earlier = [
            run(1, "m", vec![case("a", 4.0, Some(1000.0)), case("b", 1.0, None)]),
            run(2, "m", vec![case("a", 2.0, None)]),
            run(3, "other", vec![case("a", 1.0, Some(1.0)), case("b", 9.0, None)]),
            BenchRun { build: "debug".into(), ..run(4, "m", vec![case("b", 9.0, None)]) },
            BenchRun { features: vec!["avx2".into()], ..run(5, "m", vec![case("b", 9.0, None)]) },
        ];
        let now = run(
            6,
            "m",
            vec![case("a", 3.0, Some(1100.0)), case("b", 0.5, None), case("c", 1.0, None)],
        );
        let found = changes(&now, &earlier);
        let a = found[0].as_ref().unwrap();
        // Timed last in run 2, counted last in run 1.
        assert_eq!((a.commit.as_str(), a.cpu, a.instructions), ("c2", Some(1.5), Some(1.1)));
        assert!((a.rates["pairs"] - 2.0 / 3.0).abs() < 1e-12);
        let b = found[1].as_ref().unwrap();
        assert_eq!((b.commit.as_str(), b.cpu, b.instructions), ("c1", Some(0.5), None));
        assert_eq!(found[2], None);
    }

    #[test]
    fn a_case_that_was_changed_is_not_compared() {
        let old = run(1, "m", vec![case("a", 4.0, Some(1000.0))]);
        let with = |change: &dyn Fn(&mut Case)| {
            let mut new = case("a", 2.0, Some(500.0));
            change(&mut new);
            changes(&run(2, "m", vec![new]), std::slice::from_ref(&old))[0].clone()
        };
        let found = with(&|_| ()).unwrap();
        assert_eq!((found.cpu, found.instructions), (Some(0.5), Some(0.5)));
        let found = with(&|case| case.passes = 3).unwrap();
        assert_eq!((found.cpu, found.instructions), (None, Some(0.5)));
        let found = with(&|case| case.counted.as_mut().unwrap().vectors = "scalar".into()).unwrap();
        assert_eq!((found.cpu, found.instructions), (Some(0.5), None));
        let other = |case: &mut Case| {
            (case.command, case.counted) = ("another".into(), None);
        };
        assert_eq!(with(&other), None);
    }

    #[test]
    fn goals_are_met_or_missed() {
        let cost = |instructions, at_most, at_least| Cost {
            instructions,
            at_most,
            at_least,
            ..Cost::default()
        };
        assert_eq!(cost([1.0, 2.0], None, None).met(), None);
        assert_eq!(cost([102.0, 100.0], Some(1.02), None).met(), Some(true));
        assert_eq!(cost([103.0, 100.0], Some(1.02), None).met(), Some(false));
        assert_eq!(cost([190.0, 100.0], None, Some(2.0)).met(), Some(false));
        assert_eq!(cost([200.0, 100.0], None, Some(2.0)).met(), Some(true));
        assert_eq!(cost([1.0, 0.0], Some(1.0), None).met(), Some(false));
    }

    #[test]
    fn lines_survive_json_and_those_of_other_versions_are_read() {
        let mut run = run(7, "m", vec![case("a", 4.0, Some(1000.0)), case("b", 1.0, None)]);
        run.costs = vec![Cost { instructions: [3.0, 2.0], at_most: Some(1.02), ..Cost::default() }];
        let text = serde_json::to_string(&run).unwrap();
        assert!(!text.contains('\n') && text.contains(r#""counted":null"#), "{text}");
        assert_eq!(serde_json::from_str::<BenchRun>(&text).unwrap(), run);
        let old = r#"{"time":1,"commit":"c","new":[1],"cases":[{"name":"a","command":"x",
            "passes":1,"cpu_seconds":2.0,"wall_seconds":2.0}]}"#;
        let old: BenchRun = serde_json::from_str(old).unwrap();
        assert_eq!((old.cases[0].counted.clone(), old.costs.len()), (None, 0));
        let merged = merge([run.clone(), old.clone(), run.clone()]);
        assert_eq!(merged, [old, run]);
    }
}
