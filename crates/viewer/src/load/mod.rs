//! Results from files: folders and archives of ours, cubes of other programs.
//!
//! | input | what is read |
//! | --- | --- |
//! | a result folder | its `transient.npz` |
//! | `.npz` of ours: `steady`, with `before` and `after` or alone | all arrays |
//! | `.npz` of others | the cube `transient`, `radiance`, or the only array of 3 or 4 dimensions; if there: `opl_edges` \[m\] or `time_edges` \[s\], `variance`, `batches` (from how many independent runs the variance is) |
//! | `.npy` | the cube |
//!
//! Cubes are (rows, columns, bins, channels) or (rows, columns, bins), of floats of 16 to 64 bits,
//! integers or truth values, of any byte order, in C or Fortran order. What a cube of others lacks is
//! made: its time axis is that of the results that it is compared with, or counts bins; its steady
//! image is the light of the window alone ([`Loaded::window_only`]).
//!
//! Cells that are negative or not finite are kept and remarked upon.

mod cube;
mod npy;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use tpb_film::{Arrays, FilmError};

use crate::ViewerError;
use crate::comparison::same_shape;

/// The arrays of a result folder.
const TRANSIENT: &str = "transient.npz";

/// First bytes of a `.npy` file.
const NPY_MAGIC: &[u8] = b"\x93NUMPY";

/// A result from a file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The file that was read.
    pub file: PathBuf,
    /// Its arrays.
    pub arrays: Arrays,
    /// Whether the file has a time axis; otherwise `opl_edges` counts bins.
    pub timed: bool,
    /// Whether the steady image is made of the bins, for want of what arrives outside the window:
    /// their sum or, of continuous emission, the radiance at the last edge.
    pub window_only: bool,
    /// Whether the unit of the cells is ours, W m⁻² sr⁻¹: no other program's is known.
    pub unit_known: bool,
    /// From how many independent batches the variance is, if the file tells.
    pub batches: Option<u64>,
    /// What the reader should know: made-up axes, negative cells, cells that are not finite.
    pub remarks: Vec<String>,
}

impl Loaded {
    fn new(file: &Path, arrays: Arrays, timed: bool) -> Self {
        let mut loaded = Self {
            file: file.to_owned(),
            arrays,
            timed,
            window_only: false,
            unit_known: true,
            batches: None,
            remarks: Vec::new(),
        };
        loaded.remark_cells();
        loaded
    }

    /// Leaves out what arrives outside the window, as results that it is compared with know none.
    fn keep_window(&mut self) {
        let steady = cube::within_window(&self.arrays);
        let outside = self.arrays.steady.iter().zip(&steady);
        let outside: f64 = outside.map(|(all, inside)| (all - inside).max(0.0)).sum();
        let all: f64 = self.arrays.steady.iter().sum();
        self.window_only = true;
        // Beyond the rounding of 32-bit cells.
        let matters = outside > 1e-6 * all;
        if !matters {
            return;
        }
        self.remarks.push(format!(
            "{:.3} % of the light arrives outside the window and is left out here, for what is \
             compared with it knows none: steady images are of the window alone",
            100.0 * outside / all
        ));
        self.arrays.steady = steady;
        self.arrays.before.fill(0.0);
        self.arrays.after.fill(0.0);
    }

    /// Whether all cells are finite and none is negative.
    pub fn is_sound(&self) -> bool {
        let cells = self.arrays.transient.iter();
        cells.chain(self.arrays.variance.iter().flatten()).all(|&c| c.is_finite() && c >= 0.0)
            && self.arrays.steady.iter().all(|s| s.is_finite() && *s >= 0.0)
    }

    fn remark_cells(&mut self) {
        let cells = &self.arrays.transient;
        let count = |odd: fn(&&f32) -> bool| cells.iter().filter(odd).count();
        let not_finite = count(|cell| !cell.is_finite());
        let negative = count(|cell| **cell < 0.0);
        let of = format!("of {} cells", cells.len());
        if not_finite > 0 {
            self.remarks.push(format!(
                "{not_finite} {of} are not finite: left out of all numbers, marked in the page"
            ));
        }
        if negative > 0 {
            self.remarks.push(format!(
                "{negative} {of} are negative: kept in all numbers, shown black in the page"
            ));
        }
    }
}

/// Reads a result.
///
/// # Errors
/// [`ViewerError::Film`] if the file cannot be read or an archive of ours is damaged,
/// [`ViewerError::Cube`] if there is no cube in it.
pub fn load(path: &Path) -> Result<Loaded, ViewerError> {
    let file = if path.is_dir() { path.join(TRANSIENT) } else { path.to_owned() };
    if starts_with(&file, NPY_MAGIC)? {
        return cube::of_npy(&file);
    }
    if !starts_with(&file, b"PK")? {
        let reason = "is neither a result of tpb nor a .npz or .npy file";
        return Err(ViewerError::cube(&file, reason));
    }
    let names = npy::names(&file)?;
    if is_ours(&file, &names)? {
        return Ok(Loaded::new(&file, Arrays::read_npz(&file)?, true));
    }
    cube::of_npz(&file, &names)
}

/// The arrays of our archives.
const OURS: [&str; 8] =
    ["transient", "radiance", "variance", "opl_edges", "time_edges", "before", "after", "steady"];

/// Whether an archive of these arrays is one of ours: it has a steady image, nothing that we do not
/// write, and either images of what arrives outside the window or, of a steady film, nothing else.
fn is_ours(file: &Path, names: &[String]) -> Result<bool, ViewerError> {
    let has = |name: &str| names.iter().any(|n| n == name);
    if !has("steady") || !names.iter().all(|name| OURS.contains(&name.as_str())) {
        return Ok(false);
    }
    if let [_] = names {
        let member = npy::member(file, "steady")?;
        return Ok(member.is_double && member.dimensions == 3);
    }
    Ok(has("before") || has("after"))
}

/// Whether a file starts with some bytes.
fn starts_with(file: &Path, magic: &[u8]) -> Result<bool, ViewerError> {
    let io = |source| ViewerError::Film(FilmError::Io { path: file.to_owned(), source });
    let mut start = Vec::new();
    File::open(file).map_err(io)?.take(magic.len() as u64).read_to_end(&mut start).map_err(io)?;
    Ok(start == magic)
}

/// Reads which pixels count, row by row: those where a (rows, columns) array is not 0; NaN is an error. The array is
/// that of a `.npy` file, or `mask` or the only one of a `.npz` file.
///
/// # Errors
/// [`ViewerError::Film`] if the file cannot be read, [`ViewerError::Cube`] if there is no such array,
/// [`ViewerError::Mismatch`] if it has not the shape of these arrays, or no pixel counts.
pub fn load_mask(path: &Path, arrays: &Arrays) -> Result<Vec<bool>, ViewerError> {
    let (shape, mask) = cube::mask(path)?;
    if shape != [arrays.height, arrays.width] {
        let [rows, columns] = shape;
        return Err(ViewerError::Mismatch(format!(
            "shapes differ: the mask {} has ({rows}, {columns}), the results ({}, {}) (rows, columns)",
            path.display(),
            arrays.height,
            arrays.width
        )));
    }
    if !mask.contains(&true) {
        return Err(ViewerError::cube(path, "is 0 everywhere: no pixel counts"));
    }
    Ok(mask)
}

/// Gives results without a time axis that of the first that has one, leaves out what arrives outside
/// the window where others know none, and checks that all agree.
/// Returns whether the time axis is known; otherwise `opl_edges` counts bins everywhere.
///
/// # Errors
/// [`ViewerError::Mismatch`], which names two files and what differs.
pub fn bring_together(results: &mut [&mut Loaded]) -> Result<bool, ViewerError> {
    let axis = results.iter().find(|r| r.timed && r.arrays.bins > 0);
    let axis = axis.map(|r| (r.arrays.opl_edges.clone(), r.file.display().to_string()));
    for result in results.iter_mut().filter(|result| !result.timed) {
        match &axis {
            Some((edges, from)) if edges.len() == result.arrays.bins + 1 => {
                result.arrays.opl_edges.clone_from(edges);
                result.remarks.push(format!("no time axis: that of {from} is used"));
            }
            Some(_) => {}
            None => result.remarks.push("no time axis: times are numbers of bins".to_owned()),
        }
    }
    if let Some((first, others)) = results.split_first() {
        let named = |result: &Loaded| result.file.display().to_string();
        for other in others {
            same_shape((&named(first), &first.arrays), (&named(other), &other.arrays))?;
        }
    }
    if results.iter().any(|result| result.window_only) {
        let whole = results.iter_mut().filter(|result| !result.window_only);
        whole.filter(|result| result.arrays.bins > 0).for_each(|result| result.keep_window());
    }
    Ok(results.iter().any(|result| result.timed))
}

#[cfg(test)]
mod tests;
