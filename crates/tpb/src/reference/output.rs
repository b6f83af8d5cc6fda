//! A curve as CSV, JSON and SVG. Each says if it is an approximation.

use std::fmt::Write;

use serde_json::{Value, json};
use tpb_plot::{Axis, Chart, Mark, Series};
use tpb_reference::registry::Quantity;

use super::curve::Curve;
use super::request::Request;
use crate::cli::ReferenceArgs;
use crate::failure::Failure;

const PLOT_SIZE: (u32, u32) = (900, 560);

/// The name of a quantity in a heading.
fn name(quantity: &Quantity) -> &'static str {
    quantity.name.unwrap_or("value")
}

/// Comments, a heading, and a line for each point.
pub(super) fn csv(request: &Request, curve: &Curve) -> String {
    let solution = request.solution;
    let inputs = Value::Object(request.inputs.clone());
    let mut text = format!("# {}: {}\n# inputs: {inputs}\n", solution.name, solution.summary);
    if let Some(validity) = solution.approximate {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "# APPROXIMATE: {validity}");
    }
    let sweep = request.sweep.as_ref();
    let mut heading: Vec<_> = sweep.map_or_else(Vec::new, |sweep| sweep.keys.clone());
    heading.extend(
        request.quantities.iter().map(|q| format!("{} [{}]", name(q), solution.unit_of(q))),
    );
    let _ = writeln!(text, "{}", heading.join(","));
    for point in 0..curve.values.first().map_or(0, Vec::len) {
        let mut cells: Vec<_> = sweep
            .map_or(&[][..], |sweep| &sweep.points[point])
            .iter()
            .map(|&value| json!(value).to_string())
            .collect();
        let cell = |row: &Vec<Option<f64>>| row[point].map(|v| json!(v).to_string());
        cells.extend(curve.values.iter().map(|row| cell(row).unwrap_or_default()));
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// Everything in one object.
pub(super) fn json(request: &Request, curve: &Curve) -> String {
    let solution = request.solution;
    let over = request.sweep.iter().flat_map(|sweep| {
        sweep.keys.iter().enumerate().map(|(i, key)| {
            let values: Vec<_> = sweep.points.iter().map(|point| point[i]).collect();
            json!({ "key": key, "values": values })
        })
    });
    let quantities = request.quantities.iter().zip(&curve.values).map(|(quantity, values)| {
        let unit = solution.unit_of(quantity);
        json!({ "name": name(quantity), "unit": unit, "values": values })
    });
    let value = json!({
        "name": solution.name,
        "summary": solution.summary,
        "exact": solution.approximate.is_none(),
        "validity": solution.approximate,
        "inputs": request.inputs,
        "over": over.collect::<Vec<_>>(),
        "quantities": quantities.collect::<Vec<_>>(),
    });
    format!("{value:#}")
}

/// A plot; it needs a sweep.
pub(super) fn svg(
    request: &Request,
    curve: &Curve,
    args: &ReferenceArgs,
) -> Result<String, Failure> {
    let Some(sweep) = &request.sweep else {
        return Err(Failure::with_help("a plot needs a range", "--over KEY=A..B:N"));
    };
    let axis = |label: String, logarithmic: bool| {
        if logarithmic { Axis::logarithmic(label) } else { Axis::linear(label) }
    };
    let [only] = sweep.keys.as_slice() else { return steps(request, curve, args) };
    let series = request.quantities.iter().zip(&curve.values).map(|(quantity, values)| {
        let points = sweep.points.iter().zip(values);
        let points = points.map(|(point, value)| (point[0], value.unwrap_or(f64::NAN)));
        Series::new(legend(request, quantity), Mark::Line, points.collect())
    });
    draw(request, axis(only.clone(), args.log_x), args, series.collect())
}

/// Bins, as steps.
fn steps(request: &Request, curve: &Curve, args: &ReferenceArgs) -> Result<String, Failure> {
    let bins = request.sweep.as_ref().map_or(&[][..], |sweep| &sweep.points);
    let series = request.quantities.iter().zip(&curve.values).map(|(quantity, values)| {
        let both_ends = bins.iter().zip(values).flat_map(|(bin, value)| {
            let value = value.unwrap_or(f64::NAN);
            [(bin[0], value), (bin[1], value)]
        });
        Series::new(legend(request, quantity), Mark::Line, both_ends.collect())
    });
    let label = "t, bin by bin".to_owned();
    let axis = if args.log_x { Axis::logarithmic(label) } else { Axis::linear(label) };
    draw(request, axis, args, series.collect())
}

/// What a curve is called; a single one needs no legend.
fn legend(request: &Request, quantity: &Quantity) -> String {
    match request.quantities.len() {
        1 => String::new(),
        _ => format!("{} [{}]", name(quantity), request.solution.unit_of(quantity)),
    }
}

fn draw(
    request: &Request,
    x: Axis,
    args: &ReferenceArgs,
    series: Vec<Series>,
) -> Result<String, Failure> {
    let solution = request.solution;
    let label = match request.quantities.as_slice() {
        [only] => format!("{} [{}]", name(only), solution.unit_of(only)),
        _ => "see the legend".to_owned(),
    };
    let approximate = if solution.approximate.is_some() { " (approximate)" } else { "" };
    let chart = Chart {
        title: format!("{}{approximate}", solution.name),
        x,
        y: if args.log_y { Axis::logarithmic(label) } else { Axis::linear(label) },
        series,
    };
    chart.svg(PLOT_SIZE).map_err(|error| Failure::input(error.to_string()))
}
