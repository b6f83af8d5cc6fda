//! The page as its readers meet it: in a real browser, from a file.
//!
//! These tests need Chromium; without one they fail and say how to get it. Every page must load and
//! be used without a word on its console and without a request.

mod keyboard;
mod looks;
mod pictures;
mod scene;
mod values;
mod words;

use std::path::Path;

use serde_json::Value;
use tpb_browser::Page;
use tpb_browser::testing::press;
use tpb_viewer::{Comparison, PageReport, write_comparison};

/// Writes a comparison, opens it, uses it, and makes sure that nothing went wrong meanwhile.
#[track_caller]
fn with_page(comparison: &Comparison<'_>, test: impl FnOnce(&mut Page<'_>)) -> PageReport {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // A name that addresses must escape.
    let file = folder.path().join("a page, with 100 %.html");
    let report = write_comparison(&file, comparison).expect("a page");
    with_file(&file, test);
    report
}

/// The same with a page that is there already.
#[track_caller]
fn with_file(file: &Path, test: impl FnOnce(&mut Page<'_>)) {
    tpb_browser::testing::with_file(file, "window.tpbViewer", test);
}

/// The value of a script, after everything is drawn.
#[track_caller]
fn ask(page: &mut Page<'_>, script: &str) -> Value {
    let script = format!("tpbViewer.settled().then(() => ({script}))");
    page.evaluate(&script).unwrap_or_else(|error| panic!("{script}: {error}"))
}

/// A list of numbers; what is no number, such as a gap in a curve, is NaN.
#[track_caller]
fn numbers(value: &Value) -> Vec<f64> {
    let values = value.as_array().unwrap_or_else(|| panic!("no list: {value}"));
    values.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}
