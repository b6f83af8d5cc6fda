//! The rule of Gauss and Legendre, with as many points as asked for.
//!
//! ∫ f from −1 to 1 ≈ Σ w_i f(x_i), exact for polynomials of degree 2n − 1. The nodes are the zeros
//! of the Legendre polynomial P_n, by Newton's method from the estimate of Tricomi (1950),
//! x_i ≈ cos(π (i − 1/4)/(n + 1/2)); w_i = 2/((1 − x²) P_n'(x)²). It suits functions that are
//! analytic around the interval, for which it converges geometrically.

use std::f64::consts::PI;

/// Nodes and weights on [−1, 1], ascending; `count` at least 1.
pub(crate) fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let rule = (0..count).map(|i| {
        let mut x = -(PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        // Newton doubles the digits of an estimate that has at least two.
        for _ in 0..6 {
            let (value, slope) = legendre(count, x);
            x -= value / slope;
        }
        let (_, slope) = legendre(count, x);
        (x, 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope))
    });
    rule.collect()
}

/// P_n and its derivative at x inside (−1, 1), by the recurrence of Bonnet.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (0.0, 1.0);
    for k in 0..n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
    }
    (value, n as f64 * (before - x * value) / ((1.0 - x) * (1.0 + x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_twice_the_count_are_exact() {
        for count in [1, 2, 5, 16] {
            let rule = gauss_legendre(count);
            let moment = |degree: usize| -> f64 {
                rule.iter().map(|(x, w)| w * x.powf(degree as f64)).sum()
            };
            for degree in (0..2 * count).step_by(2) {
                let exact = 2.0 / (degree + 1) as f64;
                assert!((moment(degree) - exact).abs() < 3e-15, "{count} points, x^{degree}");
            }
            let first_missed = 2.0 / (2 * count + 1) as f64;
            assert!((moment(2 * count) - first_missed).abs() > 1e-12);
        }
    }

    #[test]
    fn many_points_keep_their_digits() {
        for count in [64, 257] {
            let rule = gauss_legendre(count);
            assert!(rule.windows(2).all(|pair| pair[0].0 < pair[1].0));
            let sum: f64 = rule.iter().map(|(x, w)| w * x.exp()).sum();
            assert!((sum - 2.0 * 1.0_f64.sinh()).abs() < 2e-14);
        }
    }
}
