//! Measures the method on cornell-blocks: where variance, bias and time come from.
//!
//! `cornell [passes=N] [seed=N] [scene=FILE (square)] [width=64] [only=beams,photons,direct] [save=FILE] [reference=FILE] [OPTIONS as JSON]`
//!
//! Prints speed, and NMSE over the pixels away from the lamp: its variance from the spread of
//! passes (times seconds: a figure that does not depend on the budget), and with a reference the
//! squared bias. Run with `RAYON_NUM_THREADS=1` for times per core.
#![expect(clippy::print_stdout, reason = "a program that prints measurements")]

#[path = "../tests/suite/scenes.rs"]
mod scenes;

use std::path::Path;
use std::time::Instant;

use tpb_beams::{BeamOptions, PhotonBeams};
use tpb_film::{FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_render::{Method, PassId, PassReport};
use tpb_scene::load::load_scene;
use tpb_scene::{Plan, Scene};

fn main() {
    let (mut passes, mut width, mut only) = (16, 64, None);
    let (mut save, mut reference, mut options) = (None, None, BeamOptions::default());
    let (mut seed, mut file) = (1, None);
    for argument in std::env::args().skip(1) {
        match argument.split_once('=') {
            Some(("passes", n)) => passes = n.parse().expect("a number of passes"),
            Some(("seed", n)) => seed = n.parse().expect("a seed"),
            Some(("scene", name)) => file = Some(name.to_owned()),
            Some(("width", n)) => width = n.parse().expect("a number of pixels"),
            Some(("only", parts)) => only = Some(parts.to_owned()),
            Some(("save", file)) => save = Some(file.to_owned()),
            Some(("reference", file)) => reference = Some(file.to_owned()),
            _ => options = serde_json::from_str(&argument).expect("options as JSON"),
        }
    }
    let scene = match &file {
        Some(file) => load_scene(Path::new(file), &[]).expect("a scene file").scene,
        None => scenes::cornell_blocks(width),
    };
    width = scene.film.width;
    let mut plan = Plan::new(&scene, &scene.integrator);
    if let Some(parts) = only {
        plan.beams = parts.contains("beams");
        plan.surface_photons = parts.contains("photons");
        plan.next_event_estimation = parts.contains("direct");
    }
    let method =
        PhotonBeams::new(&scene, &plan, scene.integrator, &options).expect("sound options");
    println!("{}", Method::<1>::options(&method));

    let time = scene.film.time.expect("a time axis");
    let axis =
        TimeAxis { start_opl: time.start_opl, bin_width_opl: time.bin_width_opl, bins: time.bins };
    let layout = Layout::new(width, width, Some(axis)).expect("a film");
    let statistics = FilmOptions { variance: true, ..Default::default() };
    let mut film = TransientFilm::<1>::new(layout, statistics).expect("a film");
    let mut report = PassReport::default();
    let (start, before) = (Instant::now(), cpu_seconds());
    for index in 0..passes {
        report.add(&method.pass(PassId { seed, index }, &mut film));
    }
    let (wall, seconds) = (start.elapsed().as_secs_f64(), cpu_seconds() - before);
    let c = report.counts;
    println!(
        "{passes} passes in {seconds:.2} CPU s ({wall:.2} s wall); per pass {:.1} ms, {} photons, {} beams, {} surface photons; \
         {:.2} M accepted pairs/s, {:.3} of tested; ledger closes to {:.1e}",
        1e3 * seconds / passes as f64,
        c.photon_paths / passes,
        c.beams / passes,
        c.surface_photons / passes,
        c.pairs_accepted as f64 / seconds * 1e-6,
        c.pairs_accepted as f64 / c.pairs_tested.max(1) as f64,
        report.ledger.closure(),
    );
    let arrays = film.develop();
    let variance = arrays.variance.as_ref().expect("variance was asked for");
    let away = away_from_lamp(&scene, width);
    let bins = arrays.bins;
    let cells = |data: &[f32]| -> Vec<f64> {
        (0..width * width)
            .filter(|&p| away[p])
            .flat_map(|p| data[p * bins..(p + 1) * bins].iter().map(|&v| f64::from(v)))
            .collect()
    };
    let (mean, variance) = (cells(&arrays.transient), cells(variance));
    let power: f64 = mean.iter().map(|m| m * m).sum();
    let variance: f64 = variance.iter().sum();
    println!(
        "sum of squares {power:.4}; variance NMSE {:.5}; times seconds {:.4}; sum {:.4}",
        variance / power,
        variance / power * seconds,
        mean.iter().sum::<f64>()
    );
    if let Some(file) = save {
        let header = [variance];
        let values = header.iter().chain(&mean).flat_map(|v| v.to_le_bytes());
        std::fs::write(file, values.collect::<Vec<u8>>()).expect("a file to write");
    }
    if let Some(file) = reference {
        let bytes = std::fs::read(file).expect("a reference");
        let values: Vec<f64> =
            bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
        let (its_variance, truth) = (values[0], &values[1..]);
        let error: f64 = mean.iter().zip(truth).map(|(x, r)| (x - r) * (x - r)).sum();
        let power: f64 = truth.iter().map(|r| r * r).sum::<f64>() - its_variance;
        println!(
            "NMSE {:.5} = variance {:.5} + of the reference {:.5} + squared bias {:.6}; sum {:.5} of its",
            error / power,
            variance / power,
            its_variance / power,
            (error - variance - its_variance) / power,
            mean.iter().sum::<f64>() / truth.iter().sum::<f64>(),
        );
    }
}

/// CPU seconds of this process so far, all threads (Linux; 100 ticks a second).
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    let after_name = stat.rsplit(')').next().expect("a process has a name");
    let ticks = |n: usize| -> f64 {
        after_name.split_whitespace().nth(n).and_then(|t| t.parse().ok()).expect("ticks")
    };
    (ticks(11) + ticks(12)) / 100.0
}

/// Pixels that do not see the lamp, nor have a neighbour that does.
fn away_from_lamp(scene: &Scene, width: usize) -> Vec<bool> {
    let sees = |x: usize, y: usize| {
        (0..64).any(|i| {
            let (a, b) = ((i % 8) as f64 / 7.0, (i / 8) as f64 / 7.0);
            let flight =
                scene.fly(&scene.eye(), scene.sensor.direction(x as f64 + a, y as f64 + b));
            flight.hit.is_some_and(|h| scene.shape(h.primitive).emitter.is_some())
        })
    };
    let lit: Vec<bool> = (0..width * width).map(|p| sees(p % width, p / width)).collect();
    let near = |p: usize, q: usize| {
        (p % width).abs_diff(q % width) <= 1 && (p / width).abs_diff(q / width) <= 1
    };
    let lit: Vec<usize> = (0..width * width).filter(|&p| lit[p]).collect();
    (0..width * width).map(|p| !lit.iter().any(|&q| near(p, q))).collect()
}
