//! What is printed of a suite. Text is made here and printed by the caller; [`crate::pages`] makes
//! the report that is kept.

use std::sync::Arc;

use crate::experiment::{Experiment, Outcome, Verdict};
use crate::suite::{Record, SuiteResult};

/// The plan: what will be run.
pub fn plan(experiments: &[Arc<dyn Experiment>]) -> Vec<String> {
    let width = width(experiments.iter().map(|e| e.name()));
    experiments.iter().map(|e| format!("  {:width$}  {}", e.name(), e.description())).collect()
}

/// One line for a record.
pub fn line(record: &Record, width: usize) -> String {
    let verdict = match record.verdict {
        Verdict::Passed => "passed",
        Verdict::Failed => "FAILED",
        Verdict::Broken => "BROKEN",
    };
    let (interval, p) = numbers(record);
    format!("{verdict}  {:width$}  {interval:>21}  p {p:>7}  {:6.1} s", record.name, record.seconds)
}

/// What a reader should know beyond the line.
pub fn remarks(record: &Record) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(outcome) = &record.outcome {
        lines.extend(outcome.notes.iter().map(|note| format!("        {note}")));
        if let Some(equal_time) = &outcome.equal_time {
            lines.extend(equal_time.table().iter().map(|line| format!("      {line}")));
        }
    }
    if record.verdict != Verdict::Passed {
        lines.extend(record.error.iter().map(|error| format!("        {error}")));
        lines.extend(record.files.iter().map(|file| format!("        see {}", file.display())));
        lines.push(format!("        repeat: {}", record.repeat));
    }
    lines
}

/// The closing table, and the line for machines.
pub fn summary(result: &SuiteResult) -> Vec<String> {
    let width = width(result.records.iter().map(|record| record.name.clone()));
    let mut lines: Vec<String> = result.records.iter().map(|r| line(r, width)).collect();
    for record in &result.records {
        let equal_time = record.outcome.as_ref().and_then(|outcome| outcome.equal_time.as_ref());
        lines.extend(equal_time.iter().flat_map(|table| table.table()));
    }
    for rate in result.rates() {
        lines.push(format!("calibration, {}", rate.line()));
    }
    let count = |verdict| result.records.iter().filter(|r| r.verdict == verdict).count();
    let verdict = if result.passed() { "PASSED" } else { "FAILED" };
    lines.push(format!(
        "chance that a sound program is called wrong: {:.1e} (nominal {:.0e}); that noise hides a claim: {:.1e}",
        result.false_alarm, result.nominal, result.unresolved
    ));
    lines.push(format!(
        "validate: {verdict} passed={} failed={} broken={} false_alarm={:.2e} unresolved={:.2e} seconds={:.1}",
        count(Verdict::Passed),
        count(Verdict::Failed),
        count(Verdict::Broken),
        result.false_alarm,
        result.unresolved,
        result.seconds
    ));
    lines
}

/// The width of a column of names.
pub fn width(names: impl Iterator<Item = String>) -> usize {
    names.map(|name| name.len()).max().unwrap_or(0)
}

/// Interval and p value as text.
pub(crate) fn numbers(record: &Record) -> (String, String) {
    record.outcome.as_ref().map_or(("-".into(), "-".into()), |outcome| {
        (interval(outcome), outcome.worst_p.map_or("-".into(), |p| format!("{p:.1e}")))
    })
}

fn interval(outcome: &Outcome) -> String {
    outcome.interval.map_or("-".into(), |[low, high]| {
        if low.abs().max(high.abs()) < 1e-4 {
            format!("|error| <= {:.1e}", low.abs().max(high.abs()))
        } else {
            format!("{:+.2} %..{:+.2} %", 100.0 * low, 100.0 * high)
        }
    })
}
