//! The slope of an error against time on logarithmic axes.
//!
//! Ordinary least squares through (ln seconds, ln error) of the checkpoints. Checkpoints of a run
//! share its samples, so their noise is correlated; the standard error is therefore the jackknife's
//! over replicates (Efron & Stein 1981), each of which is left out of all checkpoints at once.

use crate::statistics::split::Estimate;
use crate::statistics::{Gram, ReferenceNoise, regression, student};

/// ln seconds and ln error of a checkpoint: over all replicates, and with each left out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Resolved {
    all: (f64, f64),
    without: Vec<(f64, f64)>,
}

impl Resolved {
    /// Of a part of the error: 0 the whole, 1 variance, 2 squared bias.
    pub(super) fn new(
        gram: &Gram,
        reference: &ReferenceNoise,
        seconds: &[f64],
        part: usize,
    ) -> Self {
        let n = seconds.len();
        let point = |without: Option<usize>| {
            let used = (0..n).filter(|&i| Some(i) != without).map(|i| seconds[i]);
            let mean = used.sum::<f64>() / (n - usize::from(without.is_some())) as f64;
            (mean.ln(), gram.parts(reference, without)[part].ln())
        };
        Self { all: point(None), without: (0..n).map(|i| point(Some(i))).collect() }
    }
}

/// The slope; `None` for fewer than two checkpoints, or if leaving out one replicate leaves an
/// error that is not positive.
pub(super) fn slope(points: &[Resolved], confidence: f64) -> Option<Estimate> {
    if points.len() < 2 {
        return None;
    }
    let n = points[0].without.len();
    let value = regression::slope(points.iter().map(|point| point.all));
    let left_out: Vec<f64> =
        (0..n).map(|i| regression::slope(points.iter().map(|point| point.without[i]))).collect();
    let mean = left_out.iter().sum::<f64>() / n as f64;
    let squares: f64 = left_out.iter().map(|slope| (slope - mean).powi(2)).sum();
    let standard_error = (squares * (n as f64 - 1.0) / n as f64).sqrt();
    if !(value.is_finite() && standard_error.is_finite()) {
        return None;
    }
    let half = student::quantile(0.5 * (1.0 - confidence), n as f64 - 1.0) * standard_error;
    Some(Estimate { value, standard_error, interval: [value - half, value + half] })
}
