//! What tests of different pages do alike. Failures are panics: this is for tests alone.

use std::path::Path;

use crate::{Browser, Page};

/// A function of a script: the contrast of an element's text and its background, 1 to 21 (WCAG 2).
pub const CONTRAST: &str = "((element) => { \
    const parse = (text) => text.match(/[\\d.]+/g).map(Number); \
    const light = ([r, g, b]) => [r, g, b].map((v) => v / 255) \
        .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4) \
        .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0); \
    const opaque = (e) => { const c = parse(getComputedStyle(e).backgroundColor); \
        return c.length < 4 || c[3] > 0 ? c : opaque(e.parentElement); }; \
    const [a, b] = [light(parse(getComputedStyle(element).color)), light(opaque(element))]; \
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05); })";

/// Opens a file, waits until `ready` is true on it, uses it, and makes sure that nothing went wrong.
///
/// # Panics
/// Without a browser, if the page does not start, or if something went wrong ([`Page::problems`]).
#[track_caller]
pub fn with_file(file: &Path, ready: &str, test: impl FnOnce(&mut Page<'_>)) {
    let mut browser = Browser::start().unwrap_or_else(|error| panic!("{error}"));
    let mut page = browser.open(file).expect("the page opens");
    page.wait_for(ready).expect("the page starts");
    test(&mut page);
    let problems = page.problems();
    assert!(problems.is_empty(), "{problems:#?}");
}

/// Presses keys, one after the other.
///
/// # Panics
/// For a key that does not exist.
#[track_caller]
pub fn press(page: &mut Page<'_>, keys: &[&str]) {
    for key in keys {
        page.press(key).expect("a key");
    }
}
