//! The dashboard as its readers meet it: in a real browser, from a file.
//!
//! These tests need Chromium; without one they fail and say how to get it. Every page must load and
//! be used without a word on its console and without a request.

mod benchmarks;
mod errors;
mod keyboard;
mod looks;
mod overview;
mod workshop;

use serde_json::Value;
use tpb_browser::Page;
use tpb_browser::testing::{press, with_file};
use tpb_dashboard::{DashboardReport, write};

use crate::workshop::Workshop;

/// Writes the dashboard of a workshop, opens it, uses it, and makes sure that nothing went wrong.
#[track_caller]
fn with_page(workshop: &Workshop, test: impl FnOnce(&mut Page<'_>)) -> DashboardReport {
    let report = write(&workshop.sources()).expect("a dashboard");
    with_file(&report.page, "window.tpbDashboard", test);
    report
}

/// The value of a script, after everything is drawn.
#[track_caller]
fn ask(page: &mut Page<'_>, script: &str) -> Value {
    let script = format!("tpbDashboard.settled().then(() => ({script}))");
    page.evaluate(&script).unwrap_or_else(|error| panic!("{script}: {error}"))
}

/// The text of the first element of a selector.
#[track_caller]
fn text(page: &mut Page<'_>, selector: &str) -> String {
    let value = ask(page, &format!("document.querySelector(`{selector}`).innerText"));
    value.as_str().unwrap_or_else(|| panic!("no text in {selector}")).to_owned()
}
