//! The plane pulse in an infinite medium that scatters isotropically.
//!
//! An isotropic source on the plane x = 0 emits 1 J per m² (or one photon per unit area) at time 0. In units of
//! the mean free path, with v = 1 and the albedo c, the fluence rate of scattered light at |x| < t is
//! (Ganapol 2001, LA-UR-01-1854, AZURV1; notation of `saddle`)
//!
//! > φ = (c m e^(−t)/4π) ∫₀^∞ Re ξ² e^(c t m ξ/2) ds,   m = 1 − (x/t)²,
//!
//! and its part of order n, the coefficient of cⁿ,
//!
//! > φₙ = (m e^(−t)/4π) (t m/2)ⁿ⁻¹/(n − 1)! ∫₀^∞ Re ξⁿ⁺¹ ds,
//! > φ₁ = (e^(−t)/2) (2 ln 2 − (1 + η) ln(1 + η) − (1 − η) ln(1 − η)),   η = |x|/t.
//!
//! Unscattered light adds e^(−t)/(2t) for |x| < t. The scattered light vanishes towards the front and is 0 beyond.
//!
//! * Scaling: a medium of extinction σt and speed v has v σt φ(σt x, σt v t) \[W/m² for 1 J/m²\], c = σs/σt.
//! * [`plane_pulse_fluence_by_order`] is for c = 1; order n of another medium has the factor cⁿ.
//! * [`plane_pulse_cells`] averages over a cell \[x0, x1\], as a tally of photons in slabs does.
//!
//! An albedo above 1 (gain) is in the domain as long as the value is.

use super::saddle::Saddle;
use crate::error::{Result, finite, finite_result, non_negative, positive, require};
use crate::numerics::complex::Complex;
use crate::numerics::poisson::poisson;
use crate::numerics::quadrature::{Node, RELATIVE_TOLERANCE, adaptive, tanh_sinh};
use serde::Deserialize;
use std::f64::consts::{LN_2, PI};

/// Inputs of [`plane_pulse_fluence`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanePulse {
    /// Distance from the plane, of either sign \[mean free paths\].
    pub x: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Albedo c, at least 0.
    pub albedo: f64,
}

/// Inputs of [`plane_pulse_fluence_by_order`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanePulseOrder {
    /// Distance from the plane, of either sign \[mean free paths\].
    pub x: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Number of scatterings, at least 1.
    pub order: u32,
}

/// Inputs of [`plane_pulse_cells`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanePulseCell {
    /// Start of the cell \[mean free paths\].
    pub x0: f64,
    /// End of the cell, beyond its start \[mean free paths\].
    pub x1: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Albedo c, at least 0.
    pub albedo: f64,
}

/// The fluence rate of scattered light of a plane pulse \[1/mfp for 1 J per mfp² and v = 1\].
pub fn plane_pulse_fluence(input: &PlanePulse) -> Result<f64> {
    let &PlanePulse { x, time, albedo } = input;
    finite("x", x)?;
    positive("time", time)?;
    non_negative("albedo", albedo)?;
    let value = scattered(x.abs(), time - x.abs(), albedo);
    finite_result("plane_pulse_fluence", value)
}

/// The fluence rate of light of a plane pulse scattered n times, at albedo 1.
pub fn plane_pulse_fluence_by_order(input: &PlanePulseOrder) -> Result<f64> {
    let &PlanePulseOrder { x, time, order } = input;
    finite("x", x)?;
    positive("time", time)?;
    require(order > 0, "order", 0.0, "at least 1; order 0 is ballistic light")?;
    let value = of_order(x.abs(), time - x.abs(), order);
    finite_result("plane_pulse_fluence_by_order", value)
}

/// The mean over a cell of the fluence rate of scattered light of a plane pulse.
pub fn plane_pulse_cells(input: &PlanePulseCell) -> Result<f64> {
    let &PlanePulseCell { x0, x1, time, albedo } = input;
    let width = check_cell(input)?;
    let integral = if x0 < 0.0 && x1 > 0.0 {
        half_cell(0.0, -x0, time, albedo)? + half_cell(0.0, x1, time, albedo)?
    } else {
        half_cell(x0.abs().min(x1.abs()), x0.abs().max(x1.abs()), time, albedo)?
    };
    finite_result("plane_pulse_cells", integral / width)
}

/// The mean over a cell of the fluence rate of all light of a plane pulse, the unscattered included.
pub fn plane_pulse_cells_with_ballistic(input: &PlanePulseCell) -> Result<f64> {
    let &PlanePulseCell { x0, x1, time, .. } = input;
    let width = check_cell(input)?;
    let lit = (x1.min(time) - x0.max(-time)).max(0.0);
    let ballistic = (-time).exp() / (2.0 * time) * (lit / width);
    finite_result("plane_pulse_cells", plane_pulse_cells(input)? + ballistic)
}

fn check_cell(input: &PlanePulseCell) -> Result<f64> {
    let &PlanePulseCell { x0, x1, time, albedo } = input;
    finite("x0", x0)?;
    require(x1.is_finite() && x1 > x0, "x1", x1, "finite and beyond x0")?;
    positive("time", time)?;
    non_negative("albedo", albedo)?;
    finite("x1 - x0", x1 - x0)
}

/// ∫ φ dx from `start` to `end`, both at least 0.
fn half_cell(start: f64, end: f64, time: f64, albedo: f64) -> Result<f64> {
    if start >= time {
        return Ok(0.0);
    }
    if end < time {
        let integrand = |x: f64| scattered(x, time - x, albedo);
        return Ok(adaptive(integrand, &[start, end], RELATIVE_TOLERANCE)?.value);
    }
    // The front itself: φ vanishes there like m ln m.
    let integrand = |node: Node| scattered(time - node.to_end, node.to_end, albedo);
    Ok(tanh_sinh(integrand, start, time, RELATIVE_TOLERANCE)?.value)
}

/// φ at the distance x, `gap` behind the front.
pub(super) fn scattered(x: f64, gap: f64, albedo: f64) -> f64 {
    if gap <= 0.0 || albedo == 0.0 {
        return 0.0;
    }
    let time = x + gap;
    let saddle = Saddle::new(x, gap);
    let depth = albedo * time;
    let peak = saddle.peak.deficit.re;
    let integral = saddle.integral(
        0.5 * depth * saddle.m + 2.0 / saddle.height(),
        |node| (node.deficit + -peak) * -depth,
        |node| node.xi * node.xi,
    );
    let exponent = -(1.0 - albedo) * time - depth * peak;
    albedo * saddle.m / (4.0 * PI) * integral * exponent.exp()
}

/// φₙ at the distance x, `gap` behind the front.
pub(super) fn of_order(x: f64, gap: f64, order: u32) -> f64 {
    if gap <= 0.0 {
        return 0.0;
    }
    let time = x + gap;
    if order == 1 {
        // 1 − η = d: no difference is left in the bracket.
        let d = gap / time;
        let bracket = d * LN_2 - (2.0 - d) * (-0.5 * d).ln_1p() - d * d.ln();
        return 0.5 * (-time).exp() * bracket;
    }
    let saddle = Saddle::new(x, gap);
    let n = f64::from(order);
    let (height, peak) = (saddle.height(), saddle.peak.deficit.re);
    let integral = saddle.integral(
        (n + 1.0) / height,
        |node| saddle.log_ratio(node) * (n + 1.0),
        |_| Complex::new(1.0, 0.0),
    );
    let probability = poisson(order - 1, time * (1.0 - peak)) * (-time * peak).exp();
    saddle.m / (4.0 * PI) * probability * height * height * integral
}

#[cfg(test)]
#[path = "plane_pulse_tests.rs"]
mod tests;
