//! All orders: a box of fog with a null boundary, a diffuse floor inside it, a spot above.
//!
//! No exact value is known. Methods are compared with path tracing, both with their noise. Camera
//! and lamp are outside the fog, where no connection has infinite variance. Beams blur by a radius
//! that is small against everything that is seen; what is left of it is within their margin.

use tpb_optics::Rgb;
use tpb_scene::{Bsdf, IntegratorSpec, Reflector, SceneParts};

use super::{Budget, Case, Family, MatrixMedium, Player, fog_box};
use crate::experiment::Effort;
use crate::matrix::players::{Blur, Kernels};
use crate::matrix::view::Frame;
use crate::sabotage::Sabotage;
use crate::scenes::View;

/// Media are twice as dense here: light is scattered often.
const DENSITY: f64 = 2.0;
/// Discs and spheres lose about R/3 of the light at the borders of the box (measured: 1 % at 0.03),
/// so they are smaller than segments.
const SEGMENT_RADIUS: f64 = 0.03;
const DISC_RADIUS: f64 = 0.015;

/// The case.
pub(super) struct Room;

impl Case for Room {
    fn name(&self) -> &'static str {
        "room"
    }

    fn question(&self) -> &'static str {
        "a box of fog with a null boundary and a diffuse floor: all orders"
    }

    fn frame(&self) -> Frame {
        fog_box::frame()
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
        // It lights the whole box evenly: 66 degrees from its axis reach all corners.
        parts.emitters = vec![fog_box::spot(70.0, 66.0)];
        let front = Reflector::Diffuse(Rgb::splat(0.5));
        let floor = fog_box::floor(Bsdf::Opaque { front, back: Reflector::Black });
        parts.shapes = vec![fog_box::walls(), floor];
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
        let (radius, passes) = match player.blur() {
            None | Some(Blur::OneD) => (SEGMENT_RADIUS, passes),
            Some(Blur::TwoD | Blur::ThreeD) => (DISC_RADIUS, 2 * passes),
        };
        let paths = if player.is_baseline() { 10_000 } else { 100 };
        Budget { paths, photons, rays, passes, radius }
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
