use std::path::{Path, PathBuf};

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DashboardError {
    /// A file or folder cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// Where.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Where copies of pages belong, there is something else.
    #[error("{}: is in the way of copied pages, and was not made by us", path.display())]
    Occupied {
        /// The folder.
        path: PathBuf,
    },
    /// A file cannot be written whole.
    #[error(transparent)]
    Film(#[from] tpb_film::FilmError),
    /// What was to be written is nothing that JSON can hold.
    #[error("no JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl DashboardError {
    /// An error of the system at a place.
    pub(crate) fn io(path: &Path, source: std::io::Error) -> Self {
        Self::Io { path: path.to_owned(), source }
    }
}
