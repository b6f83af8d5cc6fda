//! The Poisson distribution, with its digits for every order and mean.
//!
//! P(n; x) = e^(−x) xⁿ/n!. Taken as the exponential of n ln x − x − ln n!, it loses as many digits as
//! those terms have before the point. The form of Loader ("Fast and Accurate Computation of Binomial
//! Probabilities", 2000) does not:
//!
//! > P = e^(−δ(n) − n·h(x/n)) / √(2πn),   h(u) = u − 1 − ln u,
//!
//! where δ(n) = ln n! − ln(√(2πn) (n/e)ⁿ) is the remainder of Stirling's formula.

use std::f64::consts::TAU;

/// P(n; x) for a mean x of at least 0; e^(−x) and underflow included.
pub(crate) fn poisson(n: u32, x: f64) -> f64 {
    if n == 0 {
        return (-x).exp();
    }
    if x == 0.0 {
        return 0.0;
    }
    let n = f64::from(n);
    (-stirling_remainder(n) - deviance(n, x)).exp() / (TAU * n).sqrt()
}

/// The probability of at least n, for n of at least 1; also that n waiting times of mean 1 together
/// take at most x (Gamma distribution).
///
/// A sum of positive terms up to the mean, and 1 less such a sum, of at most a half, above.
pub(crate) fn at_least(n: u32, x: f64) -> f64 {
    if x == f64::INFINITY {
        return 1.0;
    }
    let below = x > f64::from(n);
    let mut term = if below { poisson(n - 1, x) } else { poisson(n, x) };
    let mut sum = term;
    let mut k = f64::from(n);
    while term > f64::EPSILON / 8.0 * sum {
        if below {
            k -= 1.0;
            term *= k / x;
        } else {
            k += 1.0;
            term *= x / k;
        }
        sum += term;
    }
    if below { 1.0 - sum } else { sum }
}

/// n·h(x/n) = x − n − n ln(x/n), without cancellation around x = n.
fn deviance(n: f64, x: f64) -> f64 {
    let d = (x - n) / n;
    if d.abs() > 0.1 {
        let ratio = n / x;
        // The logarithm in parts cannot overflow.
        return (x - n) + n * if ratio.is_finite() { ratio.ln() } else { n.ln() - x.ln() };
    }
    // d − ln(1 + d) = d²/2 − d³/3 + …; a term is at most a tenth of the one before.
    let (mut sum, mut power) = (0.0, d * d);
    for k in 2..20 {
        sum += power / f64::from(k);
        power *= -d;
    }
    n * sum
}

/// δ(n) for n of at least 1.
fn stirling_remainder(n: f64) -> f64 {
    if n < 16.0 {
        let factorial: f64 = (1..=n as u32).map(f64::from).product();
        return (factorial / (TAU * n).sqrt()).ln() - n * (n.ln() - 1.0);
    }
    // The asymptotic series; the first term left out is below 1e-15 for n = 16.
    let square = 1.0 / (n * n);
    (1.0 / 12.0
        - square
            * (1.0 / 360.0 - square * (1.0 / 1260.0 - square * (1.0 / 1680.0 - square / 1188.0))))
        / n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_orders_meet_the_definition() {
        for x in [1e-3, 0.7, 1.0, 12.5, 40.0] {
            let mut term = f64::exp(-x);
            for n in 0..60 {
                // The exponent is rounded.
                let rounding = 1e-14 - 4e-16 * term.ln();
                assert!((poisson(n, x) / term - 1.0).abs() < rounding, "n = {n}, x = {x}");
                term *= x / f64::from(n + 1);
            }
        }
    }

    #[test]
    fn neighbours_have_the_ratio_of_the_recurrence_at_every_size() {
        for n in [1_u32, 14, 15, 16, 1000, 1_000_000] {
            for factor in [0.7, 0.95, 1.0, 1.0001, 1.1, 1.5] {
                let x = f64::from(n) * factor;
                let ratio = poisson(n + 1, x) / poisson(n, x);
                let expected = x / f64::from(n + 1);
                // The exponent itself is rounded.
                let rounding = 1e-14 + 1e-15 * f64::from(n) * (factor - 1.0).abs();
                if poisson(n, x) > 1e-300 {
                    assert!((ratio / expected - 1.0).abs() < rounding, "n = {n}, x = {x}");
                }
            }
        }
    }

    #[test]
    fn the_extremes_are_zero_and_not_nan() {
        assert_eq!(poisson(5, 0.0), 0.0);
        assert_eq!(poisson(0, 0.0), 1.0);
        assert_eq!(poisson(3, 1e300), 0.0);
        assert_eq!(poisson(u32::MAX, 1.0), 0.0);
        assert!(poisson(1, 1e-300) > 0.0);
    }

    #[test]
    fn the_tail_is_the_sum_of_the_probabilities() {
        for n in [1, 2, 7, 30] {
            for x in [1e-5, 0.5, 6.0, 7.0, 8.0, 29.0, 31.0, 300.0] {
                let sum: f64 = (n..n + 600).map(|k| poisson(k, x)).sum();
                assert!((at_least(n, x) / sum - 1.0).abs() < 1e-13, "n = {n}, x = {x}");
            }
        }
        assert_eq!(at_least(3, 0.0), 0.0);
        assert_eq!(at_least(3, 1e300), 1.0);
        assert_eq!(at_least(3, f64::INFINITY), 1.0);
    }
}
