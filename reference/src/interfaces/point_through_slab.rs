//! An isotropic point pulse behind a clear slab, seen on a plane parallel to it.
//!
//! The air gap H (before and behind the slab together), the slab (index η ≥ 1, thickness d), and a
//! point of the plane at the lateral distance ρ from the foot of the source. Snell's law fixes
//! one straight-through path. With u = tan θ1 and w = √(η² + (η² − 1) u²) = η cos θ2 / cos θ1,
//!
//! > ρ = u (H + d/w),
//!
//! which is increasing and concave in u: Newton's iteration from u = ρ/(H + d/η), below the root,
//! rises to it without a bracket. The arrival \[s\] (c: speed in air) and the irradiance that the
//! direct pulse leaves on the plane \[J/m²\] are
//!
//! > t = √(1 + u²) (H + η² d/w) / c,
//! > E = Q/(4π) (1 − R)² / ((1 + u²)^(3/2) (H + d/w) (H + η² d/w³)),
//!
//! the latter being Q/(4π) (1 − R)² sin θ1 / (ρ dρ/dθ1), from the energy between two cones, without
//! its 0/0 on the axis. R is the reflectance of a face for unpolarised light, as renderers take it
//! ([`slab_echo_weight_sp`](super::slab_echo_weight_sp) shows the difference); 1 − R depends on
//! w alone. Echoes are not included.
//!
//! Domain: H > 0 or ρ within the reach of the slab, d/√(η² − 1); H + d > 0.

use crate::error::{Result, finite_result, non_negative, positive, require};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of the direct pulse of a point light through a slab.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointThroughSlab {
    /// Energy Q of the pulse \[J\].
    pub energy: f64,
    /// Air H on the way, before and behind the slab together \[m\].
    pub air_gap: f64,
    /// Thickness d of the slab \[m\].
    pub thickness: f64,
    /// Index η of the slab, relative to air; at least 1.
    pub eta: f64,
    /// Lateral distance ρ \[m\].
    pub lateral: f64,
    /// Speed of light c in air \[m/s\].
    pub speed: f64,
}

/// The irradiance \[J/m²\] of the direct pulse on the plane.
pub fn point_through_slab_irradiance(input: &PointThroughSlab) -> Result<f64> {
    let Ray { secant, w, .. } = solve(input)?;
    let &PointThroughSlab { energy, air_gap, thickness, eta, .. } = input;
    let s = 4.0 * (1.0 / (1.0 + w)) * (w / (1.0 + w));
    let p = 4.0 * (eta * eta / (eta * eta + w)) * (w / (eta * eta + w));
    let transmitted = 0.5 * (s + p);
    let reach = air_gap + thickness / w;
    let spread = air_gap + (eta / w) * (eta / w) * (thickness / w);
    let cone = energy / (4.0 * PI) / secant / secant / secant;
    finite_result("point_through_slab", cone * transmitted * transmitted / reach / spread)
}

/// The sine of the angle θ1 of the direct ray in air.
pub fn point_through_slab_sine(input: &PointThroughSlab) -> Result<f64> {
    let Ray { tangent, secant, .. } = solve(input)?;
    Ok(tangent / secant)
}

/// The time \[s\] when the direct pulse arrives.
pub fn point_through_slab_time(input: &PointThroughSlab) -> Result<f64> {
    let Ray { secant, w, .. } = solve(input)?;
    let &PointThroughSlab { air_gap, thickness, eta, speed, .. } = input;
    let optical = air_gap + eta * (eta / w) * thickness;
    finite_result("point_through_slab", secant * optical / speed)
}

/// The direct ray in air.
#[derive(Debug, Clone, Copy)]
struct Ray {
    /// u = tan θ1.
    tangent: f64,
    /// √(1 + u²).
    secant: f64,
    /// √(η² + (η² − 1) u²).
    w: f64,
}

impl Ray {
    fn new(eta: f64, tangent: f64) -> Self {
        let w = eta.hypot((eta - 1.0).sqrt() * (eta + 1.0).sqrt() * tangent);
        Self { tangent, secant: tangent.hypot(1.0), w }
    }
}

fn solve(input: &PointThroughSlab) -> Result<Ray> {
    let &PointThroughSlab { energy, air_gap, thickness, eta, lateral, speed } = input;
    non_negative("energy", energy)?;
    non_negative("air_gap", air_gap)?;
    non_negative("thickness", thickness)?;
    require(eta.is_finite() && eta >= 1.0, "eta", eta, "at least 1 and finite")?;
    non_negative("lateral", lateral)?;
    positive("speed", speed)?;
    positive("air_gap + thickness", air_gap + thickness)?;
    if air_gap == 0.0 {
        let reach = thickness / ((eta - 1.0).sqrt() * (eta + 1.0).sqrt());
        require(lateral < reach, "lateral", lateral, "within the reach of the slab")?;
    }
    let mut ray = Ray::new(eta, lateral / (air_gap + thickness / eta));
    for _ in 0..MAX_STEPS {
        let missing = lateral - ray.tangent * (air_gap + thickness / ray.w);
        let slope = air_gap + (eta / ray.w) * (eta / ray.w) * (thickness / ray.w);
        let tangent = ray.tangent + missing / slope;
        // At the root, rounding ends the rise.
        if tangent <= ray.tangent || tangent.is_nan() {
            finite_result("point_through_slab", ray.tangent)?;
            return Ok(ray);
        }
        ray = Ray::new(eta, tangent);
    }
    Err(crate::ReferenceError::NoConvergence {
        value: ray.tangent,
        error: (lateral - ray.tangent * (air_gap + thickness / ray.w)).abs(),
    })
}

/// Newton's iteration at least multiplies a small u by 3/2 in a step, until it converges.
const MAX_STEPS: u32 = 5000;

#[cfg(test)]
#[path = "point_through_slab_tests.rs"]
mod tests;
