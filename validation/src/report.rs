//! What is printed of a suite, and what a failing experiment leaves on disk.
//!
//! Text is made here and printed by the caller. A failing experiment leaves its contrasts as CSV
//! (expectation, mean, standard error, z, interval, p), the deviation of every bin in standard errors,
//! and everything it found as JSON.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use crate::error::{Result, ValidationError};
use crate::experiment::{Context, Experiment, Outcome, Verdict, ZMap};
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
    let (interval, p) = record.outcome.as_ref().map_or(("-".into(), "-".into()), |outcome| {
        (interval(outcome), outcome.worst_p.map_or("-".into(), |p| format!("{p:.1e}")))
    });
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

fn interval(outcome: &Outcome) -> String {
    outcome.interval.map_or("-".into(), |[low, high]| {
        if low.abs().max(high.abs()) < 1e-4 {
            format!("|error| <= {:.1e}", low.abs().max(high.abs()))
        } else {
            format!("{:+.2} %..{:+.2} %", 100.0 * low, 100.0 * high)
        }
    })
}

/// Writes the tables of a failed experiment into the output folder.
pub(crate) fn leave_tables(record: &Record, context: &Context) -> Result<Vec<PathBuf>> {
    let Some(outcome) = &record.outcome else { return Ok(Vec::new()) };
    let folder = context.out.join(record.name.replace('/', "-"));
    fs::create_dir_all(&folder).map_err(|error| ValidationError::io(&folder, error))?;
    let mut files = Vec::new();
    let mut write = |name: &str, text: String| -> Result<()> {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| ValidationError::io(&path, error))?;
        files.push(path);
        Ok(())
    };
    let json = serde_json::to_string_pretty(outcome)
        .map_err(|error| ValidationError::unusable("outcome", error))?;
    write("outcome.json", json + "\n")?;
    if !outcome.contrasts.is_empty() {
        write("contrasts.csv", contrasts(outcome))?;
    }
    if let Some(map) = &outcome.z_map {
        write("z-map.csv", z_map(map))?;
    }
    Ok(files)
}

fn contrasts(outcome: &Outcome) -> String {
    let header = "contrast,expected,expected_error,mean,standard_error,z,low,high,p,adjusted_p\n";
    let row = |c: &crate::statistics::Contrast| {
        format!(
            "\"{}\",{:e},{:e},{:e},{:e},{:.3},{:e},{:e},{:e},{:e}\n",
            c.name,
            c.expected,
            c.expected_error,
            c.mean,
            c.standard_error,
            c.z,
            c.interval[0],
            c.interval[1],
            c.p,
            c.adjusted_p
        )
    };
    outcome.contrasts.iter().fold(header.to_owned(), |text, c| text + &row(c))
}

fn z_map(map: &ZMap) -> String {
    let bins = map.rows.first().map_or(0, Vec::len);
    let header = (0..bins).fold("column,row".to_owned(), |text, bin| text + &format!(",bin {bin}"));
    let row = |(pixel, row): (usize, &Vec<f64>)| {
        let place = format!("\n{},{}", pixel % map.width, pixel / map.width);
        row.iter().fold(place, |text, z| text + &format!(",{z:.2}"))
    };
    map.rows.iter().enumerate().map(row).fold(header, |text, row| text + &row) + "\n"
}
