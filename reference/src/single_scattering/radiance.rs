//! Light scattered once in an infinite homogeneous medium, from an isotropic point pulse.
//!
//! # Radiance along a camera ray
//!
//! The camera is at the origin; the source is at the distance D and at the angle α from the ray.
//! With x = v t, z = D cos α, b = D sin α and
//!
//! > q = x − z = (x − D) + 2 D sin²(α/2),
//!
//! the one point of the ray that is seen at t deflects light by θ = 2 atan(q/b), and
//!
//! > I(t) = Q σs v p(θ) e^(−σt x) / (2π (q² + b²)),   x ≥ D
//!
//! ([`single_scatter_radiance`], \[W/(m² sr)\]). This is the substitution of equi-angular sampling
//! (Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in Participating Media",
//! 2012) with time as the variable. The second form of q keeps its digits as α → 0. The wavefront
//! itself belongs to the domain: the radiance there is finite, a step. Only on the wavefront
//! of a source that lies exactly on the ray is it infinite, which is an error.
//!
//! [`single_scatter_radiance_bins`] \[J/(m² sr)\] integrates over t0 ≤ t < t1. In θ the integrand
//! is p e^(−σt (z + b tan(θ/2))) / b, which degenerates as b → 0; in ln q it does not
//! (`path_integral`).
//!
//! # Not handled
//!
//! A ray of finite length, a boundary, other emitters than the isotropic point.

use crate::error::{Result, finite_result, non_negative, path_bin, path_length, positive, require};
use crate::numerics::path_integral::decaying_integral;
use crate::phase::{Deflection, check_mean_cosine, henyey_greenstein};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`single_scatter_radiance`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SingleScatter {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Distance D from the camera to the source \[m\].
    pub source_distance: f64,
    /// Angle α between the camera ray and the direction to the source, 0 to π \[rad\].
    pub alpha: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`single_scatter_radiance_bins`]: those of [`SingleScatter`] with a bin of time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of SingleScatter, except for the bin")]
pub struct SingleScatterBin {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
    pub g: f64,
    pub speed: f64,
    pub source_distance: f64,
    pub alpha: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The radiance \[W/(m² sr)\] of once-scattered light at an instant.
pub fn single_scatter_radiance(input: &SingleScatter) -> Result<f64> {
    let &SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let ray = RayToSource::new(source_distance, alpha)?;
    let path = path_length(speed, time)?;
    if path < source_distance {
        return Ok(0.0);
    }
    let q = (path - source_distance) + ray.q_at_front;
    let strength = energy * sigma_s * speed * (-sigma_t * path).exp();
    finite_result("single_scatter_radiance", strength * ray.kernel(g, q))
}

/// The radiance \[J/(m² sr)\] of once-scattered light that arrives within a bin.
pub fn single_scatter_radiance_bins(input: &SingleScatterBin) -> Result<f64> {
    let &SingleScatterBin { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, .. } =
        input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let ray = RayToSource::new(source_distance, alpha)?;
    let (start, end) = path_bin(speed, input.t0, input.t1)?;
    let start = start.max(source_distance);
    if end <= start {
        return Ok(0.0);
    }
    let q_start = (start - source_distance) + ray.q_at_front;
    require(q_start > 0.0, "alpha", alpha, "above 0 where the bin holds the wavefront")?;
    let strength = energy * sigma_s * (-sigma_t * start).exp();
    if strength == 0.0 {
        return Ok(0.0);
    }
    let unit = ray.distance(q_start);
    let kernel = |q: f64, _| ray.kernel_per(unit, g, q);
    let integral = decaying_integral(q_start, end - start, sigma_t, &ray.scales(g), kernel)?;
    finite_result("single_scatter_radiance_bins", strength * (integral / unit / unit))
}

/// Checks what every solution of singly scattered light has in common.
pub(crate) fn check_medium(energy: f64, sigma_s: f64, sigma_t: f64, g: f64) -> Result<()> {
    non_negative("energy", energy)?;
    non_negative("sigma_s", sigma_s)?;
    non_negative("sigma_t", sigma_t)?;
    check_mean_cosine(g)?;
    Ok(())
}

/// How the source lies relative to the camera ray.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RayToSource {
    /// b: distance of the source from the line of the ray.
    offset: f64,
    /// q at the wavefront.
    pub(crate) q_at_front: f64,
}

impl RayToSource {
    pub(crate) fn new(source_distance: f64, alpha: f64) -> Result<Self> {
        positive("source_distance", source_distance)?;
        require((0.0..=PI).contains(&alpha), "alpha", alpha, "between 0 and pi")?;
        Ok(Self {
            offset: source_distance * alpha.sin(),
            q_at_front: 2.0 * source_distance * (0.5 * alpha).sin().powi(2),
        })
    }

    /// p(θ) / (2π (q² + b²)).
    fn kernel(&self, g: f64, q: f64) -> f64 {
        self.kernel_per(1.0, g, q)
    }

    /// The same times `unit`², for integrals over squares that are out of range.
    pub(crate) fn kernel_per(&self, unit: f64, g: f64, q: f64) -> f64 {
        let share = unit / self.distance(q);
        let deflection = Deflection::from_half_tangent(q, self.offset);
        henyey_greenstein(g, deflection) / (2.0 * PI) * share * share
    }

    /// √(q² + b²)
    pub(crate) fn distance(&self, q: f64) -> f64 {
        q.hypot(self.offset)
    }

    /// The q at which the kernel changes its slope.
    pub(crate) fn scales(&self, g: f64) -> [f64; 3] {
        // Where p turns from its peak to its tail: 4 g sin²(θ/2) = (1 − g)² or its mirror image.
        let knee = (1.0 - g.abs()) / (2.0 * g.abs().sqrt());
        [self.offset, self.offset * knee, self.offset / knee]
    }
}

#[cfg(test)]
#[path = "radiance_tests.rs"]
mod tests;
