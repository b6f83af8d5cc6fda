//! Samples in a histogram against the integral of their density over each cell.
//!
//! The domain is a rectangle of one or two coordinates; curved domains are given in coordinates
//! that fill one (cosine and azimuth, radius and azimuth), their Jacobian in the density. Expected
//! counts come from adaptive 5 × 5 Gauss-Legendre rules, fine enough to be no part of the error;
//! a sample outside the domain, or one where nothing can be, fails the test at once, and so does
//! a density that does not integrate to 1.

use std::f64::consts::PI;

use rayon::prelude::*;
use tpb_optics::Stream;

use super::Draws;
use crate::statistics::chi_square;

/// Samples are drawn in so many independent streams.
const STREAMS: u64 = 64;

/// Levels of subdivision of a cell.
const DEPTH: u32 = 14;

/// A rectangle cut into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// Range of the first coordinate.
    pub x: [f64; 2],
    /// Range of the second coordinate.
    pub y: [f64; 2],
    /// Cells along each; odd numbers, so that no cell's edge lies on a symmetry axis.
    pub cells: [usize; 2],
}

impl Grid {
    /// Cosine and azimuth over the whole sphere.
    pub(super) const SPHERE: Self = Self { x: [-1.0, 1.0], y: [-PI, PI], cells: [31, 41] };

    /// One coordinate from 0 to 1.
    pub(super) const UNIT: Self = Self { x: [0.0, 1.0], y: [0.0, 1.0], cells: [101, 1] };

    /// Two coordinates from 0 to 1.
    pub(super) const SQUARE: Self = Self { x: [0.0, 1.0], y: [0.0, 1.0], cells: [21, 21] };

    /// A range of one coordinate.
    pub(super) const fn line(x: [f64; 2], cells: usize) -> Self {
        Self { x, y: [0.0, 1.0], cells: [cells, 1] }
    }

    /// Cosine in a range, and azimuth.
    pub(super) const fn band(x: [f64; 2]) -> Self {
        Self { x, y: [-PI, PI], cells: [21, 31] }
    }

    fn cell(&self, point: [f64; 2]) -> Option<usize> {
        let index = |value: f64, [low, high]: [f64; 2], cells: usize| {
            let position = (value - low) / (high - low);
            // The upper end belongs to the last cell; NaN to none.
            let inside = (0.0..=1.0).contains(&position);
            inside.then(|| ((position * cells as f64) as usize).min(cells - 1))
        };
        let x = index(point[0], self.x, self.cells[0])?;
        Some(x * self.cells[1] + index(point[1], self.y, self.cells[1])?)
    }

    /// The point with its share of the first range raised to a power.
    fn warped(&self, [x, y]: [f64; 2], exponent: f64) -> [f64; 2] {
        let [low, high] = self.x;
        let share = (x - low) / (high - low);
        // Without a power nothing is touched, not even by rounding.
        if exponent == 1.0 { [x, y] } else { [low + (high - low) * share.powf(exponent), y] }
    }

    fn corners(&self, cell: usize) -> [[f64; 2]; 2] {
        let edge = |i: usize, [low, high]: [f64; 2], cells: usize| {
            low + (high - low) * i as f64 / cells as f64
        };
        let (i, j) = (cell / self.cells[1], cell % self.cells[1]);
        let along = |i, range, cells| [edge(i, range, cells), edge(i + 1, range, cells)];
        [along(i, self.x, self.cells[0]), along(j, self.y, self.cells[1])]
    }
}

/// The p value of one sampler's test.
#[derive(Clone, Debug, PartialEq)]
pub struct Tested {
    /// Which sampler.
    pub name: String,
    /// The statistic and its degrees of freedom, as text.
    pub detail: String,
    /// P(a worse fit) if the sampler is right.
    pub p: f64,
}

impl Tested {
    /// Of an exact claim.
    pub fn exact(name: impl Into<String>, holds: bool) -> Self {
        let detail = if holds { "holds" } else { "VIOLATED" };
        Self { name: name.into(), detail: detail.into(), p: if holds { 1.0 } else { 0.0 } }
    }

    /// Of counts against probabilities.
    pub fn discrete(name: impl Into<String>, counts: &[u64], probabilities: &[f64]) -> Self {
        let total: u64 = counts.iter().sum();
        let expected: Vec<f64> = probabilities.iter().map(|p| p * total as f64).collect();
        let test = chi_square(counts, &expected);
        let detail = format!("chi2 {:.1} of {}", test.statistic, test.freedom);
        Self { name: name.into(), detail, p: test.p }
    }
}

/// Draws samples and tests them against their density.
pub(super) fn test(
    name: impl Into<String>,
    grid: Grid,
    samples: u64,
    seed: Draws,
    sample: impl Fn(&mut Stream) -> [f64; 2] + Sync,
    density: impl Fn(f64, f64) -> f64 + Sync,
) -> Tested {
    compare(name.into(), grid, (samples, seed), |rng| Some(sample(rng)), density, |_| 0.0)
}

/// The same where some samples are none, or belong elsewhere: the density falls short of 1 by
/// their share.
pub(super) fn test_part(
    name: impl Into<String>,
    grid: Grid,
    samples: u64,
    seed: Draws,
    sample: impl Fn(&mut Stream) -> Option<[f64; 2]> + Sync,
    density: impl Fn(f64, f64) -> f64 + Sync,
) -> Tested {
    compare(name.into(), grid, (samples, seed), sample, density, |within| 1.0 - within)
}

/// Counts against probabilities; `beside` makes the probability of no cell from that of all cells.
fn compare(
    name: String,
    grid: Grid,
    (samples, seed): (u64, Draws),
    sample: impl Fn(&mut Stream) -> Option<[f64; 2]> + Sync,
    density: impl Fn(f64, f64) -> f64 + Sync,
    beside: impl Fn(f64) -> f64,
) -> Tested {
    // Each test has random numbers of its own.
    let item = name
        .bytes()
        .fold(0_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    let cells = grid.cells[0] * grid.cells[1];
    let counts = (0..STREAMS)
        .into_par_iter()
        .map(|stream| {
            let mut rng = Stream::new(seed.seed, stream, item);
            // One cell more for what falls outside.
            let mut counts = vec![0_u64; cells + 1];
            for _ in 0..samples / STREAMS {
                let point = sample(&mut rng).map(|point| grid.warped(point, seed.exponent));
                counts[point.and_then(|point| grid.cell(point)).unwrap_or(cells)] += 1;
            }
            counts
        })
        .reduce(|| vec![0; cells + 1], |a, b| a.iter().zip(b).map(|(a, b)| a + b).collect());
    let mut probabilities: Vec<f64> = (0..cells)
        .into_par_iter()
        .map(|cell| {
            let [x, y] = grid.corners(cell);
            integrate(&density, x, y, DEPTH)
        })
        .collect();
    probabilities.push(beside(probabilities.iter().sum()));
    Tested::discrete(name, &counts, &probabilities)
}

/// Gauss-Legendre nodes and weights on (−1, 1).
const GAUSS_5: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Adaptive integral over a rectangle.
fn integrate(f: &impl Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2], depth: u32) -> f64 {
    let whole = rule(f, x, y);
    let (mx, my) = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    let (xs, ys) = ([[x[0], mx], [mx, x[1]]], [[y[0], my], [my, y[1]]]);
    let parts: f64 =
        xs.iter().flat_map(|&x| ys.iter().map(move |&y| (x, y))).map(|(x, y)| rule(f, x, y)).sum();
    // The first levels are split in any case, lest a peak between the nodes goes unseen.
    if depth == 0 || depth < DEPTH - 2 && (parts - whole).abs() <= 1e-12 + 1e-9 * parts.abs() {
        return parts;
    }
    let halves = xs.iter().flat_map(|&x| ys.iter().map(move |&y| (x, y)));
    halves.map(|(x, y)| integrate(f, x, y, depth - 1)).sum()
}

fn rule(f: &impl Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2]) -> f64 {
    let at = |[a, b]: [f64; 2], node: f64| 0.5 * (a + b) + 0.5 * (b - a) * node;
    let mut sum = 0.0;
    for (u, wu) in GAUSS_5 {
        for (v, wv) in GAUSS_5 {
            sum += wu * wv * f(at(x, u), at(y, v));
        }
    }
    0.25 * (x[1] - x[0]) * (y[1] - y[0]) * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOUND: Draws = Draws { seed: 1, exponent: 1.0 };

    #[test]
    fn a_right_sampler_passes_and_one_two_percent_off_does_not() {
        let sampler = |power: f64| {
            test(
                "ramp",
                Grid::UNIT,
                2_000_000,
                SOUND,
                |rng| [rng.uniform().powf(power), 0.5],
                |x, _| 2.0 * x,
            )
        };
        assert!(sampler(0.5).p > 1e-6);
        assert!(sampler(0.51).p < 1e-9);
    }

    #[test]
    fn samples_outside_and_densities_that_are_not_normalised_fail() {
        let outside = test(
            "outside",
            Grid::UNIT,
            6400,
            SOUND,
            |rng| [1.001 * rng.uniform(), 0.5],
            |_, _| 1.0,
        );
        assert_eq!(outside.p, 0.0);
        let short = test("short", Grid::UNIT, 6400, SOUND, |rng| [rng.uniform(), 0.5], |_, _| 0.99);
        assert_eq!(short.p, 0.0);
    }

    #[test]
    fn peaks_are_integrated() {
        let peak = |x: f64, y: f64| (-1e4 * ((x - 0.3).powi(2) + (y - 0.4).powi(2))).exp();
        let sum = integrate(&peak, [0.2, 0.5], [0.3, 0.5], DEPTH);
        assert!((sum / (PI * 1e-4) - 1.0).abs() < 1e-8);
    }
}
