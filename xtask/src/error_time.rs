//! `cargo xtask error-time`: error against run time, as tables, JSON and charts.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use tpb_validation::experiment::{Context, Effort};
use tpb_validation::judged::Referee;
use tpb_validation::measure::Estimator;
use tpb_validation::reference_cube::ReferenceCube;
use tpb_validation::run_time::{Clock, ErrorAgainstTime, RunTimePlan};
use tpb_validation::{ValidationError, scenes, with_threads};

use crate::circumstances;
use crate::workspace::{Outcome, root, say};

/// Options of `cargo xtask error-time`.
#[derive(Args)]
#[command(after_help = "\
Writes SCENE.json, SCENE-cpu.svg, SCENE-wall.svg and SCENE-efficiency.svg for each scene.
A scene that ships without a reference gets one first, rendered by the path tracer for
--reference-time; it is kept under target/validation/references.")]
pub(crate) struct ErrorTimeArgs {
    /// Names of shipped scenes
    #[arg(long = "scene", value_name = "NAME", default_value = "cornell-blocks")]
    scenes: Vec<String>,
    /// Methods [default: all]
    #[arg(long = "method", value_parser = Estimator::NAMES)]
    methods: Vec<String>,
    /// Wall time of a run in seconds
    #[arg(long, value_name = "SECONDS", default_value = "8", value_parser = seconds)]
    time: Duration,
    /// Runs of each method, at least 3
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u64).range(3..))]
    replicates: u64,
    /// Seed of the first run
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Wall time of a reference that has to be made
    #[arg(long, value_name = "SECONDS", default_value = "240", value_parser = seconds)]
    reference_time: Duration,
    /// Threads [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Output folder [default: target/error-time]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Measures, prints and writes.
pub(crate) fn run(args: &ErrorTimeArgs) -> Outcome {
    let out = args.out.clone().unwrap_or_else(|| root().join("target/error-time"));
    fs::create_dir_all(&out)?;
    for scene in &args.scenes {
        let found = with_threads(args.threads, || measure(args, scene))??;
        for line in found.table() {
            say(&line);
        }
        write(&found, &out)?;
    }
    say(&format!("wrote {}", out.display()));
    Ok(true)
}

fn measure(args: &ErrorTimeArgs, scene: &str) -> Result<ErrorAgainstTime, ValidationError> {
    let kept = root().join("target/validation");
    let context = Context::new(Effort::Full, args.seed, kept);
    let loaded = scenes::shipped(&context.scene_path(scene))?;
    let (reference, note) =
        ReferenceCube::of_shipped(&loaded, scene, Referee::Path, &context, args.reference_time)?;
    if let Some(note) = note {
        say(&format!("{scene}: {note}"));
    }
    let plan = RunTimePlan {
        name: scene.to_owned(),
        scene: &loaded.scene,
        reference: &reference,
        methods: methods(&args.methods),
        time: args.time,
        replicates: args.replicates,
        seed: args.seed,
        circumstances: circumstances::of(args.threads, args.seed),
    };
    plan.run(|method, replicate| say(&format!("{scene}: {method}, run {}", replicate + 1)))
}

/// Seconds of the command line.
fn seconds(text: &str) -> Result<Duration, Box<dyn Error + Send + Sync>> {
    Ok(Duration::try_from_secs_f64(text.parse()?)?)
}

/// The methods of these names, or all.
fn methods(names: &[String]) -> Vec<Estimator> {
    let all = Estimator::NAMES.into_iter();
    let chosen = all.filter(|name| names.is_empty() || names.iter().any(|asked| asked == name));
    chosen.filter_map(Estimator::of_name).collect()
}

fn write(found: &ErrorAgainstTime, out: &Path) -> Result<(), Box<dyn Error>> {
    let file = |suffix: &str| out.join(format!("{}{suffix}", found.scene));
    fs::write(file(".json"), serde_json::to_string_pretty(found)? + "\n")?;
    fs::write(file("-cpu.svg"), found.error_chart(Clock::Cpu)?)?;
    fs::write(file("-wall.svg"), found.error_chart(Clock::Wall)?)?;
    fs::write(file("-efficiency.svg"), found.efficiency_chart()?)?;
    Ok(())
}
