//! `cargo xtask stress`: parse, call `tpb-validation`, print.

use std::path::PathBuf;

use clap::Args;
use tpb_validation::stress::{Case, Setup, groups, report, run_cases};
use tpb_validation::suite;
use xshell::{Shell, cmd};

use crate::workspace::{Outcome, root, say};

/// Examples below the options.
const EXAMPLES: &str = "Examples:
  cargo xtask stress                         everything, about 5 minutes on 2 cores
  cargo xtask stress --filter 'scale/*'      some cases
  cargo xtask stress --list                  the cases alone

Exit codes: 0 passed, 1 a case failed, 2 usage or files.
The table is written as stress.json and stress.md into --out.";

/// Options of `cargo xtask stress`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct StressArgs {
    /// Only cases whose name matches (`*`, `?`; plain text: contains it)
    #[arg(long, value_name = "GLOB")]
    filter: Option<String>,
    /// Print the cases and stop
    #[arg(long)]
    list: bool,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Also write all results as JSON to this file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Where the table is written [default: target/stress]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the cases; true if all passed.
pub(crate) fn run(args: &StressArgs) -> Outcome {
    let chosen: Vec<Case> = groups::all()
        .into_iter()
        .filter(|case| args.filter.as_ref().is_none_or(|glob| suite::matches(glob, &case.name)))
        .collect();
    if chosen.is_empty() {
        return Err("no case matches the filter; --list shows all".into());
    }
    if args.list {
        say_all(&report::plan(&chosen));
        return Ok(true);
    }
    let out = args.out.clone().unwrap_or_else(|| root().join("target/stress"));
    let setup = Setup { seed: args.seed, program: Some(program()?), folder: out.join("files") };
    // Better now than after the run.
    tpb_validation::suite::probe(&out)?;
    let width = report::width(&chosen);
    let result =
        run_cases(&chosen, &setup, args.threads, |record| say(&report::line(record, width)));
    let files = report::write(&result, &out)?;
    if let Some(path) = &args.json {
        report::write_json(&result, path)?;
    }
    say("");
    for file in files {
        say(&format!("wrote {}", file.display()));
    }
    say_all(&report::summary(&result));
    Ok(result.passed())
}

/// Builds the program that users run.
fn program() -> Result<PathBuf, Box<dyn std::error::Error>> {
    let sh = Shell::new()?;
    sh.change_dir(root());
    cmd!(sh, "cargo build --quiet --release --package tpb").quiet().run()?;
    let folder = std::env::current_exe()?;
    let name = format!("tpb{}", std::env::consts::EXE_SUFFIX);
    let program = folder.with_file_name(name);
    if program.exists() {
        return Ok(program);
    }
    Err(format!("there is no program at {}", program.display()).into())
}

fn say_all(lines: &[String]) {
    for line in lines {
        say(line);
    }
}
