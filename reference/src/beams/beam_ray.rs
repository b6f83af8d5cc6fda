//! One photon beam seen along one camera ray: the radiance that a blur kernel makes of the pair.
//!
//! A beam o_b + s_b d of energy Φ crosses a homogeneous medium, in which a camera ray o_c + s_r ω
//! looks (ω points away from the camera). Light runs along d and leaves along −ω, so that the
//! deflection θ has cos θ = −d·ω. With
//!
//! > κ = 1 + d·ω = 1 − cos θ ∈ \[0, 2\],   sin ψ = |d × ω|,
//!
//! moving by u along the ray moves the foot on the beam by (κ − 1) u: the path length s_b + s_r
//! grows by κ u. The kernels are those of Jarosz, Nowrouzezahrai, Sadeghi and Jensen ("A
//! Comprehensive Theory of Volumetric Radiance Estimation Using Photon Points and Beams", 2011,
//! section 5), with the time kept instead of integrated.
//!
//! # Kernel across the plane of closest approach (1-D)
//!
//! > L(t) = Φ σs p(θ) e^(−σt S) / (2R sin ψ) · δ(t − S/v),   S = s_b + s_r at closest approach,
//!
//! if the lines pass within h < R and both feet lie on their segments. [`beam_ray_1d`] is the weight
//! for Φ = 1. Parallel pairs have measure zero and the weight 0.
//!
//! # Kernel over the disc across the beam (2-D)
//!
//! > L(t) = Φ σs p(θ) v / (π R² κ) · e^(−σt v t)
//!
//! while the point of the ray is inside the cylinder of radius R around the beam, its foot lies on
//! the beam, and it lies on the ray; [`beam_ray_2d_bins`] integrates over t0 ≤ t < t1. In the
//! position u along the ray, the energy between u₁ and u₂ is
//!
//! > Φ σs p / (π R²) · e^(−σt S(u₁)) · (u₂ − u₁) · f(σt κ (u₂ − u₁)),   f(x) = (1 − e^(−x))/x,
//!
//! where nothing divides by κ: a ray that looks straight into the beam (κ = 0) receives everything
//! at one instant. Also, κ = sin²ψ / (1 − d·ω) where d·ω < 0, and the ends of the cylinder come
//! from the form of the quadratic formula that does not cancel, so that neither almost parallel
//! nor almost antiparallel pairs lose digits.
//!
//! Directions are normalised here. Domain: R > 0; lengths of segments may be 0 but not infinite.

use crate::error::{Result, finite_result, non_negative, path_bin, positive};
use crate::numerics::vector::{self, Vector, cross, dot, length, scale, subtract, unit};
use crate::phase::{Deflection, henyey_greenstein};
use crate::single_scattering::check_medium;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`beam_ray_1d`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeamRay1d {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
    /// Half-width R of the kernel \[m\].
    pub radius: f64,
    /// Origin of the beam \[m\].
    pub beam_origin: [f64; 3],
    /// Direction of the beam, of any length.
    pub beam_direction: [f64; 3],
    /// Length of the beam \[m\].
    pub beam_length: f64,
    /// Origin of the camera ray \[m\].
    pub ray_origin: [f64; 3],
    /// Direction of the camera ray, away from the camera, of any length.
    pub ray_direction: [f64; 3],
    /// Length of the camera ray \[m\].
    pub ray_length: f64,
}

/// Inputs of [`beam_ray_2d_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeamRay2dBin {
    /// Energy Φ of the beam \[J\].
    pub energy: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Radius R of the disc \[m\].
    pub radius: f64,
    /// Origin of the beam \[m\].
    pub beam_origin: [f64; 3],
    /// Direction of the beam, of any length.
    pub beam_direction: [f64; 3],
    /// Length of the beam \[m\].
    pub beam_length: f64,
    /// Origin of the camera ray \[m\].
    pub ray_origin: [f64; 3],
    /// Direction of the camera ray, away from the camera, of any length.
    pub ray_direction: [f64; 3],
    /// Length of the camera ray \[m\].
    pub ray_length: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The weight \[1/(m² sr)\] of the delta in time that the 1-D kernel makes of a unit of energy.
pub fn beam_ray_1d(input: &BeamRay1d) -> Result<f64> {
    let &BeamRay1d { sigma_s, sigma_t, g, radius, beam_length, ray_length, .. } = input;
    check_medium(1.0, sigma_s, sigma_t, g)?;
    check_lengths(radius, beam_length, ray_length)?;
    let beam = (input.beam_origin, input.beam_direction);
    let pair = Pair::new(beam, (input.ray_origin, input.ray_direction))?;
    let Some(crossing) = pair.crossing() else { return Ok(0.0) };
    let on_segments = (0.0..=beam_length).contains(&crossing.on_beam)
        && (0.0..=ray_length).contains(&crossing.on_ray);
    if crossing.distance >= radius || !on_segments {
        return Ok(0.0);
    }
    let transmittance = (-sigma_t * (crossing.on_beam + crossing.on_ray)).exp();
    let scattered = sigma_s * henyey_greenstein(g, pair.deflection()) * transmittance;
    finite_result("beam_ray_1d", scattered / (2.0 * radius) / pair.sin_psi)
}

/// The radiance \[J/(m² sr)\] that the 2-D kernel makes of the pair within a bin.
pub fn beam_ray_2d_bins(input: &BeamRay2dBin) -> Result<f64> {
    let &BeamRay2dBin { energy, sigma_s, sigma_t, g, radius, beam_length, ray_length, .. } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    check_lengths(radius, beam_length, ray_length)?;
    let bin = path_bin(input.speed, input.t0, input.t1)?;
    let beam = (input.beam_origin, input.beam_direction);
    let pair = Pair::new(beam, (input.ray_origin, input.ray_direction))?;
    let Some((start, end)) = Some((0.0, ray_length))
        .and_then(|span| clip(span, pair.inside_cylinder(radius)?))
        .and_then(|span| clip(span, pair.with_foot_on_beam(beam_length)?))
        .and_then(|span| clip(span, pair.arriving_within(bin)?))
    else {
        return Ok(0.0);
    };
    let first_path = pair.foot_at_start + pair.kappa * start;
    let shape = decay_mean(sigma_t * pair.kappa * (end - start));
    let scattered = energy * sigma_s * henyey_greenstein(g, pair.deflection());
    let spread = (-sigma_t * first_path).exp() * (end - start) * shape / PI / radius / radius;
    finite_result("beam_ray_2d_bins", scattered * spread)
}

pub(super) fn check_lengths(radius: f64, beam_length: f64, ray_length: f64) -> Result<()> {
    positive("radius", radius)?;
    non_negative("beam_length", beam_length)?;
    non_negative("ray_length", ray_length)?;
    Ok(())
}

/// The mean of e^(−u) over 0 < u < x.
pub(super) fn decay_mean(x: f64) -> f64 {
    if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 }
}

/// An interval of positions along the camera ray.
pub(super) type Span = (f64, f64);

/// The common part of two intervals, unless it is empty.
pub(super) fn clip(a: Span, b: Span) -> Option<Span> {
    let (start, end) = (a.0.max(b.0), a.1.min(b.1));
    (start < end).then_some((start, end))
}

/// A beam and a camera ray, in what is common to all kernels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) beam_direction: Vector,
    pub(super) ray_direction: Vector,
    /// From the beam's origin to the ray's.
    pub(super) offset: Vector,
    /// d × ω, of length sin ψ.
    pub(super) normal: Vector,
    pub(super) sin_psi: f64,
    pub(super) cos_psi: f64,
    /// 1 + cos ψ = 1 − cos θ.
    pub(super) kappa: f64,
    /// 1 − cos ψ = 1 + cos θ.
    kappa_complement: f64,
    /// The position along the beam of the foot of the ray's origin.
    pub(super) foot_at_start: f64,
}

/// Where the lines of a beam and a ray come closest.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    on_beam: f64,
    on_ray: f64,
    distance: f64,
}

impl Pair {
    pub(super) fn new(beam: (Vector, Vector), ray: (Vector, Vector)) -> Result<Self> {
        vector::finite("beam_origin", beam.0)?;
        vector::finite("ray_origin", ray.0)?;
        let beam_direction = unit("beam_direction", beam.1)?;
        let ray_direction = unit("ray_direction", ray.1)?;
        let normal = cross(beam_direction, ray_direction);
        let sin_psi = length(normal);
        let cos_psi = dot(beam_direction, ray_direction);
        // The larger of the two is a sum; the smaller one follows from their product sin²ψ.
        let larger = 1.0 + cos_psi.abs();
        let smaller = sin_psi * sin_psi / larger;
        let (kappa, kappa_complement) =
            if cos_psi < 0.0 { (smaller, larger) } else { (larger, smaller) };
        let offset = subtract(ray.0, beam.0);
        let foot_at_start = dot(offset, beam_direction);
        Ok(Self {
            beam_direction,
            ray_direction,
            offset,
            normal,
            sin_psi,
            cos_psi,
            kappa,
            kappa_complement,
            foot_at_start,
        })
    }

    pub(super) fn deflection(&self) -> Deflection {
        Deflection { sin2_half: 0.5 * self.kappa, cos2_half: 0.5 * self.kappa_complement }
    }

    /// The closest approach, or `None` for parallel lines.
    fn crossing(&self) -> Option<Crossing> {
        if self.sin_psi == 0.0 {
            return None;
        }
        let normal = scale(self.normal, 1.0 / self.sin_psi);
        let on_ray = dot(cross(self.offset, self.beam_direction), normal) / self.sin_psi;
        let on_beam = self.foot_at_start + on_ray * self.cos_psi;
        Some(Crossing { on_beam, on_ray, distance: dot(self.offset, normal).abs() })
    }

    /// Where the ray is inside the infinite cylinder around the beam.
    pub(super) fn inside_cylinder(&self, radius: f64) -> Option<Span> {
        let distance_at_start = length(cross(self.offset, self.beam_direction));
        if self.sin_psi == 0.0 {
            return (distance_at_start < radius).then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let normal = scale(self.normal, 1.0 / self.sin_psi);
        let distance = dot(self.offset, normal).abs();
        if distance >= radius {
            return None;
        }
        // Across the beam, the ray runs at the distance `distance` from it; in units of its motion
        // there, it starts at `along` and is inside between ±half_chord.
        let along = dot(self.offset, cross(normal, self.beam_direction));
        let half_chord = ((radius - distance) * (radius + distance)).sqrt();
        let outer = -(along + half_chord.copysign(along));
        let product = (distance_at_start - radius) * (distance_at_start + radius);
        let (a, b) = (outer / self.sin_psi, product / outer / self.sin_psi);
        Some((a.min(b), a.max(b)))
    }

    /// Where the foot of the ray's point lies on the beam.
    fn with_foot_on_beam(&self, beam_length: f64) -> Option<Span> {
        where_linear_is_within(self.foot_at_start, self.cos_psi, (0.0, beam_length))
    }

    /// Where the ray's point is seen within a bin of path lengths, its end excluded.
    fn arriving_within(&self, bin: Span) -> Option<Span> {
        if self.kappa == 0.0 && self.foot_at_start == bin.1 {
            return None;
        }
        where_linear_is_within(self.foot_at_start, self.kappa, bin)
    }
}

/// Where `start + slope * s` lies within `range`, ends included.
fn where_linear_is_within(start: f64, slope: f64, range: Span) -> Option<Span> {
    if slope == 0.0 {
        let inside = (range.0..=range.1).contains(&start);
        return inside.then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (a, b) = ((range.0 - start) / slope, (range.1 - start) / slope);
    Some((a.min(b), a.max(b)))
}

#[cfg(test)]
#[path = "beam_ray_tests.rs"]
mod tests;
