//! The error of a cube, split into variance and squared bias, none of them biased.
//!
//! Independent replicates x_1 … x_n of a cube and a reference r with known summed variance V_r,
//! independent of them. Of the residuals e_i = x_i − r only the Gram matrix g_ij = Σ_cells e_i e_j
//! is needed. With bias b, E g_ij = |b|² + V_r for i ≠ j, and E g_ii = |b|² + V_r + V, hence
//!
//! > |b|² ≈ mean_{i≠j} g_ij − V_r,   V ≈ mean_i g_ii − mean_{i≠j} g_ij,
//! > error = |b|² + V ≈ mean_i g_ii − V_r,
//!
//! which is the textbook |x̄ − r|² − V/n − V_r without its rounding. Estimates of |b|² may be
//! negative: that is noise, and it is not cut off. Divided by the signal Σr² − V_r they are parts
//! of the NMSE.
//!
//! Standard errors come from the jackknife over replicates (Efron & Stein 1981: not too small on
//! average), Student's t with n − 1 degrees of freedom. The reference's own noise is the same in
//! all replicates and is added: with v_k the summed variance of pixel k, whose cells may be
//! correlated in any way, Var |ε_r|² ≤ 2Σv_k² and Var 2b·ε_r ≤ 4|b|² max v_k, for normal noise.

use serde::{Deserialize, Serialize};

use super::student;

/// Inner products of the residuals of n replicates.
#[derive(Clone, Debug, PartialEq)]
pub struct Gram {
    /// Replicates.
    n: usize,
    /// Row by row.
    products: Vec<f64>,
}

/// What the reference itself contributes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReferenceNoise {
    /// Σr² over the cells.
    pub power: f64,
    /// Sum over cells of the variance of r, rounding included.
    pub variance: f64,
    /// Sum over pixels of their summed variance squared.
    pub squares: f64,
    /// The largest summed variance of a pixel.
    pub largest: f64,
}

impl ReferenceNoise {
    /// The power of the noise-free signal, estimated without bias.
    pub fn signal(&self) -> f64 {
        self.power - self.variance
    }
}

/// An estimate with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Its confidence interval.
    pub interval: [f64; 2],
}

/// Parts of the normalised mean squared error of one replicate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Split {
    /// NMSE: variance plus squared bias.
    pub nmse: Estimate,
    /// Variance over replicates.
    pub variance: Estimate,
    /// Squared bias.
    pub squared_bias: Estimate,
    /// One-sided p value of the hypothesis that there is no bias.
    pub p_no_bias: f64,
    /// NMSE of each replicate, the reference's noise subtracted.
    pub replicates: Vec<f64>,
}

impl Gram {
    /// From residual vectors of equal length.
    pub fn of<T: Copy + Into<f64>>(residuals: &[Vec<T>]) -> Self {
        let mut products = Vec::with_capacity(residuals.len() * residuals.len());
        for a in residuals {
            for b in residuals {
                products.push(a.iter().zip(b).map(|(&x, &y)| x.into() * y.into()).sum());
            }
        }
        Self { n: residuals.len(), products }
    }

    /// From inner products, row by row: `n` times `n`, symmetric.
    pub(crate) fn from_products(n: usize, products: Vec<f64>) -> Self {
        debug_assert_eq!(products.len(), n * n);
        Self { n, products }
    }

    /// Adds the products of another set of cells of the same replicates.
    pub fn add(&mut self, other: &Self) {
        debug_assert_eq!(self.n, other.n);
        for (mine, theirs) in self.products.iter_mut().zip(&other.products) {
            *mine += theirs;
        }
    }

    /// Mean over pairs of different replicates: squared bias plus the reference's variance.
    pub fn cross_mean(&self) -> f64 {
        self.means(None)[1]
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.products[i * self.n + j]
    }

    /// Means of the diagonal and of the rest, over replicates but one.
    fn means(&self, without: Option<usize>) -> [f64; 2] {
        let (mut own, mut cross) = (0.0, 0.0);
        let used = |i: &usize| Some(*i) != without;
        for i in (0..self.n).filter(used) {
            own += self.at(i, i);
            cross +=
                (0..self.n).filter(used).filter(|&j| j != i).map(|j| self.at(i, j)).sum::<f64>();
        }
        let m = (self.n - usize::from(without.is_some())) as f64;
        [own / m, cross / (m * (m - 1.0))]
    }

    /// Squared residuals of one replicate, split: [error, variance, squared bias], the reference's
    /// variance subtracted; of all replicates, or of all but one. Needs two replicates at least.
    pub fn parts(&self, reference: &ReferenceNoise, without: Option<usize>) -> [f64; 3] {
        let [own, cross] = self.means(without);
        [own - reference.variance, own - cross, cross - reference.variance]
    }

    /// The parts of the NMSE; `None` under three replicates or without a signal.
    pub fn split(&self, reference: &ReferenceNoise, confidence: f64) -> Option<Split> {
        let signal = reference.signal();
        if self.n < 3 || signal.is_nan() || signal <= 0.0 {
            return None;
        }
        let whole = self.parts(reference, None);
        let left_out: Vec<[f64; 3]> = (0..self.n).map(|i| self.parts(reference, Some(i))).collect();
        let n = self.n as f64;
        let jackknife = |part: usize| {
            let mean = left_out.iter().map(|p| p[part]).sum::<f64>() / n;
            let squares: f64 = left_out.iter().map(|p| (p[part] - mean).powi(2)).sum();
            squares * (n - 1.0) / n
        };
        let of_reference = 2.0 * reference.squares + 4.0 * whole[2].max(0.0) * reference.largest;
        let freedom = n - 1.0;
        let critical = student::quantile(0.5 * (1.0 - confidence), freedom);
        let estimate = |part: usize, extra: f64| {
            let value = whole[part] / signal;
            let standard_error = (jackknife(part) + extra).sqrt() / signal;
            let half = critical * standard_error;
            Estimate { value, standard_error, interval: [value - half, value + half] }
        };
        let squared_bias = estimate(2, of_reference);
        Some(Split {
            nmse: estimate(0, of_reference),
            variance: estimate(1, 0.0),
            p_no_bias: student::upper_tail(
                squared_bias.value / squared_bias.standard_error,
                freedom,
            ),
            squared_bias,
            replicates: (0..self.n)
                .map(|i| (self.at(i, i) - reference.variance) / signal)
                .collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tpb_optics::Stream;

    const CELLS: usize = 300;

    /// A triangular variate with variance 1.
    fn noise(rng: &mut Stream) -> f64 {
        (rng.uniform() + rng.uniform() - 1.0) * 6.0_f64.sqrt()
    }

    /// Five replicates of noise variance 1 per cell with this bias, and a reference of variance
    /// 0.04 per cell, on a signal of 100 per cell.
    fn simulate(rng: &mut Stream, bias: f64) -> (Gram, ReferenceNoise) {
        let reference: Vec<f64> = (0..CELLS).map(|_| 10.0 + 0.2 * noise(rng)).collect();
        let residuals: Vec<Vec<f64>> = (0..5)
            .map(|_| reference.iter().map(|r| 10.0 + bias + noise(rng) - r).collect())
            .collect();
        let cells = CELLS as f64;
        let noise = ReferenceNoise {
            power: reference.iter().map(|r| r * r).sum(),
            variance: 0.04 * cells,
            squares: 0.04 * 0.04 * cells,
            largest: 0.04,
        };
        (Gram::of(&residuals), noise)
    }

    #[test]
    fn the_parts_have_the_right_means() {
        let mut rng = Stream::new(21, 0, 0);
        let (mut variance, mut bias, mut nmse) = (0.0, 0.0, 0.0);
        for _ in 0..400 {
            let (gram, reference) = simulate(&mut rng, 0.5);
            let split = gram.split(&reference, 0.95).unwrap();
            variance += split.variance.value / 400.0;
            bias += split.squared_bias.value / 400.0;
            nmse += split.nmse.value / 400.0;
        }
        assert!((variance / 1e-2 - 1.0).abs() < 0.01, "{variance}");
        assert!((bias / 2.5e-3 - 1.0).abs() < 0.02, "{bias}");
        assert!((nmse - variance - bias).abs() < 1e-12);
    }

    #[test]
    fn no_bias_is_claimed_rarely_without_and_always_with_one() {
        // 1000 tests at level 5 %: the jackknife is conservative here; 6 sd above 50 is 91.
        let mut rng = Stream::new(22, 0, 0);
        let mut claimed = |bias: f64, level: f64| {
            (0..1000)
                .filter(|_| {
                    let (gram, reference) = simulate(&mut rng, bias);
                    gram.split(&reference, 0.95).unwrap().p_no_bias < level
                })
                .count()
        };
        let by_chance = claimed(0.0, 0.05);
        assert!(by_chance <= 91, "{by_chance} of 1000");
        assert!(claimed(0.0, 0.001) <= 7);
        assert!(claimed(1.0, 0.001) > 990);
    }

    #[test]
    fn too_few_replicates_or_no_signal_give_nothing() {
        let gram = Gram::of(&[vec![1.0], vec![1.0]]);
        assert!(gram.split(&ReferenceNoise { power: 1.0, ..Default::default() }, 0.9).is_none());
        let gram = Gram::of(&vec![vec![1.0]; 3]);
        assert!(gram.split(&ReferenceNoise::default(), 0.9).is_none());
    }
}
