//! Error numbers as a table and as JSON.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};
use tpb_viewer::{Metrics, PageReport};

use super::input::Input;
use crate::summary::Lines;

/// Numbers of one result.
pub(super) struct Judged {
    /// Which of the inputs.
    index: usize,
    /// Over all pixels.
    all: Numbers,
    /// Over those of the mask.
    masked: Option<Numbers>,
}

/// Numbers over some pixels.
struct Numbers {
    /// Over all cells; none for steady results.
    cube: Option<Metrics>,
    /// Over the steady image.
    steady: Metrics,
}

impl Judged {
    /// Of a result against the reference, which has its shape.
    pub(super) fn new(
        index: usize,
        result: &Input,
        reference: &Input,
        mask: Option<&[bool]>,
    ) -> Self {
        let (x, r) = (result.estimate(), reference.estimate());
        let independent = result.independent_of(reference);
        let of_cube = |mask| {
            let metrics = Metrics::of_cube(x, r, mask);
            if independent { metrics } else { metrics.without_noise() }
        };
        let numbers = |mask| Numbers {
            cube: (x.arrays.bins > 0).then(|| of_cube(mask)),
            steady: Metrics::of_steady(x.arrays, r.arrays, mask),
        };
        Self { index, all: numbers(None), masked: mask.map(|mask| numbers(Some(mask))) }
    }
}

/// All that is said about results.
pub(super) struct Verdicts<'a> {
    pub(super) inputs: &'a [Input],
    /// Which of them judges.
    pub(super) reference: usize,
    pub(super) judged: Vec<Judged>,
    /// Which pixels are also judged alone, from which file.
    pub(super) mask: Option<(&'a Path, &'a [bool])>,
    pub(super) notes: Vec<String>,
}

/// Names of the columns.
const COLUMNS: [&str; 8] = ["RMSE", "NMSE", "noise", "bias2", "relMSE", "MAPE", "SMAPE", "bias"];

/// A number to so many digits; with a power of ten only where it is very small or very large.
fn digits(value: f64, count: usize) -> String {
    let size = value.abs();
    if value != 0.0 && size.is_finite() && !(1e-3..1e5).contains(&size) {
        return format!("{value:.*e}", count - 1);
    }
    let before = if value == 0.0 { 1.0 } else { size.log10().floor() + 1.0 };
    format!("{value:.*}", (count as f64 - before).max(0.0) as usize)
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| digits(value, 4))
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{} %", digits(100.0 * value, 4)))
}

fn bias(metrics: &Metrics) -> String {
    let Some(bias) = metrics.bias else { return "-".to_owned() };
    let interval = metrics.bias_half.map_or_else(String::new, |half| {
        let [independent, bound] = [half.independent, half.bound].map(|h| digits(100.0 * h, 2));
        format!(" ± {independent} % (at most {bound} %)")
    });
    let sign = if bias > 0.0 { "+" } else { "" };
    format!("{sign}{}{interval}", percent(Some(bias)))
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
        .map(|(i, name)| {
            rows.iter().map(|row| row.1[i].chars().count()).max().unwrap_or(0).max(name.len())
        })
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

impl Verdicts<'_> {
    /// A table of some numbers of each result; nothing if there are none.
    fn table<'s>(
        &'s self,
        heading: &str,
        of: impl Fn(&'s Judged) -> Option<&'s Metrics>,
    ) -> String {
        let rows: Vec<_> = self
            .judged
            .iter()
            .filter_map(|judged| Some((self.inputs[judged.index].label.as_str(), of(judged)?)))
            .collect();
        if rows.is_empty() { String::new() } else { format!("\n{}", table(heading, &rows)) }
    }

    /// What a person reads.
    pub(super) fn as_text(&self, page: Option<&str>) -> String {
        let mut head = Lines::default();
        let judge = &self.inputs[self.reference];
        head.add("reference", &format!("{} ({})", judge.label, judge.loaded.file.display()));
        let arrays = &judge.loaded.arrays;
        let (height, width, bins, channels) =
            (arrays.height, arrays.width, arrays.bins, arrays.channels);
        head.add(
            "shape",
            &format!("({height}, {width}, {bins}, {channels}) = (rows, columns, bins, channels)"),
        );
        let mut text = head.text();
        text += &self.table("all cells", |judged| judged.all.cube.as_ref());
        text += &self.table("cells in mask", |judged| judged.masked.as_ref()?.cube.as_ref());
        text += &self.table("steady image", |judged| Some(&judged.all.steady));
        text += &self.table("steady in mask", |judged| Some(&judged.masked.as_ref()?.steady));
        let mut tail = Lines::default();
        if let Some(page) = page {
            tail.add("page", page);
        }
        for note in &self.notes {
            tail.add("note", note);
        }
        for input in self.inputs {
            for remark in &input.loaded.remarks {
                tail.add("WARNING", &format!("{}: {remark}", input.label));
            }
        }
        let tail = tail.text();
        let text = text.trim_end();
        if tail.is_empty() { format!("{text}\n") } else { format!("{text}\n\n{tail}") }
    }

    /// What a program reads.
    pub(super) fn as_json(&self, page: Option<(&Path, &PageReport)>) -> String {
        let input = |index: usize| -> Value {
            let input = &self.inputs[index];
            json!({
                "label": input.label,
                "file": input.loaded.file.display().to_string(),
                "remarks": input.loaded.remarks,
            })
        };
        let results = self.judged.iter().map(|judged| {
            let mut result = input(judged.index);
            result["cube"] = json!(judged.all.cube);
            result["steady"] = json!(judged.all.steady);
            if let Some(masked) = &judged.masked {
                result["masked_cube"] = json!(masked.cube);
                result["masked_steady"] = json!(masked.steady);
            }
            result
        });
        let arrays = &self.inputs[self.reference].loaded.arrays;
        let report = json!({
            "reference": input(self.reference),
            "shape": [arrays.height, arrays.width, arrays.bins, arrays.channels],
            "mask": self.mask.map(|(file, mask)| json!({
                "file": file.display().to_string(),
                "pixels": mask.iter().filter(|counts| **counts).count(),
            })),
            "notes": self.notes,
            "results": results.collect::<Vec<Value>>(),
            "page": page.map(|(path, report)| json!({
                "file": path.display().to_string(),
                "bytes": report.bytes,
                "shown": report.shown,
            })),
        });
        format!("{report:#}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_powers_of_ten_only_where_they_need_them() {
        let texts = [
            (0.0, "0.000"),
            (4.57, "4.570"),
            (-0.041_826, "-0.04183"),
            (0.001, "0.001000"),
            (9.994e-4, "9.994e-4"),
            (12_345.6, "12346"),
            (123_456.0, "1.235e5"),
            (f64::INFINITY, "inf"),
        ];
        for (value, text) in texts {
            assert_eq!(digits(value, 4), text);
        }
    }

    /// Regression: half widths were `+- 4.57e0 %`.
    #[test]
    fn a_bias_is_told_with_its_interval() {
        let half = tpb_viewer::Half { independent: 0.0457, bound: 0.523 };
        let metrics =
            Metrics { bias: Some(-0.001_99), bias_half: Some(half), ..Metrics::default() };
        assert_eq!(bias(&metrics), "-0.1990 % ± 4.6 % (at most 52 %)");
        let metrics = Metrics { bias: Some(0.5), ..Metrics::default() };
        assert_eq!(bias(&metrics), "+50.00 %");
        // Aligned, though the sign takes two bytes.
        let table = table("all cells", &[("a", &metrics)]);
        assert!(
            table.lines().all(|line| line.chars().count() == table.lines().next().unwrap().len())
        );
    }
}
