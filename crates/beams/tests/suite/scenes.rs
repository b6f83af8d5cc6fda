//! Scenes for tests and measurements, built without files.
#![allow(dead_code, reason = "each user takes the scenes that it needs")]

use glam::{DAffine3, DMat3, DVec3};
use tpb_optics::{Coefficients, Phase, Rgb, Spectrum};
use tpb_scene::geometry::{Outline, Planar, Sphere};
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, FilmSpec, FovAxis, IntegratorSpec, Medium, MediumBoundary,
    MediumId, PixelFormat, Primitive, Reflector, Scene, SceneParts, Sensor, ShapePart, TimeSpec,
};

/// A medium with equal channels.
pub(crate) fn fog(sigma_s: f64, sigma_t: f64, g: f64) -> Medium {
    colored_fog([sigma_s; 3], [sigma_t; 3], g)
}

/// A medium.
pub(crate) fn colored_fog(sigma_s: [f64; 3], sigma_t: [f64; 3], g: f64) -> Medium {
    Medium {
        name: "fog".to_owned(),
        coefficients: Coefficients { sigma_s: Spectrum(sigma_s), sigma_t: Spectrum(sigma_t) },
        phase: Phase::with_mean_cosine(g),
        eta: None,
    }
}

/// A camera at `position` looking along `forward`.
pub(crate) fn camera(position: DVec3, forward: DVec3, fov: f64, (w, h): (usize, usize)) -> Sensor {
    let z = forward.normalize();
    let helper = if z.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
    let x = helper.cross(z).normalize();
    let y = z.cross(x);
    let to_world = DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), position);
    Sensor::perspective(to_world, fov, FovAxis::X, w, h)
}

/// A film with bins from 0 on.
pub(crate) fn film(width: usize, height: usize, bin_width_opl: f64, bins: usize) -> FilmSpec {
    let time = Some(TimeSpec { start_opl: 0.0, bin_width_opl, bins });
    FilmSpec { width, height, pixel_format: PixelFormat::Luminance, time }
}

/// A two-sided-black-behind diffuse material.
pub(crate) fn diffuse(rho: f64) -> Bsdf {
    Bsdf::Opaque { front: Reflector::Diffuse(Rgb::splat(rho)), back: Reflector::Black }
}

/// A shape without media.
pub(crate) fn shape(name: &str, primitives: Vec<Primitive>, bsdf: Bsdf) -> ShapePart {
    ShapePart { name: name.to_owned(), primitives, bsdf, boundary: None, radiance: None }
}

/// Centre and half edges; the normal is along u × v.
pub(crate) fn rectangle(centre: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Primitive {
    let [c, u, v] = [centre, u, v].map(DVec3::from_array);
    Primitive::Planar(Planar::new(c, u, v, Outline::Parallelogram))
}

/// A sphere.
pub(crate) fn sphere(centre: DVec3, radius: f64, flipped: bool) -> Primitive {
    Primitive::Sphere(Sphere { centre, radius, flipped })
}

/// A box with outward normals, turned around y.
pub(crate) fn block(half: DVec3, degrees: f64, centre: DVec3) -> Vec<Primitive> {
    let turn = DMat3::from_rotation_y(degrees.to_radians());
    let mut faces = Vec::new();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let unit = |i: usize| turn * (DVec3::AXES[i % 3] * half[i % 3]);
            let (c, u, v) = (sign * unit(axis), unit(axis + 1), sign * unit(axis + 2));
            faces.push(Primitive::Planar(Planar::new(centre + c, u, v, Outline::Parallelogram)));
        }
    }
    faces
}

/// A point emitter.
pub(crate) fn point(position: DVec3, intensity: Rgb) -> EmitterPart {
    EmitterPart {
        name: "point".to_owned(),
        kind: EmitterKind::Point { position, intensity },
        stated_medium: None,
    }
}

/// The parts of an infinite medium with one emitter.
pub(crate) fn infinite(
    medium: Medium,
    emitter: EmitterPart,
    sensor: Sensor,
    film: FilmSpec,
) -> SceneParts {
    SceneParts {
        shapes: vec![],
        media: vec![medium],
        textures: vec![],
        emitters: vec![emitter],
        background: Some(MediumId(0)),
        sensor,
        film,
        integrator: IntegratorSpec::default(),
    }
}

/// The scene of `validation/scenes/cornell-blocks.json`.
pub(crate) fn cornell_blocks(width: usize) -> Scene {
    let wall = |name: &str, rho: f64, centre, u, v| {
        shape(name, vec![rectangle(centre, u, v)], diffuse(rho))
    };
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let (mx, my, mz) = ([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]);
    let _ = (mx, my);
    let mut front = shape("front", vec![rectangle(z, x, y)], Bsdf::Null);
    front.boundary = Some(MediumBoundary { interior: Some(MediumId(0)), exterior: None });
    let mut lamp = shape(
        "lamp",
        vec![rectangle([0.0, 0.99, 0.0], [0.2, 0.0, 0.0], [0.0, 0.0, 0.2])],
        diffuse(0.0),
    );
    lamp.radiance = Some(Rgb::splat(10.0));
    let shapes = vec![
        front,
        wall("back", 0.75, mz, x, y),
        wall("floor", 0.75, my, x, mz),
        wall("ceiling", 0.75, y, x, z),
        wall("left", 0.45, mx, mz, y),
        wall("right", 0.3, x, z, y),
        shape(
            "tall",
            block(DVec3::new(0.3, 0.6, 0.3), 18.0, DVec3::new(-0.35, -0.4, -0.3)),
            diffuse(0.75),
        ),
        shape(
            "short",
            block(DVec3::new(0.3, 0.3, 0.3), -17.0, DVec3::new(0.35, -0.7, 0.35)),
            diffuse(0.75),
        ),
        lamp,
    ];
    Scene::assemble(SceneParts {
        shapes,
        media: vec![fog(0.4, 0.5, 0.0)],
        textures: vec![],
        emitters: vec![],
        background: None,
        sensor: camera(DVec3::new(0.0, 0.0, 3.9), -DVec3::Z, 38.0, (width, width)),
        film: film(width, width, 0.07, 200),
        integrator: IntegratorSpec { max_depth: Some(100), rr_depth: 8, ..Default::default() },
    })
    .expect("the scene is consistent")
}
