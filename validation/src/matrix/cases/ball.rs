//! Light scattered once in a ball of fog, seen from the outside and lit by a lamp beside it.
//!
//! Along a camera ray that is inside the ball from s0 to s1, with r the distance of its point from the
//! lamp and ℓ the part of that which lies in the ball, light of the intensity 1/4π is scattered by
//!
//! > dL = σs p(θ)/(4π r²) · exp(−σt (s − s0 + ℓ)) ds, at the instant s + r,
//!
//! which grows along the ray. With D the lamp's distance from the eye and z that along the ray,
//! light of the instant t is scattered at s = (t² − D²)/(2 (t − z)): bins are ranges of s, over
//! which the integral is smooth. All pixels lie within the ball's outline.
//!
//! The lamp is a spot whose beam is just wide enough for the ball, so that no photon is wasted.
//! A null sphere around the lamp is crossed by all light, over its radius. No kernel's blur is
//! known here, so beams do not play.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_reference::ReferenceError;
use tpb_reference::numerics::quadrature::adaptive;
use tpb_scene::geometry::Sphere;
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, IntegratorSpec, MediumBoundary, MediumId, Primitive,
    SceneParts, ShapePart, TimeSpec,
};

use super::{Budget, Case, Channel, Family, MatrixMedium, Player};
use crate::error::Result;
use crate::experiment::Effort;
use crate::matrix::players::Blur;
use crate::matrix::view::{Expected, Frame, gauss};
use crate::sabotage::Sabotage;
use crate::scenes::{View, null_sphere, only_depth};

const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 2.0);
const RADIUS: f64 = 1.0;
const LAMP: DVec3 = DVec3::new(1.6, 0.3, 1.8);
const NULL_RADIUS: f64 = 0.3;

/// The case.
pub(super) struct Ball;

/// Where the line from `origin` enters and leaves the ball; it meets it.
fn chord(origin: DVec3, direction: DVec3) -> (f64, f64) {
    let to_centre = CENTRE - origin;
    let middle = to_centre.dot(direction);
    let across = to_centre - middle * direction;
    let half = (RADIUS * RADIUS - across.length_squared()).max(0.0).sqrt();
    (middle - half, middle + half)
}

/// A spot that lights the whole ball evenly.
fn spot() -> EmitterPart {
    let to_centre = CENTRE - LAMP;
    let half_angle = (RADIUS / to_centre.length()).asin();
    let kind = EmitterKind::Spot {
        position: LAMP,
        axis: to_centre.normalize(),
        intensity: Rgb::splat(0.25 / PI),
        cos_cutoff: (half_angle + 0.04).cos(),
        cos_beam: (half_angle + 0.02).cos(),
    };
    EmitterPart { name: "spot".into(), kind, stated_medium: None }
}

fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5))
}

/// dL/ds of the module's equation.
fn scattered(channel: &Channel, ray: DVec3, s0: f64, s: f64) -> f64 {
    let way = s * ray - LAMP;
    let r = way.length();
    let (entry, _) = chord(LAMP, way / r);
    let inside = (s - s0) + (r - entry);
    let phase = henyey_greenstein(channel.g, -(way / r).dot(ray));
    channel.sigma_s * phase / (4.0 * PI * r * r) * (-channel.sigma_t * inside).exp()
}

impl Case for Ball {
    fn name(&self) -> &'static str {
        "ball"
    }

    fn question(&self) -> &'static str {
        "a ball of fog with a null boundary, camera and lamp outside: one scattering"
    }

    fn frame(&self) -> Frame {
        let time = TimeSpec { start_opl: 2.0, bin_width_opl: 0.125, bins: 32 };
        Frame { side: 4, fov: 38.0, time }
    }

    fn integrator(&self) -> IntegratorSpec {
        only_depth(2)
    }

    fn takes(&self, medium: &MatrixMedium) -> bool {
        medium.scatters()
    }

    fn admits(&self, family: Family) -> bool {
        !matches!(family, Family::Beams { .. })
    }

    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![medium.medium(1.0)];
        parts.emitters = vec![spot()];
        let sphere = Sphere { centre: CENTRE, radius: RADIUS, flipped: false };
        parts.shapes = vec![
            ShapePart {
                name: "ball".into(),
                primitives: vec![Primitive::Sphere(sphere)],
                bsdf: Bsdf::Null,
                boundary: Some(MediumBoundary { interior: Some(MediumId(0)), exterior: None }),
                radiance: None,
            },
            null_sphere(LAMP, NULL_RADIUS),
        ];
        parts
    }

    fn expected(&self, channel: &Channel, _: Option<(Blur, f64)>) -> Result<Expected> {
        let frame = self.frame();
        let cube = |points: usize| {
            frame.average(&gauss(points), |point, bins| {
                let ray = point.direction();
                let (s0, s1) = chord(DVec3::ZERO, ray);
                let along = LAMP.dot(ray);
                let place = |t: f64| 0.5 * (t * t - LAMP.length_squared()) / (t - along);
                // Before the direct way to the lamp nothing can arrive.
                let at = |t: f64| if t <= LAMP.length() { s0 } else { place(t).clamp(s0, s1) };
                for (index, value) in bins.iter_mut().enumerate() {
                    let (start, end) = (at(frame.edge(index)), at(frame.edge(index + 1)));
                    if end > start {
                        let integrand = |s: f64| scattered(channel, ray, s0, s);
                        *value = adaptive(integrand, &[start, end], 1e-10)?.value;
                    }
                }
                Ok::<(), ReferenceError>(())
            })
        };
        // The edges of the ball and of the front cross pixels.
        Ok(Expected { fine: cube(12)?, coarse: cube(8)? })
    }

    fn budget(&self, player: &Player, medium: &MatrixMedium, effort: Effort) -> Budget {
        // Photons are connected with weights as unequal as the phase function.
        let passes = match (player.is_baseline(), medium.name) {
            (true, "forward" | "backward") => effort.pick(1, 2),
            (true, _) => 1,
            (false, "backward" | "coloured") => 8,
            (false, _) => 6,
        };
        Budget {
            paths: effort.pick(10_000, 14_000),
            photons: 100_000,
            rays: 1,
            passes,
            radius: 0.1,
        }
    }

    fn twins(&self, player: &Player, medium: &MatrixMedium) -> Vec<Sabotage> {
        match (player.is_baseline(), medium.name) {
            (true, "isotropic") => vec![Sabotage::NullSegment(NULL_RADIUS), Sabotage::SIGMA_S],
            (true, "coloured") => vec![Sabotage::SIGMA_S],
            (true, _) => vec![Sabotage::LATE],
            (false, _) => vec![Sabotage::PhaseNormalisation],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_pixels_are_within_the_outline_and_all_light_within_the_window() {
        let frame = Ball.frame();
        let corner = frame.point(0, 0.0, 0.0).direction();
        let (s0, s1) = chord(DVec3::ZERO, corner);
        assert!(s1 - s0 > 0.1, "{s0} {s1}");
        let channel = Channel { sigma_s: 0.4, sigma_t: 0.5, g: -0.5 };
        let expected = Ball.expected(&channel, None).unwrap();
        for pixel in 0..expected.fine.pixels() {
            let bins = expected.fine.pixel_bins(pixel);
            assert!(bins[0] == 0.0 && bins[31] == 0.0 && bins.iter().any(|&v| v > 0.0));
        }
    }

    /// All energy of a ray by one integral, without bins.
    #[test]
    fn bins_add_up_to_the_whole_ray() {
        let channel = Channel { sigma_s: 0.4, sigma_t: 0.5, g: 0.5 };
        let frame = Ball.frame();
        let expected = Ball.expected(&channel, None).unwrap().fine;
        let mean: f64 = gauss(12)
            .iter()
            .flat_map(|(u, wu)| gauss(12).into_iter().map(move |(v, wv)| (*u, v, wu * wv)))
            .map(|(u, v, weight)| {
                let ray = frame.point(5, u, v).direction();
                let (s0, s1) = chord(DVec3::ZERO, ray);
                weight
                    * adaptive(|s| scattered(&channel, ray, s0, s), &[s0, s1], 1e-10).unwrap().value
            })
            .sum();
        let sum: f64 = expected.pixel_bins(5).iter().sum();
        assert!((sum / mean - 1.0).abs() < 1e-9, "{sum} {mean}");
    }
}
