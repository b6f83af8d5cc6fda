//! Time inside glass.
//!
//! * [`GlassFog`]: camera and lamp in infinite fog of index η. Light scattered once has the exact
//!   law of fog without an index at the speed c/η (`tpb_reference::single_scattering`; for beams,
//!   their expected blur). A null sphere around the lamp, with the same fog on both sides, changes
//!   nothing: its part of the OPL must not be lost.
//! * [`GlassClock`]: all orders, in fog over a diffuse floor. η changes no probability, only the
//!   clock: with η = 2 and twice as wide bins, the same random numbers must give the same film, to
//!   the bit.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;
use tpb_beams::{BeamOptions, KernelChoice};
use tpb_optics::Rgb;
use tpb_path::PathOptions;
use tpb_reference::beams::expected_blur::{Blur1dBin, expected_blur_1d_bins};
use tpb_reference::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};
use tpb_scene::geometry::Sphere;
use tpb_scene::{
    Bsdf, IntegratorSpec, MediumBoundary, MediumId, Primitive, Reflector, Scene, ShapePart,
    TimeSpec,
};

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::experiments::screen::blocks;
use crate::experiments::sights::across;
use crate::measure::{BatchPlan, Estimator, batches};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{Fog, View, only_depth, unit_point};

const ETA: f64 = 1.5;
const FOG: Fog = Fog { sigma_s: 0.4, sigma_a: 0.1, g: 0.4 };
const SIDE: usize = 6;
const FOV: f64 = 50.0;
const LAMP: f64 = 0.6;
const NULL_RADIUS: f64 = 0.25;
const RADIUS: f64 = 0.25;
/// Rays of the expectation along a pixel's edge.
const GRID: usize = 16;
const TIME: TimeSpec = TimeSpec { start_opl: 0.15, bin_width_opl: 0.225, bins: 40 };

/// Who looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diver {
    /// The path tracer.
    Path,
    /// Beams with the 1D kernel.
    Beams,
}

impl Diver {
    fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Beams => "beams",
        }
    }

    fn estimator(self) -> Estimator {
        match self {
            Self::Path => Estimator::Path(PathOptions { samples_per_pass: 2500.try_into().ok() }),
            Self::Beams => Estimator::Beams(BeamOptions {
                kernel: Some(KernelChoice::OneD),
                radius: Some(RADIUS),
                radius_exponent: Some(0.0),
                beam_photons: Some(40_000),
                gather_samples: Some(1),
                ..BeamOptions::default()
            }),
        }
    }
}

/// Single scattering inside glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlassFog {
    /// Who looks.
    pub who: Diver,
}

/// Each method.
pub fn all(effort: Effort) -> Experiments {
    let mut list: Experiments = vec![
        Arc::new(GlassFog { who: Diver::Path }),
        Arc::new(GlassClock { who: Diver::Path }),
        Arc::new(GlassClock { who: Diver::Beams }),
    ];
    if effort == Effort::Full {
        list.push(Arc::new(GlassFog { who: Diver::Beams }));
    }
    list
}

impl GlassFog {
    fn scene(context: &Context) -> Result<Scene> {
        let view = View { pixels: SIDE, fov: FOV, time: Some(TIME), integrator: only_depth(2) };
        let mut parts = view.parts();
        let mut fog = FOG.medium();
        fog.eta = Some(ETA);
        parts.media = vec![fog];
        parts.background = Some(MediumId(0));
        parts.emitters = vec![unit_point(LAMP * DVec3::X)];
        let both = Some(MediumId(0));
        let ball = Sphere { centre: LAMP * DVec3::X, radius: NULL_RADIUS, flipped: false };
        parts.shapes = vec![ShapePart {
            name: "nothing".into(),
            primitives: vec![Primitive::Sphere(ball)],
            bsdf: Bsdf::Null,
            boundary: Some(MediumBoundary { interior: both, exterior: both }),
            radiance: None,
        }];
        context.assemble(parts)
    }

    /// The exact energy of a bin, for a ray at the angle `alpha` to the direction to the lamp.
    fn bin(self, alpha: f64, t0: f64, t1: f64) -> Result<f64> {
        let Fog { sigma_s, g, .. } = FOG;
        let (energy, sigma_t, speed) = (1.0, FOG.sigma_t(), 1.0 / ETA);
        let value = match self.who {
            Diver::Path => single_scatter_radiance_bins(&SingleScatterBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                source_distance: LAMP,
                alpha,
                t0,
                t1,
            }),
            Diver::Beams => expected_blur_1d_bins(&Blur1dBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                ray_offset: LAMP * alpha.sin(),
                source_z: LAMP * alpha.cos(),
                radius: RADIUS,
                t0,
                t1,
            }),
        };
        Ok(value?)
    }

    /// The mean over pixels by the midpoint rule: what `grid` rays along an edge miss is a third of what they
    /// differ by from half as many.
    fn expected(self, scene: &Scene, grid: usize) -> Result<Cube> {
        let mut cube = Cube::zero(SIDE, SIDE, TIME.bins);
        let pixel = |pixel: usize| -> Result<Vec<f64>> {
            let mut bins = vec![0.0; TIME.bins];
            let (column, row) = ((pixel % SIDE) as f64, (pixel / SIDE) as f64);
            let middle = |step: usize| (step as f64 + 0.5) / grid as f64;
            for index in 0..grid * grid {
                let (x, y) = (column + middle(index % grid), row + middle(index / grid));
                let alpha = scene.sensor.direction(x, y).x.acos();
                for (index, bin) in bins.iter_mut().enumerate() {
                    let edge = |i: usize| TIME.start_opl + i as f64 * TIME.bin_width_opl;
                    *bin += self.bin(alpha, edge(index), edge(index + 1))? / (grid * grid) as f64;
                }
            }
            Ok(bins)
        };
        let rows: Vec<Vec<f64>> =
            (0..SIDE * SIDE).into_par_iter().map(pixel).collect::<Result<_>>()?;
        for (pixel, bins) in rows.iter().enumerate() {
            cube.pixel_mut(pixel)[1..=TIME.bins].copy_from_slice(bins);
        }
        Ok(cube)
    }
}

impl Experiment for GlassFog {
    fn name(&self) -> String {
        format!("glass/single-scatter/{}", self.who.name())
    }

    fn description(&self) -> String {
        "fog of index 1.5 with a null sphere around the lamp, per bin, at the speed c/1.5".into()
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        let segment = Sabotage::NullSegment(ETA * NULL_RADIUS);
        match (self.who, effort) {
            (Diver::Path, Effort::Full) => vec![segment, Sabotage::LATE],
            (_, Effort::Full) => vec![segment],
            (_, Effort::Quick) => vec![],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let scene = Self::scene(context)?;
        let (expected, coarser) = (self.expected(&scene, GRID)?, self.expected(&scene, GRID / 2)?);
        let path = self.who == Diver::Path;
        let shares = 3;
        let contrasts = standard(&expected, &blocks((SIDE, SIDE), (2, 1)), shares);
        let passes = if path { 2 } else { 10 };
        Comparison {
            scene: &scene,
            estimator: self.who.estimator(),
            plan: BatchPlan { batches: 80, passes, seed: context.seed },
            expected: &expected,
            coarser: Some(&coarser),
            contrasts: &contrasts,
            // The matrix has single scattering to 0.5 %; the question here is the clock.
            criterion: context.blurred(),
            dropped: &[],
        }
        .run(context)
    }
}

/// The same film from twice the index and twice the bins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlassClock {
    /// Who looks.
    pub who: Diver,
}

impl GlassClock {
    /// A film of fog with this index over a floor; time is counted in multiples of it.
    fn film(self, context: &Context, eta: f64) -> Result<Cube> {
        let time = TimeSpec { start_opl: 0.2 * eta, bin_width_opl: 0.15 * eta, bins: 40 };
        let integrator =
            IntegratorSpec { method: None, max_depth: Some(6), min_depth: 1, rr_depth: 3 };
        let mut parts = View { pixels: 8, fov: 60.0, time: Some(time), integrator }.parts();
        let mut fog = FOG.medium();
        fog.eta = Some(eta);
        parts.media = vec![fog];
        parts.background = Some(MediumId(0));
        let front = Reflector::Diffuse(Rgb::splat(0.6));
        let floor = Bsdf::Opaque { front, back: Reflector::Black };
        parts.shapes = vec![across("floor", 2.0, -1.0, floor)];
        parts.emitters = vec![unit_point(DVec3::new(0.4, 0.3, 0.9))];
        let scene = context.assemble(parts)?;
        let plan = BatchPlan { batches: 1, passes: 1, seed: context.seed };
        let mut film = Cube::zero(0, 0, 0);
        let layout = context.layout(&scene.film)?;
        let estimator = match self.who {
            Diver::Path => Estimator::Path(PathOptions { samples_per_pass: 400.try_into().ok() }),
            Diver::Beams => Estimator::Beams(BeamOptions {
                photons_per_pass: Some(20_000),
                beam_photons: Some(5_000),
                ..BeamOptions::default()
            }),
        };
        batches(&scene, &estimator, layout, &plan, |cube| film = cube.clone())?;
        Ok(film)
    }
}

impl Experiment for GlassClock {
    fn name(&self) -> String {
        format!("glass/clock/{}", self.who.name())
    }

    fn description(&self) -> String {
        "with index 2 and twice as wide bins, the same film to the bit, all orders".into()
    }

    fn kind(&self) -> Kind {
        Kind::Exact
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        vec![Sabotage::NullSegment(0.01)]
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let sound = Context { sabotage: None, ..context.clone() };
        let (plain, slow) = (self.film(&sound, 1.0)?, self.film(context, 2.0)?);
        let cells = plain.values.len();
        let same = plain.values.iter().zip(&slow.values).filter(|(a, b)| a == b).count();
        let lit = plain.values.iter().filter(|value| **value > 0.0).count();
        let note = format!("{same} of {cells} cells are equal, {lit} of them hold light");
        Ok(Outcome::exact(same == cells && 2 * lit > cells, vec![note]))
    }
}
