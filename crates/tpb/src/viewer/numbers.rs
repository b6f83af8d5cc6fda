//! Error numbers as a table and as JSON.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};
use tpb_viewer::{Loaded, Metrics, PageReport};

use super::input::Input;
use crate::summary::Lines;

/// Numbers of one result.
pub(super) struct Judged {
    /// Which of the inputs.
    index: usize,
    /// Over all cells; none for steady results.
    cube: Option<Metrics>,
    /// Over the steady image.
    steady: Metrics,
}

impl Judged {
    /// Of a result against the reference, which has its shape.
    pub(super) fn new(index: usize, result: &Loaded, reference: &Loaded) -> Self {
        let (x, r) = (&result.arrays, &reference.arrays);
        Self {
            index,
            cube: (x.bins > 0).then(|| Metrics::of_cube(x, r, None)),
            steady: Metrics::of_steady(x, r, None),
        }
    }
}

/// Names of the columns.
const COLUMNS: [&str; 8] = ["RMSE", "NMSE", "noise", "bias2", "relMSE", "MAPE", "SMAPE", "bias"];

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3e}"))
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{:.3} %", 100.0 * value))
}

fn bias(metrics: &Metrics) -> String {
    let Some(bias) = metrics.bias else { return "-".to_owned() };
    let interval = metrics.bias_half.map_or_else(String::new, |half| {
        format!(" +- {:.2e} % (at most {:.2e} %)", 100.0 * half.independent, 100.0 * half.bound)
    });
    format!("{:+.3} %{interval}", 100.0 * bias)
}

fn cells(metrics: &Metrics) -> [String; 8] {
    [
        number(metrics.rmse),
        number(metrics.nmse),
        number(metrics.noise),
        number(metrics.squared_bias),
        number(metrics.relative_mse),
        percent(metrics.mape),
        percent(metrics.smape),
        bias(metrics),
    ]
}

/// A table with a heading, columns aligned.
fn table(heading: &str, rows: &[(&str, &Metrics)]) -> String {
    let rows: Vec<(&str, [String; 8])> =
        rows.iter().map(|(label, metrics)| (*label, cells(metrics))).collect();
    let first = rows.iter().map(|row| row.0.chars().count()).chain([heading.len(), 16]).max();
    let first = first.unwrap_or(16);
    let widths: Vec<usize> = COLUMNS
        .iter()
        .enumerate()
        .map(|(i, name)| rows.iter().map(|row| row.1[i].len()).max().unwrap_or(0).max(name.len()))
        .collect();
    let mut text = String::new();
    let mut line = |label: &str, cells: &[&str]| {
        // Writing to a text cannot fail.
        let _ = write!(text, "{label:<first$}");
        for (cell, width) in cells.iter().zip(&widths) {
            let _ = write!(text, "  {cell:>width$}");
        }
        text.push('\n');
    };
    line(heading, &COLUMNS);
    for (label, cells) in &rows {
        line(label, &cells.each_ref().map(String::as_str));
    }
    text
}

/// What a person reads.
pub(super) fn as_text(
    inputs: &[Input],
    reference: usize,
    judged: &[Judged],
    page: Option<&str>,
) -> String {
    let mut head = Lines::default();
    let judge = &inputs[reference];
    head.add("reference", &format!("{} ({})", judge.label, judge.loaded.file.display()));
    let arrays = &judge.loaded.arrays;
    let (height, width, bins, channels) =
        (arrays.height, arrays.width, arrays.bins, arrays.channels);
    head.add(
        "shape",
        &format!("({height}, {width}, {bins}, {channels}) = (rows, columns, bins, channels)"),
    );
    let label = |judged: &Judged| inputs[judged.index].label.as_str();
    let cube: Vec<_> = judged.iter().filter_map(|j| Some((label(j), j.cube.as_ref()?))).collect();
    let steady: Vec<_> = judged.iter().map(|j| (label(j), &j.steady)).collect();
    let mut text = head.text();
    if !cube.is_empty() {
        let _ = write!(text, "\n{}", table("all cells", &cube));
    }
    let _ = write!(text, "\n{}\n", table("steady image", &steady));
    let mut tail = Lines::default();
    if let Some(page) = page {
        tail.add("page", page);
    }
    for input in inputs {
        for remark in &input.loaded.remarks {
            tail.add("WARNING", &format!("{}: {remark}", input.label));
        }
    }
    let tail = tail.text();
    text.truncate(if tail.is_empty() { text.trim_end().len() } else { text.len() });
    text.push_str(&tail);
    format!("{}\n", text.trim_end())
}

/// What a program reads.
pub(super) fn as_json(
    inputs: &[Input],
    reference: usize,
    judged: &[Judged],
    page: Option<(&Path, &PageReport)>,
) -> String {
    let input = |index: usize| -> Value {
        let input = &inputs[index];
        json!({
            "label": input.label,
            "file": input.loaded.file.display().to_string(),
            "remarks": input.loaded.remarks,
        })
    };
    let results: Vec<Value> = judged
        .iter()
        .map(|judged| {
            let mut result = input(judged.index);
            result["cube"] = json!(judged.cube);
            result["steady"] = json!(judged.steady);
            result
        })
        .collect();
    let arrays = &inputs[reference].loaded.arrays;
    let report = json!({
        "reference": input(reference),
        "shape": [arrays.height, arrays.width, arrays.bins, arrays.channels],
        "results": results,
        "page": page.map(|(path, report)| json!({
            "file": path.display().to_string(),
            "bytes": report.bytes,
            "shown": report.shown,
        })),
    });
    format!("{report:#}\n")
}
