//! Figure 3: *Mirrors*, delta and continuous emission from one render, and what can be checked of it.
//!
//! * One beams render of the point-lamp room gives the delta sequence; continuous emission is its
//!   running sum. Captions name what geometry says arrives in a frame ([`room`]).
//! * The delay behind the glass ball, against its exact optical path length ([`delay`]).
//! * Caustics: path tracing, light tracing and progressive beams on the twin with a tiny area lamp,
//!   region by region; and what path tracing misses of the point lamp ([`caustics`]).
//! * Path tracing and beams at equal time on the twin.

pub mod caustics;
pub mod delay;
mod pages;
pub mod room;

use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tpb_beams::BeamOptions;
use tpb_film::{Arrays, Quantity, TimeAxis};
use tpb_scene::load::LoadedScene;

use super::compare::Comparison;
use super::contest::{Contest, Judge};
use super::race::{Race, Spent};
use super::{Options, folder, write_json};
use crate::error::{Result, ValidationError};
use crate::measure::{Estimator, layout};
use crate::suite::Circumstances;
use crate::watch::Watch;
use caustics::{Caustics, CausticsPlan};
use delay::Delay;
use room::{Event, Room};

/// Its name, in files and pages.
pub const NAME: &str = "mirrors";
/// The twin with a tiny area lamp.
pub const TWIN: &str = "mirrors-area";
/// Times of the sequence, of a caustic comparison of the twin and of the point lamp for each method,
/// of a run at equal time, and of its reference, as parts of a run's time at picture quality.
const SEQUENCE: f64 = 3.0;
const CAUSTICS: f64 = 1.0;
const CAUSTICS_POINT: f64 = 0.5;
const RACE: f64 = 0.2;
const REFERENCE: f64 = 3.0;
/// Film of the comparisons: pixels on a side, bins over the scene's window.
const SMALL: (usize, usize) = (64, 160);
/// Windows of time lie between these \[m\].
const WINDOWS: [f64; 8] = [3.9, 4.5, 5.0, 5.5, 6.0, 6.5, 7.5, 10.0];

/// What is kept of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MirrorsResult {
    /// Commit, machine, flags, seed.
    pub circumstances: Circumstances,
    /// The command that repeats it.
    pub command: String,
    /// What was spent on the sequence.
    pub sequence: Spent,
    /// What geometry says happens when, and what the render has there.
    pub events: Vec<Event>,
    /// Delay behind the ball, by each method.
    pub delays: Vec<Delay>,
    /// Caustics of the twin.
    pub twin: Caustics,
    /// Caustics of the point lamp.
    pub point: Caustics,
    /// Path and beams at equal time on the twin.
    pub equal_time: Comparison,
}

/// Renders, measures, and writes `mirrors/` below the output folder. Each step is told.
///
/// # Errors
/// If a scene or a kept file is broken, the folder cannot be written, or something cannot be
/// measured.
pub fn run(options: &Options, watch: &mut Watch<'_>) -> Result<MirrorsResult> {
    let out = options.out.join(NAME);
    folder(&out)?;
    let loaded = options.load(NAME, &[])?;
    let room = Room::of(&loaded)?;
    watch.tell(&format!("{NAME}: the delay behind the ball"));
    let delays = delay::measure(options, &room, watch)?;
    write_json(&out.join("delay.json"), &delays)?;
    watch.tell(&format!("{NAME}: caustics of {TWIN} by three methods"));
    let small = small(options);
    let (twin, arrays) = caustics(&small, TWIN, &room, CAUSTICS, watch)?;
    write_json(&out.join("caustics-area.json"), &twin)?;
    pages::caustics_viewer(&out, &small, &twin, &arrays)?;
    drop(arrays);
    watch.tell(&format!("{NAME}: caustics of the point lamp"));
    let (point, _) = caustics(&small, NAME, &room, CAUSTICS_POINT, watch)?;
    write_json(&out.join("caustics-point.json"), &point)?;
    let equal_time = equal_time(&small, &out, watch)?;
    write_json(&out.join("equal-time.json"), &equal_time)?;
    watch.tell(&format!("{NAME}: the sequence, by photon beams"));
    let methods = [Estimator::Beams(BeamOptions::default())];
    let race = sequence(options, &loaded, &methods, &out);
    let found = race.run(watch)?;
    let replicate = &found[0][0];
    let arrays = replicate.arrays(&blank(&loaded)?)?;
    let result = MirrorsResult {
        circumstances: options.circumstances.clone(),
        command: options.command.clone(),
        sequence: replicate.spent[0],
        events: room.events(&loaded.scene, &arrays),
        delays,
        twin,
        point,
        equal_time,
    };
    write_json(&out.join("result.json"), &result)?;
    watch.tell("  pictures and pages");
    pages::write(&out, &result, arrays)?;
    race.clear()?;
    watch.tell(&format!("  wrote {}", out.join("index.html").display()));
    Ok(result)
}

fn sequence<'a>(
    options: &'a Options,
    loaded: &'a LoadedScene,
    methods: &'a [Estimator],
    out: &Path,
) -> Race<'a> {
    Race {
        loaded,
        methods,
        times: vec![options.time.mul_f64(SEQUENCE)],
        replicates: 1,
        seed: options.circumstances.seed,
        commit: &options.circumstances.commit,
        folder: out.join("replicates"),
    }
}

/// The options with the film of the comparisons, unless a trial's is smaller still.
fn small(options: &Options) -> Options {
    let (pixels, bins) = SMALL;
    Options {
        pixels: Some(options.pixels.unwrap_or(pixels)),
        bins: Some(options.bins.unwrap_or(bins)),
        ..options.clone()
    }
}

fn caustics(
    options: &Options,
    scene: &str,
    room: &Room,
    part: f64,
    watch: &mut Watch<'_>,
) -> Result<(Caustics, Vec<Arrays>)> {
    let loaded = options.load(scene, &[])?;
    let time: Duration = options.time.mul_f64(part);
    let plan =
        CausticsPlan { name: scene, loaded: &loaded, room, time, seed: options.circumstances.seed };
    plan.run(watch)
}

fn equal_time(options: &Options, out: &Path, watch: &mut Watch<'_>) -> Result<Comparison> {
    watch.tell(&format!("{TWIN}: path and beams at equal time"));
    let (loaded, absorbing) = (options.load(TWIN, &[])?, options.load(TWIN, &["fog.albedo=0"])?);
    let contest = Contest {
        loaded: &loaded,
        absorbing: &absorbing,
        time: options.time.mul_f64(RACE),
        replicates: options.replicates,
        seed: options.circumstances.seed,
        commit: &options.circumstances.commit,
        judge: Judge::Rendered {
            path: options.reference(out),
            time: options.time.mul_f64(REFERENCE),
        },
        windows: &WINDOWS,
        folder: out.join("replicates-area"),
    };
    let comparison = contest.run(watch)?.comparison;
    contest.clear()?;
    Ok(comparison)
}

/// Empty arrays with the shape and the edges of a scene's film.
fn blank(loaded: &LoadedScene) -> Result<Arrays> {
    let layout = layout(&loaded.scene.film, 0.0)?;
    let edges = layout.time.as_ref().map(TimeAxis::edges);
    let opl_edges = edges
        .ok_or_else(|| ValidationError::unusable(NAME, "the scene's film has no time bins"))?;
    Ok(Arrays {
        width: layout.width,
        height: layout.height,
        bins: layout.bins(),
        channels: 3,
        quantity: Quantity::BinEnergy,
        opl_edges,
        transient: Vec::new(),
        variance: None,
        before: Vec::new(),
        after: Vec::new(),
        steady: Vec::new(),
    })
}

#[cfg(test)]
mod tests;
