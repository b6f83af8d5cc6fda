//! Paths, photon segments and passes of beams per CPU second on one core, on Cornell blocks (64x64 pixels, 200 bins,
//! depth 100), in one channel and in three. The best of some turns counts.
//!
//! A *path* is one camera path: all its flights, connections to the lamp and deposits, until it ends,
//! with its share of the film's statistics. A *segment* is one flight of a photon, from its emission or
//! last event to the next, with the beam that it leaves; the emission and the surface photons are in
//! the time, too. A *pass* is one of photon beams with the defaults of the scene: photons, both maps, and
//! the gather.
//!
//! `cargo run --release -p tpb-benches --example rates [TURNS [NAME]]`: only rows whose name contains NAME.

use cpu_time::ProcessTime;
use tpb_beams::photons::PhotonTracer;
use tpb_beams::{BeamLength, BeamOptions, PhotonBeams, Sampling};
use tpb_benches::{one_thread, shipped_scene};
use tpb_path::{PathOptions, PathTracer};
use tpb_render::{FilmSetup, Method, PassId, PassReport, RenderOptions};
use tpb_scene::{Plan, Scene, Transport};

/// Passes of a turn.
const PASSES: u64 = 4;
/// Photons of a turn.
const PHOTONS: u64 = 100_000;
/// Its name, and the rate of a turn \[1/s\].
type Row = (&'static str, fn(&Scene) -> f64);

#[expect(clippy::print_stdout, reason = "a program that prints a table")]
fn main() {
    let turns = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(3);
    let name = std::env::args().nth(2).unwrap_or_default();
    let scene = &shipped_scene("cornell-blocks");
    let rows: [Row; 6] = [
        ("M paths, mono", paths::<1>),
        ("M paths, rgb", paths::<3>),
        ("M segments, mono", photons::<1>),
        ("M segments, rgb", photons::<3>),
        ("passes, mono", passes::<1>),
        ("passes, rgb", passes::<3>),
    ];
    let rows: Vec<_> = rows.into_iter().filter(|row| row.0.contains(&name)).collect();
    let mut best = vec![0.0_f64; rows.len()];
    one_thread(|| {
        for _ in 0..turns {
            for (best, (_, rate)) in best.iter_mut().zip(&rows) {
                *best = best.max(rate(scene));
            }
        }
    });
    for ((name, _), rate) in rows.iter().zip(best) {
        println!("{name:<17} {rate:>7.3} /s");
    }
}

/// Million paths per CPU second in `C` channels.
fn paths<const C: usize>(scene: &Scene) -> f64 {
    let plan = Plan::new(scene, &scene.integrator);
    let tracer = PathTracer::<C>::new(scene, &plan, scene.integrator, &PathOptions::default());
    let (seconds, reports) = timed(scene, &tracer);
    let paths: u64 = reports.iter().map(|report| report.counts.camera_paths).sum();
    paths as f64 / seconds / 1e6
}

/// Passes of photon beams per CPU second in `C` channels.
fn passes<const C: usize>(scene: &Scene) -> f64 {
    let plan = Plan::new(scene, &scene.integrator);
    let options = BeamOptions::default();
    let beams = PhotonBeams::new(scene, &plan, scene.integrator, &options).expect("sound options");
    PASSES as f64 / timed::<C>(scene, &beams).0
}

/// CPU seconds of some passes, and what they say.
fn timed<const C: usize>(scene: &Scene, method: &impl Method<C>) -> (f64, Vec<PassReport>) {
    let transport = if C == 1 { Transport::Mono } else { Transport::Rgb };
    let setup = FilmSetup::new(&scene.film, transport, &RenderOptions::default());
    let mut film = setup.expect("a sound film").film::<C>().expect("a film that fits");
    let start = ProcessTime::now();
    let passes = (0..PASSES).map(|index| method.pass(PassId { seed: 1, index }, &mut film));
    let reports = passes.collect();
    (start.elapsed().as_secs_f64(), reports)
}

/// Million photon segments per CPU second in `C` channels; each leaves one beam in this scene, whose medium
/// fills all of it.
fn photons<const C: usize>(scene: &Scene) -> f64 {
    let (plan, integrator) = (&Plan::new(scene, &scene.integrator), scene.integrator);
    let (length, sampling) = (BeamLength::Long, Sampling::default());
    let tracer = PhotonTracer { scene, plan, integrator, length, sampling };
    let start = ProcessTime::now();
    let traced = tracer.trace::<C>(PassId { seed: 1, index: 0 }, PHOTONS, PHOTONS);
    traced.beams.len() as f64 / start.elapsed().as_secs_f64() / 1e6
}
