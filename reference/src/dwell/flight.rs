//! How much light is in flight, where every scattering takes an exponential time.
//!
//! A pulse starts in flight at t = 0; flights end by scattering at the rate λ = σs v, and each
//! scattering holds the light for a time of mean τ, without absorption. Shares of the energy:
//!
//! * in flight at t ([`dwell_flight_fraction`]), the two-state Markov process:
//!   > (1 + a e^(−(λ + 1/τ) t)) / (1 + a),   a = λτ
//! * in flight after exactly n scatterings ([`dwell_order_in_flight`]), with ₁F₁ of Kummer:
//!   > (λ/τ)ⁿ t²ⁿ/(2n)! · e^(−λt) ₁F₁(n; 2n + 1; (λ − 1/τ) t)
//!
//! Source: own derivation; the second is the inverse Laplace transform of λⁿ τ⁻ⁿ / ((s + λ)ⁿ⁺¹
//! (s + 1/τ)ⁿ).
//!
//! # Stable form
//!
//! The first is divided by a if a > 1. For the second, the powers overflow and the series
//! alternates; instead, with Poisson probabilities P(n; x), the share is taken as
//!
//! > ∫ P(n; λ(t − d)) · P(n − 1; d/τ) dd/τ,   0 < d < t,
//!
//! over the time d of all dwells together: n scatterings in the time of flight, and the law of
//! Gamma of n dwells. Both factors are positive and their product has one peak, at a root of a
//! quadratic equation, around which the panels are set. Time is counted from the end that is
//! closer to the peak.
//!
//! Domain: rates, times and mean dwell of at least 0; τ = 0 is the medium without dwell.

use crate::error::{Result, finite, finite_result, non_negative};
use crate::numerics::poisson::poisson;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use serde::Deserialize;

/// Inputs of [`dwell_flight_fraction`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DwellFlight {
    /// Rate λ = σs v at which flights end \[1/s\].
    pub scattering_rate: f64,
    /// Mean dwell time τ \[s\].
    pub mean_dwell: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`dwell_order_in_flight`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DwellOrder {
    /// Rate λ = σs v at which flights end \[1/s\].
    pub scattering_rate: f64,
    /// Mean dwell time τ \[s\].
    pub mean_dwell: f64,
    /// Number n of scatterings.
    pub scatterings: u32,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// The share of the energy that is in flight.
pub fn dwell_flight_fraction(input: &DwellFlight) -> Result<f64> {
    let &DwellFlight { scattering_rate, mean_dwell, time } = input;
    check(scattering_rate, mean_dwell, time)?;
    if mean_dwell == 0.0 {
        return Ok(1.0);
    }
    let decay = (-(scattering_rate * time) - time / mean_dwell).exp();
    let ratio = scattering_rate * mean_dwell;
    Ok(if ratio <= 1.0 {
        (1.0 + ratio * decay) / (1.0 + ratio)
    } else {
        (1.0 / ratio + decay) / (1.0 / ratio + 1.0)
    })
}

/// The share of the energy that is in flight after exactly n scatterings.
pub fn dwell_order_in_flight(input: &DwellOrder) -> Result<f64> {
    let &DwellOrder { scattering_rate, mean_dwell, scatterings, time } = input;
    check(scattering_rate, mean_dwell, time)?;
    let events = finite("scattering_rate * time", scattering_rate * time)?;
    let dwells = time / mean_dwell;
    if scatterings == 0 || events == 0.0 || dwells == 0.0 {
        return Ok(poisson(scatterings, if scatterings == 0 { events } else { 0.0 }));
    }
    // Dwells that are so short change nothing: the relative effect is n (n − λt) τ/t.
    let n = f64::from(scatterings);
    if dwells == f64::INFINITY || dwells > 1e18 * n * (n + events) {
        return Ok(poisson(scatterings, events));
    }
    let flight = Peaked { count: scatterings, mean: events };
    let dwell = Peaked { count: scatterings - 1, mean: dwells };
    let integral = if dwell.peak_with(flight) <= 0.5 {
        dwell.convolved_with(flight)?
    } else {
        flight.convolved_with(dwell)?
    };
    finite_result("dwell_flight_fraction", dwells * integral)
}

pub(super) fn check(scattering_rate: f64, mean_dwell: f64, time: f64) -> Result<()> {
    non_negative("scattering_rate", scattering_rate)?;
    non_negative("mean_dwell", mean_dwell)?;
    non_negative("time", time)?;
    Ok(())
}

/// The function P(count; mean · u) of the share u of the time.
#[derive(Debug, Clone, Copy)]
struct Peaked {
    count: u32,
    mean: f64,
}

impl Peaked {
    fn at(self, share: f64) -> f64 {
        poisson(self.count, self.mean * share)
    }

    /// Where P(self; u) P(other; 1 − u) is largest.
    fn peak_with(self, other: Self) -> f64 {
        let (near, far) = (f64::from(self.count), f64::from(other.count));
        // near/u − far/(1 − u) = δ.
        let delta = self.mean - other.mean;
        let b = near + far + delta;
        let root = (b * b - 4.0 * delta * near).max(0.0).sqrt();
        let peak = if b >= 0.0 { 2.0 * near / (b + root) } else { (root - b) / (-2.0 * delta) };
        peak.clamp(0.0, 1.0)
    }

    /// ∫ P(self; u) P(other; 1 − u) du, the peak at u ≤ 1/2.
    fn convolved_with(self, other: Self) -> Result<f64> {
        let peak = self.peak_with(other);
        let (near, far) = (f64::from(self.count), f64::from(other.count));
        let curvature = if near > 0.0 { near / peak / peak } else { 0.0 } + far;
        let slope = if near > 0.0 { 0.0 } else { self.mean - other.mean + far };
        let width = 1.0 / (curvature.sqrt() + slope.max(0.0));
        let mut breaks = vec![0.0, 1.0, peak];
        for widths in [1.0, 4.0, 12.0, 40.0] {
            breaks.extend([peak - widths * width, peak + widths * width]);
        }
        breaks.retain(|u| (0.0..=1.0).contains(u));
        breaks.sort_by(f64::total_cmp);
        let integrand = |u: f64| self.at(u) * other.at(1.0 - u);
        Ok(adaptive(integrand, &breaks, RELATIVE_TOLERANCE)?.value)
    }
}

#[cfg(test)]
#[path = "flight_tests.rs"]
mod tests;
