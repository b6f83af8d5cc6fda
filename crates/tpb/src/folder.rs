//! The result folder: what is in it, and how nothing else comes to harm.
//!
//! A folder may be written to if it is new, empty, or a result folder: one whose entries are all
//! names of ours, or that holds a report of ours. Everything is checked before the render starts;
//! afterwards each file is tried on its own, so that one failure does not take the others along.

use std::fmt::Display;
use std::fs;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use tpb_film::{Arrays, FilmError, PictureOptions, Quantity, atomic_write};
use tpb_render::Report;
use tpb_video::{Format, VideoError, VideoOptions, write_video};

use crate::failure::Failure;

const TRANSIENT: &str = "transient.npz";
/// While a render goes on.
const PREVIEW: &str = "preview.png";
const REPORT: &str = "report.json";
const FRAMES: &str = "frames";
const UNFINISHED: &str = ".unfinished-";

/// All files of a result; `frames` is a folder beside them.
const FILES: [&str; 8] = [
    PREVIEW,
    TRANSIENT,
    "steady.exr",
    "steady.png",
    "animation.png",
    "arrival_time.png",
    "streak.png",
    REPORT,
];

/// A folder that may be written to.
#[derive(Debug)]
pub(crate) struct ResultFolder {
    path: PathBuf,
}

/// What became of the files.
#[derive(Debug, Default)]
pub(crate) struct Written {
    /// Names of those that are there now.
    pub(crate) files: Vec<String>,
    /// Why others are not.
    pub(crate) failures: Vec<String>,
}

/// The arrays of a result, if `path` is its folder or an npz file.
pub(crate) fn arrays_of(path: &Path) -> PathBuf {
    if path.is_dir() { path.join(TRANSIENT) } else { path.to_owned() }
}

/// The report beside the arrays of a result.
pub(crate) fn report_of(path: &Path) -> PathBuf {
    if path.is_dir() { path.join(REPORT) } else { path.with_file_name(REPORT) }
}

impl ResultFolder {
    /// Makes the folder if need be, and makes sure that it may be written to.
    ///
    /// # Errors
    /// [`Failure::Input`] if something else than a result is there, or it cannot be written.
    pub(crate) fn prepare(path: &Path) -> Result<Self, Failure> {
        let failed = |what: &str, error: &io::Error| {
            let message = format!("cannot {what} the result folder {}: {error}", path.display());
            Failure::with_help(message, "name another folder with -o")
        };
        if path.exists() && !path.is_dir() {
            return Err(Failure::with_help(
                format!("{} is a file, not a folder", path.display()),
                "name another folder with -o",
            ));
        }
        fs::create_dir_all(path).map_err(|e| failed("make", &e))?;
        if !is_result(path).map_err(|e| failed("read", &e))? {
            return Err(Failure::with_help(
                format!("{} holds other files than a result of tpb", path.display()),
                "name a new or empty folder with -o; only results are replaced",
            ));
        }
        let mut trial = tempfile::Builder::new();
        trial.prefix(UNFINISHED).tempfile_in(path).map_err(|e| failed("write to", &e))?;
        Ok(Self { path: path.to_owned() })
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Where a render that goes on may show how far it is; removed when the result is written.
    pub(crate) fn preview(&self) -> PathBuf {
        self.path.join(PREVIEW)
    }

    /// Writes all files that this result has; those of an earlier one that it lacks are removed.
    pub(crate) fn write(
        &self,
        arrays: &Arrays,
        report: &Report,
        pictures: Option<&PictureOptions>,
    ) -> Written {
        let mut written = Written::default();
        let at = |name: &str| self.path.join(name);
        // Then there is no steady image.
        let window_only = report.options.window_only;
        if window_only {
            written.note(TRANSIENT, arrays.write_window_npz(&at(TRANSIENT)));
        } else {
            written.note(TRANSIENT, arrays.write_npz(&at(TRANSIENT)));
            written.note("steady.exr", arrays.write_steady_exr(&at("steady.exr")));
        }
        if let Some(options) = pictures {
            if !window_only {
                written.note("steady.png", arrays.write_steady_png(&at("steady.png"), options));
            }
            if arrays.bins > 0 {
                let animation = at("animation.png");
                written.note("animation.png", write_animation(arrays, &animation, options));
                written.note("streak.png", arrays.write_streak(&at("streak.png"), options));
                let frames = arrays.write_frames(&at(FRAMES), options);
                written.note("frames/", frames.map(drop));
                if arrays.quantity == Quantity::BinEnergy {
                    let arrival = arrays.write_arrival_time(&at("arrival_time.png"), options);
                    written.note("arrival_time.png", arrival.map(drop));
                }
            }
        }
        written.note(REPORT, write_report(&at(REPORT), report));
        self.remove_stale(&mut written);
        written
    }

    /// Removes what an earlier result left and this one does not have.
    fn remove_stale(&self, written: &mut Written) {
        if !written.failures.is_empty() {
            return;
        }
        let old = FILES.iter().filter(|name| !written.has(name)).map(|name| self.path.join(name));
        let mut stale: Vec<PathBuf> = old.collect();
        if !written.has("frames/") {
            stale.extend(frames_in(&self.path.join(FRAMES)));
        }
        for file in stale {
            match fs::remove_file(&file) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    written.failures.push(format!("cannot remove {}: {error}", file.display()));
                }
                _ => {}
            }
        }
        if !written.has("frames/") {
            // Fails if there is none, or if someone keeps other files in it: both are fine.
            let _ = fs::remove_dir(self.path.join(FRAMES));
        }
    }
}

impl Written {
    fn note<E: Display>(&mut self, name: &str, outcome: Result<(), E>) {
        match outcome {
            Ok(()) => self.files.push(name.to_owned()),
            Err(error) => self.failures.push(format!("cannot write {error}")),
        }
    }

    fn has(&self, name: &str) -> bool {
        self.files.iter().any(|file| file == name)
    }
}

fn write_report(path: &Path, report: &Report) -> Result<(), FilmError> {
    atomic_write(path, |file| {
        serde_json::to_writer_pretty(&mut *file, report)?;
        file.write_all(b"\n")
    })
}

/// All frames as one animated PNG, which plays for ever in any browser.
fn write_animation(
    arrays: &Arrays,
    path: &Path,
    options: &PictureOptions,
) -> Result<(), VideoError> {
    let options = VideoOptions { pictures: *options, ..VideoOptions::default() };
    write_video(arrays, path, Format::Apng, &options, &mut |_, _| ControlFlow::Continue(()))?;
    Ok(())
}

/// Whether nothing of anyone else is in a folder.
fn is_result(path: &Path) -> io::Result<bool> {
    let mut only_ours = true;
    for entry in fs::read_dir(path)? {
        let name = entry?.file_name();
        let name = name.to_string_lossy();
        only_ours &= FILES.contains(&&*name) || name == FRAMES || name.starts_with(UNFINISHED);
    }
    Ok(only_ours || read_report(&path.join(REPORT)).is_ok())
}

/// Reads a report of ours.
pub(crate) fn read_report(path: &Path) -> Result<Report, String> {
    let text = fs::read_to_string(path).map_err(|e| e.to_string())?;
    serde_json::from_str(&text).map_err(|e| e.to_string())
}

/// The frames in a folder; none if it cannot be read.
fn frames_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_frame = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.strip_suffix(".png").is_some_and(|stem| stem.starts_with("frame-"))
    };
    entries.filter(is_frame).collect()
}
