//! Tables of reference values, and the comparison of the solutions with them.
//!
//! A table is a JSON file with a `name`, a `doc`, a `formula` and `rows`; a row has the inputs
//! `in`, a `quantity` if the table has several, and the `value`, computed elsewhere in higher
//! precision. The file is read strictly if its name belongs to a solution ([`registry`]); other
//! files only need to be JSON with rows, and are reported as unknown.
//!
//! A row may leave out inputs that the table fixes, and say so behind the name of the quantity, as in
//! "time R=1 L=4 c=1": if no quantity goes by the whole name, what counts is the name up to the first
//! space or parenthesis, and the solution's defaults are those values ([`field@Solution::defaults`]).
//!
//! The error of a row is relative to its value. A value of 0 stands for darkness, before a front
//! or outside a kernel, which is a matter of cases and not of rounding: it must be met exactly.
//! What is allowed is the tolerance of the solution, or the row's own `relative_error_estimate`, if
//! the table knows its value less well than that. Tables of third parties are read by `published`.
//!
//! [`registry`]: crate::registry

use crate::error::{ReferenceError, Result};
use crate::published;
use crate::registry::{self, Solution};
use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use serde_json::{Map, Value};
use std::fs;
use std::path::{Path, PathBuf};

/// What the comparison of one table found.
#[derive(Debug, Clone, PartialEq)]
pub struct TableReport {
    /// The name of the table.
    pub name: String,
    /// How many rows it has.
    pub rows: usize,
    /// The comparison, or `None` if no solution goes by this name.
    pub comparison: Option<Comparison>,
}

/// How a solution compares with its table.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The largest relative error that is allowed, except for rows that state a larger one.
    pub tolerance: f64,
    /// How many rows do.
    pub widened: usize,
    /// The row with the largest error for its tolerance, unless there are no rows.
    pub worst: Option<RowError>,
}

/// The error of one row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowError {
    /// The number of the row, from 0.
    pub row: usize,
    /// The value of the table.
    pub expected: f64,
    /// The value of the solution, or why it has none.
    pub found: std::result::Result<f64, String>,
    /// The relative error; infinite without a value, or if 0 is missed.
    pub relative_error: f64,
    /// The largest relative error that is allowed here.
    pub tolerance: f64,
}

impl RowError {
    /// The error in units of what is allowed.
    fn severity(&self) -> f64 {
        self.relative_error / self.tolerance
    }
}

/// The outcome for one table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every row is met to the tolerance.
    Passed,
    /// A row is not, or there is none.
    Failed,
    /// No solution goes by this name.
    Unknown,
}

impl TableReport {
    /// The outcome.
    pub fn verdict(&self) -> Verdict {
        match &self.comparison {
            None => Verdict::Unknown,
            Some(Comparison { worst: Some(worst), .. })
                if worst.relative_error <= worst.tolerance =>
            {
                Verdict::Passed
            }
            Some(_) => Verdict::Failed,
        }
    }
}

/// Compares every table of a directory, in the order of the file names.
pub fn evaluate_directory(directory: &Path) -> Result<Vec<TableReport>> {
    let unreadable = |source| ReferenceError::Read { path: directory.to_path_buf(), source };
    let mut files = Vec::new();
    for entry in fs::read_dir(directory).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            files.push(path);
        }
    }
    files.sort();
    files.iter().map(|path| evaluate_file(path)).collect()
}

/// Compares the table of a file.
pub fn evaluate_file(path: &Path) -> Result<TableReport> {
    let text = fs::read_to_string(path)
        .map_err(|source| ReferenceError::Read { path: path.to_path_buf(), source })?;
    evaluate_text(&text, path)
}

/// Compares the table of a text; `path` serves for messages, and for the name if the text has none.
pub fn evaluate_text(text: &str, path: &Path) -> Result<TableReport> {
    let Outline { name, rows } = parse(text, path)?;
    let name = name.unwrap_or_else(|| {
        path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    });
    let published = published::solution_of(&name);
    let comparison = match registry::find(published.unwrap_or(&name)) {
        None => None,
        Some(solution) if published.is_some() => {
            Some(compare(solution, &published::rows(text, path)?))
        }
        Some(solution) => Some(compare(solution, &parse::<Table>(text, path)?.rows)),
    };
    Ok(TableReport { name, rows: rows.len(), comparison })
}

fn compare(solution: &Solution, rows: &[Row]) -> Comparison {
    let worst = rows
        .iter()
        .enumerate()
        .map(|(index, row)| row_error(solution, index, row))
        .max_by(|a, b| a.severity().total_cmp(&b.severity()));
    let tolerance = solution.tolerance.relative();
    let widened = rows.iter().filter(|row| row.tolerance(solution) > tolerance).count();
    Comparison { tolerance, widened, worst }
}

fn row_error(solution: &Solution, index: usize, row: &Row) -> RowError {
    let name = row.quantity.as_deref();
    let short = name.and_then(|name| name.split([' ', '(']).next());
    let found = match solution.quantity(name).or_else(|| solution.quantity(short)) {
        None => Err(format!("{} has no such quantity", solution.name)),
        Some(quantity) => (quantity.evaluate)(&solution.complete(quantity, &row.inputs))
            .map_err(|error| explain(&error)),
    };
    let relative_error = found.as_ref().map_or(f64::INFINITY, |&v| relative_error(v, row.value));
    let tolerance = row.tolerance(solution);
    RowError { row: index, expected: row.value, found, relative_error, tolerance }
}

fn relative_error(found: f64, expected: f64) -> f64 {
    if found == expected {
        0.0
    } else if expected == 0.0 || !found.is_finite() {
        f64::INFINITY
    } else {
        ((found - expected) / expected).abs()
    }
}

/// The message of an error with those of its sources.
fn explain(error: &dyn std::error::Error) -> String {
    match error.source() {
        None => error.to_string(),
        Some(source) => format!("{error}: {}", explain(source)),
    }
}

pub(crate) fn parse<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T> {
    let path: PathBuf = path.into();
    serde_json::from_str(text).map_err(|source| ReferenceError::Parse { path, source })
}

/// What any table has.
#[derive(Debug, Deserialize)]
struct Outline {
    name: Option<String>,
    rows: Vec<IgnoredAny>,
}

/// The table of a solution.
#[derive(Debug, Deserialize)]
struct Table {
    rows: Vec<Row>,
}

/// One value of a table.
#[derive(Debug, Deserialize)]
pub(crate) struct Row {
    #[serde(rename = "in")]
    pub(crate) inputs: Map<String, Value>,
    pub(crate) quantity: Option<String>,
    pub(crate) value: f64,
    /// How well the table knows the value, if it says so.
    pub(crate) relative_error_estimate: Option<f64>,
}

impl Row {
    /// The largest relative error that is allowed.
    fn tolerance(&self, solution: &Solution) -> f64 {
        solution.tolerance.relative().max(self.relative_error_estimate.unwrap_or(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(text: &str) -> Result<TableReport> {
        evaluate_text(text, Path::new("tables/ballistic_point_fluence.json"))
    }

    fn one_row(inputs: &str, value: f64) -> TableReport {
        report(&format!(r#"{{"rows": [{{"in": {inputs}, "value": {value:e}}}]}}"#)).unwrap()
    }

    fn worst(report: &TableReport) -> &RowError {
        report.comparison.as_ref().unwrap().worst.as_ref().unwrap()
    }

    const UNIT_SPHERE: &str = r#"{"energy": 1.0, "sigma_t": 0.0, "r": 1.0}"#;
    const DARK: &str = r#"{"energy": 1.0, "sigma_t": 1e6, "r": 1.0}"#;
    const INVERSE_AREA: f64 = 0.079_577_471_545_947_67;

    #[test]
    fn a_value_within_the_tolerance_passes_and_one_outside_fails() {
        let within = one_row(UNIT_SPHERE, INVERSE_AREA * (1.0 + 0.5e-12));
        assert_eq!(within.verdict(), Verdict::Passed);
        let outside = one_row(UNIT_SPHERE, INVERSE_AREA * (1.0 + 2e-12));
        assert_eq!(outside.verdict(), Verdict::Failed);
        assert!((worst(&outside).relative_error - 2e-12).abs() < 1e-15);
    }

    #[test]
    fn a_row_that_is_known_less_well_has_its_own_tolerance() {
        let table = |estimate: &str| {
            let value = INVERSE_AREA * (1.0 + 2e-12);
            let row = format!(r#""value": {value:e}, "relative_error_estimate": {estimate}"#);
            report(&format!(r#"{{"rows": [{{"in": {UNIT_SPHERE}, {row}}}]}}"#)).unwrap()
        };
        let widened = |report: &TableReport| report.comparison.as_ref().unwrap().widened;
        for (estimate, verdict, count) in [
            ("3e-12", Verdict::Passed, 1),
            ("1.5e-12", Verdict::Failed, 1),
            ("1e-20", Verdict::Failed, 0),
            ("null", Verdict::Failed, 0),
        ] {
            let report = table(estimate);
            assert_eq!((report.verdict(), widened(&report)), (verdict, count), "{estimate}");
        }
    }

    #[test]
    fn zero_must_be_met_exactly() {
        assert_eq!(one_row(DARK, 0.0).verdict(), Verdict::Passed);
        assert_eq!(one_row(DARK, 1e-300).verdict(), Verdict::Failed);
        assert_eq!(one_row(UNIT_SPHERE, 0.0).verdict(), Verdict::Failed);
    }

    #[test]
    fn the_worst_of_several_rows_is_reported() {
        let text = format!(
            r#"{{"rows": [{{"in": {UNIT_SPHERE}, "value": 0.0795774715459477}},
                          {{"in": {UNIT_SPHERE}, "value": 0.08}},
                          {{"in": {DARK}, "value": 0}}]}}"#
        );
        let report = report(&text).unwrap();
        assert_eq!((report.rows, worst(&report).row), (3, 1));
        assert_eq!(worst(&report).found, Ok(INVERSE_AREA));
    }

    #[test]
    fn a_row_without_a_value_of_the_solution_fails_and_says_why() {
        let outside = one_row(r#"{"energy": 1.0, "sigma_t": 0.0, "r": 0.0}"#, 1.0);
        assert_eq!(outside.verdict(), Verdict::Failed);
        assert!(worst(&outside).found.as_ref().unwrap_err().contains("r = 0"));
        let misspelt = one_row(r#"{"energy": 1.0, "sigma_t": 0.0, "radius": 1.0}"#, 1.0);
        assert!(worst(&misspelt).found.as_ref().unwrap_err().contains("unknown field `radius`"));
    }

    #[test]
    fn a_known_table_without_rows_does_not_pass() {
        assert_eq!(report(r#"{"rows": []}"#).unwrap().verdict(), Verdict::Failed);
    }

    #[test]
    fn an_unknown_name_is_unknown_whatever_its_rows() {
        let text = r#"{"name": "elsewhere", "rows": [{"r": 1}, {"t": 2}]}"#;
        let report = report(text).unwrap();
        assert_eq!((report.rows, report.verdict()), (2, Verdict::Unknown));
    }

    #[test]
    fn a_broken_table_is_named_with_the_position() {
        let error = explain(&report("{\"rows\": [\n{\"in\": {},, }]}").unwrap_err());
        assert!(error.contains("ballistic_point_fluence.json"), "{error}");
        assert!(error.contains("line 2 column 11"), "{error}");
        let error = explain(&report("{\"rows\": [\n{\"in\": {}}]}").unwrap_err());
        assert!(error.contains("missing field `value`") && error.contains("line 2"), "{error}");
    }

    #[test]
    fn a_name_of_several_words_is_a_name_first() {
        let text = r#"{"name": "dwell_flight_fraction", "rows": [{"in":
            {"scattering_rate": 1.0, "mean_dwell": 1.0, "scatterings": 0, "time": 0.0},
            "quantity": "n-th order in flight", "value": 1.0}]}"#;
        assert_eq!(report(text).unwrap().verdict(), Verdict::Passed);
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = evaluate_file(Path::new("no/such/table.json")).unwrap_err();
        assert!(error.to_string().contains("no/such/table.json"));
        assert!(evaluate_directory(Path::new("no/such")).is_err());
    }
}
