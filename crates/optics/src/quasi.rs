//! Quasi-random points: Sobol's sequence, scrambled as Owen does.
//!
//! Any 2^k successive points that start at a multiple of 2^k fill space far more evenly than random
//! ones, and each point alone is uniform: means stay unbiased (Owen 1995; by hashing: Burley 2020,
//! "Practical Hash-based Owen Scrambling"). Sequences of different seeds are independent.

use crate::rng::{LONGEST_LEAD, Stream, seed_of};

/// Points of one sequence; a longer one begins another.
const LONGEST: u64 = 1 << 16;
/// What the sequence's coordinates are multiples of: they have 23 bits.
const STEP: f64 = 1.0 / (1_u64 << 23) as f64;

/// Coordinates of a point that [`Points`] gives at once.
pub const TOGETHER: usize = 4;

/// Sets of coordinates that points have.
pub const SETS: u32 = sobol_burley::NUM_DIMENSION_SETS_4D;

/// A sequence of points.
#[derive(Clone, Copy, Debug)]
pub struct Points(u64);

impl Points {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Coordinates 4 `set` to 4 `set` + 3 of point `index`, in [0, 1); `set` is below [`SETS`]. `fill` draws
    /// what lies below the bits of the sequence.
    #[inline]
    pub fn at(self, index: u64, set: u32, fill: &mut Stream) -> [f64; TOGETHER] {
        let seed = seed_of(self.0, index / LONGEST) as u32;
        let point = sobol_burley::sample_4d((index % LONGEST) as u32, set, seed);
        let mut all = [0.0; TOGETHER];
        for (exact, coordinate) in all.iter_mut().zip(point) {
            *exact = f64::from(coordinate) + STEP * fill.uniform();
        }
        all
    }

    /// Makes the first [`LONGEST_LEAD`] coordinates of point `index` the next numbers of a stream.
    #[inline]
    pub fn lead(self, index: u64, rng: &mut Stream) {
        // What was left of an earlier lead fills nothing.
        rng.lead(&[]);
        let mut numbers = [0.0; LONGEST_LEAD];
        for (set, of_set) in (0..).zip(numbers.chunks_exact_mut(TOGETHER)) {
            of_set.copy_from_slice(&self.at(index, set, rng));
        }
        rng.lead(&numbers);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 256 points that start at a multiple of 256, one lies in each of 16 by 16 squares of the
    /// first two coordinates, also beyond the first sequence.
    #[test]
    fn successive_points_fill_squares_evenly() {
        for (seed, first) in [(1, 0), (2, 256), (3, 65_536 - 256), (3, 65_536), (4, 1 << 40)] {
            let mut fill = Stream::new(seed, 0, 0);
            let mut counts = [0; 256];
            for index in first..first + 256 {
                let [x, y, ..] = Points::new(seed).at(index, 0, &mut fill);
                assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                counts[(16.0 * x) as usize * 16 + (16.0 * y) as usize] += 1;
            }
            assert_eq!(counts, [1; 256], "seed {seed} from {first}");
        }
    }

    /// Over seeds, one point is uniform: the means of its coordinates and their products within
    /// 5 standard errors (1/√12 and √7/12 over √n); 14 checks, chance of a false alarm 8e-6.
    #[test]
    fn one_point_is_uniform_over_seeds() {
        let n = 20_000;
        let mut fill = Stream::new(9, 0, 0);
        let (mut means, mut products) = ([0.0; 4], [[0.0; 4]; 4]);
        for seed in 0..n {
            let x = Points::new(seed).at(5, 1, &mut fill);
            for (i, (mean, products)) in means.iter_mut().zip(&mut products).enumerate() {
                *mean += x[i] / n as f64;
                for (product, y) in products.iter_mut().zip(&x[..i]) {
                    *product += x[i] * y / n as f64;
                }
            }
        }
        let error = |deviation: f64| 5.0 * deviation / (n as f64).sqrt();
        for i in 0..4 {
            assert!((means[i] - 0.5).abs() < error(1.0 / 12.0_f64.sqrt()), "{means:?}");
            for product in &products[i][..i] {
                assert!((product - 0.25).abs() < error(7.0_f64.sqrt() / 12.0), "{products:?}");
            }
        }
    }
}
