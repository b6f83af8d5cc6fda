//! The lines that a person reads after a render, and of a report later.

use std::fmt::Write;
use std::path::Path;

use tpb_render::{Report, RunSummary, amount};

use crate::folder::Written;

/// Lines with a label, aligned.
#[derive(Debug, Default)]
pub(crate) struct Lines(String);

impl Lines {
    /// Adds a line.
    pub(crate) fn add(&mut self, label: &str, value: &str) {
        // Writing to a text cannot fail.
        let _ = writeln!(self.0, "{label:<16} {value}");
    }

    /// The text.
    pub(crate) fn text(self) -> String {
        self.0
    }
}

/// After a render.
pub(crate) fn of_render(report: &Report, written: &Written, folder: &Path) -> String {
    let mut lines = Lines::default();
    of_report(&mut lines, report);
    lines.add("written", &format!("{}: {}", folder.display(), written.files.join(", ")));
    lines.text()
}

/// What a report says.
pub(crate) fn of_report(lines: &mut Lines, report: &Report) {
    let Report { run, method, .. } = report;
    lines.add("method", &method.name);
    lines.add("passes", &format!("{}, seed {}", run.passes, report.options.run.seed));
    lines.add("time", &time(run));
    lines.add("rate", &rates(report));
    let error = match run.relative_error {
        Some(error) => format!("{:.3} % (median relative error of a pixel)", 100.0 * error),
        None => "unknown: it needs two passes and some light".to_owned(),
    };
    lines.add("error", &error);
    if let Some(closure) = report.ledger_closure {
        let carrier = &run.ledger.carrier;
        lines.add("ledger", &format!("of {carrier} closes to {:.1e}", closure.abs()));
    }
    lines.add("not finite", &report.non_finite.to_string());
    if report.pulse.relative_error_bound > 0.0 {
        let bound = 100.0 * report.pulse.relative_error_bound;
        lines.add("pulse", &format!("bins are off by at most {bound:.2} % of a pixel in sum"));
    }
    if let Some(peak) = report.peak_memory_bytes {
        lines.add("peak memory", &amount(peak));
    }
    for warning in &report.warnings {
        lines.add("WARNING", warning);
    }
}

fn time(run: &RunSummary) -> String {
    let cpu = run.cpu_seconds.map_or_else(String::new, |cpu| format!(", {cpu:.2} s CPU"));
    format!("{:.2} s{cpu}, of which {:.2} s setup", run.wall_seconds, run.setup_seconds)
}

fn rates(report: &Report) -> String {
    let rates = &report.rates;
    let kinds = [
        (rates.camera_paths_per_second, "camera paths/s"),
        (rates.photon_paths_per_second, "photons/s"),
        (rates.connections_per_second, "connections/s"),
        (rates.pairs_accepted_per_second, "ray-beam pairs/s"),
    ];
    let mut parts = Vec::new();
    for (rate, name) in kinds {
        if rate > 0.0 {
            parts.push(format!("{} {name}", si(rate)));
        }
    }
    parts.join(", ")
}

/// Three digits with a prefix.
fn si(value: f64) -> String {
    let (scaled, prefix) = match value {
        v if v >= 1e9 => (v / 1e9, " G"),
        v if v >= 1e6 => (v / 1e6, " M"),
        v if v >= 1e3 => (v / 1e3, " k"),
        v => (v, ""),
    };
    format!("{scaled:.2}{prefix}")
}
