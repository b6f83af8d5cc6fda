//! What ends the program early, and how it is shown.
//!
//! Errors in scene files are drawn by miette, with the line, a caret, the JSON path and what to
//! do; colour only on terminals, and not where `NO_COLOR` is set. All others are plain lines.

use std::fmt;
use std::process::ExitCode;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use tpb_render::RenderError;
use tpb_scene::load::SceneError;

use crate::print;

/// Drawn lines longer than this would flood the terminal; the scene error's own text clips them.
const LONGEST_LINE: usize = 240;

/// Why there is no result.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The scene, or an override of it, is wrong.
    Scene(Box<SceneError>),
    /// The usage, another input, or a file is wrong.
    Input {
        /// What is wrong.
        message: String,
        /// What to do about it.
        help: Option<String>,
    },
}

impl Failure {
    /// A failure without a hint.
    pub(crate) fn input(message: impl Into<String>) -> Self {
        Self::Input { message: message.into(), help: None }
    }

    /// A failure with a hint.
    pub(crate) fn with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Input { message: message.into(), help: Some(help.into()) }
    }

    /// Prints it and says how the program should exit.
    pub(crate) fn report(self) -> ExitCode {
        match self {
            Self::Scene(error) => print::err(&draw(*error)),
            Self::Input { message, help } => {
                print::err(&format!("error: {message}"));
                if let Some(help) = help {
                    print::err(&format!(" help: {help}"));
                }
            }
        }
        ExitCode::from(2)
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let message = error.to_string();
        match error {
            RenderError::Memory { .. } => Self::with_help(
                message,
                "fewer pixels or bins: --set sensor.film.width=…, --set sensor.film.temporal_bins=…",
            ),
            _ => Self::input(message),
        }
    }
}

/// A scene error as text for standard error.
fn draw(error: SceneError) -> String {
    let longest = error.source_text().lines().map(str::len).max().unwrap_or(0);
    if error.span().is_none() || longest > LONGEST_LINE {
        return format!("error: {error}");
    }
    let diagnostic = SceneDiagnostic {
        source: NamedSource::new(error.file(), error.source_text().to_owned()),
        error,
    };
    format!("{:?}", miette::Report::new(diagnostic)).trim_end().to_owned()
}

/// A scene error as miette wants it.
#[derive(Debug)]
struct SceneDiagnostic {
    error: SceneError,
    source: NamedSource<String>,
}

impl fmt::Display for SceneDiagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.error.message())
    }
}

impl std::error::Error for SceneDiagnostic {}

impl Diagnostic for SceneDiagnostic {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let parts: Vec<&str> = self.error.note().into_iter().chain(self.error.hint()).collect();
        (!parts.is_empty()).then(|| Box::new(parts.join("\n")) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let path = self.error.path().unwrap_or("here").to_owned();
        let label = LabeledSpan::new_with_span(Some(path), self.error.span()?);
        Some(Box::new(std::iter::once(label)))
    }
}
