//! The ends of an axis.

use crate::{Axis, Chart, PlotError, Scale, Series};

/// A range of one value is widened by this part of it, to have a length.
const WIDENING: f64 = 0.05;

/// The ends of the horizontal axis.
pub(crate) fn horizontal(chart: &Chart) -> Result<(f64, f64), PlotError> {
    let values = chart.series.iter().flat_map(|series| series.points.iter().map(|point| point.0));
    ends(&chart.x, "horizontal", values)
}

/// The ends of the vertical axis; intervals count.
pub(crate) fn vertical(chart: &Chart) -> Result<(f64, f64), PlotError> {
    let of_one = |series: &Series| -> Vec<f64> {
        let points = series.points.iter().map(|point| point.1);
        points.chain(series.band.iter().flat_map(|&(low, high)| [low, high])).collect()
    };
    ends(&chart.y, "vertical", chart.series.iter().flat_map(of_one))
}

fn ends(
    axis: &Axis,
    name: &'static str,
    values: impl Iterator<Item = f64>,
) -> Result<(f64, f64), PlotError> {
    if let Some((start, end)) = axis.range {
        let proper = axis.shows(start) && axis.shows(end) && start < end;
        return proper.then_some((start, end)).ok_or(PlotError::Range { axis: name, start, end });
    }
    let (low, high) = values
        .filter(|&value| axis.shows(value))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return Err(PlotError::Empty { axis: name });
    }
    let widened = low == high;
    Ok(match axis.scale {
        Scale::Linear if widened => {
            let half = if low == 0.0 { 1.0 } else { WIDENING * low.abs() };
            (low - half, high + half)
        }
        Scale::Logarithmic if widened => (low / 2.0, high * 2.0),
        Scale::Linear | Scale::Logarithmic => (low, high),
    })
}
