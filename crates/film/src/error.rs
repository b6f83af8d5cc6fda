//! What can go wrong in the film, as values.

use std::path::{Path, PathBuf};

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The image has no pixels.
    #[error("the film is {width} x {height} pixels; both sides must be at least 1")]
    Empty {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The time axis has no bins.
    #[error("the time axis has no bins; leave the axis out for a steady image")]
    NoBins,
    /// Start or width of the bins cannot make a time axis.
    #[error("bad time axis: {reason} (start_opl {start_opl} m, bin_width_opl {bin_width_opl} m)")]
    TimeAxis {
        /// OPL of the first edge \[m\].
        start_opl: f64,
        /// OPL that a bin spans \[m\].
        bin_width_opl: f64,
        /// What is wrong with them.
        reason: &'static str,
    },
    /// The arrays do not fit into memory.
    #[error("a film of {width} x {height} pixels and {bins} bins does not fit into memory")]
    TooLarge {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Bins per pixel.
        bins: usize,
    },
    /// A pulse shape with an impossible parameter.
    #[error("bad pulse: {0}")]
    Pulse(String),
    /// The arrays lack what the operation needs.
    #[error("{0}")]
    Unsuitable(&'static str),
    /// Reading or writing failed: disk full, no permission, no such folder...
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A file was read but does not hold what it should.
    #[error("{}: {reason}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

impl FilmError {
    /// An I/O error at `path`.
    pub(crate) fn io(path: &Path, source: std::io::Error) -> Self {
        Self::Io { path: path.to_path_buf(), source }
    }

    /// A malformed file at `path`.
    pub(crate) fn format(path: &Path, reason: impl Into<String>) -> Self {
        Self::Format { path: path.to_path_buf(), reason: reason.into() }
    }
}
