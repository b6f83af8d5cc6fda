//! The disc-blurred single scattering of an isotropic point pulse in a medium of any mean cosine g.
//!
//! [`super::expected_blur_disc`] averages isotropic scattering over the cone of beams that see one
//! point. In its geometry, a beam in the direction (θ, φ) from the source is met by the ray's light of
//! path length x = z + q where the point at r = q tan(θ/2), φ of the plane across the ray lies within
//! R of the source's place there, at the distance b: sin θ dθ/κ = 2 r dr/(q² + r²). The cone
//! average is therefore a mean over a *disc of sources* across the camera ray (own derivation),
//!
//! > E\[L\](t) = 1/(πR²) · ∫ L(t; r, z) d²ϱ,   ϱ0 < ϱ < R,   r² = b² + ϱ² − 2bϱ cos φ,
//!
//! of the single scattering L = Q σs v e^(−σt x) p(θs)/(2π (q² + r²)), θs = 2 atan(q/r)
//! ([`crate::single_scattering`]). ϱ0² = max(0, b² + z² − x²) leaves out the points behind the
//! camera; those behind the source do not exist while b > R. As p depends on r alone, the angle
//! at the ray has a closed form once ϱ0 = 0; before, the angle at the source is summed instead, so
//! that the onset keeps its digits.
//!
//! [`expected_blur_2d_hg`] is the density in time \[W/(m² sr)\]; [`expected_blur_2d_hg_bins`] is
//! its integral over t0 ≤ t < t1 \[J/(m² sr)\]. Domain: b > R > 0.

use super::expected_blur_disc::DiscBlur;
use crate::error::{Result, finite_result, path_bin, path_length};
use crate::numerics::path_integral::decaying_integral;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use crate::phase::{Deflection, henyey_greenstein};
use crate::single_scattering::check_medium;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`expected_blur_2d_hg`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blur2dHg {
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
    /// Distance b of the source from the line of the camera ray \[m\].
    pub ray_offset: f64,
    /// Position z of the source along the camera ray; negative is behind the camera \[m\].
    pub source_z: f64,
    /// Radius R of the disc \[m\].
    pub radius: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`expected_blur_2d_hg_bins`]: those of [`Blur2dHg`] with a bin of time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of Blur2dHg, except for the bin")]
pub struct Blur2dHgBin {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
    pub g: f64,
    pub speed: f64,
    pub ray_offset: f64,
    pub source_z: f64,
    pub radius: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The expected radiance \[W/(m² sr)\] of the 2-D kernel at an instant.
pub fn expected_blur_2d_hg(input: &Blur2dHg) -> Result<f64> {
    let &Blur2dHg { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, time } =
        input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let disc = DiscBlur::new(ray_offset, source_z, radius)?;
    let x = path_length(speed, time)?;
    let onset = disc.onset();
    if x <= onset {
        return Ok(0.0);
    }
    let peaked = Peaked { disc, g };
    let q = disc.q_beyond(onset, disc.core2(), x - onset);
    let kernel = if x < disc.front() {
        peaked.before_front(q, x, x - onset)?
    } else {
        peaked.after_front(q)?
    };
    let strength = energy * sigma_s * speed * (-sigma_t * x).exp();
    finite_result("expected_blur_2d_hg", strength * kernel)
}

/// The expected radiance \[J/(m² sr)\] of the 2-D kernel within a bin.
pub fn expected_blur_2d_hg_bins(input: &Blur2dHgBin) -> Result<f64> {
    let &Blur2dHgBin { energy, sigma_s, sigma_t, g, ray_offset, source_z, radius, .. } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let disc = DiscBlur::new(ray_offset, source_z, radius)?;
    let peaked = Peaked { disc, g };
    let (start, end) = path_bin(input.speed, input.t0, input.t1)?;
    let (onset, front) = (disc.onset(), disc.front());
    let start = start.max(onset);
    let knee = (1.0 - g.abs()) / (2.0 * g.abs().sqrt());
    let scales = [ray_offset, ray_offset * knee, ray_offset / knee];
    let mut integral = 0.0;
    let early_end = end.min(front);
    if start < early_end {
        let early = |q: f64, passed: f64| {
            let (x, since_onset) = (start + passed, (start - onset) + passed);
            peaked.before_front(q, x, since_onset).unwrap_or(f64::NAN)
        };
        let q = disc.q_beyond(onset, disc.core2(), start - onset);
        integral += decaying_integral(q, early_end - start, sigma_t, &scales, early)?;
    }
    let late_start = start.max(front);
    if late_start < end {
        let late = |q: f64, _: f64| peaked.after_front(q).unwrap_or(f64::NAN);
        let q = disc.q_beyond(front, ray_offset * ray_offset, late_start - front);
        let decay = (-sigma_t * (late_start - start)).exp();
        integral += decay * decaying_integral(q, end - late_start, sigma_t, &scales, late)?;
    }
    let strength = energy * sigma_s * (-sigma_t * start).exp();
    finite_result("expected_blur_2d_hg_bins", strength * integral)
}

/// Disc and phase function; the kernels are E\[L\] without Q σs v e^(−σt x).
#[derive(Debug, Clone, Copy)]
struct Peaked {
    disc: DiscBlur,
    g: f64,
}

impl Peaked {
    /// p / (2π (q² + r²)).
    fn sharp(&self, q: f64, r: f64) -> f64 {
        let distance = q.hypot(r);
        henyey_greenstein(self.g, Deflection::from_half_tangent(q, r))
            / (2.0 * PI)
            / distance
            / distance
    }

    /// The whole disc, by circles around the ray: r = b − R cos a.
    fn after_front(&self, q: f64) -> Result<f64> {
        let (b, radius) = (self.disc.offset, self.disc.radius);
        let integrand = |a: f64| {
            let sin = a.sin();
            let r = (b - radius) + radius * 2.0 * (0.5 * a).sin().powi(2);
            // Half the angle of the circle's part inside the disc.
            let half_angle = 2.0 * (radius * sin / (2.0 * (r * b).sqrt())).min(1.0).asin();
            2.0 * half_angle * r * radius * sin * self.sharp(q, r)
        };
        let integral = adaptive(integrand, &[0.0, 0.5 * PI, PI], INNER_TOLERANCE)?.value;
        Ok(integral / PI / radius / radius)
    }

    /// The ring ϱ0 < ϱ < R, by circles around the source, evenly in ϱ².
    fn before_front(&self, q: f64, x: f64, since_onset: f64) -> Result<f64> {
        let (b, radius) = (self.disc.offset, self.disc.radius);
        // R² − ϱ0².
        let width = since_onset * (x + self.disc.onset());
        let integrand = |u: f64| {
            let rho = (radius * radius - width * u).max(0.0).sqrt();
            self.circle(q, b, rho).unwrap_or(f64::NAN)
        };
        let mean = adaptive(integrand, &[0.0, 1.0], INNER_TOLERANCE)?.value;
        Ok(mean * (width / radius / radius))
    }

    /// The mean over a circle of sources.
    fn circle(&self, q: f64, b: f64, rho: f64) -> Result<f64> {
        let at = |phi: f64| {
            let half = (0.5 * phi).sin();
            let r = (b - rho).hypot(2.0 * (b * rho).sqrt() * half);
            self.sharp(q, r)
        };
        Ok(adaptive(at, &[0.0, 0.5 * PI, PI], 0.1 * INNER_TOLERANCE)?.value / PI)
    }
}

/// The quadratures over the disc, inside that over the time.
const INNER_TOLERANCE: f64 = 0.1 * RELATIVE_TOLERANCE;

#[cfg(test)]
#[path = "expected_blur_disc_hg_tests.rs"]
mod tests;
