//! Reflections in a sphere with a diffuse wall, one scattering order at a time.
//!
//! Point light and camera at the centre of a unit sphere with albedo ρ. Light that was reflected k
//! times arrives with the exact law of k − 1 chords (`tpb_reference::diffuse_sphere`), the same in
//! every pixel. Depth k + 1 isolates it. Order 1 is an instant, the others are spread over
//! 2 … 2k radii. *Filled* with a medium that absorbs, the sphere leaves e^(−σ_a·path) of it.
//!
//! For the path tracer the total of an empty sphere has no variance at all, so that it is compared
//! to rounding. Beams see orders from 2 on through their surface photons: on a sphere the area within
//! the disc is exact, and the delay that the disc costs is of second order, r²/8 per radius, which
//! with a disc of 0.04 radii is 2e-4 of a radius, 0.3 % of a bin. Light tracing has no blur.

use std::sync::Arc;

use tpb_beams::BeamOptions;
use tpb_light::LightOptions;
use tpb_optics::{Coefficients, Phase, Rgb};
use tpb_path::PathOptions;
use tpb_reference::diffuse_sphere::{
    AbsorbingCentreBin, Order, SphereCentreBin, sphere_centre_radiance_absorbing_bins,
    sphere_centre_radiance_bins,
};
use tpb_scene::{Medium, MediumId, TimeSpec};

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::experiments::screen::blocks;
use crate::measure::{BatchPlan, Estimator};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, diffuse_sphere_parts, only_depth};

const ALBEDO: f64 = 0.7;

/// Absorption of the filling \[1/m\].
const SIGMA_A: f64 = 0.35;

/// Radius of the disc that photons are gathered from \[m\].
const BLUR: f64 = 0.04;

/// No edge at 2, where the first order arrives.
const TIME: TimeSpec = TimeSpec { start_opl: 1.95, bin_width_opl: 0.1, bins: 90 };

/// Who looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Insider {
    /// The path tracer.
    Path,
    /// Photons on surfaces.
    Beams,
    /// Photons that are connected to the camera.
    Light,
}

impl Insider {
    /// Its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Beams => "beams",
            Self::Light => "light",
        }
    }

    /// With so many camera paths per pixel, or photons, in a pass.
    pub(super) fn estimator(self, samples: u32, photons: u64) -> Estimator {
        match self {
            Self::Path => {
                Estimator::Path(PathOptions { samples_per_pass: samples.try_into().ok() })
            }
            Self::Beams => Estimator::Beams(BeamOptions {
                photons_per_pass: Some(photons),
                surface_radius: Some(BLUR),
                surface_radius_exponent: Some(0.0),
                surface_samples: Some(16),
                ..BeamOptions::default()
            }),
            Self::Light => Estimator::Light(LightOptions { photons_per_pass: Some(photons) }),
        }
    }
}

/// One order, empty or filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SphereOrder {
    /// Who looks.
    pub who: Insider,
    /// Number of reflections.
    pub order: u32,
    /// Whether the sphere is filled with a medium that absorbs.
    pub filled: bool,
}

/// The first orders.
pub fn all(effort: Effort) -> Experiments {
    let one = |who, order, filled| Arc::new(SphereOrder { who, order, filled }) as _;
    let mut list: Experiments =
        (1..=effort.pick(4, 6)).map(|order| one(Insider::Path, order, false)).collect();
    if effort == Effort::Full {
        list.push(one(Insider::Path, 3, true));
        for who in [Insider::Beams, Insider::Light] {
            list.extend([one(who, 2, false), one(who, 3, true)]);
        }
    }
    list
}

impl SphereOrder {
    fn expected(self, side: usize) -> Result<Cube> {
        let edge = |i: usize| TIME.start_opl + i as f64 * TIME.bin_width_opl;
        let order = Order::Exactly(self.order);
        let bin = |i: usize| {
            let (t0, t1) = (edge(i), edge(i + 1));
            if !self.filled {
                let input = SphereCentreBin { albedo: ALBEDO, order, t0, t1 };
                return sphere_centre_radiance_bins(&input);
            }
            sphere_centre_radiance_absorbing_bins(&AbsorbingCentreBin {
                energy: 1.0,
                albedo: ALBEDO,
                radius: 1.0,
                sigma_a: SIGMA_A,
                speed: 1.0,
                order,
                t0,
                t1,
            })
        };
        let bins = (0..TIME.bins).map(bin).collect::<std::result::Result<Vec<_>, _>>()?;
        let mut cube = Cube::zero(side, side, TIME.bins);
        for pixel in 0..cube.pixels() {
            cube.pixel_mut(pixel)[1..=TIME.bins].copy_from_slice(&bins);
        }
        Ok(cube)
    }

    /// Pixels on a side, angle across the film, time shares, and passes in a batch.
    fn budget(self, effort: Effort) -> (usize, f64, usize, u64) {
        match self.who {
            Insider::Path if self.order == 1 => (16, 70.0, effort.pick(6, 12), 1),
            Insider::Path if self.filled => (16, 70.0, 6, 1),
            Insider::Path => (16, 70.0, effort.pick(6, 12), effort.pick(1, 2)),
            Insider::Beams | Insider::Light => (8, 80.0, 3, 2),
        }
    }
}

impl Experiment for SphereOrder {
    fn name(&self) -> String {
        let filled = if self.filled { "/filled" } else { "" };
        format!("sphere-order-{}/{}{filled}", self.order, self.who.name())
    }

    fn description(&self) -> String {
        let filled = if self.filled { " filled with an absorber" } else { "" };
        let order = self.order;
        format!("{order} diffuse reflections in a sphere{filled}, per bin, against the exact law")
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        match (effort, self.order, self.filled) {
            (Effort::Full, _, true) => vec![Sabotage::TRANSMITTANCE],
            (Effort::Quick, _, true) => vec![],
            // Half a bin would put the instant of the first order on an edge.
            (Effort::Full, 1, _) => vec![Sabotage::Late(0.75)],
            (Effort::Full, ..) | (Effort::Quick, 3, _) => vec![Sabotage::LATE],
            (Effort::Quick, ..) => vec![],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (side, fov, shares, passes) = self.budget(context.effort);
        let integrator = only_depth(self.order + 1);
        let view = View { pixels: side, fov, time: Some(TIME), integrator };
        let mut parts = diffuse_sphere_parts(&view, ALBEDO);
        if self.filled {
            parts.media = vec![absorber(SIGMA_A)];
            parts.background = Some(MediumId(0));
        }
        let scene = context.assemble(parts)?;
        let expected = self.expected(side)?;
        let (path, samples) = (self.who == Insider::Path, if self.order == 1 { 4 } else { 1200 });
        let groups = blocks((side, side), (2, if path { 2 } else { 1 }));
        let contrasts = standard(&expected, &groups, shares);
        Comparison {
            scene: &scene,
            estimator: self.who.estimator(samples, 200_000),
            plan: BatchPlan { batches: 64, passes, seed: context.seed },
            expected: &expected,
            coarser: None,
            contrasts: &contrasts,
            criterion: if path { context.unbiased() } else { context.blurred() },
            dropped: &[],
        }
        .run(context)
    }
}

/// A medium that only absorbs.
pub(super) fn absorber(sigma_a: f64) -> Medium {
    Medium {
        name: format!("absorber {sigma_a}"),
        coefficients: Coefficients { sigma_s: Rgb::ZERO, sigma_t: Rgb::splat(sigma_a) },
        phase: Phase::with_mean_cosine(0.0),
        eta: None,
    }
}
