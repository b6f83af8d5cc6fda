//! What can go wrong before the first pass, as values.

use tpb_film::FilmError;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The film refuses its layout, or the pulse its parameters.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The system does not give the threads that were asked for.
    #[error("cannot start the threads: {0}")]
    Threads(String),
    /// The film would not fit the memory that is free now.
    #[error(
        "a film of {width} x {height} pixels and {bins} bins needs {} and {} are free",
        crate::memory::amount(*needed), crate::memory::amount(*available)
    )]
    Memory {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Bins per pixel, those around a pulse included.
        bins: usize,
        /// Bytes of the film and of its arrays.
        needed: u64,
        /// Bytes that are free now.
        available: u64,
    },
}
