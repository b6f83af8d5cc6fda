//! What can keep an experiment from having a result at all.

use std::fmt::Display;
use std::path::PathBuf;

/// Why an experiment, or a reference render, could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    /// The analytic reference has no value.
    #[error("the analytic reference has no value")]
    Reference(#[from] tpb_reference::ReferenceError),
    /// The film refuses its layout, or an array file is broken.
    #[error(transparent)]
    Film(#[from] tpb_film::FilmError),
    /// The parts of a scene contradict each other.
    #[error(transparent)]
    Scene(#[from] tpb_scene::AssembleError),
    /// A file could not be read or written.
    #[error("cannot access {}", path.display())]
    Io {
        /// Which one.
        path: PathBuf,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// The task was ended by the person who runs it; what was finished is kept.
    #[error("interrupted; what was finished is kept, and the same command goes on there")]
    Interrupted,
    /// A file holds something else than it should, or a tool refused its input.
    #[error("{what}: {reason}")]
    Unusable {
        /// The file or the tool.
        what: String,
        /// Why.
        reason: String,
    },
}

impl ValidationError {
    /// A failure to access a file.
    pub(crate) fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Self::Io { path: path.into(), source }
    }

    /// Something that cannot be used.
    pub(crate) fn unusable(what: impl Into<String>, reason: impl Display) -> Self {
        Self::Unusable { what: what.into(), reason: format!("{reason}") }
    }
}

/// The result of what may not work.
pub type Result<T> = std::result::Result<T, ValidationError>;
