//! `tables`: the analytic solutions against their tables of reference values.

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use tpb_reference::tables::{Comparison, TableReport, Verdict, evaluate_directory};

const DEFAULT_DIRECTORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../validation/tables");

/// Prints a line for each table of a directory; false if a solution misses its table.
pub(crate) fn run(directory: Option<PathBuf>) -> Result<bool, Box<dyn Error>> {
    let directory = directory.unwrap_or_else(|| PathBuf::from(DEFAULT_DIRECTORY));
    run_to(&mut std::io::stdout().lock(), &directory)
}

fn run_to(out: &mut impl Write, directory: &Path) -> Result<bool, Box<dyn Error>> {
    let reports = evaluate_directory(directory)?;
    if reports.is_empty() {
        return Err(format!("there is no table in {}", directory.display()).into());
    }
    let width = reports.iter().map(|report| report.name.len()).max().unwrap_or(0).max(5);
    writeln!(out, "{:width$}  rows  worst error  tolerance  verdict", "table")?;
    for report in &reports {
        writeln!(out, "{}", line(report, width))?;
    }
    let count = |verdict| reports.iter().filter(|report| report.verdict() == verdict).count();
    let (passed, failed) = (count(Verdict::Passed), count(Verdict::Failed));
    let unknown = count(Verdict::Unknown);
    writeln!(out, "{passed} passed, {failed} failed, {unknown} unknown")?;
    Ok(failed == 0)
}

fn line(report: &TableReport, width: usize) -> String {
    let TableReport { name, rows, comparison } = report;
    let verdict = match report.verdict() {
        Verdict::Passed => "passed",
        Verdict::Failed => "FAILED",
        Verdict::Unknown => "unknown",
    };
    let (worst, tolerance, reason) = match comparison {
        None => ("-".into(), "-".into(), String::new()),
        Some(comparison) => columns(comparison, report.verdict()),
    };
    format!("{name:width$}  {rows:4}  {worst:>11}  {tolerance:>9}  {verdict}{reason}")
}

/// The worst error, its tolerance, and for a failure its row.
fn columns(comparison: &Comparison, verdict: Verdict) -> (String, String, String) {
    let tolerance = |relative: f64| format!("{relative:.0e}");
    let Some(worst) = &comparison.worst else {
        return ("-".into(), tolerance(comparison.tolerance), ": no rows".into());
    };
    let reason = match (&worst.found, verdict) {
        (_, Verdict::Passed | Verdict::Unknown) if comparison.widened > 0 => {
            format!(", to their own precision: {} of the rows", comparison.widened)
        }
        (_, Verdict::Passed | Verdict::Unknown) => String::new(),
        (Ok(found), Verdict::Failed) => {
            format!(": row {} gives {found:e} for {:e}", worst.row, worst.expected)
        }
        (Err(problem), Verdict::Failed) => format!(": row {}: {problem}", worst.row),
    };
    (format!("{:.1e}", worst.relative_error), tolerance(worst.tolerance), reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(directory: &Path) -> (bool, String) {
        let mut out = Vec::new();
        let passed = run_to(&mut out, directory).unwrap();
        (passed, String::from_utf8(out).unwrap())
    }

    #[test]
    fn the_tables_of_the_workspace_pass_in_aligned_columns() {
        let (passed, text) = printed(Path::new(DEFAULT_DIRECTORY));
        assert!(passed, "{text}");
        let lines: Vec<_> = text.lines().collect();
        let column = lines[0].find("verdict").unwrap();
        let verdicts: Vec<_> =
            lines[1..lines.len() - 1].iter().map(|line| &line[column..]).collect();
        let known = |verdict: &&str| {
            ["passed", "unknown"].iter().any(|start| verdict.split(',').next() == Some(start))
        };
        assert!(verdicts.iter().all(known), "{text}");
        assert!(text.contains("passed, to their own precision: 1 of the rows"), "{text}");
    }

    #[test]
    fn a_missed_table_is_false_and_names_the_row() {
        let directory = std::env::temp_dir().join(format!("tables-{}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        let row = r#"{"in": {"energy": 1, "sigma_t": 0, "r": 1}, "value": 1.0}"#;
        let text = format!(r#"{{"name": "ballistic_point_fluence", "rows": [{row}]}}"#);
        std::fs::write(directory.join("wrong.json"), text).unwrap();
        let (passed, text) = printed(&directory);
        std::fs::remove_dir_all(&directory).unwrap();
        assert!(!passed);
        assert!(text.contains("FAILED: row 0 gives"), "{text}");
    }

    #[test]
    fn a_missing_directory_is_an_error() {
        assert!(run(Some(PathBuf::from("no/such/directory"))).is_err());
    }
}
