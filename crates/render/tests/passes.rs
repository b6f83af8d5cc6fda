//! The loop against a method whose passes are known.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tpb_film::{Arrays, Arrival, FilmOptions, Layout, Ledger, TimeAxis, TransientFilm};
use tpb_optics::{Spectrum, Stream};
use tpb_render::{
    Budget, Control, Counts, Method, PassId, PassReport, Progress, RunSettings, RunSummary,
    Stopwatch, run, with_threads,
};

/// Random energy at random times; each pass takes at least `nap`.
struct Noise {
    nap: Duration,
}

impl Method<1> for Noise {
    fn name(&self) -> &'static str {
        "noise"
    }

    fn options(&self) -> serde_json::Value {
        serde_json::Value::Null
    }

    fn pass(&self, id: PassId, film: &mut TransientFilm<1>) -> PassReport {
        std::thread::sleep(self.nap);
        let tiles = film.add_pass(|tile| {
            for pixel in tile.pixels() {
                let mut rng = Stream::new(id.seed, id.index, pixel as u64);
                let arrival = Arrival::Instant(12.0 * rng.uniform());
                tile.deposit(pixel, 0.0, &arrival, Spectrum([rng.uniform()]));
            }
            tile.pixels().count() as u64
        });
        let counts = Counts { camera_paths: tiles.iter().sum(), ..Counts::default() };
        let ledger = Ledger { emitted: 2.0, escaped: 2.0, ..Ledger::default() };
        PassReport { counts, ledger }
    }
}

const QUICK: Noise = Noise { nap: Duration::ZERO };

fn film() -> TransientFilm<1> {
    let time = TimeAxis { start_opl: 1.0, bin_width_opl: 1.0, bins: 10 };
    let layout = Layout::new(50, 40, Some(time)).unwrap();
    TransientFilm::new(layout, FilmOptions { variance: true, ..FilmOptions::default() }).unwrap()
}

fn passes(first_pass: u64, passes: u64) -> RunSettings {
    RunSettings { seed: 5, budget: Budget::Passes(passes), first_pass }
}

fn go(
    method: &Noise,
    film: &mut TransientFilm<1>,
    settings: &RunSettings,
    control: &mut dyn Control,
) -> RunSummary {
    run(method, film, settings, &Stopwatch::start(), control)
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let render = |threads| {
        let mut film = film();
        with_threads(Some(threads), || go(&QUICK, &mut film, &passes(0, 3), &mut ())).unwrap();
        film.develop()
    };
    let one = render(1);
    assert!(one == render(2) && one == render(7));
    assert!(one.steady.iter().all(|&s| s > 0.0));
}

#[test]
fn a_run_may_be_continued() {
    let mut whole = film();
    let summary = go(&QUICK, &mut whole, &passes(0, 9), &mut ());
    assert_eq!((summary.passes, summary.interrupted), (9, false));
    assert_eq!(summary.counts.camera_paths, 9 * 50 * 40);
    assert_eq!(summary.ledger.mean_of_a_pass.emitted, 2.0, "not of all passes");
    assert_eq!(summary.ledger.carrier, "light [W]");
    assert_eq!(summary.relative_error, whole.relative_error());
    let at: Vec<u64> = summary.history.iter().map(|milestone| milestone.passes).collect();
    assert_eq!(at, [2, 4, 8]);

    let mut parts = film();
    go(&QUICK, &mut parts, &passes(0, 4), &mut ());
    go(&QUICK, &mut parts, &passes(4, 5), &mut ());
    assert!(whole.develop() == parts.develop());
}

/// Remembers what it was told; interrupts after so many passes.
#[derive(Default)]
struct Watch {
    told: Vec<Progress>,
    stop_after: Option<usize>,
    steady: Vec<f64>,
}

impl Control for Watch {
    fn interrupted(&self) -> bool {
        self.stop_after.is_some_and(|passes| self.told.len() >= passes)
    }

    fn progress(&mut self, progress: &Progress, steady: &dyn Fn() -> Arrays) {
        self.told.push(*progress);
        self.steady = steady().steady;
    }
}

#[test]
fn an_interrupt_ends_the_run_after_the_pass() {
    let mut watch = Watch { stop_after: Some(2), ..Watch::default() };
    let mut seen = film();
    let summary = go(&QUICK, &mut seen, &passes(0, 100), &mut watch);
    assert_eq!((summary.passes, summary.interrupted), (2, true));
    assert!(watch.steady == seen.develop().steady && watch.steady.iter().any(|&v| v > 0.0));
    let mut already = &AtomicBool::new(false);
    already.store(true, Ordering::Relaxed);
    let summary = go(&QUICK, &mut film(), &passes(0, 100), &mut already);
    assert_eq!((summary.passes, summary.interrupted), (1, true), "always one pass");
}

#[test]
fn the_watcher_hears_of_each_pass_and_of_what_is_left() {
    let mut watch = Watch::default();
    let nap = Duration::from_millis(5);
    let summary = go(&Noise { nap }, &mut film(), &passes(0, 4), &mut watch);
    let numbers: Vec<u64> = watch.told.iter().map(|progress| progress.passes).collect();
    assert_eq!(numbers, [1, 2, 3, 4]);
    assert!(watch.told[0].remaining >= 3 * nap, "{:?}", watch.told[0]);
    assert_eq!(watch.told[3].remaining, Duration::ZERO);
    assert!(watch.told[0].relative_error.is_none() && watch.told[1].relative_error.is_some());
    assert!(summary.wall_seconds >= 0.02 && summary.cpu_seconds.is_some(), "{summary:?}");
}

#[test]
fn a_time_budget_includes_the_setup() {
    let method = Noise { nap: Duration::from_millis(10) };
    let started = Stopwatch::start();
    std::thread::sleep(Duration::from_millis(40));
    let budget = Budget::Time(Duration::from_millis(50));
    let settings = RunSettings { budget, ..RunSettings::default() };
    let mut film = film();
    let summary = run(&method, &mut film, &settings, &started, &mut ());
    assert!(summary.setup_seconds >= 0.04);
    assert!(summary.passes <= 2, "{summary:?}");
}

#[test]
fn no_time_is_still_one_pass() {
    let settings = RunSettings { budget: Budget::Time(Duration::ZERO), ..RunSettings::default() };
    assert_eq!(go(&QUICK, &mut film(), &settings, &mut ()).passes, 1);
}

#[test]
fn too_many_threads_are_an_error_or_work() {
    if let Ok(answer) = with_threads(Some(3), || 42) {
        assert_eq!(answer, 42);
    }
}
