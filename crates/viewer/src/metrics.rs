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
//! variance counts as exact. The bias has an interval of ±1.96 standard errors, in two forms: cells
//! independent, √Σv, and the widest possible, Σ√v, of cells that move together.
//!
//! Cells that are not finite in x or r are left out and counted.

use rayon::prelude::*;
use serde::Serialize;
use tpb_film::Arrays;

/// Part of the mean of |r| that keeps relative errors finite.
pub(crate) const EPSILON: f64 = 1e-2;

/// Standard errors on each side of a 95 % interval.
pub(crate) const INTERVAL: f64 = 1.96;

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

/// Errors bin by bin.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameCurves {
    /// Mean over pixels and channels.
    pub mean: Vec<f64>,
    /// NMSE of each bin; `None` where the reference is black, or there is none.
    pub nmse: Vec<Option<f64>>,
    /// Relative difference of the sums of each bin.
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
    variance: f64,
    deviation: f64,
}

/// One cell: result, reference, variance of both.
#[derive(Clone, Copy)]
struct Pair {
    x: f64,
    r: f64,
    variance: f64,
}

impl Sums {
    /// What ε is made of.
    fn add_scale(&mut self, Pair { x, r, .. }: Pair) {
        if x.is_finite() && r.is_finite() && r != 0.0 {
            self.lit += 1;
            self.magnitude += r.abs();
        }
    }

    fn add(&mut self, Pair { x, r, variance }: Pair, epsilon: f64) {
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
        self.variance += variance;
        self.deviation += variance.sqrt();
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
        self.variance += other.variance;
        self.deviation += other.deviation;
        self
    }

    fn metrics(&self, epsilon: f64, variance_known: bool) -> Metrics {
        let ratio = |a: f64, b: f64| Some(a / b).filter(|value| value.is_finite());
        let n = self.cells as f64;
        let nmse = ratio(self.squares, self.squares_of_r);
        let noise = ratio(self.variance, self.squares_of_r).filter(|_| variance_known);
        let mean = |sum: f64| ratio(sum, n).filter(|_| epsilon > 0.0);
        let half = |error: f64| ratio(INTERVAL * error, self.r.abs());
        let halves = half(self.variance.sqrt()).zip(half(self.deviation));
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
            bias_half: halves
                .filter(|_| variance_known)
                .map(|(independent, bound)| Half { independent, bound }),
        }
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
    variance_known: bool,
) -> Metrics {
    let cells = |pixel: usize| pixel * size..(pixel + 1) * size;
    let scale = over_pixels(x.pixels(), judged, |sums, pixel| {
        cells(pixel).for_each(|cell| sums.add_scale(pair(cell)));
    });
    let epsilon = if scale.lit == 0 { 0.0 } else { EPSILON * scale.magnitude / scale.lit as f64 };
    let sums = over_pixels(x.pixels(), judged, |sums, pixel| {
        cells(pixel).for_each(|cell| sums.add(pair(cell), epsilon));
    });
    sums.metrics(epsilon, variance_known)
}

impl Metrics {
    /// Over the bins of the chosen pixels (all if `None`). Both have the same shape
    /// ([`Comparison::check`](crate::Comparison::check)).
    pub fn of_cube(x: &Arrays, r: &Arrays, judged: Option<&[bool]>) -> Self {
        let variance_of = |arrays: &Arrays, cell: usize| {
            arrays.variance.as_ref().map_or(0.0, |variance| f64::from(variance[cell]))
        };
        let pair = |cell: usize| Pair {
            x: f64::from(x.transient[cell]),
            r: f64::from(r.transient[cell]),
            variance: variance_of(x, cell) + variance_of(r, cell),
        };
        measure(x, judged, x.bins * x.channels, pair, x.variance.is_some())
    }

    /// Over the steady image; its variance is not kept.
    pub fn of_steady(x: &Arrays, r: &Arrays, judged: Option<&[bool]>) -> Self {
        let pair = |cell: usize| Pair { x: x.steady[cell], r: r.steady[cell], variance: 0.0 };
        measure(x, judged, x.channels, pair, false)
    }
}

impl FrameCurves {
    /// Bin by bin, over all pixels and channels that are finite.
    pub fn new(x: &Arrays, reference: Option<&Arrays>) -> Self {
        let sums = sums_of_bins(x, reference.unwrap_or(x));
        let judged = |value: Option<f64>| value.filter(|_| reference.is_some());
        let metrics: Vec<Metrics> = sums.iter().map(|sums| sums.metrics(1.0, false)).collect();
        Self {
            mean: sums.iter().map(|sums| sums.x / sums.cells.max(1) as f64).collect(),
            nmse: metrics.iter().map(|metrics| judged(metrics.nmse)).collect(),
            bias: metrics.iter().map(|metrics| judged(metrics.bias)).collect(),
        }
    }
}

/// Sums over all pixels, for each bin, in an order that no thread changes.
fn sums_of_bins(x: &Arrays, r: &Arrays) -> Vec<Sums> {
    let size = x.bins * x.channels;
    if size == 0 {
        return Vec::new();
    }
    let chunk = x.pixels().div_ceil(64) * size;
    let cells = x.transient.par_chunks(chunk).zip(r.transient.par_chunks(chunk));
    let parts: Vec<Vec<Sums>> = cells
        .map(|(x_cells, r_cells)| {
            let mut sums = vec![Sums::default(); x.bins];
            for (at, (&x_cell, &r_cell)) in x_cells.iter().zip(r_cells).enumerate() {
                let pair = Pair { x: f64::from(x_cell), r: f64::from(r_cell), variance: 0.0 };
                sums[at % size / x.channels].add(pair, 1.0);
            }
            sums
        })
        .collect();
    let all = |bin: usize| parts.iter().fold(Sums::default(), |sum, part| sum.merge(&part[bin]));
    (0..x.bins).map(all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{cube, with_error};

    #[test]
    fn numbers_follow_their_formulas() {
        let mut r = cube(2, 1, 2, 1);
        r.transient = vec![1.0, 2.0, 0.0, 5.0];
        let mut x = r.clone();
        x.transient = vec![1.5, 2.0, 1.0, 3.0];
        let found = Metrics::of_cube(&x, &r, None);
        let epsilon = 0.01 * 8.0 / 3.0;
        let squares = 0.25 + 1.0 + 4.0;
        let near = |found: Option<f64>, exact: f64| {
            assert!((found.unwrap() - exact).abs() < 1e-12 * exact.abs(), "{found:?} {exact}");
        };
        assert!((found.epsilon - epsilon).abs() < 1e-15);
        near(found.rmse, (squares / 4.0_f64).sqrt());
        near(found.nmse, squares / 30.0);
        near(found.bias, -0.5 / 8.0);
        near(found.mape, (0.5 / (1.0 + epsilon) + 1.0 / epsilon + 2.0 / (5.0 + epsilon)) / 4.0);
        let symmetric = 1.0 / (2.5 + epsilon) + 2.0 / (1.0 + epsilon) + 4.0 / (8.0 + epsilon);
        near(found.smape, symmetric / 4.0);
        let e2 = epsilon * epsilon;
        near(found.relative_mse, (0.25 / (1.0 + e2) + 1.0 / e2 + 4.0 / (25.0 + e2)) / 4.0);
        assert_eq!((found.noise, found.bias_half), (None, None));
        let steady = Metrics::of_steady(&x, &r, None);
        assert_eq!(steady.rmse, Some(0.0));
    }

    #[test]
    fn noise_is_told_from_bias() {
        let r = cube(16, 16, 20, 1);
        let relative = 0.05;
        let mut x = with_error(r.clone(), relative);
        // Errors of exactly one standard deviation, alternating, on a bias of 3 %.
        for (at, cell) in x.transient.iter_mut().enumerate() {
            *cell *= 1.03 + if at % 2 == 0 { relative } else { -relative };
        }
        let found = Metrics::of_cube(&x, &r, None);
        assert!((found.noise.unwrap() - 2.5e-3).abs() < 1e-8);
        assert!((found.squared_bias.unwrap() - 9e-4).abs() < 2e-4, "{:?}", found.squared_bias);
        let half = found.bias_half.unwrap();
        assert!((half.bound - 1.96 * 0.05).abs() < 1e-6 && half.independent < half.bound / 20.0);
    }

    #[test]
    fn what_is_not_finite_is_left_out_and_counted() {
        let r = cube(4, 4, 5, 3);
        let mut x = r.clone();
        x.transient[7] = f32::NAN;
        x.transient[100] = f32::INFINITY;
        let found = Metrics::of_cube(&x, &r, None);
        assert_eq!((found.left_out, found.cells), (2, 4 * 4 * 5 * 3 - 2));
        assert_eq!(found.nmse, Some(0.0));
    }

    #[test]
    fn judged_pixels_are_chosen_and_black_references_have_no_ratios() {
        let r = cube(3, 1, 4, 1);
        let mut x = r.clone();
        x.transient[0] += 1.0;
        let judged = [false, true, true];
        assert_eq!(Metrics::of_cube(&x, &r, Some(&judged)).rmse, Some(0.0));
        assert!(Metrics::of_cube(&x, &r, None).rmse.unwrap() > 0.1);
        let mut black = r.clone();
        black.transient.fill(0.0);
        let found = Metrics::of_cube(&x, &black, None);
        assert_eq!((found.nmse, found.mape, found.bias), (None, None, None));
        assert!(found.rmse.is_some());
    }

    #[test]
    fn curves_are_the_numbers_of_each_bin() {
        let r = cube(5, 4, 6, 3);
        let mut x = r.clone();
        x.transient.iter_mut().for_each(|cell| *cell *= 1.1);
        let curves = FrameCurves::new(&x, Some(&r));
        for bin in 0..6 {
            let lit = r.transient.chunks_exact(3).skip(bin).step_by(6).any(|cell| cell[0] > 0.0);
            assert_eq!(curves.nmse[bin].is_some(), lit);
            if lit {
                assert!((curves.nmse[bin].unwrap() - 0.01).abs() < 1e-6);
                assert!((curves.bias[bin].unwrap() - 0.1).abs() < 1e-6);
            }
        }
        assert!(FrameCurves::new(&x, None).nmse.iter().all(Option::is_none));
    }
}
