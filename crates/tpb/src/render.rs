//! `tpb render`: a scene into a result folder.

use std::num::NonZero;
use std::path::PathBuf;
use std::process::ExitCode;

use tpb_film::{Arrays, PulseReport};
use tpb_render::{
    Budget, FilmSetup, MethodRecord, Outcome, RenderOptions, Report, RunSettings, RunSummary,
    SceneRecord, Stopwatch, with_threads,
};
use tpb_scene::Transport;

use crate::cli::RenderArgs;
use crate::failure::Failure;
use crate::folder::ResultFolder;
use crate::prepare::{Job, Kept};
use crate::watch::Watch;
use crate::{print, summary};

/// The program and its version, as it goes into reports.
const PROGRAM: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));

/// Loads, renders, writes.
pub(crate) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    let started = Stopwatch::start();
    let options = options(args);
    let kept = Kept { window_only: args.window_only, unwarp: args.unwarp };
    let job = Job::new(&args.job, &args.method, kept)?;
    let setup = FilmSetup::new(&job.loaded.scene.film, job.plan.transport, &options)?;
    let folder = ResultFolder::prepare(&output(args, &job))?;
    let rendered = match job.plan.transport {
        Transport::Mono => render::<1>(&job, &setup, &options, &folder, &started),
        Transport::Rgb => render::<3>(&job, &setup, &options, &folder, &started),
    }?;
    finish(&job, args, options, rendered, &folder)
}

fn options(args: &RenderArgs) -> RenderOptions {
    let budget = match (args.passes, args.time) {
        (Some(passes), _) => Budget::Passes(passes.get()),
        (None, Some(time)) => Budget::Time(time),
        (None, None) => Budget::default(),
    };
    RenderOptions {
        run: RunSettings { seed: args.seed, budget, first_pass: 0 },
        threads: args.threads.map(NonZero::get),
        variance: args.variance,
        unwarp: args.unwarp,
        window_only: args.window_only,
        pulse: args.pulse,
        pictures: (!args.no_pictures).then(|| args.tone.pictures()),
    }
}

/// The folder that the command line names, or one named after scene and method.
fn output(args: &RenderArgs, job: &Job) -> PathBuf {
    args.output.clone().unwrap_or_else(|| {
        let scene = args.job.scene.file_stem().unwrap_or("scene".as_ref()).to_string_lossy();
        PathBuf::from(format!("{scene}-{}", job.method.name()))
    })
}

/// What comes out of the passes.
struct Rendered {
    run: RunSummary,
    arrays: Arrays,
    pulse: PulseReport,
    non_finite: u64,
    method: MethodRecord,
}

fn render<const C: usize>(
    job: &Job,
    setup: &FilmSetup,
    options: &RenderOptions,
    folder: &ResultFolder,
    started: &Stopwatch,
) -> Result<Rendered, Failure> {
    let mut film = setup.film::<C>()?;
    with_threads(options.threads, || {
        let method = job.method::<C>()?;
        let preview = options.pictures.map(|pictures| (folder.preview(), pictures));
        let mut watch = Watch::new(options.run.budget, preview);
        let run = tpb_render::run(&*method, &mut film, &options.run, started, &mut watch);
        watch.finish();
        let method = MethodRecord::new(method.name(), method.options(), &job.integrator);
        let non_finite = film.non_finite();
        let (arrays, pulse) = setup.develop(film)?;
        Ok(Rendered { run, arrays, pulse, non_finite, method })
    })?
}

fn finish(
    job: &Job,
    args: &RenderArgs,
    options: RenderOptions,
    rendered: Rendered,
    folder: &ResultFolder,
) -> Result<ExitCode, Failure> {
    let Rendered { run, arrays, pulse, non_finite, method } = rendered;
    let scene = SceneRecord {
        file: args.job.scene.display().to_string(),
        canonical: job.loaded.canonical.clone(),
    };
    let plan = &job.plan;
    let outcome = Outcome { scene, method, plan, run, non_finite, arrays: &arrays, pulse };
    let report = Report::new(PROGRAM, options, outcome);
    let written = folder.write(&arrays, &report, options.pictures.as_ref());
    for failure in &written.failures {
        print::err(&format!("error: {failure}"));
    }
    print::out(&summary::of_render(&report, &written, folder.path()))?;
    Ok(if !written.failures.is_empty() {
        ExitCode::from(2)
    } else if report.is_sound() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}
