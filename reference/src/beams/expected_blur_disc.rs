//! What a renderer with the 2-D beam kernel must find *on average*: the disc-blurred single
//! scattering of an isotropic point pulse.
//!
//! The counterpart of [`crate::beams::expected_blur`] for the uniform disc of radius R across each beam, in the
//! same geometry: camera at the origin, looking along +z; source at the axial position z and at
//! the distance b > R from the ray; x = v t, q = x − z. A point of the ray at the axial distance
//! w = s − z from the source is seen through the beams of a cone; for isotropic scattering the average
//! over it has the closed form (own derivation)
//!
//! > E\[L\](t) = Q σs v e^(−σt x) / (8π² R²) · \[asinh(w2/b) − asinh(w1/b)\],
//! > w1 = max((q² − b²)/2q, −z),   w2 = (q² − b² + R²)/2q,
//!
//! and 0 where w2 ≤ w1. The second case of w1, a ray that starts inside a blurred shell, is the time
//! before the true front x² = z² + b²; light appears at x² = z² + b² − R². The two asinh are
//! close to each other whenever R ≪ b, so their difference is formed from w2 − w1, which is known
//! in closed form.
//!
//! [`expected_blur_2d`] is the density in time \[W/(m² sr)\]; [`expected_blur_2d_bins`] is its
//! integral over t0 ≤ t < t1 \[J/(m² sr)\], split at the true front, where the density has a kink.
//!
//! Domain: b > R > 0; isotropic scattering only, because the kernel tilts the directions of the beams
//! that see one point, and p then stays inside the average ([`super::expected_blur_disc_hg`]).

use crate::error::{Result, finite, finite_result, path_bin, path_length, positive, require};
use crate::numerics::path_integral::decaying_integral;
use crate::single_scattering::check_medium;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`expected_blur_2d`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blur2d {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
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

/// Inputs of [`expected_blur_2d_bins`]: those of [`Blur2d`] with a bin of time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of Blur2d, except for the bin")]
pub struct Blur2dBin {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
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
pub fn expected_blur_2d(input: &Blur2d) -> Result<f64> {
    let &Blur2d { energy, sigma_s, sigma_t, speed, ray_offset, source_z, radius, time } = input;
    check_medium(energy, sigma_s, sigma_t, 0.0)?;
    let blur = DiscBlur::new(ray_offset, source_z, radius)?;
    let x = path_length(speed, time)?;
    let since_onset = x - blur.onset();
    if since_onset <= 0.0 {
        return Ok(0.0);
    }
    let q = x - source_z;
    let kernel =
        if x < blur.front() { blur.before_front(q, x, since_onset) } else { blur.after_front(q) };
    let strength = energy * sigma_s * speed * (-sigma_t * x).exp();
    finite_result("expected_blur_2d", strength * kernel)
}

/// The expected radiance \[J/(m² sr)\] of the 2-D kernel within a bin.
pub fn expected_blur_2d_bins(input: &Blur2dBin) -> Result<f64> {
    let &Blur2dBin { energy, sigma_s, sigma_t, speed, ray_offset, source_z, radius, t0, t1 } =
        input;
    check_medium(energy, sigma_s, sigma_t, 0.0)?;
    let blur = DiscBlur::new(ray_offset, source_z, radius)?;
    let (start, end) = path_bin(speed, t0, t1)?;
    let (onset, front) = (blur.onset(), blur.front());
    let start = start.max(onset);
    let mut integral = 0.0;
    let early_end = end.min(front);
    if start < early_end {
        let early =
            |q: f64, passed: f64| blur.before_front(q, start + passed, (start - onset) + passed);
        let q = blur.q_beyond(onset, blur.core2(), start - onset);
        integral += decaying_integral(q, early_end - start, sigma_t, &[ray_offset], early)?;
    }
    let late_start = start.max(front);
    if late_start < end {
        let late = |q: f64, _: f64| blur.after_front(q);
        let q = blur.q_beyond(front, ray_offset * ray_offset, late_start - front);
        let decay = (-sigma_t * (late_start - start)).exp();
        integral += decay * decaying_integral(q, end - late_start, sigma_t, &[ray_offset], late)?;
    }
    let strength = energy * sigma_s * (-sigma_t * start).exp();
    finite_result("expected_blur_2d_bins", strength * integral)
}

/// The geometry of source, ray and disc; its kernels are E\[L\] without Q σs v e^(−σt x).
#[derive(Debug, Clone, Copy)]
pub(super) struct DiscBlur {
    /// b
    pub(super) offset: f64,
    /// z
    source_z: f64,
    /// R
    pub(super) radius: f64,
}

impl DiscBlur {
    pub(super) fn new(offset: f64, source_z: f64, radius: f64) -> Result<Self> {
        positive("radius", radius)?;
        finite("source_z", source_z)?;
        positive("ray_offset", offset)?;
        require(offset > radius, "ray_offset", offset, "larger than the radius")?;
        Ok(Self { offset, source_z, radius })
    }

    /// The path length of the earliest blurred light.
    pub(super) fn onset(&self) -> f64 {
        self.source_z.hypot(self.core2().sqrt())
    }

    /// The path length of the earliest light of the source itself.
    pub(super) fn front(&self) -> f64 {
        self.source_z.hypot(self.offset)
    }

    /// b² − R²
    pub(super) fn core2(&self) -> f64 {
        (self.offset - self.radius) * (self.offset + self.radius)
    }

    /// x − z at `passed` beyond `front`, where x² = z² + `distance2`, without cancellation.
    pub(super) fn q_beyond(&self, front: f64, distance2: f64, passed: f64) -> f64 {
        if self.source_z > 0.0 {
            distance2 / (front + self.source_z) + passed
        } else {
            (front - self.source_z) + passed
        }
    }

    /// w1 = −z; w2 + z = (x² − onset²) / 2q.
    fn before_front(&self, q: f64, x: f64, since_onset: f64) -> f64 {
        let width = since_onset * (x + self.onset()) / (2.0 * q);
        self.kernel(-self.source_z, width)
    }

    /// w1 = (q² − b²) / 2q; w2 − w1 = R² / 2q.
    fn after_front(&self, q: f64) -> f64 {
        let start = (q - self.offset) * ((q + self.offset) / (2.0 * q));
        self.kernel(start, self.radius / (2.0 * q) * self.radius)
    }

    fn kernel(&self, start: f64, width: f64) -> f64 {
        let angle = asinh_difference(start / self.offset, width / self.offset);
        angle / (8.0 * PI * PI) / self.radius / self.radius
    }
}

/// asinh(a + width) − asinh(a).
fn asinh_difference(a: f64, width: f64) -> f64 {
    let b = a + width;
    if a < 0.0 && b > 0.0 {
        return b.asinh() - a.asinh();
    }
    // sinh of the difference is b √(1 + a²) − a √(1 + b²) = (b² − a²) / (their sum).
    let sum = b * 1.0_f64.hypot(a) + a * 1.0_f64.hypot(b);
    if sum == 0.0 { 0.0 } else { (width / sum * (a + b)).asinh() }
}

#[cfg(test)]
#[path = "expected_blur_disc_tests.rs"]
mod tests;
