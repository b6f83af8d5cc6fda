//! The error that a user sees: what is wrong, where, and what to do.

use std::fmt;
use std::ops::Range;

use super::source::Source;
use super::tree::Node;
use super::trouble::{Site, Trouble};

/// Why a scene could not be loaded.
///
/// `Display` gives several lines of plain text, with the source line and a caret; the parts are
/// there for programs that draw their own report.
#[derive(Debug, thiserror::Error)]
#[error("{}", Report(.0))]
pub struct SceneError(Box<Details>);

#[derive(Debug)]
struct Details {
    source: Source,
    span: Option<Range<usize>>,
    path: Option<String>,
    message: String,
    hint: Option<String>,
    note: Option<String>,
}

impl SceneError {
    pub(crate) fn new(source: Source, root: Option<&Node>, trouble: Trouble) -> Self {
        let (span, id) = match trouble.site {
            Some(Site::Bytes(span)) => (Some(span), None),
            Some(Site::Value(id, span)) => (Some(span), Some(id)),
            None => (None, None),
        };
        let location = root.zip(id).and_then(|(root, id)| root.locate(id));
        Self(Box::new(Details {
            span: span.map(|span| source.clip(span)),
            source,
            path: location.map(|location| format!("${}", location.path)),
            message: trouble.message,
            hint: trouble.hint,
            note: None,
        }))
    }

    /// An error about a file as a whole.
    pub(crate) fn of_file(name: impl Into<String>, message: impl Into<String>) -> Self {
        Self::new(Source::new(name, String::new()), None, Trouble::new(message))
    }

    pub(crate) fn with_note(mut self, note: Option<String>) -> Self {
        self.0.note = note;
        self
    }

    pub(crate) fn with_hint(mut self, hint: &str) -> Self {
        self.0.hint.get_or_insert_with(|| hint.to_owned());
        self
    }

    /// The name of the file (or of the option) that is wrong.
    pub fn file(&self) -> &str {
        &self.0.source.name
    }

    /// Its text; empty where the file could not be read.
    pub fn source_text(&self) -> &str {
        &self.0.source.text
    }

    /// The bytes of the text that the error is about.
    pub fn span(&self) -> Option<Range<usize>> {
        self.0.span.clone()
    }

    /// Line and column of the beginning of the span, both from 1; columns count characters.
    pub fn position(&self) -> Option<(usize, usize)> {
        self.0.span.as_ref().map(|span| self.0.source.position(span.start))
    }

    /// The JSON path of the value that the error is about: `$.fog.phase.g`.
    pub fn path(&self) -> Option<&str> {
        self.0.path.as_deref()
    }

    /// What is wrong, and what was expected.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// What to do about it, where there is something to say.
    pub fn hint(&self) -> Option<&str> {
        self.0.hint.as_deref()
    }

    /// Which override (`--set`) is to blame, if one is.
    pub fn note(&self) -> Option<&str> {
        self.0.note.as_deref()
    }
}

struct Report<'a>(&'a Details);

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let details = self.0;
        write!(f, "{}", details.message)?;
        write!(f, "\n  --> {}", details.source.name)?;
        if let Some(span) = &details.span {
            let (line, column) = details.source.position(span.start);
            write!(f, ":{line}:{column}")?;
            if let Some(path) = &details.path {
                write!(f, " ({path})")?;
            }
            excerpt(f, &details.source, span, line)?;
        }
        if let Some(note) = &details.note {
            write!(f, "\n  note: {note}")?;
        }
        if let Some(hint) = &details.hint {
            write!(f, "\n  hint: {hint}")?;
        }
        Ok(())
    }
}

/// Characters of the source line shown before and after the beginning of the span.
const BEFORE: usize = 60;
const AFTER: usize = 60;

/// The source line and a caret, as much of it as fits a terminal.
fn excerpt(
    f: &mut fmt::Formatter,
    source: &Source,
    span: &Range<usize>,
    line: usize,
) -> fmt::Result {
    let bytes = source.line_of(span.start);
    let start = span.start.min(bytes.end);
    let before: Vec<char> = source.text[bytes.start..start].chars().map(printable).collect();
    let after: Vec<char> = source.text[start..bytes.end].chars().map(printable).collect();
    let marked = source.text[start..span.end.clamp(start, bytes.end)].chars().count();

    let skipped = before.len().saturating_sub(BEFORE);
    let mut text: String = if skipped > 0 { "…".to_owned() } else { String::new() };
    text.extend(&before[skipped..]);
    let indent = text.chars().count();
    text.extend(after.iter().take(AFTER));
    if after.len() > AFTER {
        text.push('…');
    }

    let number = line.to_string();
    let gutter = " ".repeat(number.len());
    let caret = "^".repeat(marked.clamp(1, AFTER));
    write!(f, "\n{gutter} |\n{number} | {}", text.trim_end())?;
    write!(f, "\n{gutter} | {}{caret}", " ".repeat(indent))
}

/// Control characters would move the caret.
fn printable(c: char) -> char {
    if c.is_control() { ' ' } else { c }
}
