//! One part of the renderers by itself, on one thread: what `cargo xtask bench` times and counts.
//!
//! `cargo run --release -p tpb-benches --example kernels -- KERNEL PASSES [SEED]`
//!
//! Prints one line of JSON: the set-up's and the passes' CPU seconds, their wall seconds, the vector
//! instructions that were used, and how much of what was done (`unit`).

use std::num::NonZeroU32;
use std::time::Instant;

use cpu_time::ProcessTime;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_beams::photons::PhotonTracer;
use tpb_beams::{BeamLength, Sampling};
use tpb_benches::gathers::Gathers;
use tpb_benches::{film_of, one_thread, shipped_scene};
use tpb_lanes::Instructions;
use tpb_path::{PathOptions, PathTracer};
use tpb_render::{Method, PassId};
use tpb_scene::Plan;

/// Photons of a pass of `photons`, and of the beams that the gathers gather.
const PHOTONS: u64 = 4_000;
/// Radius of beams \[m\].
const RADIUS: f64 = 0.005;

#[expect(clippy::print_stdout, reason = "a program that prints its result")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kernel, passes, rest @ ..] = &arguments[..] else {
        return Err("usage: kernels KERNEL PASSES [SEED]".into());
    };
    let passes: u64 = passes.parse()?;
    let seed: u64 = rest.first().map_or(Ok(1), |seed| seed.parse())?;
    let started = ProcessTime::now();
    let (unit, pass) = kernel_of(kernel, seed)?;
    let setup = started.elapsed().as_secs_f64();
    let (started, wall) = (ProcessTime::now(), Instant::now());
    let work: u64 = one_thread(|| (0..passes).map(pass).sum());
    let (cpu, wall) = (started.elapsed().as_secs_f64(), wall.elapsed().as_secs_f64());
    let instructions = Instructions::widest();
    println!(
        r#"{{"setup_seconds":{setup},"cpu_seconds":{cpu},"wall_seconds":{wall},"instructions":"{instructions}","unit":"{unit}","work":{work}}}"#
    );
    Ok(())
}

/// Makes a pass, given its index, and says how much it did.
type Pass = Box<dyn FnMut(u64) -> u64 + Send>;

/// A kernel by its name: what it does, counted in which unit.
fn kernel_of(name: &str, seed: u64) -> Result<(&'static str, Pass), String> {
    let (one, two) = (Kernel1d { radius: RADIUS }, Kernel2d { radius: RADIUS });
    let gathers = || Gathers::new(PHOTONS);
    Ok(match name {
        "photons" => ("segments", photons(seed)),
        "paths" => ("paths", paths(seed)),
        "gather-1d" => {
            let mut gathers = gathers();
            ("pairs", Box::new(move |_| gathers.drawn(one)))
        }
        "gather-2d" => {
            let mut gathers = gathers();
            ("pairs", Box::new(move |_| gathers.drawn(two)))
        }
        "gather-turned" => {
            let gathers = gathers();
            ("pairs", Box::new(move |_| gathers.bundled(one)))
        }
        _ => return Err(format!("no kernel '{name}'")),
    })
}

/// Photons of cornell-blocks, whose fog fills all of it: one segment leaves one beam.
fn photons(seed: u64) -> Pass {
    let scene = shipped_scene("cornell-blocks");
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    Box::new(move |index| {
        let length = BeamLength::Long;
        let (scene, plan, sampling) = (&scene, &plan, Sampling::default());
        let tracer = PhotonTracer { scene, plan, integrator, length, sampling };
        tracer.trace::<1>(PassId { seed, index }, PHOTONS, PHOTONS).beams.len() as u64
    })
}

/// Camera paths of cornell-blocks, one for a pixel.
fn paths(seed: u64) -> Pass {
    let scene = shipped_scene("cornell-blocks");
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    let mut film = film_of(&scene);
    let options = PathOptions { samples_per_pass: Some(NonZeroU32::MIN) };
    Box::new(move |index| {
        let tracer = PathTracer::<1>::new(&scene, &plan, integrator, &options);
        tracer.pass(PassId { seed, index }, &mut film).counts.camera_paths
    })
}
