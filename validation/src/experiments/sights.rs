//! Light that a narrow camera sees at known instants, through chains of mirrors and glass.
//!
//! The field of view is so small that all pixels see the same: a chain arrives at one time, with one
//! radiance, and must be in one bin. A contrast for each instant asks for the energy of that very
//! bin, and one for the energy of all cells, within and outside the window, that there is nothing
//! else. Several sights (scenes that differ in angle, say) are judged together, batch by batch.

use glam::{DAffine3, DQuat, DVec3};
use tpb_optics::Rgb;
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, Dielectric, FovAxis, IntegratorSpec, MediumBoundary, Primitive, Reflector, Scene,
    SceneParts, Sensor, ShapePart, TimeSpec,
};

use crate::contrasts::LinearContrast;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Outcome};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::scenes::View;
use crate::statistics::{Batches, Criterion, Target, judge};

/// Pixels on a side.
const SIDE: usize = 8;

/// Angle across the film \[degrees\].
const FOV: f64 = 0.01;

/// A narrow camera's view.
pub(super) struct Sight {
    /// What it is, for names of contrasts.
    pub(super) name: String,
    /// What is seen.
    pub(super) scene: Scene,
    /// The instants that are judged, each alone in its bin.
    pub(super) instants: Vec<Instant>,
    /// Radiance of all light, whenever it arrives.
    pub(super) total: f64,
    /// Bound of the relative error of these radiances, for the camera is not infinitely narrow.
    pub(super) error: f64,
}

/// Light that arrives at one time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Instant {
    /// What it is.
    pub(super) name: String,
    /// When it arrives \[m\].
    pub(super) opl: f64,
    /// Its radiance \[W m⁻² sr⁻¹\].
    pub(super) radiance: f64,
}

/// Sights, and how they are judged.
pub(super) struct Sights<'a> {
    /// Who looks.
    pub(super) estimator: Estimator,
    /// In which batches.
    pub(super) plan: BatchPlan,
    /// What is asked.
    pub(super) criterion: Criterion,
    /// At what.
    pub(super) at: &'a [Sight],
}

impl Sights<'_> {
    /// Renders and judges.
    pub(super) fn run(self, context: &Context) -> Result<Outcome> {
        let mut targets = Vec::new();
        let mut rows = vec![Vec::new(); self.plan.batches as usize];
        for sight in self.at {
            let (contrasts, more) = sight.contrasts();
            targets.extend(more);
            let layout = context.layout(&sight.scene.film)?;
            let mut rows = rows.iter_mut();
            batches(&sight.scene, &self.estimator, layout, &self.plan, |cube: &Cube| {
                let row = rows.next().expect("there is a row for each batch");
                row.extend(contrasts.iter().map(|c| c.value(cube) * context.estimate_factor()));
            })?;
        }
        let mut values = Batches::new();
        for row in rows {
            values.push(row);
        }
        Ok(judge(&targets, &values, &self.criterion).into())
    }
}

impl Sight {
    fn time(&self) -> TimeSpec {
        self.scene.film.time.expect("sights have a time axis")
    }

    fn contrasts(&self) -> (Vec<LinearContrast>, Vec<Target>) {
        let cells = self.time().bins + 2;
        let mean = 1.0 / (SIDE * SIDE) as f64;
        let contrast = |name: &str, inside: &dyn Fn(usize) -> bool| LinearContrast {
            name: format!("{name}, {}", self.name),
            pixels: (0..SIDE * SIDE).collect(),
            weights: (0..cells).map(|cell| if inside(cell) { mean } else { 0.0 }).collect(),
        };
        let judged = |instant: &Instant| {
            let cell = self.place(instant).floor() as usize + 1;
            (contrast(&instant.name, &|c| c == cell), instant.radiance)
        };
        let all = (contrast("all light", &|_| true), self.total);
        let (contrasts, radiances): (Vec<_>, Vec<_>) =
            self.instants.iter().map(judged).chain([all]).unzip();
        let target = |(contrast, radiance): (&LinearContrast, f64)| Target {
            name: contrast.name.clone(),
            expected: radiance,
            // Cells are stored with the rounding of f32.
            error: (self.error + 1e-7) * radiance,
        };
        let targets = contrasts.iter().zip(radiances).map(target).collect();
        (contrasts, targets)
    }

    /// Where in the window an instant is, in bins.
    pub(super) fn place(&self, instant: &Instant) -> f64 {
        let time = self.time();
        (instant.opl - time.start_opl) / time.bin_width_opl
    }
}

/// Scene parts seen by a narrow camera at `eye` that looks along `direction`.
pub(super) fn narrow(
    eye: DVec3,
    direction: DVec3,
    time: TimeSpec,
    integrator: IntegratorSpec,
) -> SceneParts {
    let mut parts = View { pixels: SIDE, fov: FOV, time: Some(time), integrator }.parts();
    let turn = DQuat::from_rotation_arc(DVec3::Z, direction.normalize());
    let to_world = DAffine3::from_rotation_translation(turn, eye);
    parts.sensor = Sensor::perspective(to_world, FOV, FovAxis::X, SIDE, SIDE);
    parts
}

/// A rectangle of two half edges; its normal is along u × v.
pub(super) fn rectangle(name: &str, centre: DVec3, u: DVec3, v: DVec3, bsdf: Bsdf) -> ShapePart {
    ShapePart {
        name: name.into(),
        primitives: vec![Primitive::Planar(Planar::new(centre, u, v, Outline::Parallelogram))],
        bsdf,
        boundary: None,
        radiance: None,
    }
}

/// A square across the z axis at `z`, 200 m wide, whose normal points along +z or −z.
pub(super) fn across(name: &str, z: f64, towards: f64, bsdf: Bsdf) -> ShapePart {
    let (u, v) = (100.0 * DVec3::X, 100.0 * towards * DVec3::Y);
    rectangle(name, z * DVec3::Z, u, v, bsdf)
}

/// The same in front of a lens or the like: between two media.
pub(super) fn between(mut shape: ShapePart, boundary: MediumBoundary) -> ShapePart {
    shape.boundary = Some(boundary);
    shape
}

/// A shape that emits, and reflects nothing.
pub(super) fn lamp(mut shape: ShapePart, radiance: f64) -> ShapePart {
    shape.bsdf = Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black };
    shape.radiance = Some(Rgb::splat(radiance));
    shape
}

/// Clear glass of this index, in air; its interior is opposite to the normal.
pub(super) fn glass(eta: f64) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        interior_eta: eta,
        exterior_eta: 1.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    })
}
