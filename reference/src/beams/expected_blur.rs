//! What a renderer with the 1-D beam kernel must find *on average*: the blurred single scattering.
//!
//! A kernel of finite width replaces the radiance L by a blurred one, which the beams estimate
//! without bias. Knowing it turns "the bias is small" into an equality that can be tested. Here
//! the source is an isotropic point pulse, the beams are the first flights from it, and the medium
//! is infinite. The camera is at the origin and looks along +z; the source is at the axial
//! position z and at the distance b from the ray. A kernel of half-width R across the plane
//! of closest approach gives (own derivation)
//!
//! > E\[L\](t; b, R) = 1/(2R) · ∫ L(t; √(b² − y²), z) dy,   |y| < m = min(R, b),
//!
//! the single scattering ([`crate::single_scattering`]) of sources closer to the ray: the closer
//! they are, the earlier their light comes, so that the blurred front precedes the true one.
//! With x = v t, q = x − z, H² = q² + b² and y = H tanh u,
//!
//! > E\[L\] = Q σs v e^(−σt x) / (2π R H) · ∫ p(θ) du   from atanh(y0/H) to atanh(m/H),
//!
//! where sin²(θ/2) = (q/H)² cosh² u, and y0² = max(0, b² + z² − x²) leaves out the sources whose light
//! has not arrived. Isotropic scattering has p = 1/4π and needs no quadrature. The atanh are
//! taken as asinh of y / √(H² − y²), with H² − m² = q² + (b − m)(b + m) and H² − y0² = 2 x q, which
//! hold their digits when y approaches H.
//!
//! The same holds for beams cut at a sampled collision. Sampling, shading and
//! light scattered more often are not part of it. For b < R the value is not close to L at all.
//!
//! [`expected_blur_1d`] is the density in time \[W/(m² sr)\]; [`expected_blur_1d_bins`] is its
//! integral over t0 ≤ t < t1 \[J/(m² sr)\]. Before the true front y0 is the variable of that integral,
//! because the density grows as the square root of the time left; after it, ln q. If b ≤ R and
//! z > 0 the density has a logarithmic singularity at its onset x = z, which is an error
//! in the density and harmless in a bin.
//!
//! Domain: R > 0, b > 0 (a source on the ray gives a delta at x = z).

use crate::error::{Result, finite, finite_result, path_bin, path_length, positive, require};
use crate::numerics::path_integral::decaying_integral;
use crate::numerics::quadrature::{Node, RELATIVE_TOLERANCE, adaptive, tanh_sinh};
use crate::phase::{Deflection, henyey_greenstein};
use crate::single_scattering::check_medium;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`expected_blur_1d`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blur1d {
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
    /// Half-width R of the kernel \[m\].
    pub radius: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`expected_blur_1d_bins`]: those of [`Blur1d`] with a bin of time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of Blur1d, except for the bin")]
pub struct Blur1dBin {
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

/// The expected radiance \[W/(m² sr)\] of the 1-D kernel at an instant.
pub fn expected_blur_1d(input: &Blur1d) -> Result<f64> {
    let &Blur1d { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, time } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let blur = Blur::new(g, ray_offset, source_z, radius)?;
    let x = path_length(speed, time)?;
    let (onset, front) = (blur.onset(), blur.front());
    if x < onset || (x == onset && ray_offset > radius) {
        return Ok(0.0);
    }
    let q = x - source_z;
    require(q > 0.0, "time", time, "other than the onset, where the density is infinite")?;
    let y0 = if x < front { ((front - x) * (front + x)).sqrt() } else { 0.0 };
    let strength = energy * sigma_s * speed * (-sigma_t * x).exp();
    finite_result("expected_blur_1d", strength * blur.kernel(q, y0, x)?)
}

/// The expected radiance \[J/(m² sr)\] of the 1-D kernel within a bin.
pub fn expected_blur_1d_bins(input: &Blur1dBin) -> Result<f64> {
    let &Blur1dBin { energy, sigma_s, sigma_t, g, ray_offset, source_z, radius, .. } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let blur = Blur::new(g, ray_offset, source_z, radius)?;
    let (start, end) = path_bin(input.speed, input.t0, input.t1)?;
    let start = start.max(blur.onset());
    let front = blur.front();
    let mut integral = 0.0;
    if start < end.min(front) {
        integral += blur.before_front(start, end.min(front), sigma_t)?;
    }
    if start.max(front) < end {
        let from = start.max(front);
        // Relative to the decay at the start of the whole bin.
        integral += (-sigma_t * (from - start)).exp() * blur.after_front(from, end, sigma_t)?;
    }
    let strength = energy * sigma_s * (-sigma_t * start).exp();
    finite_result("expected_blur_1d_bins", strength * integral)
}

/// The geometry of source, ray and kernel.
#[derive(Debug, Clone, Copy)]
struct Blur {
    g: f64,
    /// b
    offset: f64,
    /// z
    source_z: f64,
    /// R
    radius: f64,
    /// m = min(R, b)
    reach: f64,
    /// b² − m²
    core2: f64,
}

impl Blur {
    fn new(g: f64, offset: f64, source_z: f64, radius: f64) -> Result<Self> {
        positive("ray_offset", offset)?;
        finite("source_z", source_z)?;
        positive("radius", radius)?;
        let reach = radius.min(offset);
        let core2 = (offset - reach) * (offset + reach);
        Ok(Self { g, offset, source_z, radius, reach, core2 })
    }

    /// The path length of the earliest blurred light.
    fn onset(&self) -> f64 {
        self.source_z.hypot(self.core2.sqrt())
    }

    /// The path length of the earliest light of the source itself.
    fn front(&self) -> f64 {
        self.source_z.hypot(self.offset)
    }

    /// The expected radiance at x = z + q, without Q σs v e^(−σt x).
    fn kernel(&self, q: f64, y0: f64, x: f64) -> Result<f64> {
        let h = q.hypot(self.offset);
        let start = if y0 > 0.0 { (y0 / (2.0 * x * q).sqrt()).asinh() } else { 0.0 };
        let end = (self.reach / q.hypot(self.core2.sqrt())).asinh();
        if end <= start {
            return Ok(0.0);
        }
        let phase = if self.g == 0.0 {
            (end - start) / (4.0 * PI)
        } else {
            let integrand = |u: f64| {
                let sin2_half = (q / h * u.cosh()).powi(2).min(1.0);
                let deflection = Deflection { sin2_half, cos2_half: 1.0 - sin2_half };
                henyey_greenstein(self.g, deflection)
            };
            adaptive(integrand, &[start, end], INNER_TOLERANCE)?.value
        };
        Ok(phase / (2.0 * PI * self.radius * h))
    }

    /// ∫ kernel e^(−σt (x − start)) dx between the onset and the true front, over y0.
    fn before_front(&self, start: f64, end: f64, sigma_t: f64) -> Result<f64> {
        let front = self.front();
        let y0_at = |x: f64| ((front - x) * (front + x)).sqrt().min(self.reach);
        let (low, high) =
            (y0_at(end), if start > self.onset() { y0_at(start) } else { self.reach });
        if low >= high {
            return Ok(0.0);
        }
        let integrand = |node: Node| {
            // b² − y0², which may vanish at the upper end.
            let rest = (self.offset - high + node.to_end) * (self.offset + node.x);
            let x = self.source_z.hypot(rest.sqrt());
            let q =
                if self.source_z > 0.0 { rest / (x + self.source_z) } else { x - self.source_z };
            let kernel = self.kernel(q, node.x, x).unwrap_or(f64::NAN);
            kernel * (-sigma_t * (x - start).max(0.0)).exp() * node.x / x
        };
        Ok(tanh_sinh(integrand, low, high, RELATIVE_TOLERANCE)?.value)
    }

    /// ∫ kernel e^(−σt (x − start)) dx beyond the true front.
    fn after_front(&self, start: f64, end: f64, sigma_t: f64) -> Result<f64> {
        let q_start = if self.source_z > 0.0 {
            (start - self.front()) + self.offset / (self.front() + self.source_z) * self.offset
        } else {
            start - self.source_z
        };
        let scales = [self.offset, self.core2.sqrt()];
        let integrand =
            |q: f64, offset: f64| self.kernel(q, 0.0, start + offset).unwrap_or(f64::NAN);
        decaying_integral(q_start, end - start, sigma_t, &scales, integrand)
    }
}

/// The quadrature over the kernel, inside that over the time.
const INNER_TOLERANCE: f64 = 0.1 * RELATIVE_TOLERANCE;

#[cfg(test)]
#[path = "expected_blur_tests.rs"]
mod tests;
