//! A result and what its report says of it.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tpb_render::Report;
use tpb_viewer::{Estimate, Loaded, Method, PixelErrors, load};

use crate::failure::Failure;
use crate::folder;

use super::command::{command, pulse};

/// A result to show.
#[derive(Debug)]
pub(crate) struct Input {
    /// What people read.
    pub(super) label: String,
    pub(crate) loaded: Loaded,
    /// Its report, if it has one of its own.
    pub(crate) report: Option<Report>,
}

impl Input {
    /// Reads a result; a cube of another program has no report.
    pub(crate) fn read(path: &Path, label: Option<&String>) -> Result<Self, Failure> {
        let loaded = load(path)?;
        let report = folder::read_report(&folder::report_of(path)).ok();
        // The report beside an archive of ours is its own only if it tells of the same arrays.
        let report = report.filter(|report| {
            let (film, arrays) = (&report.film, &loaded.arrays);
            let ours = loaded.file.file_name().is_some_and(|name| name == "transient.npz");
            ours && (film.width, film.height, film.bins, film.channels)
                == (arrays.width, arrays.height, arrays.bins, arrays.channels)
        });
        let label = label.cloned().unwrap_or_else(|| name(path));
        Ok(Self { label, loaded, report })
    }

    /// The scene, if it is known.
    pub(super) fn scene(&self) -> Option<String> {
        let file = &self.report.as_ref()?.scene.file;
        Some(Path::new(file).file_stem()?.to_string_lossy().into_owned())
    }

    /// From how many independent batches its variance is: the passes of a render.
    fn batches(&self) -> Option<u64> {
        self.report.as_ref().map(|report| report.run.passes).or(self.loaded.batches)
    }

    /// Its arrays, for error numbers.
    pub(super) fn estimate(&self) -> Estimate<'_> {
        Estimate { arrays: &self.loaded.arrays, batches: self.batches() }
    }

    /// Whether nothing says that it shares random numbers with another result.
    pub(super) fn independent_of(&self, other: &Self) -> bool {
        let made = |input: &Self| {
            let report = input.report.as_ref()?;
            Some((report.method.name.clone(), report.options.run.seed))
        };
        made(self).is_none() || made(self) != made(other)
    }

    /// As the page shows it.
    pub(super) fn method(&self, key: &str) -> Method<'_> {
        let mut method = Method::new(key, &self.label, &self.loaded.arrays);
        method.batches = self.batches();
        method.unit_known = self.loaded.unit_known;
        let lacks = self.report.iter().flat_map(lacks);
        let remarks = self.loaded.remarks.iter().map(String::as_str).chain(lacks);
        method.caption = remarks.collect::<Vec<_>>().join("; ");
        method.provenance.push(("file".to_owned(), self.loaded.file.display().to_string()));
        if self.loaded.window_only && self.loaded.arrays.bins > 0 {
            let what = "the light of the window alone, from the bins".to_owned();
            method.provenance.push(("steady image".to_owned(), what));
        }
        if let Some(report) = &self.report {
            // Each pixel of the path tracer has paths of its own; photons are shared.
            if report.method.name == "path" {
                method.pixel_errors = PixelErrors::Independent;
            }
            method.provenance.extend(provenance(report));
            method.command = Some(command(report));
        }
        method
    }
}

/// Reads results; those of equal names are told apart by their paths. `order` says to which results
/// labels belong.
pub(super) fn read_all(
    paths: &[&PathBuf],
    labels: &[String],
    order: &str,
) -> Result<Vec<Input>, Failure> {
    if labels.len() > paths.len() {
        let message = format!("{} labels for {} results", labels.len(), paths.len());
        return Err(Failure::with_help(message, order));
    }
    let mut inputs = Vec::with_capacity(paths.len());
    for (index, path) in paths.iter().enumerate() {
        inputs.push(Input::read(path, labels.get(index))?);
    }
    let names: Vec<String> = inputs.iter().map(|input| input.label.clone()).collect();
    for (input, path) in inputs.iter_mut().zip(paths) {
        if names.iter().filter(|name| **name == input.label).count() > 1 {
            input.label = path.display().to_string();
        }
    }
    Ok(inputs)
}

/// Keys for links: labels in plain letters, told apart by a number.
pub(super) fn keys(inputs: &[Input]) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for input in inputs {
        let letters = input.label.to_lowercase();
        let words: Vec<&str> =
            letters.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let key = words.join("-");
        let taken = keys.contains(&key) || key.is_empty();
        keys.push(if taken { format!("{key}-{}", keys.len() + 1) } else { key });
    }
    keys
}

/// The name of a file or folder without what precedes it; an archive of ours is named by its folder.
pub(crate) fn name(path: &Path) -> String {
    let of = |path: &Path| path.file_stem().map(|name| name.to_string_lossy().into_owned());
    let in_folder = path.file_name().is_some_and(|name| name == "transient.npz");
    let folder = path.parent().filter(|_| in_folder).and_then(of);
    let absolute = || path.canonicalize().ok().and_then(|path| of(&path));
    folder.or_else(|| of(path)).or_else(absolute).unwrap_or_else(|| "result".to_owned())
}

/// What a report's method leaves out of the image.
fn lacks(report: &Report) -> impl Iterator<Item = &str> {
    let lacking = |warning: &&str| warning.starts_with("the image lacks ");
    report.warnings.iter().map(String::as_str).filter(lacking)
}

/// A number of seconds.
fn seconds(value: f64) -> String {
    format!("{value:.2} s")
}

/// How a result was made, by its report.
fn provenance(report: &Report) -> Vec<(String, String)> {
    let run = &report.run;
    let mut rows = vec![
        ("program", report.program.clone()),
        ("scene", report.scene.file.clone()),
        ("method", report.method.name.clone()),
        ("seed", report.options.run.seed.to_string()),
        ("passes", run.passes.to_string()),
        (
            "wall time",
            format!("{}, {} of it setup", seconds(run.wall_seconds), seconds(run.setup_seconds)),
        ),
    ];
    rows.extend(run.cpu_seconds.map(|cpu| ("CPU time", seconds(cpu))));
    let error = |error: f64| format!("{:.3} % (median relative error of a pixel)", 100.0 * error);
    rows.extend(run.relative_error.map(|value| ("error", error(value))));
    rows.push(("pulse", pulse(report.options.pulse)));
    if report.options.unwarp {
        rows.push(("times", "without the leg from the eye to the first surface".to_owned()));
    }
    rows.push(("options", options(&report.method.options)));
    rows.extend(report.warnings.iter().map(|warning| ("warning", warning.clone())));
    rows.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Members of an object as `name value`, separated by commas; numbers to four digits.
fn options(options: &Value) -> String {
    let text = |value: &Value| match (value, value.as_f64()) {
        (Value::String(word), _) => word.clone(),
        (Value::Number(number), Some(float)) if number.is_f64() => {
            let rounded: f64 = format!("{float:.3e}").parse().unwrap_or(float);
            rounded.to_string()
        }
        _ => value.to_string(),
    };
    let members = options.as_object().into_iter().flatten();
    let parts = members.map(|(name, value)| format!("{} {}", name.replace('_', " "), text(value)));
    parts.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_from_files_and_folders() {
        for (path, expected) in [
            ("results/beams", "beams"),
            ("results/beams/", "beams"),
            ("results/beams/transient.npz", "beams"),
            ("cube.npy", "cube"),
        ] {
            assert_eq!(name(Path::new(path)), expected, "{path}");
        }
        assert_ne!(name(Path::new(".")), "result", "the folder's own name");
    }
}
