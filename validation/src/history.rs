//! A run of the suite as a line of its history ([`tpb_dashboard::history`]).

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use tpb_dashboard::history;

use crate::equal_time::EqualTime;
use crate::experiment::{Effort, Experiment, Outcome, Verdict};
use crate::experiments::calibration::Rate;
use crate::registry;
use crate::suite::{Record, SuiteResult};

/// The line of a run that has just ended. Files below `root` are named from there.
pub fn line(result: &SuiteResult, effort: Effort, root: &Path) -> history::Run {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let about = &result.circumstances;
    history::Run {
        time: now.map_or(0, |since| since.as_secs()),
        commit: about.commit.clone(),
        machine: about.machine.clone(),
        flags: about.flags.clone(),
        seed: about.seed,
        effort: effort.pick("quick", "full").to_owned(),
        seconds: Some(result.seconds),
        false_alarm: Some(result.false_alarm),
        nominal: Some(result.nominal),
        unresolved: Some(result.unresolved),
        records: result.records.iter().map(|found| record(found, root)).collect(),
    }
}

fn record(found: &Record, root: &Path) -> history::Record {
    let outcome = found.outcome.as_ref();
    let failed = found.verdict != Verdict::Passed;
    let named = |file: &std::path::PathBuf| {
        file.strip_prefix(root).map_or_else(|_| file.clone(), Path::to_path_buf)
    };
    history::Record {
        name: found.name.clone(),
        verdict: match found.verdict {
            Verdict::Passed => history::Verdict::Passed,
            Verdict::Failed => history::Verdict::Failed,
            Verdict::Broken => history::Verdict::Broken,
        },
        seconds: Some(found.seconds),
        interval: outcome.and_then(|o| o.interval).map(|interval| interval.map(Some)),
        p: outcome.and_then(|o| o.worst_p),
        batches: outcome.map_or(0, |o| o.batches),
        contrasts: outcome.map_or(0, |o| o.contrasts.len()),
        notes: outcome.map_or_else(Vec::new, |o| o.notes.clone()),
        table: outcome.map_or_else(Vec::new, table),
        error: found.error.clone(),
        repeat: failed.then(|| found.repeat.clone()),
        files: found.files.iter().map(named).collect(),
    }
}

/// What an outcome has beside its contrasts.
fn table(outcome: &Outcome) -> Vec<String> {
    let equal_time = outcome.equal_time.iter().flat_map(EqualTime::table);
    equal_time.chain(outcome.calibration.iter().map(Rate::line)).collect()
}

/// All experiments, with what a dashboard says of those that were never run.
pub fn plan() -> Vec<tpb_dashboard::Planned> {
    let quick: Vec<String> =
        registry::experiments(Effort::Quick).iter().map(|experiment| experiment.name()).collect();
    let planned = |experiment: &dyn Experiment| tpb_dashboard::Planned {
        name: experiment.name(),
        description: experiment.description(),
        quick: quick.contains(&experiment.name()),
    };
    let full = registry::experiments(Effort::Full);
    let mut all: Vec<_> = full.iter().map(|experiment| planned(&**experiment)).collect();
    // What only the quick suite has: its twins may be others.
    for experiment in registry::experiments(Effort::Quick) {
        if all.iter().all(|known| known.name != experiment.name()) {
            all.push(planned(&*experiment));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::Kind;
    use crate::suite::Circumstances;
    use tpb_dashboard::{history::Run, lines};

    fn result() -> SuiteResult {
        let record = |name: &str, outcome: Option<Outcome>| Record {
            name: name.into(),
            description: "what".into(),
            verdict: outcome.as_ref().map_or(Verdict::Broken, |o| o.verdict),
            seconds: 1.5,
            error: outcome.is_none().then(|| "why".into()),
            outcome,
            repeat: format!("run {name}"),
            files: vec!["/root/of/it/target/a.svg".into(), "/elsewhere/b.svg".into()],
        };
        let mut odd =
            Outcome::exact(false, vec!["note".into()]).with_interval([-0.1, f64::INFINITY]);
        odd.worst_p = Some(0.25);
        odd.batches = 64;
        SuiteResult {
            circumstances: Circumstances {
                commit: "c-dirty".into(),
                machine: "m".into(),
                flags: "validate".into(),
                seed: 7,
            },
            records: vec![
                record("good", Some(Outcome::exact(true, vec![]))),
                record("odd", Some(odd)),
                record("broken", None),
            ],
            seconds: 9.0,
            false_alarm: 1e-7,
            nominal: 1e-6,
            unresolved: f64::NAN,
        }
    }

    #[test]
    fn a_line_says_of_a_run_what_the_report_says() {
        let line = line(&result(), Effort::Full, Path::new("/root/of/it"));
        assert_eq!((line.commit.as_str(), line.effort.as_str(), line.seed), ("c-dirty", "full", 7));
        let [good, odd, broken] = &line.records[..] else { panic!("three records") };
        assert_eq!((good.verdict, &good.repeat), (history::Verdict::Passed, &None));
        assert_eq!(odd.interval, Some([Some(-0.1), Some(f64::INFINITY)]));
        assert_eq!((odd.p, odd.batches, odd.notes.len()), (Some(0.25), 64, 1));
        assert_eq!(odd.files, [Path::new("target/a.svg"), Path::new("/elsewhere/b.svg")]);
        assert_eq!(broken.verdict, history::Verdict::Broken);
        assert_eq!(
            (broken.error.as_deref(), broken.repeat.as_deref()),
            (Some("why"), Some("run broken"))
        );
    }

    #[test]
    fn numbers_that_are_not_finite_do_not_tear_a_line() {
        let folder = std::env::temp_dir().join(format!("tpb-history-{}", std::process::id()));
        let file = folder.join("history.jsonl");
        lines::append(&file, &[line(&result(), Effort::Quick, Path::new("/"))]).unwrap();
        let back = lines::read::<Run>(&file).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(back.torn, 0);
        let run = &back.values[0];
        assert_eq!((run.unresolved, run.effort.as_str()), (None, "quick"));
        assert_eq!(run.records[1].interval, Some([Some(-0.1), None]));
    }

    #[test]
    fn the_plan_has_every_experiment_once_with_its_controls() {
        let plan = plan();
        let mut names: Vec<&str> = plan.iter().map(|planned| planned.name.as_str()).collect();
        names.sort_unstable();
        let all = names.len();
        names.dedup();
        assert_eq!(names.len(), all);
        let full = registry::experiments(Effort::Full);
        assert!(full.iter().all(|experiment| names.binary_search(&&*experiment.name()).is_ok()));
        let twins = full.iter().filter(|experiment| experiment.kind() == Kind::Twin).count();
        let controls =
            plan.iter().filter(|planned| history::control(&planned.name).is_some()).count();
        assert!(twins > 0 && controls >= twins);
    }
}
