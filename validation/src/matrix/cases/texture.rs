//! All orders under parallel light: a box of fog with a null boundary, in it a textured floor and a
//! coarse round mesh with smooth normals.
//!
//! No exact value is known. Shading normals are asymmetric: that photons and camera paths agree
//! here is a test of the photons' factor.

use std::sync::Arc;

use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};
use tpb_optics::{Rgb, Spectrum};
use tpb_scene::geometry::{Outline, Planar, VertexData};
use tpb_scene::texture::{Bitmap, Coordinates, Filter, Pattern, Wrap};
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, IntegratorSpec, Primitive, Reflector, SceneParts, Texture,
    TextureId,
};

use super::{Budget, Case, Family, MatrixMedium, Player, fog_box};
use crate::experiment::Effort;
use crate::matrix::view::Frame;
use crate::sabotage::Sabotage;
use crate::scenes::View;

const BALL: DVec3 = DVec3::new(0.1, -0.2, 2.4);
const RADIUS: f64 = 0.03;

/// The case.
pub(super) struct Textured;

/// An octahedron whose normals are those of a ball, with texture coordinates.
fn mesh(radius: f64) -> Vec<Primitive> {
    let octant = |index: u32| {
        let sign = |bit: u32| if index >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let mut corners = [sign(0) * DVec3::X, sign(1) * DVec3::Y, sign(2) * DVec3::Z];
        // Counter-clockwise from outside.
        if sign(0) * sign(1) * sign(2) < 0.0 {
            corners.swap(1, 2);
        }
        let [a, b, c] = corners.map(|corner| BALL + radius * corner);
        let uv = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let data = VertexData { normals: Some(corners), uv: Some(uv) };
        let face = Planar::new(a, b - a, c - a, Outline::Triangle).with_vertices(data);
        Primitive::Planar(face)
    };
    (0..8).map(octant).collect()
}

fn textures() -> Vec<Texture> {
    let axes = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y);
    let board = Texture {
        pattern: Pattern::Checkerboard([Rgb::splat(0.8), Spectrum([0.2, 0.3, 0.5])]),
        to_uv: DAffine2::from_mat2(DMat2::from_diagonal(DVec2::splat(2.0))),
        coordinates: Coordinates::Rectangle(
            DAffine3::from_mat3_translation(axes, fog_box::FLOOR).inverse(),
        ),
    };
    let texels = vec![[0.9, 0.8, 0.7], [0.3, 0.4, 0.5], [0.5, 0.2, 0.6], [0.7, 0.7, 0.1]];
    let image = Bitmap::new(2, 2, texels).expect("four texels");
    let bitmap = Texture {
        pattern: Pattern::Bitmap(Arc::new(image), Filter::Bilinear, Wrap::Mirror),
        to_uv: DAffine2::IDENTITY,
        coordinates: Coordinates::Vertices,
    };
    vec![board, bitmap]
}

impl Case for Textured {
    fn name(&self) -> &'static str {
        "texture"
    }

    fn question(&self) -> &'static str {
        "textures and a smooth mesh in fog under directional light: all orders"
    }

    fn frame(&self) -> Frame {
        fog_box::frame()
    }

    fn integrator(&self) -> IntegratorSpec {
        IntegratorSpec::default()
    }

    fn takes(&self, medium: &MatrixMedium) -> bool {
        medium.name == "coloured"
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
        parts.textures = textures();
        // The disc is found when the scene is assembled.
        let (position, radius) = (DVec3::ZERO, 0.0);
        let axis = DVec3::new(-0.4, -0.8, 0.2).normalize();
        let kind = EmitterKind::Directional { axis, irradiance: Rgb::ONE, position, radius };
        parts.emitters = vec![EmitterPart { name: "sun".into(), kind, stated_medium: None }];
        let textured =
            |id| Bsdf::Opaque { front: Reflector::Textured(TextureId(id)), back: Reflector::Black };
        parts.shapes = vec![
            fog_box::walls(),
            fog_box::floor(textured(0)),
            fog_box::part("mesh", mesh(0.4), textured(1), None),
        ];
        parts
    }

    fn budget(&self, player: &Player, _: &MatrixMedium, effort: Effort) -> Budget {
        let few = effort.pick(1, 2);
        let (photons, rays, passes) = match player.family {
            Family::Path => (0, 0, few),
            Family::Light => (40_000, 0, few),
            Family::Beams { .. } => (25_000, 8, effort.pick(1, 3)),
        };
        let paths = if player.is_baseline() { 3000 } else { 500 };
        Budget { paths, photons, rays, passes, radius: RADIUS }
    }

    fn groups(&self) -> Vec<(String, Vec<usize>)> {
        self.frame().halves()
    }

    fn shares(&self) -> usize {
        2
    }

    fn twins(&self, player: &Player, _: &MatrixMedium) -> Vec<Sabotage> {
        match player.family {
            Family::Light => vec![Sabotage::LATE],
            _ => vec![Sabotage::SigmaS(1.08)],
        }
    }
}
