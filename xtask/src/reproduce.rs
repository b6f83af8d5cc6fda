//! `cargo xtask reproduce`: parse, call `tpb_validation::reproduce`, print.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use tpb_validation::reproduce::Options;
use tpb_validation::reproduce::session::{self, Figure};
use tpb_validation::with_threads;

use crate::circumstances;
use crate::workspace::{Outcome, root, say};

/// Examples below the options.
const EXAMPLES: &str = "Examples:
  cargo xtask reproduce all                     everything, about half an hour on 2 cores
  cargo xtask reproduce all --time 160          four times as long, half the noise
  cargo xtask reproduce mirrors --pixels 64 --bins 80 --time 2    a trial

Time of a run is that of one render at picture quality; all other renders take a fixed part or
multiple of it: the plan is printed first. References are kept in the output folder and used again by
the same commit; a larger --reference-time adds to them. Ctrl-c ends the run after the render under way, a second one at
once; whatever was finished is kept, and the same command goes on there (same commit, sources as
committed).

A trial (--pixels, --bins, or less than the default --time) writes to a folder of its own, trials/NAME
below the output folder, and its pages say that it is one.

Writes index.html, table.md, and for each scene a folder with index.html, viewer.html, result.json,
pictures and charts. No page takes more than 20 MB; what had to be reduced for that is said on it.";

/// The exit code of a program that SIGINT ended.
const INTERRUPTED: i32 = 130;

/// Which scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Figure 2: path tracing and photon beams at equal time
    CornellBlocks,
    /// Figure 3: mirrors, a glass ball, caustics
    Mirrors,
    /// Both
    All,
}

impl Which {
    fn figures(self) -> &'static [Figure] {
        match self {
            Self::CornellBlocks => &[Figure::CornellBlocks],
            Self::Mirrors => &[Figure::Mirrors],
            Self::All => &Figure::ALL,
        }
    }
}

/// Options of `cargo xtask reproduce`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ReproduceArgs {
    /// Which scenes
    #[arg(value_enum, default_value = "all")]
    which: Which,
    /// Wall time of one render of the equal-time comparison; less than the default is a trial
    #[arg(long, value_name = "SECONDS", default_value = "40", value_parser = seconds)]
    time: Duration,
    /// Wall time of the reference at picture quality [default: 10 times --time]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    reference_time: Option<Duration>,
    /// Go on with references that sources of other commits made; pages say so. Else they are made anew
    #[arg(long)]
    old_references: bool,
    /// Renders of each method, at least 3
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(3..=100))]
    replicates: u64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Pixels along an edge instead of the scenes' own: a trial
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=4096))]
    pixels: Option<u32>,
    /// Time bins over the scenes' windows: a trial
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=100_000))]
    bins: Option<u32>,
    /// Output folder [default: target/reproduce]; a trial has a folder of its own in it
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Renders, compares, writes, prints the table.
pub(crate) fn run(args: &ReproduceArgs) -> Outcome {
    let started = Instant::now();
    let options = options(args);
    let circumstances = &options.circumstances;
    say(&format!("{}; commit {}", circumstances.machine, circumstances.commit));
    let stop = stop();
    let figures = args.which.figures();
    let summary = with_threads(args.threads, || {
        session::run(figures, &options, &mut |line| say(line), &stop)
    })??;
    say("");
    for line in summary.markdown().lines() {
        say(line);
    }
    say("");
    let seconds = started.elapsed().as_secs_f64();
    say(&format!("{}: {seconds:.0} s", options.out.join("index.html").display()));
    Ok(true)
}

/// True once ctrl-c was pressed; a second time ends the program.
fn stop() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    // Where the system refuses a handler, ctrl-c ends the program, and what was finished is kept, too.
    let _ = ctrlc::set_handler(move || on_interrupt(&asked));
    stop
}

#[expect(clippy::exit, reason = "the second ctrl-c ends the program, wherever it is")]
fn on_interrupt(stop: &AtomicBool) {
    if stop.swap(true, Ordering::Relaxed) {
        std::process::exit(INTERRUPTED);
    }
    say("ending after this render; ctrl-c again ends at once");
}

fn options(args: &ReproduceArgs) -> Options {
    let size = |n: Option<u32>| n.map(|n| n as usize);
    let options = Options {
        time: args.time,
        reference_time: args.reference_time.unwrap_or(args.time * 10),
        replicates: args.replicates,
        old_references: args.old_references,
        pixels: size(args.pixels),
        bins: size(args.bins),
        scenes: root().join("scenes"),
        out: args.out.clone().unwrap_or_else(|| root().join("target/reproduce")),
        circumstances: circumstances::of(args.threads, args.seed),
        command: command(args),
    };
    options.apart()
}

/// The command that repeats this run.
fn command(args: &ReproduceArgs) -> String {
    let which = args.which.to_possible_value().map_or(String::new(), |v| v.get_name().to_owned());
    let mut command = format!(
        "cargo xtask reproduce {which} --time {} --replicates {} --seed {}",
        args.time.as_secs_f64(),
        args.replicates,
        args.seed
    );
    let numbers = [
        ("reference-time", args.reference_time.map(|time| time.as_secs_f64().to_string())),
        ("threads", args.threads.map(|n| n.to_string())),
        ("pixels", args.pixels.map(|n| n.to_string())),
        ("bins", args.bins.map(|n| n.to_string())),
    ];
    if args.old_references {
        command += " --old-references";
    }
    for (name, value) in numbers {
        command += &value.map_or(String::new(), |value| format!(" --{name} {value}"));
    }
    command
}

/// Seconds of the command line, more than 0.
fn seconds(text: &str) -> Result<Duration, Box<dyn Error + Send + Sync>> {
    let time = Duration::try_from_secs_f64(text.parse()?)?;
    if time.is_zero() { Err("must be more than 0".into()) } else { Ok(time) }
}
