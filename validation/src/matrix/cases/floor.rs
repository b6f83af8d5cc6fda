//! A diffuse surface, lit by a point lamp, through a medium without end that only absorbs.
//!
//! The floor lies across the axis at the distance h, the lamp of unit power at p above it. Along the
//! ray of slant w the floor is met at d = h w, at the distance r from the lamp, under the cosine
//! c = (h − p_z)/r:
//!
//! > L = ρ/π · c/(4π r²) · exp(−sigma_t (d + r)), at the instant d + r.
//!
//! A null sphere around the lamp is crossed by all light, over its radius.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, IntegratorSpec, MediumId, Primitive, Reflector, SceneParts, ShapePart, TimeSpec,
};

use super::{Budget, Case, Channel, Family, MatrixMedium, Player};
use crate::error::Result;
use crate::experiment::Effort;
use crate::matrix::players::Blur;
use crate::matrix::view::{Expected, Frame, PlanePoint};
use crate::sabotage::Sabotage;
use crate::scenes::{View, null_sphere, only_depth, unit_point};

const DISTANCE: f64 = 2.0;
const REFLECTANCE: f64 = 0.6;
const LAMP: DVec3 = DVec3::new(0.25, 0.15, 1.2);
const NULL_RADIUS: f64 = 0.25;

/// The case.
pub(super) struct Floor;

impl Floor {
    /// Cosine, distances from the eye and from the lamp.
    fn geometry(point: PlanePoint) -> (f64, f64, f64) {
        let place = DISTANCE * DVec3::new(point.x, point.y, 1.0);
        let from_lamp = place.distance(LAMP);
        ((DISTANCE - LAMP.z) / from_lamp, place.length(), from_lamp)
    }

    fn radiance(point: PlanePoint, sigma_t: f64) -> (f64, f64) {
        let (cosine, from_eye, from_lamp) = Self::geometry(point);
        let opl = from_eye + from_lamp;
        let irradiance = cosine / (4.0 * PI * from_lamp * from_lamp);
        (REFLECTANCE / PI * irradiance * (-sigma_t * opl).exp(), opl)
    }
}

impl Case for Floor {
    fn name(&self) -> &'static str {
        "floor"
    }

    fn question(&self) -> &'static str {
        "a diffuse floor lit by a point lamp, through a medium: one reflection"
    }

    fn frame(&self) -> Frame {
        let time = TimeSpec { start_opl: 2.75, bin_width_opl: 0.05, bins: 24 };
        Frame { side: 4, fov: 40.0, time }
    }

    fn integrator(&self) -> IntegratorSpec {
        only_depth(2)
    }

    fn takes(&self, medium: &MatrixMedium) -> bool {
        // Scattering in the medium has the same depth.
        !medium.scatters()
    }

    fn admits(&self, _: Family) -> bool {
        true
    }

    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![medium.medium(1.0)];
        parts.background = Some(MediumId(0));
        parts.emitters = vec![unit_point(LAMP)];
        let floor = Planar::new(
            DISTANCE * DVec3::Z,
            -4.0 * DVec3::X,
            4.0 * DVec3::Y,
            Outline::Parallelogram,
        );
        let front = Reflector::Diffuse(Rgb::splat(REFLECTANCE));
        parts.shapes = vec![
            ShapePart {
                name: "floor".into(),
                primitives: vec![Primitive::Planar(floor)],
                bsdf: Bsdf::Opaque { front, back: Reflector::Black },
                boundary: None,
                radiance: None,
            },
            null_sphere(LAMP, NULL_RADIUS),
        ];
        parts
    }

    fn expected(&self, channel: &Channel, _: Option<(Blur, f64)>) -> Result<Expected> {
        let cube = |count: usize| {
            let light = |point| Self::radiance(point, channel.sigma_t);
            self.frame().average_of_instants(count, light)
        };
        Ok(Expected { fine: cube(800), coarse: cube(500) })
    }

    fn budget(&self, player: &Player, _: &MatrixMedium, effort: Effort) -> Budget {
        // Few photons from the lamp land where the camera looks; beams do not need them.
        let photons = if player.family == Family::Light { 1_200_000 } else { 10_000 };
        Budget { paths: effort.pick(1000, 2000), photons, rays: 1, passes: 1, radius: 0.1 }
    }

    fn twins(&self, player: &Player, _: &MatrixMedium) -> Vec<Sabotage> {
        if player.is_baseline() {
            let null = Sabotage::NullSegment(NULL_RADIUS);
            vec![Sabotage::Cosine, null, Sabotage::TRANSMITTANCE, Sabotage::LATE]
        } else {
            vec![Sabotage::Cosine]
        }
    }

    /// The mean radiance over what it would be without the cosine.
    fn dropped(&self) -> Vec<f64> {
        let frame = self.frame();
        let count = 100;
        let at = |i: usize| (i as f64 + 0.5) / count as f64;
        (0..frame.side * frame.side)
            .map(|pixel| {
                let (mut with, mut without) = (0.0, 0.0);
                for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
                    let point = frame.point(pixel, at(i), at(j));
                    let (radiance, _) = Self::radiance(point, 0.5);
                    with += radiance;
                    without += radiance / Self::geometry(point).0;
                }
                with / without
            })
            .collect()
    }
}
