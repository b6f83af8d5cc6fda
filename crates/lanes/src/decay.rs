//! Exponentials.

use crate::f64s::ROUND;
use crate::{F64s, Simd};

impl<S: Simd> F64s<S> {
    /// exp(self) for at most 700, with a relative error of at most 4 · 2⁻⁵³; 0 below −708, NaN for NaN.
    ///
    /// With k the integer nearest to x/ln 2, exp(x) = 2ᵏ exp(r), |r| ≤ ln(2)/2; the series of exp(r)
    /// is cut after r¹³/13!, where its rest is 4e-18.
    #[inline(always)]
    #[must_use]
    pub fn exp(self) -> Self {
        let simd = self.simd();
        let x = self.max(Self::splat(simd, LEAST));
        let shifted = x * std::f64::consts::LOG2_E + ROUND;
        let k = shifted - ROUND;
        let r = (x - k * LN2_HIGH) - k * LN2_LOW;
        // Estrin's scheme: shorter chains than Horner's.
        let (r2, r4) = (r * r, (r * r) * (r * r));
        let low = four(0, r, r2) + four(4, r, r2) * r4;
        let high = four(8, r, r2) + two(12, r) * r4;
        let sum = low + high * (r4 * r4);
        let power = sum * shifted.power_of_two();
        let zero = Self::splat(simd, 0.0);
        let finite = self.less(Self::splat(simd, LEAST)).choose(zero, power);
        self.at_most(self).choose(finite, self)
    }

    /// (1 − exp(−self))/self, the mean of exp(−x) from 0 to self, which is not negative; 1 for 0,
    /// with a relative error of at most 12 · 2⁻⁵³.
    ///
    /// Below 1/4 the series Σ (−x)ⁿ/(n + 1)!, cut after n = 11, where its rest is 1e-17.
    #[inline(always)]
    #[must_use]
    pub fn mean_decay(self) -> Self {
        let one = Self::splat(self.simd(), 1.0);
        let mut series = Self::splat(self.simd(), SERIES[12]);
        for n in (1..12).rev() {
            series = Self::splat(self.simd(), SERIES[n]) - series * self;
        }
        let far = (one - (-self).exp()) / self;
        self.less(Self::splat(self.simd(), 0.25)).choose(series, far)
    }
}

/// Two terms of the series from number `n` on, over rⁿ.
#[inline(always)]
fn two<S: Simd>(n: usize, r: F64s<S>) -> F64s<S> {
    r * SERIES[n + 1] + SERIES[n]
}

/// Four.
#[inline(always)]
fn four<S: Simd>(n: usize, r: F64s<S>, r2: F64s<S>) -> F64s<S> {
    two(n, r) + two(n + 2, r) * r2
}

/// Below it, [`F64s::exp`] is 0.
const LEAST: f64 = -708.0;
/// ln 2 in two parts; the first has 32 bits: its products with k are exact.
const LN2_HIGH: f64 = f64::from_bits(0x3FE6_2E42_FEE0_0000);
const LN2_LOW: f64 = f64::from_bits(0x3DEA_39EF_3579_3C76);

/// 1/n!.
const SERIES: [f64; 14] = {
    let mut series = [1.0; 14];
    let mut n = 1;
    while n < 14 {
        series[n] = series[n - 1] / n as f64;
        n += 1;
    }
    series
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LANES, Vectors, WithSimd, dispatch, vectors};

    /// exp of each.
    struct Exp([f64; LANES]);

    impl WithSimd for Exp {
        type Output = [f64; LANES];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> [f64; LANES] {
            let mut result = [0.0; LANES];
            for index in 0..vectors::<S>() {
                self.0.vector(simd, index).exp().store(&mut result, index);
            }
            result
        }
    }

    #[test]
    fn exponentials_are_right_to_four_roundings_and_the_same_on_all_machines() {
        let mut worst: f64 = 0.0;
        for i in 0..125_000 {
            let x = std::array::from_fn(|lane| -707.999 + (i * LANES + lane) as f64 * 1.408e-3);
            let found = dispatch(Exp(x));
            assert_eq!(found, Exp(x).with_simd(crate::Scalar), "{x:?}");
            for (x, found) in x.into_iter().zip(found) {
                worst = worst.max((found / x.exp() - 1.0).abs());
            }
        }
        assert!(worst <= 2.0 * f64::EPSILON, "{worst:e}");
        let ones = [0.0, -0.0, -1e-300, 1e-17, -f64::MIN_POSITIVE, 0.0, 0.0, 0.0];
        assert_eq!(dispatch(Exp(ones)), [1.0; LANES]);
        let zeros = [-708.1, f64::NEG_INFINITY, -1e300, -709.0, -1e4, -708.5, -1e9, -800.0];
        assert_eq!(dispatch(Exp(zeros)), [0.0; LANES]);
    }

    /// The mean decay of each.
    struct MeanDecay([f64; LANES]);

    impl WithSimd for MeanDecay {
        type Output = [f64; LANES];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> [f64; LANES] {
            let mut result = [0.0; LANES];
            for index in 0..vectors::<S>() {
                self.0.vector(simd, index).mean_decay().store(&mut result, index);
            }
            result
        }
    }

    #[test]
    fn mean_decays_are_right_from_0_to_infinity() {
        let mut worst: f64 = 0.0;
        for i in 0..20_000 {
            let x = std::array::from_fn(|lane| 1e-20 * 1.000_3_f64.powf((i * LANES + lane) as f64));
            let found = dispatch(MeanDecay(x));
            assert_eq!(found, MeanDecay(x).with_simd(crate::Scalar), "{x:?}");
            for (x, found) in x.into_iter().zip(found).filter(|(x, _)| *x < 1e30) {
                worst = worst.max((found / (-(-x).exp_m1() / x) - 1.0).abs());
            }
        }
        assert!(worst <= 6.0 * f64::EPSILON, "{worst:e}");
        assert_eq!(dispatch(MeanDecay([0.0; LANES])), [1.0; LANES]);
        assert_eq!(dispatch(MeanDecay([f64::INFINITY; LANES])), [0.0; LANES]);
    }
}
