//! Two parallel mirrors, and the images of a lamp in them.
//!
//! Mirrors at x = 0 (reflectance 0.9) and x = W (0.8). The images of a source at x_s are at
//! 2kW ± x_s; one that took a reflections off the first mirror and b off the second arrives with
//! 0.9^a 0.8^b, after its distance (`tpb_reference::interfaces`).
//!
//! * [`MirrorLamp`]: a lamp across the far end, seen in the mirrors. Nothing is left to chance: the
//!   comparison is to rounding. Light tracing cannot connect to the camera by way of a mirror.
//! * [`MirrorFloor`]: the images light a diffuse floor between the mirrors, irradiance
//!   0.9^a 0.8^b cosθ/(4πr²) each, and a camera sees the floor. Beams and light tracing find them
//!   from a point lamp; the path tracer cannot, and gets an elliptic lamp, over which the images are
//!   averaged.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use tpb_beams::BeamOptions;
use tpb_light::LightOptions;
use tpb_optics::Rgb;
use tpb_path::PathOptions;
use tpb_reference::interfaces::{ParallelMirrors, parallel_mirrors_time, parallel_mirrors_weight};
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, FovAxis, IntegratorSpec, Primitive, Reflector, Scene,
    SceneParts, Sensor, ShapePart, TimeSpec,
};

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::experiments::echoes::Follower;
use crate::experiments::screen::{Lit, Screen, blocks};
use crate::experiments::sights::{Instant, Sight, Sights, across, lamp, narrow, rectangle};
use crate::measure::{BatchPlan, Estimator};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth};

const FIRST: f64 = 0.9;
const SECOND: f64 = 0.8;

/// Each method and number of reflections.
pub fn all(effort: Effort) -> Experiments {
    let mut list: Experiments = vec![
        Arc::new(MirrorLamp { who: Follower::Path }),
        Arc::new(MirrorLamp { who: Follower::Beams }),
    ];
    let floor = |who, bounces| Arc::new(MirrorFloor { who, bounces }) as _;
    list.push(floor(Finder::Beams, 1));
    if effort == Effort::Full {
        list.extend([0, 2, 3].map(|bounces| floor(Finder::Beams, bounces)));
        list.push(floor(Finder::Path, 1));
        list.extend([1, 2].map(|bounces| floor(Finder::Light, bounces)));
    }
    list
}

/// One image: k, and the sign of x_s in its place 2kW ± x_s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Image {
    k: i32,
    sign: i32,
}

impl Image {
    /// All with exactly this many reflections.
    fn with(bounces: u32) -> Vec<Self> {
        let reach = bounces.cast_signed() + 1;
        (-reach..=reach)
            .flat_map(|k| [Self { k, sign: 1 }, Self { k, sign: -1 }])
            .filter(|image| image.bounces().iter().sum::<u32>() == bounces)
            .collect()
    }

    /// Reflections off the first and the second mirror.
    fn bounces(self) -> [u32; 2] {
        let k = self.k.unsigned_abs();
        match (self.sign, self.k) {
            (1, _) => [k, k],
            (_, 1..) => [k - 1, k],
            _ => [k + 1, k],
        }
    }

    fn input(self, width: f64, source_x: f64, observer_x: f64, lateral: f64) -> ParallelMirrors {
        let [bounces_first, bounces_second] = self.bounces();
        let (image, image_sign) = (self.k, self.sign);
        ParallelMirrors {
            width,
            source_x,
            observer_x,
            lateral,
            image,
            image_sign,
            bounces_first: Some(bounces_first),
            bounces_second: Some(bounces_second),
            first_reflectance: FIRST,
            second_reflectance: SECOND,
            speed: 1.0,
        }
    }

    fn x(self, width: f64, source_x: f64) -> f64 {
        f64::from(2 * self.k) * width + f64::from(self.sign) * source_x
    }
}

fn mirror(name: &str, x: f64, towards: f64, reflectance: f64) -> ShapePart {
    let front = Reflector::Mirror(Rgb::splat(reflectance));
    let bsdf = Bsdf::Opaque { front, back: Reflector::Black };
    rectangle(name, x * DVec3::X, 10.0 * towards * DVec3::Y, 10.0 * DVec3::Z, bsdf)
}

/// Normals point into the space between.
fn mirrors(width: f64) -> [ShapePart; 2] {
    [mirror("first", 0.0, 1.0, FIRST), mirror("second", width, -1.0, SECOND)]
}

/// A lamp seen in two mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MirrorLamp {
    /// Who looks.
    pub who: Follower,
}

impl MirrorLamp {
    const WIDTH: f64 = 2.0;
    const EYE: f64 = 1.1;
    const LAMP: f64 = 0.7;
    const DISTANCE: f64 = 3.0;
    const MOST: u32 = 4;
    const TIME: TimeSpec = TimeSpec { start_opl: 0.0, bin_width_opl: 0.1, bins: 120 };

    fn sight(context: &Context, image: Image) -> Result<Sight> {
        let input = image.input(Self::WIDTH, Self::LAMP, Self::EYE, Self::DISTANCE);
        let opl = parallel_mirrors_time(&input)?;
        // A fluence; a lamp's radiance falls by the reflectances alone.
        let radiance = parallel_mirrors_weight(&input)? * 4.0 * PI * opl * opl;
        let along = DVec3::new(image.x(Self::WIDTH, Self::LAMP) - Self::EYE, 0.0, Self::DISTANCE);
        let depths =
            IntegratorSpec { method: None, max_depth: Some(20), min_depth: 1, rr_depth: 20 };
        let mut parts = narrow(Self::EYE * DVec3::X, along, Self::TIME, depths);
        parts.shapes = mirrors(Self::WIDTH).to_vec();
        parts.shapes.push(lamp(across("lamp", Self::DISTANCE, -1.0, Bsdf::Null), 1.0));
        let [first, second] = image.bounces();
        let name = format!("image {} {:+}", image.k, image.sign);
        let instant = Instant { name: format!("{first} + {second} reflections"), opl, radiance };
        let scene = context.assemble(parts)?;
        Ok(Sight { name, scene, instants: vec![instant], total: radiance, error: 1e-12 })
    }

    fn sights(context: &Context) -> Result<Vec<Sight>> {
        let images = (0..=Self::MOST).flat_map(Image::with);
        images.map(|image| Self::sight(context, image)).collect()
    }
}

impl Experiment for MirrorLamp {
    fn name(&self) -> String {
        format!("mirrors/lamp/{}", self.who.estimator(1).name())
    }

    fn description(&self) -> String {
        "images of a lamp in two parallel mirrors: each in its bin with its reflectances".into()
    }

    fn kind(&self) -> Kind {
        Kind::Exact
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        if self.who == Follower::Path { vec![Sabotage::LATE] } else { vec![] }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let sights = Self::sights(context)?;
        let plan = BatchPlan { batches: 32, passes: 1, seed: context.seed };
        let (estimator, criterion) = (self.who.estimator(4), context.unbiased());
        let mut outcome = Sights { estimator, plan, criterion, at: &sights }.run(context)?;
        outcome.false_alarm = 0.0;
        Ok(outcome)
    }
}

/// Who finds light that reaches a diffuse screen by way of mirrors or glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finder {
    /// The path tracer, from an elliptic lamp.
    Path,
    /// Photons on surfaces, from a point lamp.
    Beams,
    /// Photons that are connected to the camera, from a point lamp.
    Light,
}

impl Finder {
    /// Its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Beams => "beams",
            Self::Light => "light",
        }
    }

    /// With this many camera paths per pixel, or this many photons, in a pass, and this radius of
    /// the disc that photons are gathered from.
    pub(super) fn estimator(self, samples: u32, photons: u64, blur: f64) -> Estimator {
        match self {
            Self::Path => {
                Estimator::Path(PathOptions { samples_per_pass: samples.try_into().ok() })
            }
            Self::Beams => Estimator::Beams(BeamOptions {
                photons_per_pass: Some(photons),
                surface_radius: Some(blur),
                surface_radius_exponent: Some(0.0),
                surface_samples: Some(16),
                ..BeamOptions::default()
            }),
            Self::Light => Estimator::Light(LightOptions { photons_per_pass: Some(photons) }),
        }
    }

    /// Adds a lamp along u × v, which are the half axes of an elliptic one: of power 1/4 W and
    /// intensity cosθ/4π, or, a point's, 1/4π within a cone.
    pub(super) fn light(self, parts: &mut SceneParts, at: DVec3, u: DVec3, v: DVec3) {
        let axis = u.cross(v);
        if self == Self::Path {
            let ellipse = Planar::new(at, u, v, Outline::Ellipse);
            let shape = ShapePart {
                name: "lamp".into(),
                primitives: vec![Primitive::Planar(ellipse)],
                bsdf: Bsdf::Null,
                boundary: None,
                radiance: None,
            };
            parts.shapes.push(lamp(shape, 0.25 / (PI * PI * axis.length())));
        } else {
            let cos = CONE.to_radians().cos();
            let kind = EmitterKind::Spot {
                position: at,
                axis: axis.normalize(),
                intensity: Rgb::splat(0.25 / PI),
                cos_cutoff: cos,
                cos_beam: cos,
            };
            parts.emitters.push(EmitterPart { name: "lamp".into(), kind, stated_medium: None });
        }
    }

    /// Half axes of its lamp, if those of an elliptic one have these lengths.
    pub(super) fn lamp(self, elliptic: DVec2) -> DVec2 {
        if self == Self::Path { elliptic } else { DVec2::ZERO }
    }

    /// Radius of its disc on screens.
    pub(super) fn blur(self, radius: f64) -> f64 {
        if self == Self::Beams { radius } else { 0.0 }
    }

    /// Intensity of a lamp's point towards a direction at this cosine to its axis, times 4π.
    pub(super) fn profile(self, cosine: f64) -> f64 {
        match self {
            Self::Path => cosine,
            _ if cosine >= CONE.to_radians().cos() => 1.0,
            _ => 0.0,
        }
    }
}

/// Half angle of the cone of light of point lamps \[degrees\].
pub(super) const CONE: f64 = 65.0;

/// The images of a lamp above a diffuse floor between two mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MirrorFloor {
    /// Who looks.
    pub who: Finder,
    /// Reflections.
    pub bounces: u32,
}

impl MirrorFloor {
    const WIDTH: f64 = 1.0;
    const LAMP: DVec3 = DVec3::new(0.35, 2.0, 0.0);
    const EYE: DVec3 = DVec3::new(0.5, 0.6, 0.0);
    /// Half axes of a lamp that is no point, along x and z.
    const AXES: DVec2 = DVec2::new(0.3, 0.9);
    const BLUR: f64 = 0.04;
    const ALBEDO: f64 = 0.8;
    const PIXELS: (usize, usize) = (6, 16);
    const TIME: TimeSpec = TimeSpec { start_opl: 2.5, bin_width_opl: 0.1, bins: 40 };

    fn scene(self, context: &Context) -> Result<Scene> {
        let integrator = only_depth(self.bounces + 2);
        let view = View { pixels: Self::PIXELS.0, fov: 72.0, time: Some(Self::TIME), integrator };
        let mut parts = view.parts();
        let matrix = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
        let to_world = DAffine3::from_mat3_translation(matrix, Self::EYE);
        let (width, height) = Self::PIXELS;
        parts.sensor = Sensor::perspective(to_world, view.fov, FovAxis::X, width, height);
        parts.film.height = height;
        parts.shapes = mirrors(Self::WIDTH).to_vec();
        let front = Reflector::Diffuse(Rgb::splat(Self::ALBEDO));
        let floor = Bsdf::Opaque { front, back: Reflector::Black };
        let half = 0.5 * Self::WIDTH * DVec3::X;
        parts.shapes.push(rectangle("floor", half, 5.0 * DVec3::Z, half, floor));
        let DVec2 { x, y: z } = Self::AXES;
        self.who.light(&mut parts, Self::LAMP, x * DVec3::X, z * DVec3::Z);
        context.assemble(parts)
    }

    /// The images of a point of the lamp, at a point of the floor.
    fn lit(self, offset: DVec2, p: DVec3) -> Result<Vec<Lit>> {
        let source = Self::LAMP + DVec3::new(offset.x, 0.0, offset.y);
        let lateral = source.y.hypot(p.z - source.z);
        let one = |image: Image| -> Result<Lit> {
            let input = image.input(Self::WIDTH, source.x, p.x, lateral);
            let from = DVec3::new(image.x(Self::WIDTH, source.x), source.y, source.z);
            let direction = (p - from).normalize();
            let cosine = -direction.y;
            let irradiance = parallel_mirrors_weight(&input)? * cosine * self.who.profile(cosine);
            let (opl, direct) = (parallel_mirrors_time(&input)?, self.bounces == 0);
            Ok(Lit { irradiance, opl, direction, direct })
        };
        Image::with(self.bounces).into_iter().map(one).collect()
    }
}

impl Experiment for MirrorFloor {
    fn name(&self) -> String {
        format!("mirrors/floor/{}-reflections/{}", self.bounces, self.who.name())
    }

    fn description(&self) -> String {
        let lamp = if self.who == Finder::Path { "wide" } else { "point" };
        let Self { bounces, .. } = self;
        format!("a {lamp} lamp's images after {bounces} reflections between mirrors, on a floor")
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        match (self.who, self.bounces) {
            (Finder::Beams, 1) => vec![Sabotage::Cosine],
            _ => vec![Sabotage::LATE],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = self.scene(context)?;
        let screen = Screen {
            scene: &scene,
            origin: DVec3::ZERO,
            normal: DVec3::Y,
            albedo: Self::ALBEDO,
            eta: 1.0,
            lamp: self.who.lamp(Self::AXES),
            blur: self.who.blur(Self::BLUR),
            points: 16384,
        };
        let expected = screen.expected(|offset, p| self.lit(offset, p))?;
        // The more reflections, the less light: longer runs and coarser shares in time.
        let (shares, passes) = match (self.who, self.bounces) {
            (Finder::Path, _) | (_, 2) => (3, 2),
            (_, 3) => (2, 3),
            _ => (3, 1),
        };
        let contrasts = standard(&expected.cube, &blocks(Self::PIXELS, (2, 1)), shares);
        let plan = BatchPlan { batches: 80, passes, seed: context.seed };
        Comparison {
            scene: &scene,
            estimator: self.who.estimator(2500, 200_000, Self::BLUR),
            plan,
            expected: &expected.cube,
            coarser: Some(&expected.coarser),
            contrasts: &contrasts,
            criterion: context.blurred(),
            dropped: &expected.cosines,
        }
        .run(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_one_direct_image_and_two_of_each_number_of_reflections() {
        assert_eq!(Image::with(0), [Image { k: 0, sign: 1 }]);
        for bounces in 1..6 {
            assert_eq!(Image::with(bounces).len(), 2, "{bounces}");
        }
    }
}
