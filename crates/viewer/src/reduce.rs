//! Smaller arrays: box means over pixels, sums over bins, by whole factors.
//!
//! A reduced pixel is the mean of a block of pixels, a reduced bin the sum of a group of bins; at
//! the right, lower and last ends blocks and groups may be smaller, and means are over what is
//! there. Hence a reduced cell is what a film with larger pixels and bins would hold, and bins +
//! before + after = steady stays true. Radiance at upper edges is that of a group's last edge.
//!
//! Variance: the covariances of cells are unknown. `sd(Σ a_i X_i) ≤ Σ |a_i| sd(X_i)` always, so the
//! reduced standard error is an upper bound: exact where cells move together, too wide by the
//! square root of their number where they are independent. Where pixels are known to be
//! independent ([`PixelErrors`]), the bound is taken over the bins of a pixel only.

use std::ops::Range;

use rayon::prelude::*;
use tpb_film::{Arrays, Quantity};

/// No axis of a page is longer: a streak has a canvas with a pixel for each of its cells, and
/// browsers draw none larger than 2^14 on a side.
pub(crate) const LONGEST: usize = 1 << 14;

/// By how much arrays are reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Factors {
    /// Side of a block of pixels.
    pub pixels: usize,
    /// Bins in a group.
    pub bins: usize,
}

impl Factors {
    /// Nothing is reduced.
    pub const NONE: Self = Self { pixels: 1, bins: 1 };

    /// Cells that become one.
    pub(crate) fn cells(self) -> usize {
        self.pixels.saturating_mul(self.pixels).saturating_mul(self.bins)
    }

    /// All that make sense for a shape, the gentlest first: none leaves an axis longer than
    /// [`LONGEST`], no axis is reduced by more than is
    /// needed, and pixels, which are looked at, are spared more than bins; what an axis without
    /// more to give leaves, the other takes. A few thousand at most, whatever the shape.
    pub(crate) fn all(arrays: &Arrays) -> Vec<Self> {
        let (side, all_bins) = (arrays.width.max(arrays.height), arrays.bins.max(1));
        // What is needed whatever the budget; the rest goes on from there.
        let needed = Self { pixels: side.div_ceil(LONGEST), bins: all_bins.div_ceil(LONGEST) };
        let ends = (side, all_bins);
        let (longest, all_bins) = (side.div_ceil(needed.pixels), all_bins.div_ceil(needed.bins));
        let balanced = |f: &Self| {
            let (least, most) = (f.pixels.min(f.bins), f.pixels.max(f.bins));
            let spent = |factor: usize, end: usize| factor == least && factor == end;
            most <= 4 * least || spent(f.pixels, longest) || spent(f.bins, all_bins)
        };
        let mut all: Vec<Self> = steps(longest)
            .into_iter()
            .flat_map(|pixels| steps(all_bins).into_iter().map(move |bins| Self { pixels, bins }))
            .filter(balanced)
            .collect();
        all.sort_by_key(|f| ((3 * f.pixels).max(2 * f.bins), f.cells()));
        for f in &mut all {
            f.pixels = (f.pixels * needed.pixels).min(ends.0);
            f.bins = (f.bins * needed.bins).min(ends.1);
        }
        all
    }
}

/// Factors from 1 up to `end`: all small ones, then each an eighth larger than the one before.
fn steps(end: usize) -> Vec<usize> {
    let next = |&factor: &usize| (factor < end).then(|| (factor + (factor / 8).max(1)).min(end));
    std::iter::successors(Some(1), next).collect()
}

/// What is known of the errors of neighbouring pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelErrors {
    /// Nothing: they may err together, as where a beam crosses many pixels.
    #[default]
    Together,
    /// They are independent: each pixel has samples of its own.
    Independent,
}

/// Reduces arrays; a factor of 0 counts as 1.
pub fn reduce(arrays: &Arrays, factors: Factors, errors: PixelErrors) -> Arrays {
    let rows: Vec<usize> = (0..arrays.height.div_ceil(factors.pixels.max(1))).collect();
    reduce_rows(arrays, factors, errors, &rows)
}

/// Some rows of the reduced arrays.
pub(crate) fn reduce_rows(
    arrays: &Arrays,
    factors: Factors,
    errors: PixelErrors,
    rows: &[usize],
) -> Arrays {
    let factors = Factors { pixels: factors.pixels.max(1), bins: factors.bins.max(1) };
    let blocks = Blocks { arrays, factors };
    let bins = arrays.bins.div_ceil(factors.bins);
    Arrays {
        width: blocks.width(),
        height: rows.len(),
        bins,
        channels: arrays.channels,
        quantity: arrays.quantity,
        opl_edges: edges_of_groups(&arrays.opl_edges, factors.bins),
        transient: blocks.cube(rows, &arrays.transient, Cells::Values),
        variance: arrays
            .variance
            .as_ref()
            .map(|variance| blocks.cube(rows, variance, Cells::Variances(errors))),
        before: blocks.image(rows, &arrays.before),
        after: blocks.image(rows, &arrays.after),
        steady: blocks.image(rows, &arrays.steady),
    }
}

/// Edges of groups of bins.
pub(crate) fn edges_of_groups(edges: &[f64], group: usize) -> Vec<f64> {
    let last = edges.len().saturating_sub(1);
    (0..=last)
        .step_by(group)
        .chain((!last.is_multiple_of(group)).then_some(last))
        .filter_map(|edge| edges.get(edge).copied())
        .collect()
}

/// What cells are, and so how they add up: within a pixel, over its block, and to a mean.
#[derive(Clone, Copy)]
enum Cells {
    Values,
    /// Added up as standard errors.
    Variances(PixelErrors),
}

impl Cells {
    /// What is added over the bins of a group.
    fn read(self, cell: f32) -> f64 {
        match self {
            Self::Values => f64::from(cell),
            Self::Variances(_) => f64::from(cell).sqrt(),
        }
    }

    /// What is added over the pixels of a block.
    fn of_pixel(self, sum: f64) -> f64 {
        if let Self::Variances(PixelErrors::Independent) = self { sum * sum } else { sum }
    }

    /// The reduced cell.
    fn mean(self, sum: f64, pixels: f64) -> f32 {
        let mean = sum / pixels;
        match self {
            Self::Values => mean as f32,
            Self::Variances(PixelErrors::Together) => (mean * mean) as f32,
            Self::Variances(PixelErrors::Independent) => (mean / pixels) as f32,
        }
    }
}

/// Pixels in blocks, bins in groups.
struct Blocks<'a> {
    arrays: &'a Arrays,
    factors: Factors,
}

impl Blocks<'_> {
    fn width(&self) -> usize {
        self.arrays.width.div_ceil(self.factors.pixels)
    }

    /// The pixels of a block.
    fn pixels(&self, row: usize, column: usize) -> impl Iterator<Item = usize> + use<'_> {
        let side = self.factors.pixels;
        let within =
            |at: usize, end: usize| -> Range<usize> { at * side..((at + 1) * side).min(end) };
        let columns = within(column, self.arrays.width);
        within(row, self.arrays.height)
            .flat_map(move |y| columns.clone().map(move |x| y * self.arrays.width + x))
    }

    /// Means over blocks of sums over groups.
    fn cube(&self, rows: &[usize], cells: &[f32], kind: Cells) -> Vec<f32> {
        let Arrays { bins, channels, quantity, .. } = *self.arrays;
        if self.factors == Factors::NONE && rows.len() == self.arrays.height {
            return cells.to_vec();
        }
        let size = bins.div_ceil(self.factors.bins) * channels;
        let mut out = vec![0.0; rows.len() * self.width() * size];
        if size == 0 {
            return out;
        }
        let last_only = quantity == Quantity::RadianceAtUpperEdges;
        let counts = |bin: usize| {
            !last_only || (bin + 1).is_multiple_of(self.factors.bins) || bin + 1 == bins
        };
        out.par_chunks_exact_mut(size).enumerate().for_each(|(at, out)| {
            let (mut sums, mut groups) = (vec![0.0; size], vec![0.0; size]);
            let mut pixels = 0.0;
            for pixel in self.pixels(rows[at / self.width()], at % self.width()) {
                pixels += 1.0;
                let cells = &cells[pixel * bins * channels..(pixel + 1) * bins * channels];
                for (bin, cell) in cells.chunks_exact(channels).enumerate() {
                    if counts(bin) {
                        let first = bin / self.factors.bins * channels;
                        for (group, &value) in groups[first..].iter_mut().zip(cell) {
                            *group += kind.read(value);
                        }
                    }
                }
                for (sum, group) in sums.iter_mut().zip(&mut groups) {
                    *sum += kind.of_pixel(std::mem::take(group));
                }
            }
            for (out, sum) in out.iter_mut().zip(sums) {
                *out = kind.mean(sum, pixels);
            }
        });
        out
    }

    fn image(&self, rows: &[usize], image: &[f64]) -> Vec<f64> {
        let channels = self.arrays.channels;
        if image.is_empty() {
            return Vec::new();
        }
        let mut out = Vec::with_capacity(rows.len() * self.width() * channels);
        for &row in rows {
            for column in 0..self.width() {
                for channel in 0..channels {
                    let values = self.pixels(row, column).map(|p| image[p * channels + channel]);
                    let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
                    out.push(sum / count);
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{cube, with_error};

    /// The reduced cell by its definition.
    fn expected(arrays: &Arrays, f: Factors, y: usize, x: usize, t: usize, c: usize) -> f64 {
        let (mut sum, mut pixels) = (0.0, 0.0);
        for row in (y * f.pixels..(y + 1) * f.pixels).filter(|&row| row < arrays.height) {
            for column in (x * f.pixels..(x + 1) * f.pixels).filter(|&x| x < arrays.width) {
                pixels += 1.0;
                for bin in (t * f.bins..(t + 1) * f.bins).filter(|&bin| bin < arrays.bins) {
                    let pixel = arrays.pixel(row * arrays.width + column);
                    sum += f64::from(pixel[bin * arrays.channels + c]);
                }
            }
        }
        sum / pixels
    }

    #[test]
    fn cells_are_means_of_sums_also_at_the_ends() {
        let arrays = cube(7, 5, 11, 3);
        for factors in [(2, 3), (3, 1), (1, 4), (7, 11), (1, 1)] {
            let factors = Factors { pixels: factors.0, bins: factors.1 };
            let small = reduce(&arrays, factors, PixelErrors::Together);
            assert_eq!(small.width, 7_usize.div_ceil(factors.pixels));
            assert_eq!(small.opl_edges.len(), small.bins + 1);
            assert_eq!(small.opl_edges.first(), arrays.opl_edges.first());
            assert_eq!(small.opl_edges.last(), arrays.opl_edges.last());
            for y in 0..small.height {
                for x in 0..small.width {
                    for at in 0..small.bins * 3 {
                        let found = f64::from(small.pixel(y * small.width + x)[at]);
                        let exact = expected(&arrays, factors, y, x, at / 3, at % 3);
                        assert!((found - exact).abs() <= 1e-7 * exact, "{factors:?} {y} {x} {at}");
                    }
                }
            }
        }
    }

    #[test]
    fn bins_still_add_up_to_the_steady_image() {
        let arrays = cube(9, 6, 20, 1);
        let small = reduce(&arrays, Factors { pixels: 4, bins: 3 }, PixelErrors::Together);
        for pixel in 0..small.pixels() {
            let inside: f64 = small.pixel(pixel).iter().map(|&cell| f64::from(cell)).sum();
            let sum = inside + small.before[pixel] + small.after[pixel];
            assert!((sum / small.steady[pixel] - 1.0).abs() < 1e-6, "{pixel}");
        }
    }

    #[test]
    fn the_standard_error_is_that_of_cells_that_move_together() {
        let arrays = with_error(cube(8, 8, 12, 1), 0.1);
        let small = reduce(&arrays, Factors { pixels: 2, bins: 2 }, PixelErrors::Together);
        let variance = small.variance.unwrap();
        for (cell, variance) in small.transient.iter().zip(variance) {
            assert!((variance.sqrt() - 0.1 * cell).abs() <= 1e-6 * cell, "{cell} {variance}");
        }
    }

    #[test]
    fn independent_pixels_err_less_together() {
        let mut arrays = cube(4, 2, 2, 1);
        arrays.transient.fill(1.0);
        // Standard errors 1, 2, 3, … 16.
        arrays.variance = Some((1..=16_u8).map(|s| f32::from(s).powi(2)).collect());
        let small = reduce(&arrays, Factors { pixels: 2, bins: 2 }, PixelErrors::Independent);
        // The first block: pixels 0, 1, 4, 5 with bins 1 + 2, 3 + 4, 9 + 10, 11 + 12.
        let exact = f32::from(9_u16 + 49 + 361 + 529) / 16.0;
        assert_eq!(small.variance.unwrap()[0], exact);
    }

    #[test]
    fn radiance_keeps_the_last_edge_of_a_group() {
        let mut arrays = cube(1, 1, 5, 1);
        arrays.quantity = Quantity::RadianceAtUpperEdges;
        arrays.transient = vec![1.0, 2.0, 3.0, 4.0, 5.0];
        let small = reduce(&arrays, Factors { pixels: 1, bins: 2 }, PixelErrors::Together);
        assert_eq!(small.transient, [2.0, 4.0, 5.0]);
    }

    #[test]
    fn the_gentlest_factors_come_first() {
        let all = Factors::all(&cube(16, 16, 20, 1));
        let first: Vec<_> = all.iter().take(4).map(|f| (f.pixels, f.bins)).collect();
        assert_eq!(first, [(1, 1), (1, 2), (1, 3), (2, 1)]);
        assert_eq!(all.last().map(|f| (f.pixels, f.bins)), Some((16, 20)));
    }

    fn of_shape(width: usize, height: usize, bins: usize) -> Vec<(usize, usize)> {
        let mut arrays = cube(1, 1, 1, 1);
        (arrays.width, arrays.height, arrays.bins) = (width, height, bins);
        Factors::all(&arrays).iter().map(|f| (f.pixels, f.bins)).collect()
    }

    /// Regression: a single pixel went from groups of 4 bins straight to all of them.
    #[test]
    fn an_axis_is_reduced_step_by_step_where_the_other_is_used_up() {
        let gentle =
            |steps: &[usize]| steps.windows(2).all(|s| s[1] <= (s[0] + 1).max(s[0] * 9 / 8));
        let bins: Vec<usize> = of_shape(1, 1, 5000).into_iter().map(|f| f.1).collect();
        assert!(gentle(&bins) && bins.last() == Some(&5000), "{bins:?}");
        let pixels: Vec<usize> = of_shape(900, 2, 0).into_iter().map(|f| f.0).collect();
        assert!(gentle(&pixels) && pixels.last() == Some(&900), "{pixels:?}");
        let wide: Vec<usize> =
            of_shape(900, 2, 2).into_iter().filter(|f| f.1 == 2).map(|f| f.0).collect();
        assert!(gentle(&wide) && wide.last() == Some(&900), "{wide:?}");
        assert!(!of_shape(64, 64, 100).contains(&(1, 100)), "no axis alone");
    }

    /// Regression: long thin cubes made as many candidates as they have cells.
    #[test]
    fn candidates_are_few_whatever_the_shape() {
        for (width, bins) in [(100_000, 50_000), (1, 1 << 40), (1 << 30, 1 << 30)] {
            let all = of_shape(width, 1, bins);
            assert!(all.len() < 10_000, "{width} x {bins}: {}", all.len());
            let first = (width.div_ceil(LONGEST), bins.div_ceil(LONGEST));
            assert_eq!(all.first(), Some(&first));
            assert!(all.contains(&(width, bins)), "down to one cell");
            let drawn = |f: &(usize, usize)| {
                width.div_ceil(f.0) <= LONGEST && bins.div_ceil(f.1) <= LONGEST
            };
            assert!(all.iter().all(drawn), "{width} x {bins}");
        }
    }
}
