//! `cargo xtask error-time`: error against run time, as tables, JSON and charts.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use tpb_scene::Scene;
use tpb_validation::experiment::{Context, Effort};
use tpb_validation::experiments::equal_time::RUNS;
use tpb_validation::judged::{Referee, sees_no_mirror};
use tpb_validation::measure::Estimator;
use tpb_validation::reference_cube::ReferenceCube;
use tpb_validation::run_time::{Clock, ErrorAgainstTime, RunTimePlan};
use tpb_validation::watch::duration;
use tpb_validation::{ValidationError, scenes, with_threads};

use crate::circumstances;
use crate::workspace::{Outcome, root, say};

/// Options of `cargo xtask error-time`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask error-time                           all scenes, 12 minutes and one reference
  cargo xtask error-time --time 2 --replicates 4   the same, noisier, in 2 minutes
  cargo xtask error-time --scene cornell-blocks --method path --method beams

Writes SCENE.json, SCENE-cpu.svg, SCENE-wall.svg and SCENE-efficiency.svg for each scene;
`cargo xtask dashboard` draws from them. A scene that ships without a reference gets one first,
rendered by the method that finds all its light for --reference-time; it is kept under
target/validation/references. The light tracer is left out where mirrors or glass are judged, in which
it sees nothing.")]
pub(crate) struct ErrorTimeArgs {
    /// Names of shipped scenes [default: those that have an equal-time experiment]
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<String>,
    /// Methods [default: path, light, beams, beams-2d; a pass with the 3D kernel takes longer than a run]
    #[arg(long = "method", value_parser = Estimator::LABELS)]
    methods: Vec<String>,
    /// Wall time of a run in seconds
    #[arg(long, value_name = "SECONDS", default_value = "8", value_parser = seconds)]
    time: Duration,
    /// Runs of each method, at least 3
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u64).range(3..))]
    replicates: u64,
    /// Seed; each run has one of its own
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
    let all = || RUNS.iter().map(|run| run.scene.to_owned()).collect();
    let scenes: Vec<String> = if args.scenes.is_empty() { all() } else { args.scenes.clone() };
    let methods = methods(&args.methods).len() as f64;
    let seconds = args.time.as_secs_f64() * args.replicates as f64 * methods * scenes.len() as f64;
    say(&format!("plan: {} scenes, about {}", scenes.len(), duration(seconds)));
    for scene in &scenes {
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
    let known = RUNS.iter().find(|run| run.scene == scene);
    let referee = known.map_or(Referee::Path, |run| run.referee);
    let there = [context.reference_path(scene), context.made_reference_path(scene)];
    if !there.iter().any(|path| path.exists()) {
        say(&format!(
            "{scene}: a reference first, {}",
            duration(args.reference_time.as_secs_f64())
        ));
    }
    let (reference, note) =
        ReferenceCube::of_shipped(&loaded, scene, referee, &context, args.reference_time)?;
    let (mut methods, mut left_out) = (methods(&args.methods), Vec::new());
    if let Some(reason) = unseen_by_light(&loaded.scene, &reference) {
        methods.retain(|method| !matches!(method, Estimator::Light(_)));
        left_out.push(reason);
    }
    for note in note.iter().chain(&left_out) {
        say(&format!("{scene}: {note}"));
    }
    let plan = RunTimePlan {
        name: scene.to_owned(),
        scene: &loaded.scene,
        reference: &reference,
        methods,
        time: args.time,
        replicates: args.replicates,
        seed: args.seed,
        circumstances: circumstances::of(args.threads, args.seed),
        left_out,
    };
    plan.run(|method, replicate| say(&format!("{scene}: {method}, run {}", replicate + 1)))
}

/// Seconds of the command line.
fn seconds(text: &str) -> Result<Duration, Box<dyn Error + Send + Sync>> {
    Ok(Duration::try_from_secs_f64(text.parse()?)?)
}

/// Why the light tracer is left out, if pixels are judged that it does not see.
fn unseen_by_light(scene: &Scene, reference: &ReferenceCube) -> Option<String> {
    let judged = reference.mask.iter().zip(sees_no_mirror(scene));
    let unseen = judged.filter(|&(&judged, plain)| judged && !plain).count();
    (unseen > 0).then(|| {
        format!("light: {unseen} judged pixels look at mirrors or glass, in which it sees nothing")
    })
}

/// What is measured unless methods are named.
const METHODS: [&str; 4] = ["path", "light", "beams", "beams-2d"];

/// The methods of these labels, or the default ones.
fn methods(labels: &[String]) -> Vec<Estimator> {
    let chosen = Estimator::LABELS.into_iter().filter(|label| match labels {
        [] => METHODS.contains(label),
        _ => labels.iter().any(|asked| asked == label),
    });
    chosen.filter_map(Estimator::of_label).collect()
}

fn write(found: &ErrorAgainstTime, out: &Path) -> Result<(), Box<dyn Error>> {
    let file = |suffix: &str| out.join(format!("{}{suffix}", found.scene));
    fs::write(file(".json"), serde_json::to_string_pretty(found)? + "\n")?;
    fs::write(file("-cpu.svg"), found.error_chart(Clock::Cpu)?)?;
    fs::write(file("-wall.svg"), found.error_chart(Clock::Wall)?)?;
    fs::write(file("-efficiency.svg"), found.efficiency_chart()?)?;
    Ok(())
}
