//! The source's evidence made again: its two scenes, its figures, and what it lacks.
//!
//! * [`cornell`]: figure 2. Path tracing and photon beams at equal time, with a reference, error
//!   curves, maps, and numbers with intervals.
//! * [`mirrors`]: figure 3. Delta and continuous emission from one render, the delay behind the glass
//!   ball against its exact optical path length, and caustics by three methods.
//!
//! Everything that takes long is kept as it comes: references for later runs of the same commit,
//! replicates until what they tell is written. An interrupted run goes on where it was. Trials, with a
//! smaller film or less time, have folders of their own ([`Options::apart`]).
//!
//! | module | subject |
//! | --- | --- |
//! | [`truth`] | the long render ([`crate::long_render`]) and its own noise, as errors need it |
//! | [`race`], [`halves`] | renders at equal time, and how they are kept |
//! | [`contest`], [`judge`], [`compare`] | errors, their parts, their ratios |
//! | [`maps`], [`charts`], [`picture`], [`colour`], [`page`] | what is looked at |
//! | [`session`] | a run over all figures, which may be interrupted |
//! | [`summary`], [`losses`] | the pages over all scenes, the tables of who wins where, and why |

pub mod charts;
pub mod colour;
pub mod compare;
pub mod contest;
pub mod cornell;
pub mod halves;
pub mod judge;
pub mod losses;
pub mod maps;
pub mod mirrors;
pub mod page;
pub mod picture;
pub mod race;
mod report;
pub mod session;
pub mod summary;
mod tables;
#[cfg(test)]
pub(crate) mod testing;
pub mod truth;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Serialize;
use tpb_film::atomic_write;
use tpb_optics::opl::seconds_from_opl;
use tpb_scene::load::{LoadedScene, Override, load_scene};

use self::race::Replicate;
use crate::error::{Result, ValidationError};
use crate::suite::Circumstances;

/// Time of a run, below which it is a trial.
pub const FULL_TIME: Duration = Duration::from_secs(40);

/// What a reproduction is told.
#[derive(Clone, Debug)]
pub struct Options {
    /// Wall time of one render of an equal-time comparison; everything else goes with it.
    pub time: Duration,
    /// Wall time of a reference.
    pub reference_time: Duration,
    /// Replicates of each method, at least 3.
    pub replicates: u64,
    /// Whether references that sources of other commits made are used, and said to be.
    pub old_references: bool,
    /// Pixels along an edge of the film, if not the scene's own: for trials.
    pub pixels: Option<usize>,
    /// Time bins over the scene's window, likewise.
    pub bins: Option<usize>,
    /// Folder of the scenes.
    pub scenes: PathBuf,
    /// Folder of everything that is written.
    pub out: PathBuf,
    /// Commit, machine, flags, seed.
    pub circumstances: Circumstances,
    /// The command that repeats it.
    pub command: String,
}

impl Options {
    /// Whether the film is not the scene's own.
    pub fn is_trial(&self) -> bool {
        self.pixels.is_some() || self.bins.is_some()
    }

    /// What makes it a trial: a film that is not the scene's own, or less than [`FULL_TIME`]; a name
    /// for a folder. `None` if it is none.
    pub fn trial(&self) -> Option<String> {
        let time = (self.time < FULL_TIME).then(|| format!("{}s", self.time.as_secs_f64()));
        let parts = [
            self.pixels.map(|pixels| format!("{pixels}px")),
            self.bins.map(|bins| format!("{bins}bins")),
            time,
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join("-"))
    }

    /// The same with a folder of its own for a trial, `trials/NAME` below the output folder: it never
    /// takes the place of a run in full.
    #[must_use]
    pub fn apart(self) -> Self {
        let out = self.trial().map(|name| self.out.join("trials").join(name));
        Self { out: out.unwrap_or_else(|| self.out.clone()), ..self }
    }

    /// A scene with the film of these options and further changes (`path=value`).
    pub fn load(&self, name: &str, changes: &[&str]) -> Result<LoadedScene> {
        let path = self.scenes.join(format!("{name}.json"));
        load(&path, &self.changes(&path, changes)?)
    }

    /// The command that makes one run of a scene again, bit for bit: with its passes, not its time.
    /// Races use default options, and so does it. To be given in the repository's folder.
    pub(crate) fn render_command(
        &self,
        scene: &str,
        method: &str,
        run: &Replicate,
    ) -> Result<String> {
        let path = self.scenes.join(format!("{scene}.json"));
        let passes = run.spent.last().map_or(0, |spent| spent.passes);
        let seed = run.seed;
        let mut words = vec![format!(
            "tpb render scenes/{scene}.json --method {method} --passes {passes} --seed {seed}"
        )];
        words.extend(self.changes(&path, &[])?.into_iter().map(|change| format!("--set {change}")));
        Ok(words.join(" "))
    }

    /// Cells of a scene's film.
    pub(crate) fn cells(&self, name: &str) -> Result<f64> {
        let film = self.load(name, &[])?.scene.film;
        Ok((film.width * film.height * film.time.map_or(0, |time| time.bins)) as f64)
    }

    /// The file of a scene's reference in its folder; trials have others.
    pub(crate) fn reference(&self, folder: &Path) -> PathBuf {
        let size = |n: Option<usize>| n.map_or(String::new(), |n| format!("-{n}"));
        folder.join(format!("reference{}{}.npz", size(self.pixels), size(self.bins)))
    }

    fn changes(&self, path: &Path, changes: &[&str]) -> Result<Vec<String>> {
        let mut all: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
        if let Some(pixels) = self.pixels {
            all.extend(["width", "height"].map(|side| format!("sensor.film.{side}={pixels}")));
        }
        if let Some(bins) = self.bins {
            let film = load(path, &[])?.scene.film;
            let time = film.time.ok_or_else(|| no_time(path))?;
            let width = time.bin_width_opl * time.bins as f64 / bins as f64;
            all.push(format!("sensor.film.temporal_bins={bins}"));
            all.push(format!("sensor.film.bin_width_opl={width}"));
        }
        Ok(all)
    }
}

/// Wall time to judge, draw and pack a comparison, for each cell of its film \[s\]; measured on two
/// cores.
pub(crate) const SECONDS_PER_CELL: f64 = 4e-6;

/// A scene file with changes.
pub(crate) fn load(path: &Path, changes: &[String]) -> Result<LoadedScene> {
    let unusable = |error| ValidationError::unusable(path.display().to_string(), error);
    let overrides: std::result::Result<Vec<_>, _> =
        changes.iter().map(|change| Override::parse(change)).collect();
    load_scene(path, &overrides.map_err(unusable)?).map_err(unusable)
}

fn no_time(path: &Path) -> ValidationError {
    ValidationError::unusable(path.display().to_string(), "its film has no time axis")
}

/// Writes a value as JSON, whole or not at all.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| ValidationError::unusable(path.display().to_string(), error))?;
    Ok(atomic_write(path, |file| std::io::Write::write_all(file, (text + "\n").as_bytes()))?)
}

/// Writes text, whole or not at all.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<()> {
    Ok(atomic_write(path, |file| std::io::Write::write_all(file, text.as_bytes()))?)
}

/// Makes a folder and sees that it can be written: better now than after the renders.
pub(crate) fn folder(path: &Path) -> Result<()> {
    fs::create_dir_all(path).map_err(|error| ValidationError::io(path, error))?;
    crate::suite::probe(path)
}

/// Removes a folder of renders that are not wanted any more, if it is there.
pub(crate) fn clear(path: &Path) -> Result<()> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(ValidationError::io(path, error))
        }
        _ => Ok(()),
    }
}

/// What names a frame: its bin, and a time of it as OPL and in ns, with decimals enough to tell
/// neighbours apart. The time is the middle of the bin, as in viewers and videos; with `at_end` its
/// upper edge, as for radiance of continuous emission.
pub(crate) fn frame_name(edges: &[f64], bin: usize, at_end: bool) -> String {
    let (low, high) = (edges[bin], edges[bin + 1]);
    let opl = if at_end { high } else { 0.5 * (low + high) };
    let nanoseconds = |opl: f64| 1e9 * seconds_from_opl(opl);
    let decimals = |width: f64| (1.0 - width.log10().floor()).clamp(0.0, 9.0) as usize;
    let (metres, time) = (decimals(high - low), decimals(nanoseconds(high - low)));
    let end = if at_end { ", at its end" } else { "" };
    format!("bin {bin}{end}: {opl:.metres$} m, {:.time$} ns", nanoseconds(opl))
}

/// The bin that holds an OPL; the nearest one if none does.
pub(crate) fn bin_of(edges: &[f64], opl: f64) -> usize {
    let above = edges.partition_point(|&edge| edge <= opl + 1e-9);
    above.saturating_sub(1).min(edges.len().saturating_sub(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression: pages named a frame by its lower edge, viewers and videos by its middle.
    #[test]
    fn frames_are_named_by_the_middle_of_their_bin() {
        let edges: Vec<f64> = (0..5).map(|edge| 4.0 + 0.02 * f64::from(edge)).collect();
        assert_eq!(frame_name(&edges, 1, false), "bin 1: 4.030 m, 13.443 ns");
        assert_eq!(frame_name(&edges, 1, true), "bin 1, at its end: 4.040 m, 13.476 ns");
        assert_eq!(frame_name(&[0.0, 1.0], 0, false), "bin 0: 0.5 m, 1.7 ns");
    }

    #[test]
    fn trials_have_folders_of_their_own() {
        let options = cornell::tests::trial("apart");
        let out = options.out.clone();
        let full = Options { time: FULL_TIME, pixels: None, bins: None, ..options.clone() };
        assert_eq!((full.trial(), full.apart().out), (None, out.clone()));
        let film = Options { time: FULL_TIME, bins: None, ..options.clone() };
        assert_eq!(film.clone().apart().out, out.join("trials/12px"));
        let short = Options { time: Duration::from_secs(2), pixels: None, ..film };
        assert_eq!(short.clone().apart().out, out.join("trials/2s"));
        assert_eq!(options.apart().out, out.join("trials/12px-20bins-0.02s"));
    }
}
