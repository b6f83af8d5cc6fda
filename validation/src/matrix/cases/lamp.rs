//! Ballistic light: an area lamp that fills the view, through a medium without end.
//!
//! The lamp is a rectangle across the axis at the distance h. Along the ray of slant w it is seen at
//! d = h w, with the radiance L exp(−sigma_t d), at the instant d.

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
use crate::matrix::view::{Expected, Frame};
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth};

const DISTANCE: f64 = 2.0;
const RADIANCE: f64 = 3.0;

/// The case.
pub(super) struct Lamp;

impl Case for Lamp {
    fn name(&self) -> &'static str {
        "lamp"
    }

    fn question(&self) -> &'static str {
        "an area lamp seen through a medium: ballistic light"
    }

    fn frame(&self) -> Frame {
        // Slants from 1 to 1.124: arrivals from 2 to 2.25.
        let time = TimeSpec { start_opl: 1.99, bin_width_opl: 0.03, bins: 10 };
        Frame { side: 4, fov: 40.0, time }
    }

    fn integrator(&self) -> IntegratorSpec {
        only_depth(1)
    }

    fn takes(&self, medium: &MatrixMedium) -> bool {
        ["isotropic", "absorbing", "coloured"].contains(&medium.name)
    }

    fn admits(&self, _: Family) -> bool {
        true
    }

    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![medium.medium(1.0)];
        parts.background = Some(MediumId(0));
        let (u, v) = (-DVec3::X, DVec3::Y);
        let lamp = Planar::new(DISTANCE * DVec3::Z, u, v, Outline::Parallelogram);
        parts.shapes = vec![ShapePart {
            name: "lamp".into(),
            primitives: vec![Primitive::Planar(lamp)],
            bsdf: Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black },
            boundary: None,
            radiance: Some(Rgb::splat(RADIANCE)),
        }];
        parts
    }

    fn expected(&self, channel: &Channel, _: Option<(Blur, f64)>) -> Result<Expected> {
        let cube = |count: usize| {
            self.frame().average_of_instants(count, |point| {
                let distance = DISTANCE * point.slant();
                (RADIANCE * (-channel.sigma_t * distance).exp(), distance)
            })
        };
        Ok(Expected { fine: cube(800), coarse: cube(500) })
    }

    fn budget(&self, player: &Player, _: &MatrixMedium, effort: Effort) -> Budget {
        // A photon from anywhere on the lamp is connected to the eye; beams leave none here.
        let photons = if player.family == Family::Light { 400_000 } else { 10_000 };
        Budget { paths: effort.pick(1000, 2000), photons, rays: 1, passes: 1, radius: 0.1 }
    }

    fn shares(&self) -> usize {
        4
    }

    fn twins(&self, _: &Player, medium: &MatrixMedium) -> Vec<Sabotage> {
        let act = if medium.scatters() { Sabotage::LATE } else { Sabotage::TRANSMITTANCE };
        vec![act]
    }
}
