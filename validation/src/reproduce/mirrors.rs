//! Figure 3: *Mirrors*, delta and continuous emission from one render, and what can be checked of it.
//!
//! * One beams render of the point-lamp room gives the delta sequence; continuous emission is its
//!   running sum. Captions name what geometry says arrives in a frame ([`room`]), and what is seen in it
//!   (`seen`).
//! * The delay behind the glass ball, against its exact optical path length ([`delay`]).
//! * Caustics: path tracing, light tracing and progressive beams on the twin with a tiny area lamp,
//!   region by region, and through a narrow camera; and what path tracing misses of the point lamp
//!   ([`caustics`]).
//! * Path tracing and beams at equal time on the twin.

pub mod caustics;
mod close_up;
pub mod delay;
mod pages;
pub mod room;
mod seen;

use std::path::Path;

use serde::{Deserialize, Serialize};
use tpb_beams::BeamOptions;
use tpb_film::{Arrays, Quantity, TimeAxis};
use tpb_scene::load::LoadedScene;

use super::compare::Comparison;
use super::contest::{self, Contest, Judge};
use super::race::{Race, Spent};
use super::{Options, SECONDS_PER_CELL, clear, folder, write_json};
use crate::error::{Result, ValidationError};
use crate::judged::Referee;
use crate::measure::{Estimator, layout};
use crate::suite::Circumstances;
use crate::watch::{Step, Watch};
use caustics::{Caustics, CausticsPlan};
use close_up::CloseUp;
use delay::Delay;
use room::{Event, Room};

/// Its name, in files and pages.
pub const NAME: &str = "mirrors";
/// The twin with a tiny area lamp.
pub const TWIN: &str = "mirrors-area";
/// Times of the sequence, of a run at equal time, and of its reference, as parts of a run's time at
/// picture quality.
const SEQUENCE: f64 = 3.0;
const RACE: f64 = 0.2;
const REFERENCE: f64 = 3.0;
/// Likewise of the renders of a caustic comparison: path, light, and beams, who render twice. Of the
/// whole room path tracing resolves little, however long; close up it limits the bounds, and beams do next.
const CAUSTICS: [f64; 3] = [0.25, 0.75, 0.75];
const CAUSTICS_CLOSE: [f64; 3] = [1.0, 0.25, 0.75];
const CAUSTICS_POINT: [f64; 3] = [0.25, 0.5, 0.5];
/// Narrow cameras.
const CLOSE_UPS: f64 = 2.0;
/// What is done, in order, and about how long the delay takes \[s\].
const DELAY_STEP: (&str, f64) = ("mirrors: the delay behind the ball", 5.0);
const TWIN_STEP: &str = "mirrors-area: caustics by three methods";
const CLOSE_STEP: &str = "mirrors-area: the caustics close up, by three methods";
const POINT_STEP: &str = "mirrors: caustics of the point lamp";
const RACE_STEP: &str = "mirrors-area: path and beams at equal time; reference by light tracing";
const SEQUENCE_STEP: &str = "mirrors: the sequence, by photon beams";
const PAGES_STEP: &str = "mirrors: pictures and pages";
/// Film of the comparisons: pixels on a side, bins over the scene's window.
const SMALL: (usize, usize) = (64, 160);
/// Renders that are kept until all is written.
const CAUSTICS_FOLDER: &str = "caustics";
const RACE_FOLDER: &str = "replicates-area";
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
    /// Caustics of the twin through a narrow camera.
    #[serde(default)]
    pub close: Vec<Caustics>,
    /// Caustics of the point lamp.
    pub point: Caustics,
    /// Path and beams at equal time on the twin.
    pub equal_time: Comparison,
}

/// What it takes.
///
/// # Errors
/// If the scene cannot be loaded.
pub fn steps(options: &Options) -> Result<Vec<Step>> {
    let time = options.time.as_secs_f64();
    let race = contest::seconds(options.time.mul_f64(RACE), options.replicates);
    Ok(vec![
        Step::new(DELAY_STEP.0, DELAY_STEP.1),
        Step::new(TWIN_STEP, caustic_renders(CAUSTICS) * time),
        Step::new(CLOSE_STEP, CLOSE_UPS * caustic_renders(CAUSTICS_CLOSE) * time),
        Step::new(POINT_STEP, caustic_renders(CAUSTICS_POINT) * time),
        Step::new(RACE_STEP, race + REFERENCE * time),
        Step::new(SEQUENCE_STEP, SEQUENCE * time),
        Step::new(PAGES_STEP, options.cells(NAME)? * SECONDS_PER_CELL),
    ])
}

/// Parts of time of the four renders of a caustic comparison.
fn caustic_renders([path, light, beams]: [f64; 3]) -> f64 {
    path + light + 2.0 * beams
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
    watch.begin(DELAY_STEP.0)?;
    let delays = delay::measure(options, &room, watch)?;
    write_json(&out.join("delay.json"), &delays)?;
    watch.begin(TWIN_STEP)?;
    let small = small(options);
    let (twin, arrays) = caustics(&small, TWIN, &room, CAUSTICS, None, watch)?;
    write_json(&out.join("caustics-area.json"), &twin)?;
    let about_caustics = pages::caustics_viewer(&out, &small, &twin, &arrays)?;
    drop(arrays);
    watch.begin(CLOSE_STEP)?;
    let narrow = narrow(&small);
    let mut close = Vec::new();
    for close_up in CloseUp::all(&room) {
        close.push(caustics(&narrow, TWIN, &room, CAUSTICS_CLOSE, Some(&close_up), watch)?.0);
    }
    write_json(&out.join("caustics-close.json"), &close)?;
    watch.begin(POINT_STEP)?;
    let (point, _) = caustics(&small, NAME, &room, CAUSTICS_POINT, None, watch)?;
    write_json(&out.join("caustics-point.json"), &point)?;
    watch.begin(RACE_STEP)?;
    let equal_time = equal_time(&small, &out, watch)?;
    write_json(&out.join("equal-time.json"), &equal_time)?;
    watch.begin(SEQUENCE_STEP)?;
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
        close,
        point,
        equal_time,
    };
    write_json(&out.join("result.json"), &result)?;
    watch.begin(PAGES_STEP)?;
    let made = pages::MadeBy {
        run: replicate,
        command: options.render_command(NAME, methods[0].name(), replicate)?,
    };
    pages::write(&out, &result, arrays, &made, &about_caustics)?;
    race.clear()?;
    for kept in [CAUSTICS_FOLDER, RACE_FOLDER] {
        clear(&out.join(kept))?;
    }
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

/// The same with the film of close-ups.
fn narrow(small: &Options) -> Options {
    let pixels = small.pixels.map_or(close_up::PIXELS, |pixels| pixels.min(close_up::PIXELS));
    Options { pixels: Some(pixels), ..small.clone() }
}

fn caustics(
    options: &Options,
    scene: &str,
    room: &Room,
    parts: [f64; 3],
    close_up: Option<&CloseUp>,
    watch: &mut Watch<'_>,
) -> Result<(Caustics, Vec<Arrays>)> {
    let changes = close_up.map(|close_up| close_up.changes(room.eye));
    let changes: Vec<&str> = changes.iter().flatten().map(String::as_str).collect();
    let loaded = options.load(scene, &changes)?;
    let plan = CausticsPlan {
        name: scene,
        loaded: &loaded,
        room,
        times: parts.map(|part| options.time.mul_f64(part)),
        seed: options.circumstances.seed,
        commit: &options.circumstances.commit,
        folder: &options.out.join(NAME).join(CAUSTICS_FOLDER),
        close_up,
    };
    plan.run(watch)
}

fn equal_time(options: &Options, out: &Path, watch: &mut Watch<'_>) -> Result<Comparison> {
    let (loaded, absorbing) = (options.load(TWIN, &[])?, options.load(TWIN, &["fog.albedo=0"])?);
    let contest = Contest {
        loaded: &loaded,
        absorbing: &absorbing,
        time: options.time.mul_f64(RACE),
        replicates: options.replicates,
        seed: options.circumstances.seed,
        commit: &options.circumstances.commit,
        command: &options.command,
        judge: Judge::Rendered {
            referee: Referee::Light,
            path: options.reference(out),
            time: options.time.mul_f64(REFERENCE),
            any_commit: options.old_references,
        },
        windows: &WINDOWS,
        folder: out.join(RACE_FOLDER),
    };
    Ok(contest.run(watch)?.comparison)
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
