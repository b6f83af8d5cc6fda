//! Single scattering that takes time.
//!
//! An isotropic point pulse, a camera ray, and a scattering that holds the light for an exponential
//! time of mean τ. With the radiance I₀ of scattering without dwell (`single_scattering`),
//!
//! > I(t) = (1/τ) ∫ I₀(t′) e^(−(t − t′)/τ) dt′,   D/v < t′ < t   \[W/(m² sr)\],
//!
//! that is, with x the path length and q, θ, b as there,
//!
//! > I(t) = Q σs / (2π τ) · ∫ p(θ)/(q² + b²) · e^(−σt x − (t − x/v)/τ) dx.
//!
//! The dwell is not attenuated: σt acts on x alone. Source: own derivation, a convolution.
//!
//! # Stable form
//!
//! The exponent changes by κ = σt − 1/(vτ) per path length. For κ ≥ 0 the light falls from the front
//! on, and the integral is taken in ln q from there. For κ < 0 it falls backward from the path
//! length v t; the last part, up to q/2, is taken in |κ| (v t − x), so that τ → 0 is a limit without
//! cancellation, and the rest in ln q. τ = 0 is the radiance without dwell.
//!
//! Domain: τ ≥ 0 and that of the radiance. The source must not lie exactly on the ray ahead: the
//! energy that comes with its front is infinite.

use crate::error::{Result, finite_result, non_negative, path_length, require};
use crate::numerics::front::offset;
use crate::numerics::path_integral::decaying_integral;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use crate::single_scattering::{RayToSource, SingleScatter, check_medium, single_scatter_radiance};
use serde::Deserialize;

/// Inputs of [`dwell_single_scatter_radiance`]: those of [`SingleScatter`] with a dwell time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of SingleScatter, except for the dwell time")]
pub struct DwellSingleScatter {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
    pub g: f64,
    pub speed: f64,
    pub source_distance: f64,
    pub alpha: f64,
    /// Mean dwell time τ \[s\].
    pub mean_dwell: f64,
    pub time: f64,
}

/// The radiance \[W/(m² sr)\] of once-scattered light whose scattering took time.
pub fn dwell_single_scatter_radiance(input: &DwellSingleScatter) -> Result<f64> {
    let &DwellSingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, .. } =
        input;
    let &DwellSingleScatter { mean_dwell, time, .. } = input;
    non_negative("mean_dwell", mean_dwell)?;
    let decay = 1.0 / (speed * mean_dwell);
    if decay == f64::INFINITY {
        return single_scatter_radiance(&SingleScatter {
            energy,
            sigma_s,
            sigma_t,
            g,
            speed,
            source_distance,
            alpha,
            time,
        });
    }
    check_medium(energy, sigma_s, sigma_t, g)?;
    let ray = RayToSource::new(source_distance, alpha)?;
    let path = path_length(speed, time)?;
    let behind = offset(speed, time, source_distance);
    if behind <= 0.0 {
        return Ok(0.0);
    }
    require(ray.q_at_front > 0.0, "alpha", alpha, "above 0")?;
    let unit = ray.distance(ray.q_at_front);
    let integrand = Integrand { ray, unit, g, behind, decay, sigma_t };
    let from_front = sigma_t >= decay;
    let depth =
        if from_front { sigma_t * source_distance + behind * decay } else { sigma_t * path };
    let strength = energy * sigma_s / mean_dwell * (-depth).exp();
    if strength == 0.0 {
        return Ok(0.0);
    }
    let integral =
        if from_front { integrand.weighted_to_front()? } else { integrand.weighted_to_now()? };
    finite_result("dwell_single_scatter_radiance", strength * (integral / unit / unit))
}

/// The integrals over the path length, with the largest exponential taken out.
#[derive(Debug, Clone, Copy)]
struct Integrand {
    ray: RayToSource,
    /// What lengths are measured in: their squares can be out of range.
    unit: f64,
    g: f64,
    /// v t − D
    behind: f64,
    /// 1/(vτ)
    decay: f64,
    sigma_t: f64,
}

impl Integrand {
    fn kernel(&self, q: f64) -> f64 {
        self.ray.kernel_per(self.unit, self.g, q)
    }

    /// ∫ kernel e^(−(σt − 1/(vτ)) (x − D)) dx.
    fn weighted_to_front(&self) -> Result<f64> {
        let rate = self.sigma_t - self.decay;
        let scales = self.ray.scales(self.g);
        decaying_integral(self.ray.q_at_front, self.behind, rate, &scales, |q, _| self.kernel(q))
    }

    /// ∫ kernel e^(−(1/(vτ) − σt) (v t − x)) dx.
    fn weighted_to_now(&self) -> Result<f64> {
        let rate = self.decay - self.sigma_t;
        let q_front = self.ray.q_at_front;
        let q_now = q_front + self.behind;
        let late = self.behind.min(0.5 * q_now);
        // In decay lengths before now, of which 800 are more than f64 can tell from all.
        let depth = (rate * late).min(800.0);
        let recent = |depth: f64| self.kernel(q_now - depth / rate) * (-depth).exp();
        let mut breaks = vec![0.0, 1.0, 8.0, 40.0, depth];
        breaks.retain(|&d| d <= depth);
        breaks.sort_by(f64::total_cmp);
        let last = adaptive(recent, &breaks, RELATIVE_TOLERANCE)?.value / rate;
        let early = self.behind - late;
        if early <= 0.0 {
            return Ok(last);
        }
        let rest = |q: f64, after: f64| self.kernel(q) * (-rate * (self.behind - after)).exp();
        Ok(last + decaying_integral(q_front, early, 0.0, &self.ray.scales(self.g), rest)?)
    }
}

#[cfg(test)]
#[path = "radiance_tests.rs"]
mod tests;
