//! `cargo xtask peers`: other programs and ours on the same scenes at equal CPU seconds.

mod setup;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use tpb_scene::load::{LoadedScene, Override, load_scene};
use tpb_validation::experiment::{Context, Effort};
use tpb_validation::experiments::equal_time::RUNS;
use tpb_validation::judged::Referee;
use tpb_validation::measure::Estimator;
use tpb_validation::peers::contest::{Contest, ContestPlan};
use tpb_validation::peers::driver::Peer;
use tpb_validation::peers::translate::{Translation, translate};
use tpb_validation::peers::{NAME, faults};
use tpb_validation::reference_cube::ReferenceCube;
use tpb_validation::run_time::Clock;
use tpb_validation::watch::duration;
use tpb_validation::with_threads;

use crate::circumstances;
use crate::workspace::{Outcome, root, say};

/// Scenes that both can render, and that show where they differ.
const SCENES: [&str; 3] = ["cornell-blocks", "mirror-caustic", "fog-only"];

/// Scenes of the gallery have a film this many times smaller along its sides, and in time.
const SMALLER: [usize; 3] = [4, 4, 2];

/// Options of `cargo xtask peers`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask peers --setup                        the environment, once: 100 MB from the Python package index
  cargo xtask peers                                three scenes, about 15 minutes on 2 cores
  cargo xtask peers --scene mirror-caustic-point   where the peer is known to lack light
  cargo xtask peers --scene window --cpu 16        any scene that ships and that it can do

The peer is mitransient (transient path tracing on Mitsuba 3) with the integrator transient_prbvolpath. Its time
counts only while its kernels run: start, compilation and tracing are told apart. Each scene is translated, or
refused with the reason. Scenes of scenes/ are rendered at a quarter of their size and half their bins; a
scene without a reference that ships gets one first (--reference-time), kept under target/validation/references.

Writes peers.json, peers.md and a chart for each scene; and target/error-time/SCENE-peers.json, from
which `cargo xtask dashboard` draws. Tests and CI never run this.")]
pub(crate) struct PeersArgs {
    /// Makes the Python environment of the peer, checks it, and ends
    #[arg(long)]
    setup: bool,
    /// Python 3.9 or newer with venv, for --setup
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    python: PathBuf,
    /// Scenes of validation/scenes or scenes [default: cornell-blocks, mirror-caustic, fog-only]
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<String>,
    /// Our methods [default: beams, and the reference's own, which is unbiased]
    #[arg(long = "method", value_parser = Estimator::LABELS)]
    methods: Vec<String>,
    /// CPU time of a run in seconds
    #[arg(long, value_name = "SECONDS", default_value = "4", value_parser = seconds)]
    cpu: Duration,
    /// Runs of each program, at least 3; 16 for medians that mean something
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u64).range(3..))]
    replicates: u64,
    /// Samples per pixel of one launch of the peer
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=4096))]
    samples: u32,
    /// Seed; each run has one of its own
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Wall time of a reference that has to be made
    #[arg(long, value_name = "SECONDS", default_value = "120", value_parser = seconds)]
    reference_time: Duration,
    /// Threads of both [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Output folder [default: target/peers]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// A scene that both render.
struct Entrant {
    name: String,
    loaded: LoadedScene,
    translation: Translation,
}

/// Compares, prints and writes; or makes the environment.
pub(crate) fn run(args: &PeersArgs) -> Outcome {
    let environment = root().join("target/peers/venv");
    if args.setup {
        return setup::run(&args.python, &environment);
    }
    let python = setup::interpreter(&environment);
    if !python.exists() {
        return Err(setup::missing(&environment).into());
    }
    let out = args.out.clone().unwrap_or_else(|| root().join("target/peers"));
    fs::create_dir_all(&out)?;
    let names: Vec<&str> = match args.scenes.as_slice() {
        [] => SCENES.to_vec(),
        names => names.iter().map(String::as_str).collect(),
    };
    let mut contests = Vec::new();
    for name in &names {
        match entrant(name)? {
            Ok(entrant) => contests.push(with_threads(args.threads, || {
                measure(args, &entrant, &python, &out).map_err(|error| error.to_string())
            })??),
            Err(refusal) => say(&format!("{name}: refused, {refusal}")),
        }
        // What is finished is kept, whatever becomes of the next scene.
        fs::write(out.join("peers.json"), serde_json::to_string_pretty(&contests)? + "\n")?;
        fs::write(out.join("peers.md"), page(&contests))?;
    }
    for line in page(&contests).lines() {
        say(line);
    }
    say(&format!("wrote {}", out.display()));
    Ok(contests.len() == names.len())
}

/// The scene of a name, or why the peer cannot render it.
fn entrant(name: &str) -> Result<Result<Entrant, String>, Box<dyn Error>> {
    let file = |folder: &str| root().join(folder).join(format!("{name}.json"));
    let small = file("validation/scenes");
    let (path, mut changes, mut shown) = (file("scenes"), Vec::new(), name.to_owned());
    let path = if small.exists() { small } else { path };
    let mut loaded = load_scene(&path, &[])?;
    if !path.starts_with(root().join("validation")) {
        let film = loaded.scene.film;
        let [width, height] = [film.width / SMALLER[0], film.height / SMALLER[1]];
        changes.extend([("width", width.to_string()), ("height", height.to_string())]);
        shown = format!("{name}-{width}x{height}");
        if let Some(time) = film.time {
            let bins = time.bins / SMALLER[2];
            let bin_width = time.bin_width_opl * SMALLER[2] as f64;
            changes.push(("temporal_bins", bins.to_string()));
            changes.push(("bin_width_opl", bin_width.to_string()));
            shown = format!("{shown}x{bins}");
        }
        let changes: Result<Vec<_>, _> = changes
            .iter()
            .map(|(key, value)| Override::parse(&format!("sensor.film.{key}={value}")))
            .collect();
        loaded = load_scene(&path, &changes?)?;
    }
    let directory = path.parent().unwrap_or(Path::new(""));
    Ok(match translate(&loaded, directory) {
        Ok(translation) => Ok(Entrant { name: shown, loaded, translation }),
        Err(refusal) => Err(refusal.to_string()),
    })
}

fn measure(
    args: &PeersArgs,
    entrant: &Entrant,
    python: &Path,
    out: &Path,
) -> Result<Contest, Box<dyn Error>> {
    let Entrant { name, loaded, translation } = entrant;
    let context = Context::new(Effort::Full, args.seed, root().join("target/validation"));
    let referee = RUNS.iter().find(|run| run.scene == name).map_or(Referee::Path, |r| r.referee);
    let there = [context.reference_path(name), context.made_reference_path(name)];
    if !there.iter().any(|path| path.exists()) {
        let time = duration(args.reference_time.as_secs_f64());
        say(&format!("{name}: a reference first, {time}"));
    }
    let (reference, note) =
        ReferenceCube::of_shipped(loaded, name, referee, &context, args.reference_time)?;
    if let Some(note) = note {
        say(&format!("{name}: {note}"));
    }
    let ours = methods(&args.methods, referee);
    let runs = args.replicates as f64 * (ours.len() + 1) as f64;
    say(&format!("{name}: about {:.0} CPU s", 1.2 * runs * args.cpu.as_secs_f64()));
    let circumstances = circumstances::of(args.threads, args.seed);
    let threads =
        args.threads.or_else(|| std::thread::available_parallelism().ok().map(usize::from));
    let folder = out.join(name);
    let mut peer = Peer::start(python, &folder, translation, threads.unwrap_or(1), args.samples)?;
    let plan = ContestPlan {
        name: name.clone(),
        scene: &loaded.scene,
        reference: &reference,
        ours,
        samples: args.samples,
        cpu_seconds: args.cpu.as_secs_f64(),
        replicates: args.replicates,
        seed: args.seed,
        circumstances,
        faults: faults::known(&loaded.scene),
    };
    let contest = plan.run(&mut peer, |method, replicate| {
        say(&format!("{name}: {method}, run {}", replicate + 1));
    })?;
    write(&contest, name, out)?;
    Ok(contest)
}

/// Our methods: those asked for, else beams and the referee's.
fn methods(labels: &[String], referee: Referee) -> Vec<Estimator> {
    if labels.is_empty() {
        return ["beams"]
            .into_iter()
            .filter_map(Estimator::of_label)
            .chain([referee.estimator()])
            .collect();
    }
    labels.iter().filter_map(|label| Estimator::of_label(label)).collect()
}

fn write(contest: &Contest, name: &str, out: &Path) -> Result<(), Box<dyn Error>> {
    let curves = &contest.curves;
    fs::write(out.join(format!("{name}-cpu.svg")), curves.error_chart(Clock::Cpu)?)?;
    let shared = root().join("target/error-time");
    fs::create_dir_all(&shared)?;
    let json = serde_json::to_string_pretty(curves)? + "\n";
    fs::write(shared.join(format!("{name}-peers.json")), json)?;
    Ok(())
}

/// All tables.
fn page(contests: &[Contest]) -> String {
    let mut lines = vec![format!("# {NAME} and photon beams at equal CPU time"), String::new()];
    if let Some(first) = contests.first() {
        let about = &first.curves.circumstances;
        lines.push(format!("{}; commit {}.", about.machine, about.commit));
    }
    for contest in contests {
        lines.push(String::new());
        lines.extend(contest.markdown());
    }
    lines.join("\n") + "\n"
}

/// Seconds of the command line, more than 0.
fn seconds(text: &str) -> Result<Duration, Box<dyn Error + Send + Sync>> {
    let time = Duration::try_from_secs_f64(text.parse()?)?;
    if time.is_zero() { Err("must be more than 0".into()) } else { Ok(time) }
}
