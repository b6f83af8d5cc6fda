//! Ballistic light that reaches an area, spread over the times to its points.
//!
//! An isotropic point pulse of energy Q lies on the axis of a disc of radius a at the distance d.
//! The light that has travelled s reaches the ring of radius √(s² − d²) of the disc, so the energy
//! \[J\] that arrives within t0 ≤ t < t1 is, with the exponential integral E₂,
//!
//! > E = Q d/2 · \[E₂(σt s0)/s0 − E₂(σt s1)/s1\] = Q d/2 · ∫ e^(−σt s) / s² ds,   s0 ≤ s < s1,
//!
//! where s0 and s1 are v t0 and v t1 clipped to d … √(d² + a²). Source: the law of Beer, Lambert
//! and Bouguer (1729) and the cosine law; own closed form.
//!
//! # Stable form
//!
//! The difference cancels for thin bins and small discs; the integral has one sign. It is taken in
//! ln s from s0 on, over a width that is counted from the centre of the disc: the rim lies
//! a²/(√(d² + a²) + d) behind it, which is not a difference.
//!
//! Domain: d > 0, a ≥ 0; the energy behind an opaque medium is 0.

use crate::error::{Result, finite_result, non_negative, path_bin, positive, require};
use crate::numerics::front::BehindFront;
use crate::numerics::path_integral::decaying_integral;
use serde::Deserialize;

/// Inputs of [`ballistic_disc_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallisticDiscBin {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Distance d of the disc from the source \[m\].
    pub disc_distance: f64,
    /// Radius a of the disc \[m\].
    pub disc_radius: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The energy \[J\] of ballistic light that reaches a coaxial disc within a bin.
pub fn ballistic_disc_bins(input: &BallisticDiscBin) -> Result<f64> {
    let &BallisticDiscBin { energy, sigma_t, speed, disc_distance, disc_radius, t0, t1 } = input;
    non_negative("energy", energy)?;
    non_negative("sigma_t", sigma_t)?;
    positive("disc_distance", disc_distance)?;
    non_negative("disc_radius", disc_radius)?;
    path_bin(speed, t0, t1)?;
    let rim = disc_distance.hypot(disc_radius);
    require(rim.is_finite(), "disc_radius", disc_radius, "at a finite distance")?;
    let beyond_centre = disc_radius / (0.5 * rim + 0.5 * disc_distance) * (0.5 * disc_radius);
    let bin = BehindFront::of_bin(speed, t0, t1, disc_distance);
    let Some(bin) = bin.and_then(|bin| bin.before(beyond_centre)) else { return Ok(0.0) };
    let start = disc_distance + bin.start;
    let transmittance = (-sigma_t * start).exp();
    if transmittance == 0.0 {
        return Ok(0.0);
    }
    let inverse_square = |s: f64, _| (start / s).powi(2);
    let integral = decaying_integral(start, bin.width, sigma_t, &[], inverse_square)?;
    let fraction = 0.5 * (disc_distance / start) * (integral / start);
    finite_result("ballistic_disc_bins", energy * fraction * transmittance)
}

#[cfg(test)]
#[path = "disc_tests.rs"]
mod tests;
