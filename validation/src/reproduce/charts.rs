//! Curves of a comparison as SVG.

use tpb_plot::{Axis, Chart, Mark, PlotError, Series, message};

use super::compare::{Comparison, Part};
use crate::error::{Result, ValidationError};
use crate::statistics::split::Estimate;

/// Pixels of a chart.
const SIZE: (u32, u32) = (900, 420);
/// Widest band that is drawn, as a factor of its value: what is wider says nothing.
const WIDEST: f64 = 30.0;

/// NMSE of every bin for each method, with its interval. Bins whose error is not resolved from 0
/// leave a gap.
pub fn error_by_bin(comparison: &Comparison, title: &str) -> Result<String> {
    let series = comparison.methods.iter().enumerate().map(|(index, name)| {
        let estimate = |part: &Part| {
            let split = part.splits[index].as_ref()?;
            (split.nmse.interval[0] > 0.0 && part.share > 0.0).then_some(split.nmse)
        };
        banded(name, &comparison.frames, estimate)
    });
    chart(title, "NMSE of the bin", series.collect())
}

/// How many times less error the second method has than the first in every bin at equal CPU time.
pub fn factor_by_bin(comparison: &Comparison, title: &str) -> Result<String> {
    let estimate = |part: &Part| {
        let factor = part.factor?;
        let (value, high) = factor.value.zip(factor.high)?;
        let interval = [factor.low.max(value / WIDEST), high.min(value * WIDEST)];
        Some(Estimate { value, standard_error: 0.0, interval })
    };
    let name = match comparison.methods.as_slice() {
        [first, second, ..] => format!("{second} against {first}"),
        _ => String::new(),
    };
    let ends = comparison.frames.first().zip(comparison.frames.last());
    let even = ends.map_or(Vec::new(), |(a, b)| vec![(a.opl[0], 1.0), (b.opl[1], 1.0)]);
    let series =
        vec![banded(&name, &comparison.frames, estimate), Series::new("equal", Mark::Dashes, even)];
    chart(title, "times less NMSE \u{d7} CPU s", series)
}

/// The share of the signal in every bin.
pub fn signal_by_bin(comparison: &Comparison, title: &str) -> Result<String> {
    let points = comparison.frames.iter().map(|part| (middle(part), part.share)).collect();
    chart(title, "share of \u{3a3}r\u{b2}", vec![Series::new("", Mark::Line, points)])
}

/// NMSE against CPU time, with the squared bias where it is resolved.
pub fn error_by_time(comparison: &Comparison, title: &str) -> Result<String> {
    let mut series = Vec::new();
    for (index, name) in comparison.methods.iter().enumerate() {
        let at = || comparison.times.iter().map(|time| &time.methods[index]);
        let points = at().map(|m| (m.spent.cpu_seconds, m.judged.nmse.value)).collect();
        let band = at().map(|m| (m.judged.nmse.interval[0], m.judged.nmse.interval[1])).collect();
        series.push(Series::new(name, Mark::LineAndPoints, points).with_band(band));
        let bias: Vec<(f64, f64)> = at()
            .filter(|m| m.judged.squared_bias.interval[0] > 0.0)
            .map(|m| (m.spent.cpu_seconds, m.judged.squared_bias.value))
            .collect();
        if !bias.is_empty() {
            series.push(Series::new(format!("{name}: bias\u{b2}"), Mark::Dashes, bias));
        }
    }
    let x = Axis::logarithmic("CPU time of all threads [s]");
    draw(&Chart { title: title.to_owned(), x, y: Axis::logarithmic("NMSE"), series })
}

fn middle(part: &Part) -> f64 {
    0.5 * (part.opl[0] + part.opl[1])
}

fn banded(name: &str, parts: &[Part], of: impl Fn(&Part) -> Option<Estimate>) -> Series {
    let gap = Estimate { value: f64::NAN, standard_error: 0.0, interval: [f64::NAN; 2] };
    let estimates = || parts.iter().map(|part| (middle(part), of(part).unwrap_or(gap)));
    let points = estimates().map(|(x, e)| (x, e.value)).collect();
    let band = estimates().map(|(_, e)| (e.interval[0], e.interval[1])).collect();
    Series::new(name, Mark::Line, points).with_band(band)
}

fn chart(title: &str, what: &str, series: Vec<Series>) -> Result<String> {
    let x = Axis::linear("optical path length [m]");
    draw(&Chart { title: title.to_owned(), x, y: Axis::logarithmic(what), series })
}

/// A chart of whatever there is; one without any value says so.
fn draw(chart: &Chart) -> Result<String> {
    match chart.svg(SIZE) {
        Err(PlotError::Empty { .. }) => {
            Ok(message(&format!("{}: nothing is resolved", chart.title), SIZE))
        }
        other => other.map_err(|error| ValidationError::unusable("chart", error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::testing::comparison;
    use crate::statistics::Factor;

    #[test]
    fn resolved_errors_and_factors_are_drawn_for_both_methods() {
        let mut comparison = comparison();
        let split = comparison.times[0].methods[0].judged.clone();
        let frame = |bin: i32| Part {
            label: format!("bin {bin}"),
            opl: [f64::from(bin), f64::from(bin + 1)],
            share: 0.25,
            splits: vec![Some(split.clone()), Some(split.clone())],
            factor: Some(Factor { value: Some(2.0), low: 1.5, high: Some(3.0) }),
        };
        comparison.frames = (0..4).map(frame).collect();
        let lines = |svg: &str| svg.matches("<polyline").count();
        for svg in
            [error_by_bin(&comparison, "t").unwrap(), error_by_time(&comparison, "t").unwrap()]
        {
            assert!(svg.contains("path") && svg.contains("beams"));
            assert!(lines(&svg) >= 2, "a curve for each method");
        }
        assert!(lines(&factor_by_bin(&comparison, "t").unwrap()) >= 2, "factor, and where it is 1");
        comparison.frames.clear();
        let nothing = error_by_bin(&comparison, "t").unwrap();
        assert!(nothing.contains("nothing is resolved") && lines(&nothing) == 0);
    }
}
