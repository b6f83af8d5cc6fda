//! What it costs to spread a pair's energy evenly over its interval of arrival.
//!
//! The 2-D kernel's light arrives over |v t − S| ≤ κA with a density that decays as e^(−σt v t)
//! ([`super::beam_ray`]). Marco and others ("Transient Photon Beams", 2017) spread it evenly. With
//! the optical half width X = σt κ A, the exact arrival has (own derivation)
//!
//! > first quarter of the interval: (1 − e^(−X/2)) / (1 − e^(−2X)) of the energy, instead of 1/4;
//! > mean arrival: S + κA (1/X − coth X), instead of S;
//! > total: sinh X / X times that with the transmittance of the middle of the interval.
//!
//! The differences start as 3X/16, −X/3 (in half widths) and −X²/6. The mean is taken from Lambert's
//! continued fraction coth X − 1/X = X/(3 + X²/(5 + X²/(7 + …))) where its two terms would cancel.
//!
//! Domain: X ≥ 0, finite.

use crate::error::{Result, non_negative};
use serde::Deserialize;

/// Inputs of the three quantities.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvenSpread {
    /// X = σt κ A: half of the interval of arrival in optical depths.
    pub optical_half_width: f64,
}

/// The share of the energy that arrives in the first quarter of the interval.
pub fn first_quarter_share(input: &EvenSpread) -> Result<f64> {
    let x = non_negative("optical_half_width", input.optical_half_width)?;
    Ok(if x > f64::MIN_POSITIVE { (-0.5 * x).exp_m1() / (-2.0 * x).exp_m1() } else { 0.25 })
}

/// How much later than the middle light arrives on average, in half widths: never positive.
pub fn mean_shift(input: &EvenSpread) -> Result<f64> {
    let x = non_negative("optical_half_width", input.optical_half_width)?;
    if x > LARGE {
        return Ok(1.0 / x - 1.0 / x.tanh());
    }
    let fraction = (1..=TERMS).rev().fold(0.0, |tail, n| x * x / (f64::from(2 * n + 1) + tail));
    Ok(if x > 0.0 { -fraction / x } else { 0.0 })
}

/// The total with the transmittance of the middle of the interval, over the exact total.
pub fn midpoint_total(input: &EvenSpread) -> Result<f64> {
    let x = non_negative("optical_half_width", input.optical_half_width)?;
    Ok(if x > f64::MIN_POSITIVE { 2.0 * x * (-x).exp() / -(-2.0 * x).exp_m1() } else { 1.0 })
}

/// Above it, 1/X and coth X differ enough.
const LARGE: f64 = 4.0;
/// Terms of the continued fraction: those left out add less than 1e-20 at X = 4.
const TERMS: u32 = 24;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;

    const HALF_WIDTHS: [f64; 8] = [1e-9, 1e-4, 0.3, 1.0, 3.999, 4.001, 12.0, 60.0];

    fn close(value: f64, expected: f64, relative: f64) {
        assert!(
            (value - expected).abs() <= relative * expected.abs(),
            "{value:e} for {expected:e}"
        );
    }

    /// ∫ weight(y) e^(−X y) dy from −1 to `end`; y is the place in the interval.
    fn moment(x: f64, end: f64, weight: impl Fn(f64) -> f64) -> f64 {
        // Relative to the start, so that nothing overflows.
        let knee = (40.0 / x - 1.0).clamp(-1.0, end);
        adaptive(|y| weight(y) * (-x * (y + 1.0)).exp(), &[-1.0, knee, end], 1e-13).unwrap().value
    }

    #[test]
    fn they_are_the_moments_of_the_exponential() {
        for optical_half_width in HALF_WIDTHS {
            let (x, of) = (optical_half_width, EvenSpread { optical_half_width });
            let total = moment(x, 1.0, |_| 1.0);
            close(first_quarter_share(&of).unwrap(), moment(x, -0.5, |_| 1.0) / total, 1e-12);
            let shift = moment(x, 1.0, |y| y + 1.0) / total - 1.0;
            assert!((mean_shift(&of).unwrap() - shift).abs() < 1e-12, "X = {x}");
            close(midpoint_total(&of).unwrap(), 2.0 * (-x).exp() / total, 1e-12);
        }
    }

    #[test]
    fn thin_intervals_follow_the_leading_terms() {
        for x in [1e-7, 1e-5] {
            let of = EvenSpread { optical_half_width: x };
            close(first_quarter_share(&of).unwrap() - 0.25, 0.1875 * x, 1e-4);
            close(mean_shift(&of).unwrap(), -x / 3.0, 1e-9);
        }
        let none = EvenSpread { optical_half_width: 0.0 };
        assert_eq!(first_quarter_share(&none).unwrap(), 0.25);
        assert_eq!(mean_shift(&none).unwrap(), 0.0);
        assert_eq!(midpoint_total(&none).unwrap(), 1.0);
    }

    #[test]
    fn extreme_widths_give_their_limits_and_others_an_error() {
        for x in [1e-320, 1e-300, 1e4, 1e300] {
            let of = EvenSpread { optical_half_width: x };
            let values = [first_quarter_share(&of), mean_shift(&of), midpoint_total(&of)];
            let [share, shift, total] = values.map(Result::unwrap);
            assert!((0.25..=1.0).contains(&share) && (-1.0..=0.0).contains(&shift));
            assert!((0.0..=1.0).contains(&total));
        }
        for x in [-1.0, f64::NAN, f64::INFINITY] {
            let of = EvenSpread { optical_half_width: x };
            assert!(first_quarter_share(&of).is_err() && mean_shift(&of).is_err());
            assert!(midpoint_total(&of).is_err());
        }
    }
}
