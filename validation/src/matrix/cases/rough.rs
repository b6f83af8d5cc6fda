//! All orders among rough surfaces: a box of fog with a null boundary, in it a rough metal floor
//! and a ball of rough glass, a spot above.
//!
//! No exact value is known. Nothing is specular here, so that path tracing finds all light, and so
//! do photons that are connected to the eye: through the ball, off the floor, in the fog.

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor};
use tpb_scene::geometry::{Outline, Planar, Sphere};
use tpb_scene::{
    Bsdf, Dielectric, EmitterKind, EmitterPart, IntegratorSpec, MediumBoundary, MediumId,
    Primitive, Reflector, RoughMetal, SceneParts, ShapePart, TimeSpec,
};

use super::{Budget, Case, Family, MatrixMedium, Player};
use crate::experiment::Effort;
use crate::matrix::view::Frame;
use crate::sabotage::Sabotage;
use crate::scenes::View;

const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 2.5);
const LAMP: DVec3 = DVec3::new(0.4, 1.8, 2.2);
const BALL: DVec3 = DVec3::new(0.2, -0.1, 2.4);
const RADIUS: f64 = 0.03;

/// The case.
pub(super) struct Rough;

fn lamp() -> EmitterPart {
    let kind = EmitterKind::Spot {
        position: LAMP,
        axis: (CENTRE - LAMP).normalize(),
        intensity: Rgb::ONE,
        cos_cutoff: 50.0_f64.to_radians().cos(),
        cos_beam: 45.0_f64.to_radians().cos(),
    };
    EmitterPart { name: "spot".into(), kind, stated_medium: None }
}

/// A square of half-width `half`, its normal along `towards`.
fn square(centre: DVec3, towards: DVec3, half: f64) -> Primitive {
    let u = if towards.x.abs() > 0.5 { DVec3::Y } else { DVec3::X };
    let v = towards.cross(u);
    Primitive::Planar(Planar::new(centre, half * u, half * v, Outline::Parallelogram))
}

impl Case for Rough {
    fn name(&self) -> &'static str {
        "rough"
    }

    fn question(&self) -> &'static str {
        "a ball of rough glass over rough metal in fog: all orders"
    }

    fn frame(&self) -> Frame {
        let time = TimeSpec { start_opl: 2.0, bin_width_opl: 0.25, bins: 40 };
        Frame { side: 4, fov: 36.0, time }
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
        parts.emitters = vec![lamp()];
        let fog = MediumBoundary { interior: Some(MediumId(0)), exterior: None };
        let faces = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        let surface = RoughConductor { ggx: Ggx::new(0.4), metal: Metal::Perfect };
        let front = Reflector::Rough(RoughMetal { surface, reflectance: Rgb::splat(0.8) });
        let glass = Dielectric {
            interior_eta: 1.4,
            exterior_eta: 1.0,
            reflectance: Rgb::ONE,
            transmittance: Rgb::ONE,
        };
        let ball = Sphere { centre: BALL, radius: 0.35, flipped: false };
        let part = |name: &str, primitives, bsdf, boundary| ShapePart {
            name: name.into(),
            primitives,
            bsdf,
            boundary,
            radiance: None,
        };
        parts.shapes = vec![
            part("box", faces.map(|n| square(CENTRE + n, n, 1.0)).into(), Bsdf::Null, Some(fog)),
            part(
                "floor",
                vec![square(CENTRE - 0.8 * DVec3::Y, DVec3::Y, 0.9)],
                Bsdf::Opaque { front, back: Reflector::Black },
                None,
            ),
            part(
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
