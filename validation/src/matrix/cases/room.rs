//! All orders: a box of fog with a null boundary, a diffuse floor inside it, a spot above.
//!
//! No exact value is known. Methods are compared with path tracing, both with their noise. Camera
//! and lamp are outside the fog, where no connection has infinite variance. Beams blur by a radius
//! that is small against everything that is seen; what is left of it is within their margin.

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, IntegratorSpec, MediumBoundary, MediumId, Primitive, Reflector,
    SceneParts, ShapePart, TimeSpec,
};

use super::{Budget, Case, Family, MatrixMedium, Player};
use crate::experiment::Effort;
use crate::matrix::players::{Blur, Kernels};
use crate::matrix::view::Frame;
use crate::sabotage::Sabotage;
use crate::scenes::View;

const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 2.5);
const LAMP: DVec3 = DVec3::new(0.4, 1.8, 2.2);
/// Media are twice as dense here: light is scattered often.
const DENSITY: f64 = 2.0;
const RADIUS: f64 = 0.03;

/// The case.
pub(super) struct Room;

/// A spot that lights the whole box evenly: 66 degrees from its axis reach all corners.
fn lamp() -> EmitterPart {
    let kind = EmitterKind::Spot {
        position: LAMP,
        axis: (CENTRE - LAMP).normalize(),
        intensity: Rgb::ONE,
        cos_cutoff: 70.0_f64.to_radians().cos(),
        cos_beam: 66.0_f64.to_radians().cos(),
    };
    EmitterPart { name: "spot".into(), kind, stated_medium: None }
}

/// A square of half-width `half`, its normal along `towards`.
fn square(centre: DVec3, towards: DVec3, half: f64) -> Primitive {
    let u = if towards.x.abs() > 0.5 { DVec3::Y } else { DVec3::X };
    let v = towards.cross(u);
    Primitive::Planar(Planar::new(centre, half * u, half * v, Outline::Parallelogram))
}

impl Case for Room {
    fn name(&self) -> &'static str {
        "room"
    }

    fn question(&self) -> &'static str {
        "a box of fog with a null boundary and a diffuse floor: all orders"
    }

    fn frame(&self) -> Frame {
        let time = TimeSpec { start_opl: 2.0, bin_width_opl: 0.25, bins: 40 };
        Frame { side: 4, fov: 36.0, time }
    }

    fn integrator(&self) -> IntegratorSpec {
        IntegratorSpec::default()
    }

    /// Where scattering is peaked, paths from the camera are too noisy to compare with.
    fn takes(&self, medium: &MatrixMedium) -> bool {
        medium.scatters() && medium.name != "forward"
    }

    fn admits(&self, _: Family) -> bool {
        true
    }

    fn kernels(&self) -> Kernels {
        Kernels::Plain
    }

    fn has_exact_value(&self) -> bool {
        false
    }

    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![medium.medium(DENSITY)];
        parts.emitters = vec![lamp()];
        let faces = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        let front = Reflector::Diffuse(Rgb::splat(0.5));
        parts.shapes = vec![
            ShapePart {
                name: "box".into(),
                primitives: faces.map(|n| square(CENTRE + n, n, 1.0)).into(),
                bsdf: Bsdf::Null,
                boundary: Some(MediumBoundary { interior: Some(MediumId(0)), exterior: None }),
                radiance: None,
            },
            ShapePart {
                name: "floor".into(),
                primitives: vec![square(CENTRE - 0.8 * DVec3::Y, DVec3::Y, 0.9)],
                bsdf: Bsdf::Opaque { front, back: Reflector::Black },
                boundary: None,
                radiance: None,
            },
        ];
        parts
    }

    fn budget(&self, player: &Player, _: &MatrixMedium, effort: Effort) -> Budget {
        let few = effort.pick(1, 2);
        let (photons, rays, passes) = match player.family {
            Family::Path => (0, 0, few),
            Family::Light => (100_000, 0, few),
            // Pixels are wide here: rays are as many as photons allow.
            Family::Beams { .. } => (20_000, 8, effort.pick(4, 5)),
        };
        let paths = if player.is_baseline() { 10_000 } else { 100 };
        Budget { paths, photons, rays, passes, radius: RADIUS }
    }

    fn shares(&self) -> usize {
        4
    }

    fn twins(&self, player: &Player, medium: &MatrixMedium) -> Vec<Sabotage> {
        match (player.blur(), medium.name) {
            (None | Some(Blur::OneD), "isotropic") => vec![Sabotage::SigmaS(1.05)],
            (None, _) | (_, "isotropic") => vec![Sabotage::PhaseNormalisation],
            _ => vec![Sabotage::LATE],
        }
    }
}
