//! Floor 0: a headless Chromium, for tests of pages and for looking at them.
//!
//! A [`Browser`] is a process of its own with an empty profile; [`Browser::open`] loads a file into
//! a [`Page`], on which one presses keys, clicks, runs scripts, and takes pictures. Everything that
//! went wrong on a page (errors and warnings on its console, exceptions, requests to the network)
//! is kept: [`Page::problems`].
//!
//! The Chrome DevTools Protocol runs over `--remote-debugging-pipe`: JSON texts that end with a NUL
//! byte, read from file descriptor 3 and written to 4, which a shell puts there. No port is opened
//! and no network is used; a few commands of the protocol need no generated bindings.
//!
//! Chromium is looked for in the environment variable `CHROMIUM`, then on the path under its usual
//! names. Not handled: other browsers, Windows, several pages at a time.

mod keys;
mod page;
mod pipe;
mod program;
pub mod testing;

use std::path::PathBuf;

pub use keys::Modifiers;
pub use page::{Page, Viewport};
pub use pipe::Browser;

/// The program that [`Browser::start`] would start.
///
/// # Errors
/// [`BrowserError::Missing`].
pub fn find_program() -> Result<PathBuf, BrowserError> {
    program::find()
}

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BrowserError {
    /// There is no Chromium.
    #[error(
        "no Chromium was found: install it (Debian, Ubuntu: `apt-get install chromium`), or name \
         its program in the environment variable CHROMIUM"
    )]
    Missing,
    /// The program that was named or found does not start.
    #[error("cannot start {}: {reason}", program.display())]
    Start {
        /// The program.
        program: PathBuf,
        /// Why not.
        reason: String,
    },
    /// The browser has ended, or does not answer in time.
    #[error("the browser does not answer to {command}: {reason}")]
    Silent {
        /// What it was asked.
        command: String,
        /// What is known.
        reason: String,
    },
    /// The browser refuses a command, or a script throws.
    #[error("{command} failed: {reason}")]
    Refused {
        /// What it was asked.
        command: String,
        /// Its answer.
        reason: String,
    },
    /// A condition did not come true.
    #[error("`{condition}` did not come true within {seconds} s; the page says: {problems}")]
    Never {
        /// The script that was to be true.
        condition: String,
        /// How long it was asked.
        seconds: u64,
        /// Problems of the page so far.
        problems: String,
    },
    /// A picture cannot be written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}
