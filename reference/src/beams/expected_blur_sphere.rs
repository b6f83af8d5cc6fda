//! What a renderer with the 3-D beam kernel must find *on average*: the single scattering of an
//! isotropic point pulse, blurred by a sphere.
//!
//! The counterpart of [`super::expected_blur`] for the ball of radius R around each point of the ray,
//! in the same geometry: camera at the origin, looking along +z; source at the axial position
//! z and at the distance b > R from the ray; x = v t, q = x − z. Light that passes a point of the ray
//! at a displacement is the light of a source displaced the other way that passes the point itself,
//! so that the expected value is the mean of the single scattering over a *ball of sources*. With
//! X the vector from the place q' = 0 on the ray's line to (source's distance, q'), of length h and
//! at the angle β from the line, single scattering is Q σs v e^(−σt x) p(θ)/(2π h²) with
//! θ = π − 2β, and it has arrived if h ≤ 2x cos β (own derivation):
//!
//! > E\[L\](t) = Q σs v e^(−σt x) · 3/(8π² R³) · ∫ p(π − 2β) ℓ(β, φ) sin β dβ dφ,
//!
//! where ℓ is the length, within the ball around (b, q) and h < 2x cos β, of the line from X = 0 in
//! the direction (β, φ). For isotropic scattering, with H² = q² + b² and the time since the onset
//! y = min(2R, x − √(z² + b²) + R),
//!
//! > ∫ ℓ dΩ = π [y − (H² − R²)/2H · ln(1 + 2H y/((H − R)(H + R − y)))].
//!
//! Light appears R before the true front and is fully there R after it. Where y ≪ H − R the two
//! terms cancel, and ∫ y(2R − y)/((H − R + y)(H + R − y)) dy, which they are, is integrated instead.
//!
//! [`expected_blur_3d`] is the density in time \[W/(m² sr)\]; [`expected_blur_3d_bins`] is its
//! integral over t0 ≤ t < t1 \[J/(m² sr)\]. Where g ≠ 0, directions are counted from that of the
//! ball's centre: ℓ then depends on one angle alone once all light has arrived.
//!
//! Domain: b > R > 0. Beams that end at a sampled collision have the same expectation.

use crate::error::{Result, finite, finite_result, path_bin, path_length, positive, require};
use crate::numerics::path_integral::decaying_integral;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive, adaptive_above};
use crate::phase::{Deflection, henyey_greenstein};
use crate::single_scattering::check_medium;
use serde::Deserialize;
use std::f64::consts::{FRAC_PI_2, PI};

/// Inputs of [`expected_blur_3d`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blur3d {
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
    /// Radius R of the sphere \[m\].
    pub radius: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`expected_blur_3d_bins`]: those of [`Blur3d`] with a bin of time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of Blur3d, except for the bin")]
pub struct Blur3dBin {
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

/// The expected radiance \[W/(m² sr)\] of the 3-D kernel at an instant.
pub fn expected_blur_3d(input: &Blur3d) -> Result<f64> {
    let &Blur3d { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, time } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let blur = SphereBlur::new(g, ray_offset, source_z, radius)?;
    let x = path_length(speed, time)?;
    if x <= blur.onset() {
        return Ok(0.0);
    }
    let strength = energy * sigma_s * speed * (-sigma_t * x).exp();
    finite_result("expected_blur_3d", strength * blur.kernel(x - blur.onset())?)
}

/// The expected radiance \[J/(m² sr)\] of the 3-D kernel within a bin.
pub fn expected_blur_3d_bins(input: &Blur3dBin) -> Result<f64> {
    let &Blur3dBin { energy, sigma_s, sigma_t, g, ray_offset, source_z, radius, .. } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let blur = SphereBlur::new(g, ray_offset, source_z, radius)?;
    let (start, end) = path_bin(input.speed, input.t0, input.t1)?;
    let onset = blur.onset();
    // From here on, paths are counted from the onset.
    let (first, last) = ((start - onset).max(0.0), end - onset);
    if last <= first {
        return Ok(0.0);
    }
    let complete = 2.0 * radius;
    let mut integral = 0.0;
    if first < complete {
        integral += blur.arriving(first, last.min(complete), sigma_t)?;
    }
    if last > complete {
        let from = first.max(complete);
        let late = |_: f64, passed: f64| blur.kernel(from + passed).unwrap_or(f64::NAN);
        let decay = (-sigma_t * (from - first)).exp();
        // From the full front on, q is at least R and the blur varies on the scale of H.
        let q = blur.q_at_onset + from;
        integral += decay * decaying_integral(q, last - from, sigma_t, &[ray_offset], late)?;
    }
    let strength = energy * sigma_s * (-sigma_t * (onset + first)).exp();
    finite_result("expected_blur_3d_bins", strength * integral)
}

/// The geometry of source, ray and sphere; its kernels are E\[L\] without Q σs v e^(−σt x).
#[derive(Debug, Clone, Copy)]
struct SphereBlur {
    g: f64,
    /// b
    offset: f64,
    /// R
    radius: f64,
    /// √(z² + b²)
    front: f64,
    /// x − z at the onset; may be negative.
    q_at_onset: f64,
}

impl SphereBlur {
    fn new(g: f64, offset: f64, source_z: f64, radius: f64) -> Result<Self> {
        positive("radius", radius)?;
        finite("source_z", source_z)?;
        positive("ray_offset", offset)?;
        require(offset > radius, "ray_offset", offset, "larger than the radius")?;
        let front = source_z.hypot(offset);
        let q_at_front =
            if source_z > 0.0 { offset / (front + source_z) * offset } else { front - source_z };
        Ok(Self { g, offset, radius, front, q_at_onset: q_at_front - radius })
    }

    /// The path length of the earliest blurred light; positive, because b > R.
    fn onset(&self) -> f64 {
        self.front - self.radius
    }

    /// The expected radiance, `passed` after the onset.
    fn kernel(&self, passed: f64) -> Result<f64> {
        let q = self.q_at_onset + passed;
        let h = q.hypot(self.offset);
        let solid = if self.g == 0.0 {
            self.isotropic(q, h, passed)? / (4.0 * PI)
        } else {
            self.peaked(q, h, passed)?
        };
        Ok(0.375 / PI / PI * solid / self.radius / self.radius / self.radius)
    }

    /// ∫ ℓ dΩ.
    fn isotropic(&self, q: f64, h: f64, passed: f64) -> Result<f64> {
        let y = passed.min(2.0 * self.radius);
        let (offset, radius) = (self.offset, self.radius);
        let outside = (q * q + (offset - radius) * (offset + radius)) / (h + radius);
        if y <= 0.5 * outside {
            let integrand = |y: f64| y * (2.0 * radius - y) / (outside + y) / (h + radius - y);
            return Ok(PI * adaptive(integrand, &[0.0, y], INNER_TOLERANCE)?.value);
        }
        let logarithm = (2.0 * h * y / outside / (h + radius - y)).ln_1p();
        Ok(PI * (y - outside * (h + radius) / (2.0 * h) * logarithm))
    }

    /// ∫ p ℓ dΩ, around the direction of the ball's centre: sin χ = R/H sin a.
    fn peaked(&self, q: f64, h: f64, passed: f64) -> Result<f64> {
        let ratio = self.radius / h;
        let arrived = passed >= 2.0 * self.radius;
        let x = self.onset() + passed;
        let integrand = |a: f64| {
            let (sin_a, cos_a) = a.sin_cos();
            let sin_chi = ratio * sin_a;
            let cos_chi = ((1.0 - sin_chi) * (1.0 + sin_chi)).sqrt();
            // cos β = level + swing cos ψ, sin β from the other components of the direction.
            let direction = Direction {
                level: cos_chi * (q / h),
                swing: sin_chi * (self.offset / h),
                out: cos_chi * (self.offset / h),
                tilt: sin_chi * (q / h),
                sin_chi,
            };
            let ring = if arrived {
                self.ring(&direction).map(|mean| mean * 2.0 * self.radius * cos_a)
            } else {
                let middle = h * cos_chi;
                let half = self.radius * cos_a;
                self.clipped_ring(&direction, (middle - half, middle + half), x)
            };
            ratio * ratio * sin_a * cos_a / cos_chi * ring.unwrap_or(f64::NAN)
        };
        let noise = if arrived { 0.0 } else { ratio * ratio * self.noise(h) };
        Ok(adaptive_above(noise, integrand, &[0.0, FRAC_PI_2], INNER_TOLERANCE)?.value)
    }

    /// ∫ p dψ around a ring: the trapezoidal rule, which converges fast for periodic functions.
    fn ring(&self, direction: &Direction) -> Result<f64> {
        let at = |psi: f64| henyey_greenstein(self.g, direction.deflection(psi));
        let mut sum = 0.5 * (at(0.0) + at(PI));
        let (mut points, mut last) = (1_u32, f64::NAN);
        while points <= 1 << 14 {
            let step = PI / f64::from(points);
            sum += (0..points)
                .filter(|i| points == 1 || i % 2 == 1)
                .map(|i| if points == 1 { 0.0 } else { at(f64::from(i) * step) })
                .sum::<f64>();
            let value = 2.0 * step * sum;
            if points >= 8 && (value - last).abs() <= RING_TOLERANCE * value {
                return Ok(value);
            }
            (points, last) = (2 * points, value);
        }
        Ok(2.0 * adaptive(at, &[0.0, FRAC_PI_2, PI], INNER_TOLERANCE)?.value)
    }

    /// ∫ p ℓ dψ around a ring of which only h < 2x cos β counts.
    fn clipped_ring(&self, direction: &Direction, chord: (f64, f64), x: f64) -> Result<f64> {
        let turn = |h: f64| (h / (2.0 * x) - direction.level) / direction.swing;
        let turns = [turn(chord.1), turn(chord.0)].map(|cos| cos.clamp(-1.0, 1.0).acos());
        let integrand = |psi: f64| {
            let end = chord.1.min(2.0 * x * direction.cos_beta(psi));
            let seen = (end - chord.0).max(0.0);
            seen * henyey_greenstein(self.g, direction.deflection(psi))
        };
        let breaks = [0.0, turns[0], turns[1]];
        let noise = self.noise(chord.1);
        Ok(2.0 * adaptive_above(noise, integrand, &breaks, INNER_TOLERANCE)?.value)
    }

    /// The rounding of lengths like `h`, as an error of ∫ p ℓ dψ.
    fn noise(&self, h: f64) -> f64 {
        let spread = 1.0 - self.g.abs();
        8.0 * f64::EPSILON * h / (spread * spread)
    }

    /// ∫ kernel e^(−σt (y − first)) dy until all light has arrived.
    fn arriving(&self, first: f64, last: f64, sigma_t: f64) -> Result<f64> {
        let mut breaks = vec![first, last, self.radius];
        breaks.extend([1.0, 8.0, 40.0, 750.0].map(|lengths| first + lengths / sigma_t));
        // Where the ball is closest to the line's origin: q = 0.
        breaks.extend([-1.0, 0.0, 1.0].map(|scale| scale * self.offset - self.q_at_onset));
        breaks.retain(|y| (first..=last).contains(y));
        breaks.sort_by(f64::total_cmp);
        let integrand =
            |y: f64| self.kernel(y).unwrap_or(f64::NAN) * (-sigma_t * (y - first)).exp();
        Ok(adaptive(integrand, &breaks, OUTER_TOLERANCE)?.value)
    }
}

/// Directions at one angle χ from that of the ball's centre, all ψ around it.
#[derive(Debug, Clone, Copy)]
struct Direction {
    level: f64,
    swing: f64,
    out: f64,
    tilt: f64,
    sin_chi: f64,
}

impl Direction {
    fn cos_beta(&self, psi: f64) -> f64 {
        self.level + self.swing * psi.cos()
    }

    /// θ = π − 2β: sin²(θ/2) = cos²β.
    fn deflection(&self, psi: f64) -> Deflection {
        let (sin, cos) = psi.sin_cos();
        let sin_beta = (self.out - self.tilt * cos).hypot(self.sin_chi * sin);
        Deflection::from_half_tangent(self.cos_beta(psi).abs(), sin_beta)
    }
}

/// The quadratures over directions, inside those over time.
const INNER_TOLERANCE: f64 = 0.1 * RELATIVE_TOLERANCE;
const RING_TOLERANCE: f64 = 1e-13;
const OUTER_TOLERANCE: f64 = RELATIVE_TOLERANCE;

#[cfg(test)]
#[path = "expected_blur_sphere_tests.rs"]
mod tests;
