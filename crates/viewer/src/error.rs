//! What can go wrong, as values.

use std::path::{Path, PathBuf};

use tpb_film::FilmError;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// The film's files: reading results, writing pages.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// A file of another program does not hold a cube.
    #[error("{}: {reason}", path.display())]
    Cube {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// Results that cannot be compared.
    #[error("{0}")]
    Mismatch(String),
    /// A comparison that makes no sense: no methods, two references, equal keys.
    #[error("{0}")]
    Comparison(String),
    /// Not even a cube of a few cells fits.
    #[error(
        "the page needs at least {needed} bytes and its budget is {budget}: raise it, or show fewer \
         methods"
    )]
    Budget {
        /// Bytes of the smallest page.
        needed: usize,
        /// Bytes allowed.
        budget: usize,
    },
}

impl ViewerError {
    /// A file that is not what it should be.
    pub(crate) fn cube(path: &Path, reason: impl Into<String>) -> Self {
        Self::Cube { path: path.to_path_buf(), reason: reason.into() }
    }
}
