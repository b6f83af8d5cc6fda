//! Where Chromium is, and how it is started.

use std::env;
use std::path::{Path, PathBuf};

use crate::BrowserError;

/// Its usual names.
const NAMES: [&str; 5] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// What keeps it quiet: no windows, no first run, no look-ups of its maker's hosts. The sandbox
/// cannot be had as root, as in containers; the pages are our own.
const FLAGS: [&str; 17] = [
    "--headless",
    "--remote-debugging-pipe",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-sync",
    "--metrics-recording-only",
    "--no-default-browser-check",
    "--no-first-run",
    "--force-color-profile=srgb",
    "--hide-scrollbars",
    "--mute-audio",
];

/// The program.
///
/// # Errors
/// [`BrowserError::Missing`].
pub(crate) fn find() -> Result<PathBuf, BrowserError> {
    if let Some(named) = env::var_os("CHROMIUM").filter(|name| !name.is_empty()) {
        return Ok(named.into());
    }
    let path = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = env::split_paths(&path).collect();
    let candidates = NAMES.iter().flat_map(|name| folders.iter().map(move |f| f.join(name)));
    candidates.into_iter().find(|program| program.is_file()).ok_or(BrowserError::Missing)
}

/// Arguments for a profile in `folder`.
pub(crate) fn arguments(folder: &Path) -> Vec<String> {
    let mut all: Vec<String> = FLAGS.iter().map(|&flag| flag.to_owned()).collect();
    all.push(format!("--user-data-dir={}", folder.display()));
    all.push("about:blank".to_owned());
    all
}
