//! The point pulse in an infinite medium that scatters isotropically.
//!
//! An isotropic point source emits 1 J (or one photon) at time 0. In units of the mean free path, with v = 1 and
//! the albedo c, the fluence rate of scattered light at the distance r is −1/(2πr) times the derivative of
//! that of the plane pulse with x, at x = r < t (Ganapol 2001, LA-UR-01-1854, AZURV1). The derivative
//! of ξ with η alone is a difference of close numbers; but that along both of its arguments is
//! 4 (η − σ)/((1 − η²)(1 − σ²)), and the one along the contour integrates to nothing. So, in the notation of
//! `saddle`, with X = (c t/2) m ξ,
//!
//! > φ = c e^(−t)/(4π² r t) ∫₀^∞ Re e^X ξ (η ξ (1 + X) + (2 + X)(σ − η)/(1 − σ²)) ds,
//! > φₙ = e^(−t)/(4π² r t) (t m/2)ⁿ⁻¹/(n − 1)! ∫₀^∞ Re ξⁿ (n η ξ + (n + 1)(σ − η)/(1 − σ²)) ds,
//! > φ₁ = e^(−t)/(4π r t) ln((t + r)/(t − r)),
//!
//! both brackets positive at the saddle. The integral is odd in η, so that at r → 0 the value at a
//! small η serves.
//! Unscattered light adds e^(−t) δ(t − r)/(4πr²). Scattered light is infinite on the front (order 1 is, as a
//! logarithm), which is an error, and 0 beyond.
//!
//! * Scaling: a medium of extinction σt and speed v has v σt³ φ(σt r, σt v t) \[W/m² for 1 J\], c = σs/σt.
//! * [`point_pulse_fluence_by_order`] is for c = 1; order n of another medium has the factor cⁿ.
//! * [`point_pulse_fluence_bins`] integrates over t0 ≤ t < t1: after the front over the fourth root of t − r,
//!   which removes the logarithm, then over ln(t − r).
//!
//! An albedo above 1 (gain) is in the domain as long as the value is.

use super::saddle::Saddle;
use crate::error::{Result, finite_result, non_negative, path_bin, positive, require};
use crate::numerics::poisson::poisson;
use crate::numerics::quadrature::adaptive;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`point_pulse_fluence`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointPulse {
    /// Distance from the source \[mean free paths\].
    pub r: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Albedo c, at least 0.
    pub albedo: f64,
}

/// Inputs of [`point_pulse_fluence_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointPulseBin {
    /// Distance from the source \[mean free paths\].
    pub r: f64,
    /// Start of the bin \[mean free times\].
    pub t0: f64,
    /// End of the bin \[mean free times\].
    pub t1: f64,
    /// Albedo c, at least 0.
    pub albedo: f64,
}

/// Inputs of [`point_pulse_fluence_by_order`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointPulseOrder {
    /// Distance from the source \[mean free paths\].
    pub r: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Number of scatterings, at least 1.
    pub order: u32,
}

/// The fluence rate of scattered light of a point pulse \[1/mfp³ for 1 J and v = 1\].
pub fn point_pulse_fluence(input: &PointPulse) -> Result<f64> {
    let &PointPulse { r, time, albedo } = input;
    non_negative("r", r)?;
    positive("time", time)?;
    non_negative("albedo", albedo)?;
    if r > time || albedo == 0.0 {
        return Ok(0.0);
    }
    require(time > r, "time", time, "other than the arrival of the wavefront")?;
    finite_result("point_pulse_fluence", scattered(r, time - r, albedo))
}

/// The fluence of scattered light of a point pulse within a bin of time \[1/mfp² for 1 J\].
pub fn point_pulse_fluence_bins(input: &PointPulseBin) -> Result<f64> {
    let &PointPulseBin { r, t0, t1, albedo } = input;
    non_negative("r", r)?;
    non_negative("albedo", albedo)?;
    let (start, end) = path_bin(1.0, t0, t1)?;
    if end <= r || end <= start || albedo == 0.0 {
        return Ok(0.0);
    }
    require(r > 0.0 || start > 0.0, "t0", t0, "above 0 at the source itself")?;
    let (start, end) = ((start - r).max(0.0), end - r);
    let near = r.min(1.0);
    let mut sum = 0.0;
    if start < near {
        sum += behind_the_front(r, albedo, start, end.min(near))?;
    }
    if end > near {
        sum += later(r, albedo, start.max(near), end)?;
    }
    finite_result("point_pulse_fluence_bins", sum)
}

/// The fluence rate of light of a point pulse scattered n times, at albedo 1 \[1/mfp³\].
pub fn point_pulse_fluence_by_order(input: &PointPulseOrder) -> Result<f64> {
    let &PointPulseOrder { r, time, order } = input;
    non_negative("r", r)?;
    positive("time", time)?;
    require(order > 0, "order", 0.0, "at least 1; order 0 is ballistic light")?;
    if r > time || (r == time && order > 1) {
        return Ok(0.0);
    }
    require(time > r, "time", time, "other than the arrival of the wavefront")?;
    finite_result("point_pulse_fluence_by_order", of_order(r, time - r, order))
}

/// The bin from `start` to `end` after the front, by the fourth root of the delay.
fn behind_the_front(r: f64, albedo: f64, start: f64, end: f64) -> Result<f64> {
    let integrand = |root: f64| {
        let delay = root.powi(4);
        if delay == 0.0 { 0.0 } else { 4.0 * root.powi(3) * scattered(r, delay, albedo) }
    };
    let breaks = [start.sqrt().sqrt(), end.sqrt().sqrt()];
    Ok(adaptive(integrand, &breaks, BIN_TOLERANCE)?.value)
}

/// The bin from `start` > 0 to `end` after the front, by the logarithm of the delay.
fn later(r: f64, albedo: f64, start: f64, end: f64) -> Result<f64> {
    let mut breaks = vec![start.ln(), end.ln()];
    // Where the light decays, and where the diffuse light passes.
    let scales = [1.0, 8.0, 40.0].map(|lengths| lengths / (1.0 - albedo).abs());
    breaks.extend(scales.into_iter().chain([r * r / 2.0]).map(f64::ln));
    breaks.retain(|y| (start.ln()..=end.ln()).contains(y));
    breaks.sort_by(f64::total_cmp);
    let integrand = |y: f64| {
        let delay = y.exp();
        delay * scattered(r, delay, albedo)
    };
    Ok(adaptive(integrand, &breaks, BIN_TOLERANCE)?.value)
}

/// The error estimate of the rule is pessimistic by orders of magnitude.
const BIN_TOLERANCE: f64 = 1e-9;

/// The r below which values, even in r, are constant to 1e-16: they change with η² and 3r²/4t.
fn central(time: f64) -> f64 {
    1e-8 * time / (1.0 + time.sqrt())
}

/// φ at the distance r, `gap` > 0 behind the front.
pub(super) fn scattered(r: f64, gap: f64, albedo: f64) -> f64 {
    let time = r + gap;
    let saddle = Saddle::new(r.max(central(time)), gap);
    let (eta, depth, peak) = (saddle.eta, albedo * time, saddle.peak.deficit.re);
    let exponent = -(1.0 - albedo) * time - depth * peak;
    if exponent < UNDERFLOW {
        return 0.0;
    }
    let half_depth = 0.5 * depth * saddle.m;
    let integral = saddle.integral(
        half_depth + 2.0 / saddle.height(),
        |node| (node.deficit + -peak) * -depth,
        |node| {
            let power = node.xi * half_depth;
            let across = (node.sigma + -eta) * node.inverse_gap();
            node.xi * (node.xi * (power + 1.0) * eta + (power + 2.0) * across)
        },
    );
    albedo * exponent.exp() * (integral / eta) / (4.0 * PI * PI) / time / time
}

/// φₙ at the distance r, `gap` > 0 behind the front.
pub(super) fn of_order(r: f64, gap: f64, order: u32) -> f64 {
    let time = r + gap;
    if order == 1 {
        let eta = r / time;
        let twice_atanh = (2.0 * eta / (gap / time)).ln_1p();
        let ratio = if eta > 0.0 { twice_atanh / eta } else { 2.0 };
        return (-time).exp() * ratio / (4.0 * PI) / time / time;
    }
    let saddle = Saddle::new(r.max(central(time)), gap);
    let (n, eta) = (f64::from(order), saddle.eta);
    let (height, peak) = (saddle.height(), saddle.peak.deficit.re);
    let probability = poisson(order - 1, time * (1.0 - peak)) * (-time * peak).exp();
    if probability == 0.0 {
        return 0.0;
    }
    let integral = saddle.integral(
        (n + 1.0) / height,
        |node| saddle.log_ratio(node) * n,
        |node| {
            let across = (node.sigma + -eta) * node.inverse_gap();
            node.xi * (n * eta) + across * (n + 1.0)
        },
    );
    probability * height * (integral / eta) / (4.0 * PI * PI) / time / time
}

/// Exponents below which nothing is left in `f64`, whatever the factor before it.
const UNDERFLOW: f64 = -2200.0;

#[cfg(test)]
#[path = "point_pulse_tests.rs"]
mod tests;
