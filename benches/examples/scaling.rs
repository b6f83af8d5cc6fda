//! How the cost of a pass grows with photons, pixels and bins, what a sample costs on a film of very
//! many bins, and what a second thread gains; on cornell-blocks.
//!
//! `cargo run --release -p tpb-benches --example scaling [photons|pixels|bins|threads]...`
//!
//! Each number is CPU seconds of a pass on one thread (wall seconds for threads): the best of some
//! turns, in which all settings come by once, so that a busy machine slows all alike. The first passes,
//! in which the system gives the film its memory, are not counted. The slope is that of the least-squares line through
//! the logarithms; the steepest of all pairs of neighbours is told beside it. Charts go to
//! `target/scaling`.

use std::error::Error;
use std::fs;
use std::num::NonZeroU32;
use std::path::Path;
use std::time::Instant;

use cpu_time::ProcessTime;
use tpb_beams::{BeamOptions, KernelChoice, PhotonBeams};
use tpb_benches::{changed_scene, film_of};
use tpb_film::TransientFilm;
use tpb_path::{PathOptions, PathTracer};
use tpb_plot::{Axis, Chart, Mark, Series};
use tpb_render::{Method, PassId, with_threads};
use tpb_scene::{Plan, Scene};

/// The window of cornell-blocks \[m\], whatever the bins.
const WINDOW: f64 = 14.0;

const TURNS: usize = 2;

/// A film is warm after so many passes, or so many CPU seconds of them.
const WARMING_PASSES: usize = 40;
const WARMING_SECONDS: f64 = 1.5;

/// What a pass does.
#[derive(Clone, Copy, Debug)]
struct Setting {
    kernel: Option<KernelChoice>,
    photons: u64,
    /// Along both edges.
    pixels: usize,
    bins: usize,
    /// Paths or gathering rays per pixel.
    samples: u32,
}

/// The path tracer, or beams by kernel.
const METHODS: [(&str, Option<KernelChoice>); 3] = [
    ("path", None),
    ("beams 1D", Some(KernelChoice::OneD)),
    ("beams 2D", Some(KernelChoice::TwoD)),
];

#[expect(clippy::print_stdout, reason = "a program that prints tables")]
fn main() -> Result<(), Box<dyn Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let wants = |what: &str| wanted.is_empty() || wanted.iter().any(|w| w == what);
    let base = Setting { kernel: None, photons: 10_000, pixels: 64, bins: 200, samples: 1 };
    if wants("photons") {
        let counts = [1_000, 10_000, 100_000, 1_000_000];
        let settings = |kernel| counts.map(|photons| Setting { kernel, photons, ..base });
        scale("photons", &METHODS[1..], &counts, settings)?;
    }
    if wants("pixels") {
        let edges = [32, 100, 320, 1000];
        let settings = |kernel| edges.map(|pixels| Setting { kernel, pixels, bins: 20, ..base });
        scale("pixels", &METHODS, &edges.map(|edge| (edge * edge) as u64), settings)?;
    }
    if wants("bins") {
        let counts = [100, 1_000, 10_000, 100_000];
        let settings = |kernel| counts.map(|bins| Setting { kernel, bins, ..base });
        scale("bins", &METHODS, &counts.map(|bins| bins as u64), settings)?;
        println!("\n{:<10} {:>8} {:>14} {:>9}", "samples", "200 bins", "100 000 bins", "ratio");
        for (name, kernel) in METHODS {
            for samples in [1, 9] {
                let few = Setting { kernel, samples, ..base };
                let many = Setting { bins: 100_000, ..few };
                let [few, many] = best(&[few, many], 1, cpu)[..] else { return Ok(()) };
                let name = format!("{name}, {samples}");
                println!("{name:<10} {few:>8.4} {many:>14.4} {:>9.2}", many / few);
            }
        }
    }
    if wants("threads") {
        println!("\n{:<10} {:>8} {:>10} {:>9}", "threads", "1", "2", "gain");
        for (name, kernel) in METHODS {
            let setting = [Setting { kernel, photons: 100_000, samples: 4, ..base }];
            let (mut one, mut two) = (f64::INFINITY, f64::INFINITY);
            for _ in 0..5 {
                one = one.min(best(&setting, 1, wall)[0]);
                two = two.min(best(&setting, 2, wall)[0]);
            }
            println!("{name:<10} {one:>8.4} {two:>10.4} {:>9.2}", one / two);
        }
    }
    Ok(())
}

/// Measures, prints and draws the cost of each method against `counts`.
#[expect(clippy::print_stdout, reason = "a program that prints tables")]
fn scale<const N: usize>(
    what: &str,
    methods: &[(&str, Option<KernelChoice>)],
    counts: &[u64; N],
    settings: impl Fn(Option<KernelChoice>) -> [Setting; N],
) -> Result<(), Box<dyn Error>> {
    let label = format!("{what} (CPU s of a pass)");
    println!("\n{label:<28} {counts:?}, slope, steepest");
    let mut chart = Chart {
        title: format!("A pass by {what}"),
        x: Axis::logarithmic(what),
        y: Axis::logarithmic("CPU seconds"),
        series: Vec::new(),
    };
    for (name, kernel) in methods {
        let seconds = best(&settings(*kernel), 1, cpu);
        let points: Vec<(f64, f64)> =
            counts.iter().zip(&seconds).map(|(&count, &seconds)| (count as f64, seconds)).collect();
        let (slope, steepest) = slopes(&points);
        let list: Vec<String> = seconds.iter().map(|s| format!("{s:.4}")).collect();
        println!("{name:<28} {}  {slope:.2}  {steepest:.2}", list.join("  "));
        // A line of slope 1 up to the last point.
        let (x, y) = points[N - 1];
        let linear = vec![(points[0].0, y * points[0].0 / x), (x, y)];
        chart.series.push(Series::new(
            format!("{name}, slope {slope:.2}"),
            Mark::LineAndPoints,
            points,
        ));
        chart.series.push(Series::new("", Mark::Dashes, linear));
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/scaling");
    fs::create_dir_all(&folder)?;
    fs::write(folder.join(format!("{what}.svg")), chart.svg((640, 400))?)?;
    Ok(())
}

/// Slope of the logarithms by least squares, and the steepest between neighbours.
fn slopes(points: &[(f64, f64)]) -> (f64, f64) {
    let logs: Vec<(f64, f64)> = points.iter().map(|p| (p.0.ln(), p.1.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let (xy, xx) = logs
        .iter()
        .fold((0.0, 0.0), |sum, p| (sum.0 + (p.0 - x) * (p.1 - y), sum.1 + (p.0 - x) * (p.0 - x)));
    let steepest = logs.windows(2).map(|p| (p[1].1 - p[0].1) / (p[1].0 - p[0].0));
    (xy / xx, steepest.fold(f64::NEG_INFINITY, f64::max))
}

/// The best of some turns for each setting.
fn best(settings: &[Setting], threads: usize, clock: Clock) -> Vec<f64> {
    let mut best = vec![f64::INFINITY; settings.len()];
    let scenes: Vec<Scene> = settings.iter().map(scene).collect();
    for _ in 0..TURNS {
        for ((best, setting), scene) in best.iter_mut().zip(settings).zip(&scenes) {
            let work = || seconds(setting, scene, clock);
            *best = best.min(with_threads(Some(threads), work).expect("threads"));
        }
    }
    best
}

/// Seconds that some work takes.
type Clock = fn(&mut dyn FnMut()) -> f64;

fn cpu(work: &mut dyn FnMut()) -> f64 {
    let start = ProcessTime::now();
    work();
    start.elapsed().as_secs_f64()
}

fn wall(work: &mut dyn FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// Seconds of a pass, by as many as take a tenth of a second.
fn seconds(setting: &Setting, scene: &Scene, clock: Clock) -> f64 {
    let plan = Plan::new(scene, &scene.integrator);
    let method = method(setting, scene, &plan);
    let mut film: TransientFilm<1> = film_of(scene);
    let mut index = 0;
    let mut pass = |passes: u64| {
        for _ in 0..passes {
            method.pass(PassId { seed: 1, index }, &mut film);
            index += 1;
        }
    };
    let start = ProcessTime::now();
    let mut once = f64::INFINITY;
    for _ in 0..WARMING_PASSES {
        once = clock(&mut || pass(1));
        if start.elapsed().as_secs_f64() > WARMING_SECONDS {
            break;
        }
    }
    let passes = (0.1 / once).ceil().clamp(1.0, 100.0);
    clock(&mut || pass(passes as u64)) / passes
}

fn scene(setting: &Setting) -> Scene {
    let Setting { pixels, bins, .. } = *setting;
    let film = [
        ("width", pixels.to_string()),
        ("height", pixels.to_string()),
        ("temporal_bins", bins.to_string()),
        ("bin_width_opl", (WINDOW / bins as f64).to_string()),
    ];
    let changes = film.map(|(name, value)| format!("sensor.film.{name}={value}"));
    changed_scene("cornell-blocks", &changes)
}

fn method<'a>(setting: &Setting, scene: &'a Scene, plan: &'a Plan) -> Box<dyn Method<1> + 'a> {
    let samples = Some(setting.samples);
    let Some(kernel) = setting.kernel else {
        let options = PathOptions { samples_per_pass: samples.and_then(NonZeroU32::new) };
        return Box::new(PathTracer::new(scene, plan, scene.integrator, &options));
    };
    let options = BeamOptions {
        kernel: Some(kernel),
        radius: Some(0.01),
        surface_radius: Some(0.02),
        radius_exponent: Some(0.0),
        surface_radius_exponent: Some(0.0),
        photons_per_pass: Some(setting.photons),
        beam_photons: Some(setting.photons),
        gather_samples: samples,
        surface_samples: samples,
        light_samples: samples,
        ..BeamOptions::default()
    };
    Box::new(PhotonBeams::new(scene, plan, scene.integrator, &options).expect("sound options"))
}
