//! `cargo xtask dashboard`: gathers what other tasks left and writes the page.

use std::path::{Path, PathBuf};

use clap::Args;
use tpb_dashboard::bench_runs::BenchRun;
use tpb_dashboard::benchmarks::{self, Benchmark, CommitBy};
use tpb_dashboard::{DashboardReport, Shelf, Sources, lines};
use tpb_validation::history;

use crate::bench;
use crate::circumstances::{commit, commit_before, machine};
use crate::validate::HISTORY;
use crate::workspace::{Outcome, root, say};

/// Options of `cargo xtask dashboard`.
#[derive(Args)]
#[command(after_help = "\
Runs no experiment: it shows what is there, and names the command that makes what is not. The output
folder is whole by itself: pages of other commands are copied into it.

  experiments          target/validation/history.jsonl, validation/history.jsonl
  error against time   target/error-time/*.json
  benchmarks           target/bench/history.jsonl, benches/history.jsonl; target/criterion,
                       collected into target/benchmarks/history.jsonl
  comparisons          target/reproduce, target/gallery

The formats of the lines are documented in the crate tpb-dashboard.")]
pub(crate) struct DashboardArgs {
    /// Open the page in a browser
    #[arg(long)]
    open: bool,
    /// Folder in which other tasks left their results [default: target]
    #[arg(long, value_name = "DIR")]
    from: Option<PathBuf>,
    /// Output folder [default: dashboard, in the folder of the results]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Collects, writes and, if asked for, opens the page.
pub(crate) fn run(args: &DashboardArgs) -> Outcome {
    let from = args.from.clone().unwrap_or_else(|| root().join("target"));
    let runs = bench::histories(&from);
    let collected = from.join("benchmarks").join(HISTORY);
    collect(&from.join("criterion"), &collected, &runs)?;
    let report = tpb_dashboard::write(&Sources {
        commit: commit(),
        machine: machine(None),
        root: root(),
        plan: history::plan(),
        histories: vec![
            from.join("validation").join(HISTORY),
            root().join("validation").join(HISTORY),
        ],
        benchmarks: vec![collected],
        bench_runs: runs.to_vec(),
        error_time: from.join("error-time"),
        shelves: shelves(&from),
        out: args.out.clone().unwrap_or_else(|| from.join("dashboard")),
    })?;
    tell(&report);
    if args.open {
        open::that_detached(&report.page).map_err(|error| {
            let page = report.page.display();
            format!("no browser could be started ({error}); open {page} by hand")
        })?;
    }
    Ok(true)
}

/// Adds what Criterion.rs left, and neither a history nor `runs` have yet, to the history.
fn collect(
    criterion: &Path,
    history: &Path,
    runs: &[PathBuf],
) -> Result<(), Box<dyn std::error::Error>> {
    let mut known: Vec<Benchmark> = lines::read(history)?.values;
    for file in runs {
        let runs: Vec<BenchRun> = lines::read(file)?.values;
        known.extend(runs.into_iter().flat_map(|run| run.benchmarks));
    }
    let commit =
        |time| (commit_before(time).unwrap_or_else(|| "unknown".to_owned()), CommitBy::Time);
    let found = benchmarks::collect(criterion, &known, &machine(None), commit)?;
    lines::append(history, &found)?;
    if !found.is_empty() {
        say(&format!("{} benchmarks added to {}", found.len(), history.display()));
    }
    Ok(())
}

/// Where other tasks leave pages.
fn shelves(from: &Path) -> Vec<Shelf> {
    let shelf = |title: &str, folder: &str, command: &str| Shelf {
        title: title.to_owned(),
        folder: from.join(folder),
        command: command.to_owned(),
    };
    vec![
        shelf("The paper's scenes", "reproduce", "cargo xtask reproduce all"),
        shelf("Gallery", "gallery", "cargo xtask gallery"),
        shelf("Criterion's own report", "criterion", "cargo bench --package tpb-benches"),
    ]
}

fn tell(report: &DashboardReport) {
    for remark in &report.remarks {
        say(&format!("note: {remark}"));
    }
    let [passed, failed, without] = report.experiments;
    say(&format!(
        "experiments: {passed} passed, {failed} did not, {without} without a result; \
         {} scenes with errors against time; {} benchmarks; {} pages, copied with what they show \
         ({:.1} MB)",
        report.scenes,
        report.benchmarks,
        report.linked,
        report.copied as f64 / 1e6
    ));
    say(&format!("wrote {} ({:.1} MB)", report.page.display(), report.bytes as f64 / 1e6));
}
