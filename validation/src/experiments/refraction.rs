//! A lamp that lights a diffuse wall through plane glass.
//!
//! Snell's law leaves one straight way from a point of the lamp to a point of the wall at the lateral
//! distance ρ; `tpb_reference::interfaces` has its irradiance E(ρ) and arrival t(ρ). Two scenes:
//!
//! * *slab*: air, slab, air, wall; the factors η² of radiance cancel, delay and spread do not;
//! * *inside*: the wall, and the camera that sees it, are within the glass. The cones of rays are
//!   those of a slab that the wall closes, so that E is the slab's over its second transmittance
//!   (1 − R). Photons carry *flux*, which knows no η²; a camera's path carries radiance, which does:
//!   to agree with the same E, the one must leave η² out and the other must not.
//!
//! Depths of other ways than the straight one (echoes, the wall's light reflected back) are left out
//! of film and expectation. Beams and light tracing find light from a point lamp; the path
//! tracer cannot meet a point, and gets a round lamp, over which E is averaged. The beams' surface
//! photons are compared with their exact blur.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use tpb_optics::Rgb;
use tpb_reference::interfaces::{
    PointThroughSlab, SlabEcho, point_through_slab_irradiance, point_through_slab_sine,
    point_through_slab_time, slab_echo_weight_unpolarised,
};
use tpb_scene::{Bsdf, FovAxis, Reflector, Scene, Sensor, TimeSpec};

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::experiments::mirrors::Finder;
use crate::experiments::screen::{Lit, Screen, blocks};
use crate::experiments::sights::{across, glass};
use crate::measure::BatchPlan;
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth};

const ETA: f64 = 1.5;
const ALBEDO: f64 = 0.8;
const PIXELS: usize = 8;
/// The lamp is at the origin and shines along +z; the glass begins here, and is so thick.
const FACE: f64 = 1.0;
const THICKNESS: f64 = 0.5;
/// Air behind the slab.
const BEHIND: f64 = 1.0;
const BLUR: f64 = 0.04;

/// A lamp through glass onto a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThroughGlass {
    /// Who looks.
    pub who: Finder,
    /// Whether wall and camera are inside the glass.
    pub inside: bool,
}

/// Each method and scene.
pub fn all(effort: Effort) -> Experiments {
    let case = |who, inside| Arc::new(ThroughGlass { who, inside }) as _;
    let mut list: Experiments = vec![case(Finder::Path, true)];
    if effort == Effort::Full {
        list.extend([Finder::Beams, Finder::Light].map(|who| case(who, true)));
        list.extend([Finder::Path, Finder::Beams, Finder::Light].map(|who| case(who, false)));
    }
    list
}

impl ThroughGlass {
    fn wall(self) -> f64 {
        if self.inside { FACE + THICKNESS } else { FACE + THICKNESS + BEHIND }
    }

    /// Pinhole, angle across the film, and window.
    fn view(self) -> (DVec3, f64, TimeSpec) {
        let time = |start_opl| TimeSpec { start_opl, bin_width_opl: 0.05, bins: 36 };
        if self.inside {
            (DVec3::new(0.6, 0.0, 1.1), 100.0, time(2.2))
        } else {
            (DVec3::new(1.0, 0.0, 1.6), 80.0, time(3.4))
        }
    }

    /// Radius of the path tracer's lamp.
    fn lamp(self) -> f64 {
        if self.inside { 0.6 } else { 1.0 }
    }

    fn scene(self, context: &Context) -> Result<Scene> {
        let (eye, fov, time) = self.view();
        let events = if self.inside { 2 } else { 3 };
        let view =
            View { pixels: PIXELS, fov, time: Some(time), integrator: only_depth(events + 1) };
        let mut parts = view.parts();
        let to_world = DAffine3::from_translation(eye);
        parts.sensor = Sensor::perspective(to_world, fov, FovAxis::X, PIXELS, PIXELS);
        let front = Reflector::Diffuse(Rgb::splat(ALBEDO));
        let wall = Bsdf::Opaque { front, back: Reflector::Black };
        parts.shapes =
            vec![across("face", FACE, -1.0, glass(ETA)), across("wall", self.wall(), -1.0, wall)];
        if !self.inside {
            parts.shapes.push(across("back", FACE + THICKNESS, 1.0, glass(ETA)));
        }
        let radius = self.lamp();
        self.who.light(&mut parts, DVec3::ZERO, radius * DVec3::X, radius * DVec3::Y);
        context.assemble(parts)
    }

    /// The straight way from a point of the lamp to a point of the wall.
    fn lit(self, offset: DVec2, p: DVec3) -> Result<Vec<Lit>> {
        let source = offset.extend(0.0);
        let across = (p - source).with_z(0.0);
        let lateral = across.length();
        let air_gap = if self.inside { FACE } else { FACE + BEHIND };
        let way = PointThroughSlab {
            energy: 1.0,
            air_gap,
            thickness: THICKNESS,
            eta: ETA,
            lateral,
            speed: 1.0,
        };
        let mut irradiance = point_through_slab_irradiance(&way)?;
        let mut sine = point_through_slab_sine(&way)?;
        let opl = point_through_slab_time(&way)?;
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        irradiance *= self.who.profile(cosine);
        if self.inside {
            let face = SlabEcho {
                eta: ETA,
                cos_incidence: cosine,
                echo: 0,
                thickness: THICKNESS,
                speed: 1.0,
            };
            irradiance /= slab_echo_weight_unpolarised(&face)?.sqrt();
            sine /= ETA;
        }
        let outwards = across.normalize_or_zero();
        let direction = sine * outwards + ((1.0 - sine) * (1.0 + sine)).sqrt() * DVec3::Z;
        Ok(vec![Lit { irradiance, opl, direction, direct: false }])
    }
}

impl Experiment for ThroughGlass {
    fn name(&self) -> String {
        let scene = if self.inside { "inside" } else { "slab" };
        format!("through-glass/{scene}/{}", self.who.name())
    }

    fn description(&self) -> String {
        let place = if self.inside { "within glass" } else { "behind a glass slab" };
        let lamp = if self.who == Finder::Path { "round" } else { "point" };
        format!(
            "a {lamp} lamp's light on a wall {place}, in space and time, against Snell and Fresnel"
        )
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        match (self.inside, self.who) {
            (true, ..) if effort == Effort::Full => vec![Sabotage::EtaSquared],
            (true, ..) => vec![],
            (false, Finder::Path) => vec![Sabotage::Cosine],
            (false, ..) => vec![Sabotage::LATE],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = self.scene(context)?;
        let screen = Screen {
            scene: &scene,
            origin: self.wall() * DVec3::Z,
            normal: DVec3::NEG_Z,
            albedo: ALBEDO,
            eta: if self.inside { ETA } else { 1.0 },
            lamp: self.who.lamp(DVec2::splat(self.lamp())),
            blur: self.who.blur(BLUR),
            points: 16384,
        };
        let expected = screen.expected(|offset, p| self.lit(offset, p))?;
        let contrasts = standard(&expected.cube, &blocks((PIXELS, PIXELS), (2, 1)), 3);
        let dropped = if context.sabotage == Some(Sabotage::EtaSquared) {
            vec![ETA * ETA; PIXELS * PIXELS]
        } else {
            expected.cosines
        };
        let passes = if self.who == Finder::Beams { 5 } else { 3 };
        Comparison {
            scene: &scene,
            estimator: self.who.estimator(2500, 150_000, BLUR),
            plan: BatchPlan { batches: 64, passes, seed: context.seed },
            expected: &expected.cube,
            coarser: Some(&expected.coarser),
            contrasts: &contrasts,
            criterion: context.blurred(),
            dropped: &dropped,
        }
        .run(context)
    }
}
