//! What can go wrong, as values.

use std::ffi::OsString;
use std::path::PathBuf;

use tpb_film::FilmError;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// The arrays lack what the video needs, or a file cannot be written.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The name of the file has the ending of no format.
    #[error("{}: the name should end in .png, .apng, .gif, .mp4 or .webm", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// An option is outside its range.
    #[error("{option} {value} is impossible: expected {expected}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Its value.
        value: String,
        /// The range.
        expected: String,
    },
    /// The picture is larger than the format can hold.
    #[error("{width} x {height} pixels are too large for {format}: at most {limit} a side")]
    TooLarge {
        /// Pixels in a row, scaled.
        width: usize,
        /// Rows, scaled.
        height: usize,
        /// The format.
        format: &'static str,
        /// Largest side.
        limit: usize,
    },
    /// The label does not fit into the picture.
    #[error("the label needs {needed:?} pixels and the picture has {available:?}")]
    Label {
        /// Width and height of the label in the smallest font.
        needed: (usize, usize),
        /// Width and height of the picture.
        available: (usize, usize),
    },
    /// The program ffmpeg cannot be started.
    #[error("cannot start {}: {source}", program.display())]
    NoFfmpeg {
        /// The program that was tried.
        program: OsString,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The program ffmpeg failed.
    #[error("{} failed ({status}){}", program.display(), said(last_lines))]
    Ffmpeg {
        /// The program.
        program: OsString,
        /// How it ended.
        status: String,
        /// The last lines that it printed.
        last_lines: Vec<String>,
    },
    /// Whoever watched the progress asked to stop.
    #[error("stopped before the video was complete; nothing was written")]
    Interrupted,
}

impl VideoError {
    /// An option outside its range.
    pub(crate) fn option(
        option: &'static str,
        value: &impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self::Option { option, value: value.to_string(), expected: expected.into() }
    }
}

/// Lines of another program, indented below ours.
fn said(lines: &[String]) -> String {
    if lines.is_empty() {
        return " and said nothing".to_owned();
    }
    format!(" and said:\n    {}", lines.join("\n    "))
}
