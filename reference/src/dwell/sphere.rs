//! Light inside an empty diffuse sphere whose wall holds it for a time.
//!
//! After n chords (`diffuse_sphere`) and n dwells at the wall, each exponential with mean τ, the total
//! delay in units of 2R/v is x with the probability, for "at most x",
//!
//! > ∫ f_n(u) P(n, (x − u)/τ) du,   0 < u < min(x, n),
//!
//! where f_n is the law of the sum of n chords and P(n, ·) the law of Gamma. Source: own derivation,
//! a convolution.
//!
//! # Stable form
//!
//! f_n in its positive Bernstein form, P as a sum of positive terms up to its mean; both factors are
//! positive. The panels end at the knots of f_n and around the step of P. τ = 0 is the law of the
//! chords alone.
//!
//! Sums that exceed 1 by their rounding give 1.
//!
//! Domain: 1 to [`MAX_CHORDS`] chords, x finite, τ ≥ 0.
//!
//! [`MAX_CHORDS`]: crate::diffuse_sphere::MAX_CHORDS

use crate::diffuse_sphere::ChordSum;
use crate::error::{Result, finite, non_negative};
use crate::numerics::poisson::at_least;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use serde::Deserialize;

/// Inputs of [`dwell_sphere_cdf`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DwellSphere {
    /// Number n of chords, and of dwells.
    pub chords: u32,
    /// Total delay, in 2R/v.
    pub x: f64,
    /// Mean dwell time τ, in 2R/v.
    pub mean_dwell: f64,
}

/// The probability that n chords and n dwells take at most x.
pub fn dwell_sphere_cdf(input: &DwellSphere) -> Result<f64> {
    let &DwellSphere { chords, x, mean_dwell } = input;
    finite("x", x)?;
    non_negative("mean_dwell", mean_dwell)?;
    let sum = ChordSum::new(chords)?;
    if x <= 0.0 {
        return Ok(0.0);
    }
    let count = f64::from(chords);
    // The law of the dwells is a step if its width is below the rounding of x.
    if mean_dwell <= 1e-20 * x.min(1.0) / count {
        return Ok(sum.probability(0.0, x).min(1.0));
    }
    let end = x.min(count);
    let mut breaks: Vec<f64> = (0..=chords).map(f64::from).collect();
    for deviations in [-4.0, -1.0, 0.0, 1.0, 4.0, 12.0, 40.0] {
        breaks.push(x - mean_dwell * (count + deviations * count.sqrt()).max(0.0));
    }
    breaks.push(end);
    breaks.retain(|u| (0.0..=end).contains(u));
    breaks.sort_by(f64::total_cmp);
    let integrand = |u: f64| sum.density(u) * at_least(chords, (x - u) / mean_dwell);
    Ok(adaptive(integrand, &breaks, RELATIVE_TOLERANCE)?.value.min(1.0))
}

#[cfg(test)]
#[path = "sphere_tests.rs"]
mod tests;
