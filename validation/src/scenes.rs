//! Small scenes in code, for which the reference has exact solutions, and the loading of the
//! shipped ones.

use std::f64::consts::PI;
use std::path::Path;

use glam::{DAffine3, DVec3};
use tpb_optics::{Coefficients, Phase, Rgb};
use tpb_scene::geometry::Sphere;
use tpb_scene::load::{LoadedScene, Override, load_scene};
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, FilmSpec, FovAxis, IntegratorSpec, Medium, MediumId,
    PixelFormat, Primitive, Reflector, Scene, SceneParts, Sensor, ShapePart, TimeSpec,
};

use crate::error::{Result, ValidationError};
use crate::experiment::Context;

/// A camera at the origin that looks along +z, with a square film of one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pixels on a side.
    pub pixels: usize,
    /// Full angle across the film \[degrees\].
    pub fov: f64,
    /// The time axis.
    pub time: Option<TimeSpec>,
    /// Which depths count.
    pub integrator: IntegratorSpec,
}

/// Only paths of this depth, and no roulette before it.
pub fn only_depth(depth: u32) -> IntegratorSpec {
    IntegratorSpec {
        method: None,
        max_depth: Some(depth),
        min_depth: depth,
        rr_depth: depth.saturating_add(1),
    }
}

impl View {
    /// Empty scene parts seen this way.
    pub fn parts(&self) -> SceneParts {
        let to_world = DAffine3::IDENTITY;
        SceneParts {
            shapes: vec![],
            media: vec![],
            textures: vec![],
            emitters: vec![],
            background: None,
            sensor: Sensor::perspective(to_world, self.fov, FovAxis::X, self.pixels, self.pixels),
            film: FilmSpec {
                width: self.pixels,
                height: self.pixels,
                pixel_format: PixelFormat::Luminance,
                time: self.time,
            },
            integrator: self.integrator,
        }
    }
}

/// A homogeneous, achromatic medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Absorption coefficient \[1/m\].
    pub sigma_a: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
}

impl Fog {
    /// Extinction coefficient \[1/m\].
    pub fn sigma_t(&self) -> f64 {
        self.sigma_s + self.sigma_a
    }

    /// As a medium of a scene.
    pub fn medium(&self) -> Medium {
        let (sigma_s, sigma_t) = (Rgb::splat(self.sigma_s), Rgb::splat(self.sigma_t()));
        Medium {
            name: "fog".into(),
            coefficients: Coefficients { sigma_s, sigma_t },
            phase: Phase::with_mean_cosine(self.g),
            eta: None,
        }
    }
}

/// A point light of unit power at `position`.
pub fn unit_point(position: DVec3) -> EmitterPart {
    let intensity = Rgb::splat(0.25 / PI);
    EmitterPart {
        name: "lamp".into(),
        kind: EmitterKind::Point { position, intensity },
        stated_medium: None,
    }
}

/// A sphere that bounds nothing: light crosses it unchanged.
pub fn null_sphere(centre: DVec3, radius: f64) -> ShapePart {
    ShapePart {
        name: "null".into(),
        primitives: vec![Primitive::Sphere(Sphere { centre, radius, flipped: false })],
        bsdf: Bsdf::Null,
        boundary: None,
        radiance: None,
    }
}

/// Infinite fog with a point light of unit power.
pub fn infinite_fog(context: &Context, view: &View, fog: &Fog, light: DVec3) -> Result<Scene> {
    let mut parts = view.parts();
    parts.media = vec![fog.medium()];
    parts.background = Some(MediumId(0));
    parts.emitters = vec![unit_point(light)];
    context.assemble(parts)
}

/// The inside of a unit sphere with a diffuse wall; camera and a point light of unit power at its
/// centre.
pub fn diffuse_sphere_parts(view: &View, albedo: f64) -> SceneParts {
    let mut parts = view.parts();
    let wall = Reflector::Diffuse(Rgb::splat(albedo));
    let sphere = Sphere { centre: DVec3::ZERO, radius: 1.0, flipped: true };
    parts.shapes = vec![ShapePart {
        name: "wall".into(),
        primitives: vec![Primitive::Sphere(sphere)],
        bsdf: Bsdf::Opaque { front: wall, back: Reflector::Black },
        boundary: None,
        radiance: None,
    }];
    parts.emitters = vec![unit_point(DVec3::ZERO)];
    parts
}

/// A shipped scene, as its file says.
pub fn shipped(path: &Path) -> Result<LoadedScene> {
    load_scene(path, &[])
        .map_err(|error| ValidationError::unusable(path.display().to_string(), error))
}

/// A shipped scene with a film of this many pixels on a side.
pub fn smaller(path: &Path, pixels: usize) -> Result<Scene> {
    let unusable = |error| ValidationError::unusable(path.display().to_string(), error);
    let overrides = [
        Override::parse(&format!("sensor.film.width={pixels}")),
        Override::parse(&format!("sensor.film.height={pixels}")),
    ];
    let overrides = overrides.into_iter().collect::<std::result::Result<Vec<_>, _>>();
    Ok(load_scene(path, &overrides.map_err(unusable)?).map_err(unusable)?.scene)
}
