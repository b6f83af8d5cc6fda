//! Rough glass, lit from within by a lamp: one refraction.
//!
//! The interface lies across the axis at the distance h; behind it is glass of index η that only
//! absorbs, with a spot of intensity 1/(4π) in it at p, whose full cone covers all that is seen.
//! Along the ray of slant w the interface is met at d = h w, at the distance r from the lamp, under
//! the cosine c = (p_z − h)/r:
//!
//! > L = f_t · c/(4π r²) · exp(−sigma_t r), at the instant d + η r,
//!
//! with the BTDF f_t in the textbook's form ([`crate::microfacet`]). Radiance is lower by η²
//! outside: that is in f_t.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_optics::microfacet::Ggx;
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, Dielectric, EmitterKind, EmitterPart, IntegratorSpec, MediumBoundary, MediumId,
    Primitive, SceneParts, ShapePart, TimeSpec,
};

use super::{Budget, Case, Channel, Family, MatrixMedium, Player};
use crate::error::Result;
use crate::experiment::Effort;
use crate::matrix::players::Blur;
use crate::matrix::view::{Expected, Frame, PlanePoint};
use crate::microfacet::transmission;
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth};

const DISTANCE: f64 = 2.0;
const ALPHA: f64 = 0.5;
const ETA: f64 = 1.5;
const LAMP: DVec3 = DVec3::new(0.2, 0.1, 2.8);

/// The case.
pub(super) struct Interface;

fn radiance(point: PlanePoint, sigma_t: f64) -> (f64, f64) {
    let place = DISTANCE * DVec3::new(point.x, point.y, 1.0);
    let from_lamp = place.distance(LAMP);
    let light = (LAMP - place) / from_lamp;
    // The surface's normal towards the lamp is +z; light leaves to the other side.
    let btdf = transmission(ALPHA, light, -point.direction(), [ETA, 1.0]);
    let irradiance = light.z / (4.0 * PI * from_lamp * from_lamp);
    let opl = place.length() + ETA * from_lamp;
    (btdf * irradiance * (-sigma_t * from_lamp).exp(), opl)
}

impl Case for Interface {
    fn name(&self) -> &'static str {
        "interface"
    }

    fn question(&self) -> &'static str {
        "rough glass with a lamp in it: one refraction"
    }

    fn frame(&self) -> Frame {
        let time = TimeSpec { start_opl: 3.1, bin_width_opl: 0.1, bins: 24 };
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
        let kind = EmitterKind::Spot {
            position: LAMP,
            axis: -DVec3::Z,
            intensity: Rgb::splat(0.25 / PI),
            cos_cutoff: 65.0_f64.to_radians().cos(),
            cos_beam: 62.0_f64.to_radians().cos(),
        };
        parts.emitters = vec![EmitterPart { name: "spot".into(), kind, stated_medium: None }];
        let (u, v) = (-9.0 * DVec3::X, 9.0 * DVec3::Y);
        let plane = Planar::new(DISTANCE * DVec3::Z, u, v, Outline::Parallelogram);
        let glass = Dielectric {
            interior_eta: ETA,
            exterior_eta: 1.0,
            reflectance: Rgb::ONE,
            transmittance: Rgb::ONE,
        };
        parts.shapes = vec![ShapePart {
            name: "interface".into(),
            primitives: vec![Primitive::Planar(plane)],
            bsdf: Bsdf::RoughDielectric(glass, Ggx::new(ALPHA)),
            boundary: Some(MediumBoundary { interior: Some(MediumId(0)), exterior: None }),
            radiance: None,
        }];
        parts
    }

    fn expected(&self, channel: &Channel, _: Option<(Blur, f64)>) -> Result<Expected> {
        let cube = |count: usize| {
            self.frame().average_of_instants(count, |point| radiance(point, channel.sigma_t))
        };
        Ok(Expected { fine: cube(400), coarse: cube(250) })
    }

    fn budget(&self, player: &Player, _: &MatrixMedium, effort: Effort) -> Budget {
        let photons = if player.family == Family::Light { 900_000 } else { 1000 };
        Budget { paths: effort.pick(1000, 2000), photons, rays: 1, passes: 1, radius: 0.1 }
    }

    fn groups(&self) -> Vec<(String, Vec<usize>)> {
        self.frame().halves()
    }

    fn shares(&self) -> usize {
        3
    }

    fn twins(&self, player: &Player, _: &MatrixMedium) -> Vec<Sabotage> {
        if player.is_baseline() {
            vec![Sabotage::EtaSquared, Sabotage::TRANSMITTANCE, Sabotage::LATE]
        } else {
            vec![Sabotage::EtaSquared]
        }
    }

    fn dropped(&self) -> Vec<f64> {
        let Frame { side, .. } = self.frame();
        vec![1.0 / (ETA * ETA); side * side]
    }
}
