//! Figure 2: *Cornell blocks*, path tracing and photon beams at equal time.
//!
//! Two comparisons. At picture quality (the scene's own film) the reference is rendered here, in
//! batches, and its measured noise is subtracted; numbers are as precise as its time allows, and say
//! so. At 64x64 pixels and 200 bins, the validation's scene of the same geometry is compared with
//! its shipped reference, which is far less noisy.

mod pages;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use tpb_film::Arrays;
use tpb_scene::load::LoadedScene;

use super::compare::Comparison;
use super::contest::{self, Contest, Contested, Judge};
use super::race::first_with_variance;
use super::{Options, SECONDS_PER_CELL, clear, folder, load, write_json};
use crate::error::Result;
use crate::judged::Referee;
use crate::suite::Circumstances;
use crate::watch::{Step, Watch};

/// Its name, in files and pages.
pub const NAME: &str = "cornell-blocks";
/// Time of a run of the precise comparison, as a part of the others'.
const PRECISE: f64 = 0.2;
/// Its replicates, kept until all is written.
const PRECISE_FOLDER: &str = "replicates-precise";
/// What is done, in order.
const SMALL_STEP: &str = "cornell-blocks: path and beams at equal time, at 64x64x200";
const STEP: &str = "cornell-blocks: path and beams at equal time, at picture quality; reference";
const PAGES_STEP: &str = "cornell-blocks: pictures and pages";
/// Windows of time lie between these \[m\]; the first light is seen at 3.9 m.
const WINDOWS: [f64; 9] = [3.85, 4.4, 4.9, 5.4, 6.0, 7.0, 8.5, 10.5, 14.0];

/// What is kept of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CornellResult {
    /// Commit, machine, flags, seed.
    pub circumstances: Circumstances,
    /// The command that repeats it.
    pub command: String,
    /// At picture quality.
    pub picture: Comparison,
    /// Against the shipped reference; `None` in trials.
    pub precise: Option<Comparison>,
}

/// What it takes.
///
/// # Errors
/// If the scene cannot be loaded.
pub fn steps(options: &Options) -> Result<Vec<Step>> {
    let (time, replicates) = (options.time, options.replicates);
    let mut steps = Vec::new();
    if !options.is_trial() {
        steps.push(Step::new(SMALL_STEP, contest::seconds(time.mul_f64(PRECISE), replicates)));
    }
    let reference = options.reference_time.as_secs_f64();
    steps.push(Step::new(STEP, contest::seconds(time, replicates) + reference));
    steps.push(Step::new(PAGES_STEP, options.cells(NAME)? * SECONDS_PER_CELL));
    Ok(steps)
}

/// Renders, compares, and writes `cornell-blocks/` below the output folder. Each step is told.
///
/// # Errors
/// If a scene or a kept file is broken, the folder cannot be written, or the reference is too noisy
/// to compare with.
pub fn run(options: &Options, watch: &mut Watch<'_>) -> Result<CornellResult> {
    let out = options.out.join(NAME);
    folder(&out)?;
    let precise = if options.is_trial() { None } else { Some(precise(options, &out, watch)?) };
    watch.begin(STEP)?;
    let loaded = options.load(NAME, &[])?;
    let absorbing = options.load(NAME, &["fog.albedo=0"])?;
    let reference = options.reference(&out);
    let contest = contest(options, [&loaded, &absorbing], &out);
    let contested = contest.run(watch)?;
    let result = CornellResult {
        circumstances: options.circumstances.clone(),
        command: options.command.clone(),
        picture: contested.comparison.clone(),
        precise,
    };
    write_json(&out.join("result.json"), &result)?;
    watch.begin(PAGES_STEP)?;
    let command = |index: usize| {
        let method = &contested.comparison.methods[index];
        options.render_command(NAME, method, &contested.runs[index][0])
    };
    let commands = [command(0)?, command(1)?];
    pages::write(&out, &result, &Shown { reference: &reference, contested: &contested, commands })?;
    contest.clear()?;
    clear(&out.join(PRECISE_FOLDER))?;
    watch.tell(&format!("  wrote {}", out.join("index.html").display()));
    Ok(result)
}

/// What pages are made of, beside the numbers.
struct Shown<'a> {
    reference: &'a Path,
    contested: &'a Contested,
    /// What makes the first replicate of each method again.
    commands: [String; 2],
}

impl Shown<'_> {
    /// Path, beams, reference, each with its variance.
    fn arrays(&self) -> Result<[Arrays; 3]> {
        let reference = Arrays::read_npz(self.reference)?;
        let path = first_with_variance(&self.contested.runs[0], &reference)?;
        let beams = first_with_variance(&self.contested.runs[1], &reference)?;
        Ok([path, beams, reference])
    }
}

/// At picture quality, with a reference of its own: the scene, and the same without scattering.
fn contest<'a>(
    options: &'a Options,
    [loaded, absorbing]: [&'a LoadedScene; 2],
    out: &Path,
) -> Contest<'a> {
    Contest {
        loaded,
        absorbing,
        time: options.time,
        replicates: options.replicates,
        seed: options.circumstances.seed,
        commit: &options.circumstances.commit,
        command: &options.command,
        judge: Judge::Rendered {
            referee: Referee::Path,
            path: options.reference(out),
            time: options.reference_time,
            any_commit: options.old_references,
        },
        windows: &WINDOWS,
        folder: out.join("replicates"),
    }
}

/// The same comparison at 64x64 pixels and 200 bins, against the reference that ships.
fn precise(options: &Options, out: &Path, watch: &mut Watch<'_>) -> Result<Comparison> {
    watch.begin(SMALL_STEP)?;
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let scene = data.join("scenes").join(format!("{NAME}.json"));
    let (loaded, absorbing) = (load(&scene, &[])?, load(&scene, &["fog.albedo=0".to_owned()])?);
    let contest = Contest {
        loaded: &loaded,
        absorbing: &absorbing,
        time: options.time.mul_f64(PRECISE),
        replicates: options.replicates,
        seed: options.circumstances.seed,
        commit: &options.circumstances.commit,
        command: &options.command,
        judge: Judge::Shipped(data.join("references").join(format!("{NAME}.npz"))),
        windows: &WINDOWS,
        folder: out.join(PRECISE_FOLDER),
    };
    let comparison = contest.run(watch)?.comparison;
    write_json(&out.join("precise.json"), &comparison)?;
    Ok(comparison)
}

#[cfg(test)]
pub(crate) mod tests;
