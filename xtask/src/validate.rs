//! `cargo xtask validate` and `cargo xtask reference-render`: parse, call `tpb-validation`, print.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use tpb_dashboard::lines;
use tpb_validation::experiment::{Context, Effort, Experiment};
use tpb_validation::judged::Referee;
use tpb_validation::reference_cube::ReferenceCube;
use tpb_validation::suite::SuiteResult;
use tpb_validation::watch::Watch;
use tpb_validation::{history, registry, report, scenes, suite, with_threads};

use crate::circumstances::{self, commit};
use crate::workspace::{Outcome, root, say};

/// Name of the file of all runs, one line each.
pub(crate) const HISTORY: &str = "history.jsonl";

/// Examples below the options.
const EXAMPLES: &str = "Examples:
  cargo xtask validate                          everything, about 4 minutes on 2 cores
  cargo xtask validate --filter 'samplers/*'    some experiments
  cargo xtask validate --list                   the plan alone

Exit codes: 0 passed, 1 an experiment failed, 2 usage or files.
A report (report.md) and all results (results.json) are written to --out. A failing experiment leaves
its contrasts, maps and plots there too, and prints the command that repeats it. Each run is a line
of history.jsonl there, from which `cargo xtask dashboard` draws.";

/// Options of `cargo xtask validate`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line are independent")]
pub(crate) struct ValidateArgs {
    /// At most 4 minutes on 2 cores (the default)
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// More batches, longer equal-time runs, more scenes: tens of minutes
    #[arg(long)]
    full: bool,
    /// Only experiments whose name matches (`*`, `?`; plain text: contains it)
    #[arg(long, value_name = "GLOB")]
    filter: Option<String>,
    /// Also write all results as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Print the plan and stop
    #[arg(long)]
    list: bool,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Also keep the run in validation/history.jsonl, which is under version control
    #[arg(long)]
    record: bool,
    /// Folder of report.md, results.json, history.jsonl, and of the tables and plots of experiments that fail
    /// [default: target/validation]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Options of `cargo xtask reference-render`.
#[derive(Args)]
pub(crate) struct ReferenceRenderArgs {
    /// Name of a shipped scene
    #[arg(long, default_value = "cornell-blocks")]
    scene: String,
    /// Wall time in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0)]
    time: f64,
    /// Seed; equal-time runs use others
    #[arg(long, default_value_t = 20_240_229)]
    seed: u64,
    /// Threads [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Output file [default: the one that ships with the scene]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Runs the experiments; true if all passed.
pub(crate) fn run(args: &ValidateArgs) -> Outcome {
    let effort = if args.full { Effort::Full } else { Effort::Quick };
    let out = args.out.clone().unwrap_or_else(|| root().join("target/validation"));
    let context = Context::new(effort, args.seed, out);
    let chosen: Vec<Arc<dyn Experiment>> = registry::experiments(effort)
        .into_iter()
        .filter(|e| args.filter.as_ref().is_none_or(|glob| suite::matches(glob, &e.name())))
        .collect();
    if chosen.is_empty() {
        return Err("no experiment matches the filter; --list shows all".into());
    }
    say(&format!("plan: {} experiments", chosen.len()));
    say_all(&report::plan(&chosen));
    if args.list {
        return Ok(true);
    }
    // Better now than after the run.
    suite::probe(&context.out)?;
    say("");
    let width = report::width(chosen.iter().map(|e| e.name()));
    let repeat = |name: &str| {
        let full = if args.full { " --full" } else { "" };
        format!("cargo xtask validate{full} --seed {} --filter '{name}'", args.seed)
    };
    let about = circumstances::of(args.threads, args.seed);
    let result = with_threads(args.threads, || {
        suite::run_suite(&chosen, &context, about, repeat, |record| {
            say(&report::line(record, width));
            say_all(&report::remarks(record));
        })
    })?;
    suite::write_results(&result, &context.out)?;
    remember(&result, args, &context)?;
    if let Some(path) = &args.json {
        suite::write_json(&result, path)?;
    }
    say("");
    say_all(&report::summary(&result));
    say(&format!("report: {}", context.out.join("report.md").display()));
    Ok(result.passed())
}

/// Adds the run to the histories that the dashboard reads.
fn remember(
    result: &SuiteResult,
    args: &ValidateArgs,
    context: &Context,
) -> Result<(), Box<dyn Error>> {
    let line = [history::line(result, context.effort, &root())];
    lines::append(&context.out.join(HISTORY), &line)?;
    if args.record {
        lines::append(&context.data.join(HISTORY), &line)?;
    }
    Ok(())
}

/// Renders and writes a reference cube.
pub(crate) fn reference_render(args: &ReferenceRenderArgs) -> Outcome {
    let context = Context::new(Effort::Full, args.seed, PathBuf::new());
    let time = Duration::try_from_secs_f64(args.time)?;
    let loaded = scenes::shipped(&context.scene_path(&args.scene))?;
    let out = args.out.clone().unwrap_or_else(|| context.reference_path(&args.scene));
    say(&format!("rendering the reference of {} for {} s", args.scene, args.time));
    let made = with_threads(args.threads, || {
        let mut tell = |line: &str| say(line);
        let mut watch = Watch::new(&mut tell);
        ReferenceCube::make(&loaded, Referee::Path, time, args.seed, &commit(), &mut watch)
    })??;
    made.write(&out)?;
    let noise = made.noise(|pixel| made.mask[pixel]);
    say(&format!(
        "wrote {}: {} passes, {:.3e} camera paths, {:.0} CPU s, own NMSE {:.2e}, {} pixels judged",
        out.display(),
        made.provenance.passes,
        made.provenance.camera_paths as f64,
        made.provenance.cpu_seconds.unwrap_or(f64::NAN),
        noise.variance / noise.signal(),
        made.mask.iter().filter(|&&judged| judged).count()
    ));
    Ok(true)
}

fn say_all(lines: &[String]) {
    for line in lines {
        say(line);
    }
}
