//! All orders among rough surfaces: a box of fog with a null boundary, in it a rough metal floor
//! and a ball of rough glass, a spot above.
//!
//! No exact value is known. Nothing is specular here, so that path tracing finds all light, and so
//! do photons that are connected to the eye: through the ball, off the floor, in the fog.

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor};
use tpb_scene::geometry::Sphere;
use tpb_scene::{
    Bsdf, Dielectric, IntegratorSpec, MediumBoundary, MediumId, Primitive, Reflector, RoughMetal,
    SceneParts,
};

use super::{Budget, Case, Family, MatrixMedium, Player, fog_box};
use crate::experiment::Effort;
use crate::matrix::view::Frame;
use crate::sabotage::Sabotage;
use crate::scenes::View;

const BALL: DVec3 = DVec3::new(0.2, -0.1, 2.4);
const RADIUS: f64 = 0.03;

/// The case.
pub(super) struct Rough;

impl Case for Rough {
    fn name(&self) -> &'static str {
        "rough"
    }

    fn question(&self) -> &'static str {
        "a ball of rough glass over rough metal in fog: all orders"
    }

    fn frame(&self) -> Frame {
        fog_box::frame()
    }

    fn integrator(&self) -> IntegratorSpec {
        IntegratorSpec::default()
    }

    fn takes(&self, medium: &MatrixMedium) -> bool {
        medium.name == "isotropic"
    }

    fn admits(&self, _: Family) -> bool {
        true
    }

    fn has_exact_value(&self) -> bool {
        false
    }

    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![medium.medium(1.0)];
        parts.emitters = vec![fog_box::spot(50.0, 45.0)];
        let surface = RoughConductor { ggx: Ggx::new(0.4), metal: Metal::Perfect };
        let front = Reflector::Rough(RoughMetal { surface, reflectance: Rgb::splat(0.8) });
        let glass = Dielectric {
            interior_eta: 1.4,
            exterior_eta: 1.0,
            reflectance: Rgb::ONE,
            transmittance: Rgb::ONE,
        };
        let ball = Sphere { centre: BALL, radius: 0.35, flipped: false };
        parts.shapes = vec![
            fog_box::walls(),
            fog_box::floor(Bsdf::Opaque { front, back: Reflector::Black }),
            fog_box::part(
                "ball",
                vec![Primitive::Sphere(ball)],
                Bsdf::RoughDielectric(glass, Ggx::new(0.3)),
                Some(MediumBoundary { interior: None, exterior: Some(MediumId(0)) }),
            ),
        ];
        parts
    }

    fn budget(&self, player: &Player, _: &MatrixMedium, effort: Effort) -> Budget {
        let few = effort.pick(1, 2);
        let (photons, rays, passes) = match player.family {
            Family::Path => (0, 0, few),
            Family::Light => (150_000, 0, few),
            Family::Beams { .. } => (20_000, 16, few),
        };
        let paths = if player.is_baseline() { 10_000 } else { 1000 };
        Budget { paths, photons, rays, passes, radius: RADIUS }
    }

    fn groups(&self) -> Vec<(String, Vec<usize>)> {
        self.frame().halves()
    }

    fn shares(&self) -> usize {
        3
    }

    fn twins(&self, player: &Player, _: &MatrixMedium) -> Vec<Sabotage> {
        match player.family {
            Family::Light => vec![Sabotage::LATE],
            _ => vec![Sabotage::SigmaS(1.08)],
        }
    }
}
