//! One photon beam seen along one camera ray through the 3-D kernel: a sphere of radius R swept
//! along the beam.
//!
//! Geometry and symbols are those of [`super::beam_ray`]. Every point of the ray sees every point
//! of the beam that is closer than R, at the density 3/(4πR³), so that a pair gives
//!
//! > L(t) = Φ σs p(θ) · 3/(4πR³) · ∫∫ e^(−σt (s_b + s_r)) δ(t − (s_b + s_r)/v) ds_b ds_r
//!
//! over |x_r(s_r) − x_b(s_b)| < R with both points on their segments (own derivation; the kernel is
//! the volumetric one of Jarosz, Nowrouzezahrai, Sadeghi and Jensen, "A Comprehensive Theory of
//! Volumetric Radiance Estimation Using Photon Points and Beams", 2011, section 5). [`beam_ray_3d`]
//! is the integral over all times, [`beam_ray_3d_bins`] that over t0 ≤ t < t1.
//!
//! From a point of the ray, the beam's points within R are the chord s_b = foot ± √(R² − distance²).
//! Segment and bin cut it to one interval, over which the exponential has a closed form; what
//! remains is one quadrature along the ray, split wherever an end of the chord meets an end
//! of the segment or of the bin: |p + s v| = R with v = ω for the segment and v = d + ω, |v|² = 2κ, for
//! the bin. Both are measured from the middle of the meeting, where coordinates are of
//! the size of R. Nothing divides by sin ψ or κ, so that parallel and antiparallel pairs are no
//! special cases. A pair without ends in the way has, with h the distance of the lines,
//!
//! > total = Φ σs p · 3 (R² − h²)/(4R³ sin ψ) · e^(−σt S) · 2 I₁(X)/X,
//! > X² = 2 σt² (R² − h²)/(1 − d·ω).
//!
//! Directions are normalised here. Domain: R > 0; lengths of segments may be 0 but not infinite.

use super::beam_ray::{Pair, Span, check_lengths, clip, decay_mean};
use crate::error::{Result, finite_result, path_bin};
use crate::numerics::quadrature::adaptive;
use crate::numerics::vector::{Vector, add, cross, dot, length, scale, subtract};
use crate::phase::henyey_greenstein;
use crate::single_scattering::check_medium;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`beam_ray_3d`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeamRay3d {
    /// Energy Φ of the beam \[J\].
    pub energy: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
    /// Radius R of the sphere \[m\].
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

/// Inputs of [`beam_ray_3d_bins`]: those of [`BeamRay3d`] with the speed of light and a bin.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of BeamRay3d, except for speed and bin")]
pub struct BeamRay3dBin {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
    pub g: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    pub radius: f64,
    pub beam_origin: [f64; 3],
    pub beam_direction: [f64; 3],
    pub beam_length: f64,
    pub ray_origin: [f64; 3],
    pub ray_direction: [f64; 3],
    pub ray_length: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The radiance \[J/(m² sr)\] that the 3-D kernel makes of the pair, all times together.
pub fn beam_ray_3d(input: &BeamRay3d) -> Result<f64> {
    finite_result("beam_ray_3d", energy_within(input, (f64::NEG_INFINITY, f64::INFINITY))?)
}

/// The radiance \[J/(m² sr)\] that the 3-D kernel makes of the pair within a bin.
pub fn beam_ray_3d_bins(input: &BeamRay3dBin) -> Result<f64> {
    let bin = path_bin(input.speed, input.t0, input.t1)?;
    finite_result("beam_ray_3d_bins", energy_within(&input.pair(), bin)?)
}

impl BeamRay3dBin {
    /// The same pair without the bin.
    fn pair(&self) -> BeamRay3d {
        let &Self { energy, sigma_s, sigma_t, g, radius, beam_length, ray_length, .. } = self;
        BeamRay3d {
            energy,
            sigma_s,
            sigma_t,
            g,
            radius,
            beam_origin: self.beam_origin,
            beam_direction: self.beam_direction,
            beam_length,
            ray_origin: self.ray_origin,
            ray_direction: self.ray_direction,
            ray_length,
        }
    }
}

/// The energy whose path length lies within `bin`.
fn energy_within(input: &BeamRay3d, bin: Span) -> Result<f64> {
    let &BeamRay3d { energy, sigma_s, sigma_t, g, radius, beam_length, ray_length, .. } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    check_lengths(radius, beam_length, ray_length)?;
    let beam = (input.beam_origin, input.beam_direction);
    let pair = Pair::new(beam, (input.ray_origin, input.ray_direction))?;
    let Some(near) = pair.inside_cylinder(radius).and_then(|span| clip(span, (0.0, ray_length)))
    else {
        return Ok(0.0);
    };
    let on_ray = 0.5 * (near.0 + near.1);
    let on_beam = (pair.foot_at_start + on_ray * pair.cos_psi).clamp(0.0, beam_length);
    let meeting = Meeting {
        beam_direction: pair.beam_direction,
        ray_direction: pair.ray_direction,
        offset: add(
            subtract(pair.offset, scale(pair.beam_direction, on_beam)),
            scale(pair.ray_direction, on_ray),
        ),
        radius,
        sigma_t,
        on_ray: (near.0 - on_ray, near.1 - on_ray),
        on_beam: (-on_beam, beam_length - on_beam),
        paths: (bin.0 - on_ray - on_beam, bin.1 - on_ray - on_beam),
        kappa: pair.kappa,
        across: Across::new(&pair, on_ray, radius),
    };
    let Some((first, integral)) = meeting.integral()? else { return Ok(0.0) };
    let density = 0.75 / PI / radius / radius * integral / radius;
    let transmittance = (-sigma_t * (first + on_ray + on_beam)).exp();
    Ok(energy * sigma_s * henyey_greenstein(g, pair.deflection()) * transmittance * density)
}

/// A pair in coordinates that are 0 in the middle of the meeting.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    beam_direction: Vector,
    ray_direction: Vector,
    /// From the beam's point 0 to the ray's point 0.
    offset: Vector,
    radius: f64,
    sigma_t: f64,
    /// The part of the ray within R of the beam's line.
    on_ray: Span,
    /// The beam.
    on_beam: Span,
    /// The bin of path lengths.
    paths: Span,
    kappa: f64,
    across: Across,
}

/// How the ray crosses the circle of radius R around the beam's line, seen along the beam: a
/// smooth function of s, however close to grazing the pair is.
#[derive(Debug, Clone, Copy)]
struct Across {
    /// Half of the circle's chord on which the ray runs.
    half_chord: f64,
    /// Where on the chord the ray's point 0 is, from the middle.
    at_zero: f64,
    /// sin ψ.
    speed: f64,
}

impl Across {
    fn new(pair: &Pair, on_ray: f64, radius: f64) -> Self {
        let point = add(pair.offset, scale(pair.ray_direction, on_ray));
        let (distance, at_zero) = if pair.sin_psi == 0.0 {
            (length(cross(point, pair.beam_direction)), 0.0)
        } else {
            let normal = scale(pair.normal, 1.0 / pair.sin_psi);
            (dot(point, normal).abs(), dot(point, cross(normal, pair.beam_direction)))
        };
        let half_chord = ((radius - distance).max(0.0) * (radius + distance)).sqrt();
        Self { half_chord, at_zero, speed: pair.sin_psi }
    }

    /// Half of what a point of the ray sees of the beam's line.
    fn half_width(&self, s: f64) -> f64 {
        let along = self.at_zero + self.speed * s;
        ((self.half_chord - along) * (self.half_chord + along)).max(0.0).sqrt()
    }
}

impl Meeting {
    /// What a point of the ray sees of the beam.
    fn chord(&self, s: f64) -> Option<Span> {
        let point = add(self.offset, scale(self.ray_direction, s));
        let half = self.across.half_width(s);
        let foot = dot(point, self.beam_direction);
        clip((foot - half, foot + half), self.on_beam)
            .and_then(|chord| clip(chord, (self.paths.0 - s, self.paths.1 - s)))
    }

    /// A path length F, and ∫∫ e^(−σt (s_b + s_r − F)) ds_b ds_r.
    fn integral(&self) -> Result<Option<(f64, f64)>> {
        let breaks = self.breaks();
        // At breaks chords may be empty, and begin.
        let between = breaks.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let points = between.chain(breaks.iter().copied());
        let Some(first) = self.least_path(points.collect()) else { return Ok(None) };
        let along_chord = |s: f64| {
            self.chord(s).map_or(0.0, |(start, end)| {
                let depth = self.sigma_t * (end - start);
                (-self.sigma_t * (s + start - first)).exp() * (end - start) * decay_mean(depth)
            })
        };
        // One abscissa for all parts: the tolerance is that of their sum. Chords begin and end as
        // square roots, which are smooth in the angle.
        let parts: Vec<f64> = (0..breaks.len()).map(|part| part as f64).collect();
        let in_angle = |abscissa: f64| {
            let part = (abscissa as usize).min(breaks.len() - 2);
            let (start, width) = (breaks[part], breaks[part + 1] - breaks[part]);
            let (sin, cos) = (0.5 * PI * (abscissa - part as f64)).sin_cos();
            PI * along_chord(start + width * sin * sin) * width * sin * cos
        };
        let integral = adaptive(in_angle, &parts, TOLERANCE)?.value;
        Ok(Some((first, integral)))
    }

    /// The least path length, from points of the ray that bracket it. The region is convex: so is
    /// the least path length at each point of the ray, infinite where it is not met.
    fn least_path(&self, mut points: Vec<f64>) -> Option<f64> {
        points.sort_by(f64::total_cmp);
        let path = |s: f64| self.chord(s).map_or(f64::INFINITY, |(start, _)| start + s);
        let paths: Vec<f64> = points.iter().map(|&s| path(s)).collect();
        let lowest = (0..paths.len()).min_by(|&a, &b| paths[a].total_cmp(&paths[b]))?;
        let mut least = paths[lowest];
        let (mut low, mut high) =
            (points[lowest.saturating_sub(1)], points[(lowest + 1).min(points.len() - 1)]);
        // Golden sections; 80 of them leave 1e-16 of the bracket.
        for _ in 0..80 {
            let (a, b) =
                (high - INVERSE_GOLDEN * (high - low), low + INVERSE_GOLDEN * (high - low));
            let (at_a, at_b) = (path(a), path(b));
            least = least.min(at_a).min(at_b);
            (low, high) = if at_a < at_b || at_a == at_b && points[lowest] < b {
                (low, b)
            } else {
                (a, high)
            };
        }
        least.is_finite().then_some(least)
    }

    /// Points of the ray between which the chord's ends are smooth, ascending, and more of them
    /// where the medium is dense.
    fn breaks(&self) -> Vec<f64> {
        let (start, end) = self.on_ray;
        let mut breaks = vec![start, end];
        for on_beam in [self.on_beam.0, self.on_beam.1] {
            let from = subtract(self.offset, scale(self.beam_direction, on_beam));
            breaks.extend(within(self.radius, from, self.ray_direction));
            breaks.extend([self.paths.0 - on_beam, self.paths.1 - on_beam]);
        }
        let bisector = add(self.beam_direction, self.ray_direction);
        for path in [self.paths.0, self.paths.1].into_iter().filter(|path| path.is_finite()) {
            let from = subtract(self.offset, scale(self.beam_direction, path));
            breaks.extend(within(self.radius, from, bisector));
        }
        if self.sigma_t * (end - start) > 1.0 {
            // The least path length of an ellipse is half its extent before the middle.
            let earliest = -0.5 * self.radius * (2.0 / (2.0 - self.kappa)).sqrt();
            breaks.push(earliest);
            for lengths in [1.0, 6.0, 40.0] {
                let step = lengths / self.sigma_t;
                let wide = (self.radius * step).sqrt();
                let ends: Vec<_> = breaks.clone();
                breaks.extend(ends.iter().flat_map(|s| [s - step, s + step]));
                breaks.extend([earliest - wide, earliest + wide]);
            }
        }
        breaks.retain(|s| (start..=end).contains(s));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

/// (√5 − 1)/2.
const INVERSE_GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Of the quadrature: a digit more than is promised.
const TOLERANCE: f64 = 1e-10;

/// The s at which `from + s * direction` is at the distance `radius` from 0.
fn within(radius: f64, from: Vector, direction: Vector) -> Vec<f64> {
    let (speed, distance) = (length(direction), length(from));
    let across = length(cross(from, direction));
    let discriminant = (radius * speed - across) * (radius * speed + across);
    if discriminant.is_nan() || discriminant <= 0.0 {
        return vec![];
    }
    let along = dot(from, direction);
    let outer = -(along + discriminant.sqrt().copysign(along));
    let roots = [outer / speed / speed, (distance - radius) * (distance + radius) / outer];
    roots.into_iter().filter(|s| s.is_finite()).collect()
}

#[cfg(test)]
#[path = "beam_ray_sphere_tests.rs"]
mod tests;
