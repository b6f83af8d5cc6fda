//! Small scenes, put together in code.

use std::num::NonZeroU32;

use glam::{DAffine3, DMat3, DVec3};
use tpb_optics::{Coefficients, Phase, Rgb};
use tpb_scene::geometry::{Outline, Planar, Sphere};
use tpb_scene::{
    Bsdf, Dielectric, EmitterKind, EmitterPart, FilmSpec, FovAxis, IntegratorSpec, Medium,
    MediumBoundary, MediumId, PixelFormat, Plan, Primitive, Reflector, Scene, SceneParts, Sensor,
    ShapePart, TimeSpec,
};

use crate::{PathOptions, PathTracer};

/// The first medium.
pub(super) const FOG: MediumId = MediumId(0);

pub(super) const BLACK: Bsdf = Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black };

/// A camera that sees practically one ray: a single pixel of 0.001 degrees.
pub(super) const ONE_RAY: (f64, usize, usize) = (1e-3, 1, 1);

/// Looks from `eye` to `target` with (field of view, width, height).
pub(super) fn camera(eye: DVec3, target: DVec3, (fov, w, h): (f64, usize, usize)) -> SceneParts {
    let z = (target - eye).normalize();
    let x = z.any_orthonormal_vector();
    let rotation = DMat3::from_cols(x, z.cross(x), z);
    let to_world = DAffine3::from_mat3_translation(rotation, eye);
    SceneParts {
        shapes: vec![],
        media: vec![],
        textures: vec![],
        emitters: vec![],
        background: None,
        sensor: Sensor::perspective(to_world, fov, FovAxis::X, w, h),
        film: FilmSpec { width: w, height: h, pixel_format: PixelFormat::Rgb, time: None },
        integrator: IntegratorSpec::default(),
    }
}

/// Bins over (start, end).
pub(super) fn time(start_opl: f64, end: f64, bins: usize) -> TimeSpec {
    TimeSpec { start_opl, bin_width_opl: (end - start_opl) / bins as f64, bins }
}

pub(super) fn medium(sigma_s: Rgb, sigma_t: Rgb, g: f64) -> Medium {
    let coefficients = Coefficients { sigma_s, sigma_t };
    Medium { name: "fog".into(), coefficients, phase: Phase::with_mean_cosine(g), eta: None }
}

pub(super) fn shape(name: &str, primitives: Vec<Primitive>, bsdf: Bsdf) -> ShapePart {
    ShapePart { name: name.into(), primitives, bsdf, boundary: None, radiance: None }
}

pub(super) fn lamp(primitive: Primitive, radiance: f64) -> ShapePart {
    let radiance = Some(Rgb::splat(radiance));
    ShapePart { radiance, ..shape("lamp", vec![primitive], BLACK) }
}

/// With fog behind the normals and `exterior` before them.
pub(super) fn filled(mut part: ShapePart, exterior: Option<MediumId>) -> ShapePart {
    part.boundary = Some(MediumBoundary { interior: Some(FOG), exterior });
    part
}

pub(super) fn ball(centre: DVec3, radius: f64, flipped: bool) -> Primitive {
    Primitive::Sphere(Sphere { centre, radius, flipped })
}

/// A parallelogram around `centre`; its normal is along u × v.
pub(super) fn plate(centre: DVec3, u: DVec3, v: DVec3) -> Primitive {
    Primitive::Planar(Planar::new(centre, u, v, Outline::Parallelogram))
}

/// Six faces of a box with outward normals; half edges are the columns of `half`.
pub(super) fn cuboid(centre: DVec3, half: DMat3) -> Vec<Primitive> {
    let [x, y, z] = [half.x_axis, half.y_axis, half.z_axis];
    [(x, y, z), (y, z, x), (z, x, y)]
        .into_iter()
        .flat_map(|(u, v, w)| [plate(centre + w, u, v), plate(centre - w, v, u)])
        .collect()
}

/// Diffuse on the side of the normal.
pub(super) fn diffuse(reflectance: Rgb) -> Bsdf {
    Bsdf::Opaque { front: Reflector::Diffuse(reflectance), back: Reflector::Black }
}

pub(super) fn glass(eta: f64) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        interior_eta: eta,
        exterior_eta: 1.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    })
}

pub(super) fn point_light(position: DVec3, intensity: Rgb) -> EmitterPart {
    EmitterPart {
        name: "point".into(),
        kind: EmitterKind::Point { position, intensity },
        stated_medium: None,
    }
}

/// Depths from `min` to `max`, no roulette.
pub(super) fn depths(min: u32, max: u32) -> IntegratorSpec {
    IntegratorSpec { method: None, max_depth: Some(max), min_depth: min, rr_depth: u32::MAX }
}

pub(super) fn tracer<const C: usize>(
    scene: &Scene,
    integrator: IntegratorSpec,
    samples: u32,
) -> PathTracer<'_, C> {
    let options = PathOptions { samples_per_pass: NonZeroU32::new(samples) };
    PathTracer::new(scene, &Plan::new(scene, &integrator), integrator, &options)
}
