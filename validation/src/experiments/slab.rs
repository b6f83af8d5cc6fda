//! A slab of fog: reflectance and transmittance, all orders of scattering.
//!
//! **Path tracing against photons.** A pencil of light meets a slab at a right angle; what leaves
//! through either face is counted by a visitor of the photon tracer, by its OPL. The path tracer
//! answers the same by reciprocity: seen at a right angle, a slab in front of a wide lamp of
//! radiance 1 has the radiance of the share of light that would cross it, and with the lamp on the
//! camera's side, of the share that would come back. Lamps stand 0.1 mm from the slab, which
//! delays light by less than 1e-3 of a bin. Both are noisy, without bias, and share no estimator:
//! one connects to lights, the other lets photons fly.
//!
//! **Diffusion, loosely.** In a slab of 20 mean free paths, late light follows the diffusion of
//! Contini, Martelli and Zaccanti (1997), an approximation that was measured to hold within 1 % in
//! the windows that are judged here; 2 % are allowed for it, and all that is asked are 5 %.

use std::sync::Arc;

use glam::DVec3;
use tpb_optics::{Rgb, Stream};
use tpb_path::PathOptions;
use tpb_reference::diffusion::{
    DiffusionSlabTotal, diffusion_slab_total_reflectance, diffusion_slab_total_transmittance,
};
use tpb_reference::numerics::quadrature::adaptive;
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, IntegratorSpec, MediumBoundary, MediumId, Scene, SceneParts,
    TimeSpec,
};
use tpb_transport::{
    FreeFlight, Outcome as End, Photon, PhotonBatch, PhotonTracer, PhotonVisitor, Sampling,
};

use super::sights::{across, between, lamp};
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{Fog, View};
use crate::statistics::{Batches, Criterion, Target, judge};

/// Distance of camera, laser and lamps from the slab \[m\].
const GAP: f64 = 1e-4;
/// Batches of every comparison.
const BATCHES: u64 = 80;

/// A slab from z = [`GAP`] on, with a mean cosine and coefficients per metre.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slab {
    thickness: f64,
    fog: Fog,
    /// Deepest paths, beyond which less than 1e-6 of the light is left.
    max_depth: u32,
}

/// Thin enough for the path tracer.
const THIN: Slab =
    Slab { thickness: 2.0, fog: Fog { sigma_s: 0.9, sigma_a: 0.1, g: 0.5 }, max_depth: 130 };
/// Thick enough for diffusion.
const THICK: Slab =
    Slab { thickness: 20.0, fog: Fog { sigma_s: 1.0, sigma_a: 0.0, g: 0.0 }, max_depth: 400 };

/// A face of the slab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Where light enters.
    Front,
    /// Opposite.
    Back,
}

/// Light that leaves through `face` with an OPL within `window` \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leaving {
    face: Face,
    window: (f64, f64),
}

/// All comparisons.
pub fn all(effort: Effort) -> Experiments {
    match effort {
        Effort::Quick => vec![],
        Effort::Full => {
            vec![
                Arc::new(Reciprocity(Face::Back)),
                Arc::new(Reciprocity(Face::Front)),
                Arc::new(Late),
            ]
        }
    }
}

impl Slab {
    fn integrator(self) -> IntegratorSpec {
        let max_depth = Some(self.max_depth);
        IntegratorSpec { method: None, max_depth, min_depth: 1, rr_depth: u32::MAX }
    }

    fn parts(self, view: &View) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![self.fog.medium()];
        let boundary = MediumBoundary { interior: Some(MediumId(0)), exterior: None };
        parts.shapes = vec![
            between(across("front", GAP, -1.0, Bsdf::Null), boundary),
            between(across("back", GAP + self.thickness, 1.0, Bsdf::Null), boundary),
        ];
        parts
    }

    /// Lit by a pencil at a right angle.
    fn lit(self, context: &Context) -> Result<Scene> {
        let integrator = self.integrator();
        let mut parts = self.parts(&View { pixels: 1, fov: 1.0, time: None, integrator });
        let (position, axis) = (DVec3::ZERO, DVec3::Z);
        let kind = EmitterKind::Laser { position, axis, radius: 1e-3, power: Rgb::splat(1.0) };
        parts.emitters = vec![EmitterPart { name: "pencil".into(), kind, stated_medium: None }];
        context.assemble(parts)
    }

    /// Shares of the light that leave, batch by batch.
    fn shares(self, context: &Context, photons: u64, leaving: &[Leaving]) -> Result<Batches> {
        let scene = self.lit(context)?;
        let tracer = PhotonTracer {
            scene: &scene,
            integrator: self.integrator(),
            sampling: Sampling::default(),
        };
        let mut shares = Batches::new();
        for pass in 0..BATCHES {
            let batch = PhotonBatch { seed: context.seed, pass, count: photons };
            let visitor = |_| Counter { leaving, sums: vec![0.0; leaving.len()] };
            let (counters, _) = tracer.trace::<1, Counter<'_>>(batch, visitor);
            let of = |k: usize| counters.iter().map(|counter| counter.sums[k]).sum();
            shares.push((0..leaving.len()).map(of).collect());
        }
        Ok(shares)
    }
}

/// Counts the photons that leave.
struct Counter<'a> {
    leaving: &'a [Leaving],
    sums: Vec<f64>,
}

impl PhotonVisitor<1> for Counter<'_> {
    fn flight(
        &mut self,
        photon: &Photon<1>,
        free: &FreeFlight<'_, 1>,
        outcome: &End<'_, 1>,
        _: &mut Stream,
    ) {
        let flight = free.flight();
        let fog = flight.spans.iter().find(|span| span.region.medium.is_some());
        let (None, Some(fog)) = (outcome.collision(), fog) else { return };
        let face = if flight.direction.z > 0.0 { Face::Back } else { Face::Front };
        let opl = photon.opl + flight.opl(fog.end);
        let power = (photon.power * free.passing(f64::INFINITY).total())[0];
        for (sum, leaving) in self.sums.iter_mut().zip(self.leaving) {
            if leaving.face == face && (leaving.window.0..leaving.window.1).contains(&opl) {
                *sum += power;
            }
        }
    }
}

/// The path tracer's view of a slab in front of a lamp, against photons.
struct Reciprocity(Face);

const TIME: TimeSpec = TimeSpec { start_opl: 0.0, bin_width_opl: 0.5, bins: 16 };
const SIDE: usize = 8;

impl Reciprocity {
    /// All light, what comes early, what comes late.
    fn leaving(&self) -> [Leaving; 3] {
        let middle = if self.0 == Face::Back { 2.5 } else { 1.5 };
        let windows = [(0.0, f64::INFINITY), (0.0, middle), (middle, f64::INFINITY)];
        windows.map(|window| Leaving { face: self.0, window })
    }

    /// The lamp lies beyond the face, or behind the camera.
    fn scene(&self, context: &Context) -> Result<Scene> {
        let view = View { pixels: SIDE, fov: 0.1, time: Some(TIME), integrator: THIN.integrator() };
        let mut parts = THIN.parts(&view);
        let black = Bsdf::Null;
        let (z, towards) = match self.0 {
            Face::Back => (2.0 * GAP + THIN.thickness, -1.0),
            Face::Front => (-GAP, 1.0),
        };
        parts.shapes.push(lamp(across("lamp", z, towards, black), 1.0));
        context.assemble(parts)
    }

    fn value(cube: &Cube, leaving: &Leaving) -> f64 {
        let start = |cell: usize| (cell as f64 - 1.0) * TIME.bin_width_opl;
        let inside =
            |cell: usize| cell > 0 && (leaving.window.0..leaving.window.1).contains(&start(cell));
        let of_pixel = |pixel| {
            (0..cube.bins + 2).filter(|&c| inside(c)).map(|c| cube.pixel(pixel)[c]).sum::<f64>()
        };
        (0..cube.pixels()).map(of_pixel).sum::<f64>() / cube.pixels() as f64
    }
}

impl Experiment for Reciprocity {
    fn name(&self) -> String {
        format!("slab/path-{}", if self.0 == Face::Back { "transmittance" } else { "reflectance" })
    }

    fn description(&self) -> String {
        "a slab of 2 mean free paths: path tracing of a lamp against photons of a pencil".into()
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        vec![Sabotage::SigmaS(1.03), Sabotage::TRANSMITTANCE]
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let leaving = self.leaving();
        let sound = Context { sabotage: None, ..context.clone() };
        let photons = THIN.shares(&sound, 120_000, &leaving)?;
        let expected: Vec<f64> = (0..leaving.len()).map(|k| photons.summary(k).mean).collect();
        let scene = self.scene(context)?;
        let estimator = Estimator::Path(PathOptions { samples_per_pass: 500.try_into().ok() });
        let plan = BatchPlan { batches: BATCHES, passes: 1, seed: context.seed ^ 0x51ab };
        let mut seen = Vec::new();
        batches(&scene, &estimator, context.layout(&scene.film)?, &plan, |cube| {
            seen.push(leaving.iter().map(|l| Self::value(cube, l)).collect::<Vec<f64>>());
        })?;
        // Differences from the photons' batches, so that the noise of both is judged.
        let mut values = Batches::new();
        for (seen, counted) in seen.iter().zip(photons.rows()) {
            let value = |k: usize| seen[k] - counted[k] + expected[k];
            values.push((0..leaving.len()).map(value).collect());
        }
        let target = |(leaving, &expected): (&Leaving, &f64)| Target {
            name: format!("{leaving:?}"),
            expected,
            error: 5e-4 * expected,
        };
        let targets: Vec<Target> = leaving.iter().zip(&expected).map(target).collect();
        let criterion = Criterion { margin: 0.01, ..context.unbiased() };
        Ok(judge(&targets, &values, &criterion).into())
    }
}

/// Late light of a thick slab, against diffusion.
struct Late;

/// Allowed for diffusion itself.
const MODEL_ERROR: f64 = 0.02;

impl Late {
    const LEAVING: [Leaving; 4] = [
        Leaving { face: Face::Front, window: (8.0, 16.0) },
        Leaving { face: Face::Front, window: (16.0, 64.0) },
        Leaving { face: Face::Back, window: (64.0, 128.0) },
        Leaving { face: Face::Back, window: (128.0, 256.0) },
    ];

    fn expected(leaving: &Leaving) -> Result<f64> {
        let rate = |path: f64| {
            let input = DiffusionSlabTotal {
                time: path,
                mu_a: THICK.fog.sigma_a,
                mu_s_prime: THICK.fog.sigma_s,
                thickness: THICK.thickness,
                eta: 1.0,
                speed: 1.0,
            };
            let share = match leaving.face {
                Face::Front => diffusion_slab_total_reflectance(&input),
                Face::Back => diffusion_slab_total_transmittance(&input),
            };
            // An integrand without a value stops the quadrature with an error.
            share.unwrap_or(f64::NAN)
        };
        // Photons fly GAP before they meet the slab.
        let (start, end) = leaving.window;
        Ok(adaptive(rate, &[start - GAP, end - GAP], 1e-9)?.value)
    }
}

impl Experiment for Late {
    fn name(&self) -> String {
        "slab/photons-diffusion".into()
    }

    fn description(&self) -> String {
        "late light of a slab of 20 mean free paths against diffusion, within 5 %".into()
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        vec![Sabotage::SigmaS(1.1)]
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let mut targets = Vec::new();
        for leaving in &Self::LEAVING {
            let expected = Self::expected(leaving)?;
            let error = MODEL_ERROR * expected;
            targets.push(Target { name: format!("{leaving:?}"), expected, error });
        }
        let shares = THICK.shares(context, 30_000, &Self::LEAVING)?;
        let criterion = Criterion { margin: 0.05, ..context.unbiased() };
        Ok(judge(&targets, &shares, &criterion).into())
    }
}
