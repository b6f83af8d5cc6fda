//! Error numbers of a result x against a reference r, over all cells and over the steady image.
//!
//! With d = x − r, sums over n cells (pixels, bins, channels), ε = 1 % of the mean of |r| over the
//! cells where r ≠ 0:
//!
//! | name | formula |
//! | --- | --- |
//! | RMSE | √(Σd²/n) |
//! | NMSE | Σd²/Σr² |
//! | relative MSE | (1/n) Σ d²/(r² + ε²) |
//! | MAPE | (1/n) Σ abs(d)/(abs(r) + ε) |
//! | SMAPE | (1/n) Σ 2 abs(d)/(abs(x) + abs(r) + ε) |
//! | bias | Σd/Σr |
//!
//! Where the variance v of x is known, NMSE splits into what noise is expected to make of it,
//! Σ(v_x + v_r)/Σr², and the rest, an unbiased estimate of the squared bias (the errors of x and r
//! being independent). This needs nothing about correlations between cells; a reference without
//! variance counts as exact. The bias has a 95 % interval by Student's t ([`crate::interval`]), in two
//! forms: with the standard error of independent cells, √Σ(v_x + v_r), and with the widest possible,
//! √((Σ√v_x)² + (Σ√v_r)²), of cells that move together within x and within r. Where x and r share
//! random numbers, noise and intervals do not exist: [`Metrics::without_noise`].
//!
//! Cells that are not finite in x or r are left out and counted.

use rayon::prelude::*;
use serde::Serialize;
use tpb_film::Arrays;
use tpb_statistics::VarianceSum;

use crate::interval::{Estimate, half};

/// Part of the mean of |r| that keeps relative errors finite.
pub(crate) const EPSILON: f64 = 1e-2;

/// Half the width of a 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Half {
    /// If the errors of all cells are independent.
    pub independent: f64,
    /// At most, however cells move together.
    pub bound: f64,
}

/// Error numbers; `None` where they do not exist (a black reference, no variance).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Metrics {
    /// Cells counted.
    pub cells: usize,
    /// Cells left out, since one of the two is not finite there.
    pub left_out: usize,
    /// ε, in the unit of the cells.
    pub epsilon: f64,
    /// Root of the mean squared error, in the unit of the cells.
    pub rmse: Option<f64>,
    /// Normalised mean squared error.
    pub nmse: Option<f64>,
    /// What of it noise is expected to make.
    pub noise: Option<f64>,
    /// The rest: an estimate of the squared bias; it may be negative.
    pub squared_bias: Option<f64>,
    /// Mean squared relative error.
    pub relative_mse: Option<f64>,
    /// Mean absolute relative error.
    pub mape: Option<f64>,
    /// The same, symmetric.
    pub smape: Option<f64>,
    /// Relative difference of the sums.
    pub bias: Option<f64>,
    /// Its 95 % interval.
    pub bias_half: Option<Half>,
}

/// Errors bin by bin, or by groups of bins.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameCurves {
    /// Bins in a group; the last may have fewer.
    pub group: usize,
    /// Mean of a bin over pixels, channels and the bins of each group.
    pub mean: Vec<f64>,
    /// NMSE over the cells of each group; `None` where the reference is black, or there is none.
    pub nmse: Vec<Option<f64>>,
    /// Relative difference of the sums of each group.
    pub bias: Vec<Option<f64>>,
}

/// Sums over cells.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    cells: usize,
    left_out: usize,
    lit: usize,
    x: f64,
    r: f64,
    magnitude: f64,
    squares_of_r: f64,
    squares: f64,
    relative_squares: f64,
    relative: f64,
    symmetric: f64,
    variances: [Variances; 2],
}

/// Sums of the variances of a result, or of the reference.
#[derive(Clone, Copy, Debug, Default)]
struct Variances {
    sum: f64,
    squares: f64,
    deviations: f64,
}

impl Variances {
    fn add(&mut self, variance: f64) {
        self.sum += variance;
        self.squares += variance * variance;
        self.deviations += variance.sqrt();
    }

    fn merge(&mut self, other: &Self) {
        self.sum += other.sum;
        self.squares += other.squares;
        self.deviations += other.deviations;
    }
}

/// One cell: result, reference, variances of both.
#[derive(Clone, Copy)]
struct Pair {
    x: f64,
    r: f64,
    variances: [f64; 2],
}

impl Sums {
    /// What ε is made of.
    fn add_scale(&mut self, Pair { x, r, .. }: Pair) {
        if x.is_finite() && r.is_finite() && r != 0.0 {
            self.lit += 1;
            self.magnitude += r.abs();
        }
    }

    fn add(&mut self, Pair { x, r, variances }: Pair, epsilon: f64) {
        if !(x.is_finite() && r.is_finite()) {
            self.left_out += 1;
            return;
        }
        let d = x - r;
        self.cells += 1;
        self.x += x;
        self.r += r;
        self.squares_of_r += r * r;
        self.squares += d * d;
        for (sums, variance) in self.variances.iter_mut().zip(variances) {
            sums.add(variance);
        }
        // A black reference has no ε: 0/0 of black cells counts as no error.
        if d != 0.0 {
            self.relative_squares += d * d / (r * r + epsilon * epsilon);
            self.relative += d.abs() / (r.abs() + epsilon);
            self.symmetric += 2.0 * d.abs() / (x.abs() + r.abs() + epsilon);
        }
    }

    fn merge(mut self, other: &Self) -> Self {
        self.cells += other.cells;
        self.left_out += other.left_out;
        self.lit += other.lit;
        self.x += other.x;
        self.r += other.r;
        self.magnitude += other.magnitude;
        self.squares_of_r += other.squares_of_r;
        self.squares += other.squares;
        self.relative_squares += other.relative_squares;
        self.relative += other.relative;
        self.symmetric += other.symmetric;
        for (sums, others) in self.variances.iter_mut().zip(&other.variances) {
            sums.merge(others);
        }
        self
    }

    /// With the degrees of freedom of both variances, if that of x is known.
    fn metrics(&self, epsilon: f64, freedoms: Option<[f64; 2]>) -> Metrics {
        let ratio = |a: f64, b: f64| Some(a / b).filter(|value| value.is_finite());
        let n = self.cells as f64;
        let nmse = ratio(self.squares, self.squares_of_r);
        let variance = self.variances.iter().map(|variances| variances.sum).sum();
        let noise = freedoms.and_then(|_| ratio(variance, self.squares_of_r));
        let mean = |sum: f64| ratio(sum, n).filter(|_| epsilon > 0.0);
        Metrics {
            cells: self.cells,
            left_out: self.left_out,
            epsilon,
            rmse: ratio(self.squares, n).map(f64::sqrt),
            nmse,
            noise,
            squared_bias: nmse.zip(noise).map(|(nmse, noise)| nmse - noise),
            relative_mse: mean(self.relative_squares),
            mape: mean(self.relative),
            smape: mean(self.symmetric),
            bias: ratio(self.x - self.r, self.r),
            bias_half: freedoms.and_then(|freedoms| {
                let (independent, bound) = self.half_widths(freedoms)?;
                let relative = |half: f64| ratio(half, self.r.abs());
                Some(Half { independent: relative(independent)?, bound: relative(bound)? })
            }),
        }
    }

    /// Half widths of the intervals of Σd: cells independent, and at most.
    fn half_widths(&self, freedoms: [f64; 2]) -> Option<(f64, f64)> {
        let (mut independent, mut bound) = (VarianceSum::default(), VarianceSum::default());
        for (variances, freedom) in self.variances.iter().zip(freedoms) {
            independent = independent.and_many(variances.sum, variances.squares, freedom);
            bound = bound.and(variances.deviations * variances.deviations, freedom);
        }
        // A sum of many cells has more freedom than any of them; the bound holds for all that.
        let bound = half(bound)?;
        Some((half(independent)?.min(bound), bound))
    }
}

/// Sums over the chosen pixels, in an order that no thread changes.
fn over_pixels(
    pixels: usize,
    judged: Option<&[bool]>,
    add: impl Fn(&mut Sums, usize) + Sync,
) -> Sums {
    let chunk = pixels.div_ceil(64).max(1);
    let starts: Vec<usize> = (0..pixels).step_by(chunk).collect();
    let parts: Vec<Sums> = starts
        .par_iter()
        .map(|&start| {
            let mut sums = Sums::default();
            for pixel in start..(start + chunk).min(pixels) {
                if judged.is_none_or(|judged| judged[pixel]) {
                    add(&mut sums, pixel);
                }
            }
            sums
        })
        .collect();
    parts.iter().fold(Sums::default(), Sums::merge)
}

fn measure(
    x: &Arrays,
    judged: Option<&[bool]>,
    size: usize,
    pair: impl Fn(usize) -> Pair + Sync,
    freedoms: Option<[f64; 2]>,
) -> Metrics {
    let cells = |pixel: usize| pixel * size..(pixel + 1) * size;
    let scale = over_pixels(x.pixels(), judged, |sums, pixel| {
        cells(pixel).for_each(|cell| sums.add_scale(pair(cell)));
    });
    let epsilon = if scale.lit == 0 { 0.0 } else { EPSILON * scale.magnitude / scale.lit as f64 };
    let sums = over_pixels(x.pixels(), judged, |sums, pixel| {
        cells(pixel).for_each(|cell| sums.add(pair(cell), epsilon));
    });
    sums.metrics(epsilon, freedoms)
}

impl Metrics {
    /// Over the bins of the chosen pixels (all if `None`). Both have the same shape
    /// ([`Comparison::check`](crate::Comparison::check)).
    pub fn of_cube<'a>(
        x: impl Into<Estimate<'a>>,
        r: impl Into<Estimate<'a>>,
        judged: Option<&[bool]>,
    ) -> Self {
        let (x, r) = (x.into(), r.into());
        let freedoms = x.arrays.variance.is_some().then(|| [x.freedom(), r.freedom()]);
        let (x, r) = (x.arrays, r.arrays);
        let variance_of = |arrays: &Arrays, cell: usize| {
            arrays.variance.as_ref().map_or(0.0, |variance| f64::from(variance[cell]))
        };
        let pair = |cell: usize| Pair {
            x: f64::from(x.transient[cell]),
            r: f64::from(r.transient[cell]),
            variances: [variance_of(x, cell), variance_of(r, cell)],
        };
        measure(x, judged, x.bins * x.channels, pair, freedoms)
    }

    /// Over the steady image; its variance is not kept.
    pub fn of_steady(x: &Arrays, r: &Arrays, judged: Option<&[bool]>) -> Self {
        let pair = |cell: usize| Pair { x: x.steady[cell], r: r.steady[cell], variances: [0.0; 2] };
        measure(x, judged, x.channels, pair, None)
    }

    /// Without what rests on independent errors of x and r: where they share random numbers.
    #[must_use]
    pub fn without_noise(self) -> Self {
        Self { noise: None, squared_bias: None, bias_half: None, ..self }
    }
}

impl FrameCurves {
    /// Over all pixels and channels that are finite, `group` bins together; 1 is bin by bin.
    pub fn new(x: &Arrays, reference: Option<&Arrays>, group: usize) -> Self {
        let group = group.max(1);
        let sums = sums_of_groups(x, reference.unwrap_or(x), group);
        let judged = |value: Option<f64>| value.filter(|_| reference.is_some());
        let metrics: Vec<Metrics> = sums.iter().map(|sums| sums.metrics(1.0, None)).collect();
        Self {
            group,
            mean: sums.iter().map(|sums| sums.x / sums.cells.max(1) as f64).collect(),
            nmse: metrics.iter().map(|metrics| judged(metrics.nmse)).collect(),
            bias: metrics.iter().map(|metrics| judged(metrics.bias)).collect(),
        }
    }
}

/// Sums over all pixels, for each group of bins, in an order that no thread changes.
fn sums_of_groups(x: &Arrays, r: &Arrays, group: usize) -> Vec<Sums> {
    let size = x.bins * x.channels;
    if size == 0 {
        return Vec::new();
    }
    let groups = x.bins.div_ceil(group);
    let chunk = x.pixels().div_ceil(64) * size;
    let cells = x.transient.par_chunks(chunk).zip(r.transient.par_chunks(chunk));
    let parts: Vec<Vec<Sums>> = cells
        .map(|(x_cells, r_cells)| {
            let mut sums = vec![Sums::default(); groups];
            for (at, (&x_cell, &r_cell)) in x_cells.iter().zip(r_cells).enumerate() {
                let (value, truth) = (f64::from(x_cell), f64::from(r_cell));
                let pair = Pair { x: value, r: truth, variances: [0.0; 2] };
                sums[at % size / x.channels / group].add(pair, 1.0);
            }
            sums
        })
        .collect();
    let all = |at: usize| parts.iter().fold(Sums::default(), |sum, part| sum.merge(&part[at]));
    (0..groups).map(all).collect()
}

#[cfg(test)]
mod tests;
