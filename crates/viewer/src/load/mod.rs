//! Results from files: folders and archives of ours, cubes of other programs.
//!
//! | input | what is read |
//! | --- | --- |
//! | a result folder | its `transient.npz` |
//! | `.npz` of ours | all arrays |
//! | `.npz` of others | the cube `transient`, `radiance`, or the only array of 3 or 4 dimensions; if there: `opl_edges` \[m\] or `time_edges` \[s\], `variance` |
//! | `.npy` | the cube |
//!
//! Cubes are (rows, columns, bins, channels) or (rows, columns, bins), float32 or float64, of any
//! byte order, in C or Fortran order. What a cube of others lacks is made: the steady image is the
//! sum of the bins, nothing lies outside the window; its time axis is that of the results that it
//! is compared with, or counts bins.
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
    /// What the reader should know: made-up axes, negative cells, cells that are not finite.
    pub remarks: Vec<String>,
}

impl Loaded {
    fn new(file: &Path, arrays: Arrays, timed: bool) -> Self {
        let mut loaded = Self { file: file.to_owned(), arrays, timed, remarks: Vec::new() };
        loaded.remark_cells();
        loaded
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
    let io = |source| ViewerError::Film(FilmError::Io { path: file.clone(), source });
    let mut start = Vec::new();
    File::open(&file).map_err(io)?.take(8).read_to_end(&mut start).map_err(io)?;
    if start.starts_with(NPY_MAGIC) {
        return cube::of_npy(&file);
    }
    if !start.starts_with(b"PK") {
        let reason = "is neither a result of tpb nor a .npz or .npy file";
        return Err(ViewerError::cube(&file, reason));
    }
    let names = npy::names(&file)?;
    let has = |name: &str| names.iter().any(|n| n == name);
    let ours = has("steady") && (!has("transient") && !has("radiance") || has("before"));
    if ours {
        return Ok(Loaded::new(&file, Arrays::read_npz(&file)?, true));
    }
    cube::of_npz(&file, &names)
}

/// Gives results without a time axis that of the first that has one, and checks that all agree.
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
    Ok(results.iter().any(|result| result.timed))
}

#[cfg(test)]
mod tests;
