//! Light scattered once in infinite fog, with the camera inside the fog.
//!
//! The point light is beside the camera at distance D, across its axis, so that beams and rays meet
//! under large angles: the variance of 1/sinψ stays small. A pixel's expectation is averaged over
//! its area on the image plane by a Gauss-Legendre product rule (a coarser rule tells its error),
//! over exact time bins:
//!
//! * `path` against the single scattering itself (`single_scatter_radiance_bins`);
//! * `beams` against their exact *expected blur* (`expected_blur_1d_bins`, `expected_blur_2d_bins`),
//!   whose difference from the true radiance, several percent with the radius chosen here, is part
//!   of the expectation. A beam estimate without blur would fail.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;
use tpb_beams::{BeamOptions, KernelChoice};
use tpb_path::PathOptions;
use tpb_reference::ReferenceError;
use tpb_reference::beams::expected_blur::{Blur1dBin, expected_blur_1d_bins};
use tpb_reference::beams::expected_blur_disc::{Blur2dBin, expected_blur_2d_bins};
use tpb_reference::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};
use tpb_scene::TimeSpec;

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::{BatchPlan, Estimator};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{Fog, View, infinite_fog, only_depth};

const TIME: TimeSpec = TimeSpec { start_opl: 0.1, bin_width_opl: 0.15, bins: 42 };
const LIGHT_DISTANCE: f64 = 0.6;
const SIDE: usize = 8;
const FOV: f64 = 50.0;
const RADIUS: f64 = 0.25;
const SIGMA_S: f64 = 0.4;
const SIGMA_A: f64 = 0.1;

/// Who estimates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// The path tracer.
    Path,
    /// Beams with the 1D kernel.
    Beams1d,
    /// Beams with the 2D kernel.
    Beams2d,
}

/// Single scattering seen by one estimator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleScatter {
    /// Who estimates.
    pub who: Who,
    /// Mean cosine of the phase function.
    pub g: f64,
}

/// Each estimator, with isotropic and with anisotropic scattering where the reference has it.
pub fn all(_: Effort) -> Experiments {
    let case = |who, g| Arc::new(SingleScatter { who, g }) as _;
    vec![
        case(Who::Path, 0.0),
        case(Who::Path, 0.6),
        case(Who::Beams1d, 0.0),
        case(Who::Beams1d, 0.6),
        case(Who::Beams2d, 0.0),
    ]
}

impl SingleScatter {
    /// The exact energy of a bin, for a ray at the angle `alpha` to the direction to the light.
    fn bin(&self, alpha: f64, t0: f64, t1: f64) -> std::result::Result<f64, ReferenceError> {
        let (energy, sigma_s, sigma_t, g, speed) = (1.0, SIGMA_S, SIGMA_S + SIGMA_A, self.g, 1.0);
        let (ray_offset, source_z) = (LIGHT_DISTANCE * alpha.sin(), LIGHT_DISTANCE * alpha.cos());
        let (source_distance, radius) = (LIGHT_DISTANCE, RADIUS);
        match self.who {
            Who::Path => single_scatter_radiance_bins(&SingleScatterBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                source_distance,
                alpha,
                t0,
                t1,
            }),
            Who::Beams1d => expected_blur_1d_bins(&Blur1dBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                ray_offset,
                source_z,
                radius,
                t0,
                t1,
            }),
            Who::Beams2d => expected_blur_2d_bins(&Blur2dBin {
                energy,
                sigma_s,
                sigma_t,
                speed,
                ray_offset,
                source_z,
                radius,
                t0,
                t1,
            }),
        }
    }

    /// The expectation of all pixels that are judged, by a rule of so many points.
    fn expected(&self, rule: &[(f64, f64)]) -> Result<Cube> {
        let mut cube = Cube::zero(SIDE, SIDE, TIME.bins);
        let bins: Vec<Vec<f64>> = (0..cube.pixels())
            .into_par_iter()
            .map(|pixel| self.pixel(pixel, rule))
            .collect::<std::result::Result<_, _>>()?;
        for (pixel, bins) in bins.iter().enumerate() {
            cube.pixel_mut(pixel)[1..=TIME.bins].copy_from_slice(bins);
        }
        Ok(cube)
    }

    fn pixel(
        &self,
        pixel: usize,
        rule: &[(f64, f64)],
    ) -> std::result::Result<Vec<f64>, ReferenceError> {
        let mut bins = vec![0.0; TIME.bins];
        let width = 2.0 * (0.5 * FOV.to_radians()).tan() / SIDE as f64;
        let from_centre =
            |index: usize, offset: f64| width * (index as f64 + offset - 0.5 * SIDE as f64);
        for (x, wx) in rule {
            for (y, wy) in rule {
                // The light is on the camera's +x, which is on the left of the image.
                let left = -from_centre(pixel % SIDE, *x);
                let down = from_centre(pixel / SIDE, *y);
                let alpha = (1.0 + down * down).sqrt().atan2(left);
                for (index, bin) in bins.iter_mut().enumerate() {
                    let edge = |i: usize| TIME.start_opl + i as f64 * TIME.bin_width_opl;
                    *bin += wx * wy * self.bin(alpha, edge(index), edge(index + 1))?;
                }
            }
        }
        Ok(bins)
    }

    fn estimator(&self) -> Estimator {
        let beams = |kernel| {
            Estimator::Beams(BeamOptions {
                kernel: Some(kernel),
                radius: Some(RADIUS),
                radius_exponent: Some(0.0),
                beam_photons: Some(40_000),
                gather_samples: Some(1),
                ..BeamOptions::default()
            })
        };
        match self.who {
            Who::Path => Estimator::Path(PathOptions { samples_per_pass: 2500.try_into().ok() }),
            Who::Beams1d => beams(KernelChoice::OneD),
            Who::Beams2d => beams(KernelChoice::TwoD),
        }
    }
}

impl Experiment for SingleScatter {
    fn name(&self) -> String {
        let who = match self.who {
            Who::Path => "path",
            Who::Beams1d => "beams-1d",
            Who::Beams2d => "beams-2d",
        };
        let phase = if self.g == 0.0 { String::new() } else { format!("/hg{}", self.g) };
        format!("single-scatter/{who}{phase}")
    }

    fn description(&self) -> String {
        let target = if self.who == Who::Path { "single scattering" } else { "expected blur" };
        format!("camera inside infinite fog, g = {}, per bin, against the exact {target}", self.g)
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        match (effort, self.who, self.g) {
            (Effort::Quick, Who::Path, 0.0) => vec![Sabotage::SIGMA_S],
            (Effort::Quick, Who::Beams1d, 0.0) => vec![Sabotage::KERNEL],
            (Effort::Quick, ..) => vec![],
            (Effort::Full, Who::Path, 0.0) => {
                vec![Sabotage::SIGMA_S, Sabotage::TRANSMITTANCE, Sabotage::PhaseNormalisation]
            }
            (Effort::Full, Who::Path, _) => vec![Sabotage::SIGMA_S],
            (Effort::Full, ..) => vec![Sabotage::KERNEL],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let view = View { pixels: SIDE, fov: FOV, time: Some(TIME), integrator: only_depth(2) };
        let fog = Fog { sigma_s: SIGMA_S, sigma_a: SIGMA_A, g: self.g };
        let scene = infinite_fog(context, &view, &fog, LIGHT_DISTANCE * DVec3::X)?;
        let (expected, coarser) = (self.expected(&GAUSS_4)?, self.expected(&GAUSS_3)?);
        let contrasts = standard(&expected, &strips(), context.effort.pick(5, 10));
        let passes = context.effort.pick(1, 4) * if self.who == Who::Path { 2 } else { 8 };
        let plan = BatchPlan { batches: 64, passes, seed: context.seed };
        let criterion = if self.who == Who::Path { context.unbiased() } else { context.blurred() };
        Comparison {
            scene: &scene,
            estimator: self.estimator(),
            plan,
            expected: &expected,
            coarser: Some(&coarser),
            contrasts: &contrasts,
            criterion,
            dropped: &[],
        }
        .run(context)
    }
}

/// Columns of pixels, from those that look towards the light to those that look away.
fn strips() -> Vec<(String, Vec<usize>)> {
    (0..4)
        .map(|strip| {
            let inside = |pixel: &usize| pixel % SIDE / (SIDE / 4) == strip;
            (format!("strip {strip} of the image"), (0..SIDE * SIDE).filter(inside).collect())
        })
        .collect()
}

/// Gauss-Legendre nodes and weights on (0, 1).
const GAUSS_3: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];
const GAUSS_4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rules_integrate_polynomials_of_their_degree() {
        let moment =
            |rule: &[(f64, f64)], n: i32| rule.iter().map(|(x, w)| w * x.powi(n)).sum::<f64>();
        for n in 0..6 {
            assert!((moment(&GAUSS_3, n) * f64::from(n + 1) - 1.0).abs() < 1e-14);
            assert!((moment(&GAUSS_4, n + 2) * f64::from(n + 3) - 1.0).abs() < 1e-14);
        }
    }

    /// The image's left looks towards the light, so the mean angle there is below 90 degrees and
    /// more light arrives early.
    #[test]
    fn the_left_of_the_image_is_brighter() {
        let expected = SingleScatter { who: Who::Path, g: 0.0 }.expected(&GAUSS_3).unwrap();
        let energy = |pixel: usize| expected.pixel_bins(pixel).iter().sum::<f64>();
        assert!(energy(3 * SIDE) > energy(3 * SIDE + SIDE - 1));
        assert!((energy(3 * SIDE) / energy(4 * SIDE) - 1.0).abs() < 1e-12, "up and down alike");
    }
}
