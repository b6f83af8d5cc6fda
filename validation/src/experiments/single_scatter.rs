//! Light scattered once in infinite fog, with the camera inside the fog.
//!
//! The point light is on the optical axis at distance D, so that a pixel's expectation depends only
//! on its distance from the centre; it is averaged over the pixel's area on the image plane
//! by a Gauss-Legendre product rule (a coarser rule tells its error), over exact time bins:
//!
//! * `path` against the single scattering itself (`single_scatter_radiance_bins`);
//! * `beams` against their exact *expected blur* (`expected_blur_1d_bins`, `expected_blur_2d_bins`),
//!   whose difference from the true radiance, several percent with the radius chosen here, is part
//!   of the expectation. A beam estimate that were unbiased would fail.
//!
//! Pixels whose rays pass closer to the light than the blur's radius are left out.

use rayon::prelude::*;
use tpb_beams::{BeamOptions, KernelChoice};
use tpb_path::PathOptions;
use tpb_reference::ReferenceError;
use tpb_reference::expected_blur::{Blur1dBin, expected_blur_1d_bins};
use tpb_reference::expected_blur_disc::{Blur2dBin, expected_blur_2d_bins};
use tpb_reference::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};
use tpb_scene::TimeSpec;

use crate::contrasts::{standard, targets};
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Experiment, Outcome, Sabotage};
use crate::measure::{BatchPlan, Estimator, batches, layout};
use crate::scenes::{Fog, View, infinite_fog, only_depth};
use crate::statistics::{Batches, Criterion, judge};

const TIME: TimeSpec = TimeSpec { start_opl: 1.6, bin_width_opl: 0.2, bins: 42 };
const LIGHT_DISTANCE: f64 = 2.0;
const SIDE: usize = 16;
const FOV: f64 = 60.0;
const RADIUS: f64 = 0.2;
/// Rays that pass closer to the light are left out \[m\].
const NEAREST: f64 = 1.2 * RADIUS;
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
    /// A deliberate defect.
    pub sabotage: Option<Sabotage>,
}

impl SingleScatter {
    /// The sound experiment.
    pub fn new(who: Who, g: f64) -> Self {
        Self { who, g, sabotage: None }
    }

    /// With a defect.
    #[must_use]
    pub fn with(mut self, sabotage: Sabotage) -> Self {
        self.sabotage = Some(sabotage);
        self
    }

    /// The exact energy of a bin, for a ray at the angle with tangent `tangent` to the axis.
    fn bin(&self, tangent: f64, t0: f64, t1: f64) -> std::result::Result<f64, ReferenceError> {
        let (energy, sigma_s, sigma_t, g, speed) = (1.0, SIGMA_S, SIGMA_S + SIGMA_A, self.g, 1.0);
        let alpha = tangent.atan();
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
        let half = SIDE / 2;
        // One octant of the film: distances from the centre in pixels, the larger one first.
        let octant: Vec<(usize, usize)> =
            (0..half).flat_map(|i| (0..=i).map(move |j| (i, j))).collect();
        let bins: Vec<Vec<f64>> = octant
            .par_iter()
            .map(|&(i, j)| self.pixel(i, j, rule))
            .collect::<std::result::Result<_, _>>()?;
        let mut cube = Cube::zero(SIDE, SIDE, TIME.bins);
        for pixel in 0..cube.pixels() {
            let (i, j) = from_centre(pixel);
            let index = octant.iter().position(|&p| p == (i.max(j), i.min(j))).unwrap_or(0);
            cube.pixel_mut(pixel)[1..=TIME.bins].copy_from_slice(&bins[index]);
        }
        Ok(cube)
    }

    fn pixel(
        &self,
        i: usize,
        j: usize,
        rule: &[(f64, f64)],
    ) -> std::result::Result<Vec<f64>, ReferenceError> {
        let mut bins = vec![0.0; TIME.bins];
        if ray_offset(i, j) < NEAREST {
            return Ok(bins);
        }
        for (x, wx) in rule {
            for (y, wy) in rule {
                let tangent = pixel_width() * (i as f64 + x).hypot(j as f64 + y);
                for (index, bin) in bins.iter_mut().enumerate() {
                    let edge = |i: usize| TIME.start_opl + i as f64 * TIME.bin_width_opl;
                    *bin += wx * wy * self.bin(tangent, edge(index), edge(index + 1))?;
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
                photons_per_pass: Some(20_000),
                gather_samples: Some(1),
                ..BeamOptions::default()
            })
        };
        match self.who {
            Who::Path => Estimator::Path(PathOptions { samples_per_pass: 400.try_into().ok() }),
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

    fn run(&self, context: &Context) -> Result<Outcome> {
        let view = View { pixels: SIDE, fov: FOV, time: Some(TIME), integrator: only_depth(2) };
        let sigma_s = SIGMA_S * Sabotage::sigma_s_factor(self.sabotage);
        let scene =
            infinite_fog(&view, &Fog { sigma_s, sigma_a: SIGMA_A, g: self.g }, LIGHT_DISTANCE)?;
        let (expected, coarser) = (self.expected(&GAUSS_4)?, self.expected(&GAUSS_3)?);
        let contrasts = standard(&expected, &rings(), context.effort.pick(5, 10));
        let passes = context.effort.pick(1, 4) * if self.who == Who::Path { 2 } else { 4 };
        let plan = BatchPlan { batches: 64, passes, seed: context.seed };
        let shift = Sabotage::shift_bins(self.sabotage) * TIME.bin_width_opl;
        let factor = Sabotage::estimate_factor(self.sabotage);
        let mut values = Batches::new();
        batches(&scene, &self.estimator(), layout(&scene.film, shift)?, &plan, |cube| {
            values.push(contrasts.iter().map(|c| factor * c.value(cube)).collect());
        })?;
        let criterion =
            if self.who == Who::Path { Criterion::UNBIASED } else { Criterion::BLURRED };
        let targets = targets(&contrasts, &expected, Some(&coarser));
        Ok(judge(&targets, &values, &criterion).into())
    }
}

/// Width of a pixel on the image plane at distance 1.
fn pixel_width() -> f64 {
    2.0 * (0.5 * FOV.to_radians()).tan() / SIDE as f64
}

/// Columns and rows between a pixel and the film's centre.
fn from_centre(pixel: usize) -> (usize, usize) {
    let fold = |index: usize| {
        let half = SIDE / 2;
        if index >= half { index - half } else { half - 1 - index }
    };
    (fold(pixel % SIDE), fold(pixel / SIDE))
}

/// How close to the light the nearest ray of a pixel passes \[m\].
fn ray_offset(i: usize, j: usize) -> f64 {
    let tangent = pixel_width() * (i as f64).hypot(j as f64);
    LIGHT_DISTANCE * tangent.atan().sin()
}

/// Three rings of pixels around the light, farther from it than the blur's radius.
fn rings() -> Vec<(String, Vec<usize>)> {
    let offset = |pixel: usize| {
        let (i, j) = from_centre(pixel);
        ray_offset(i, j)
    };
    let limits = [NEAREST, 0.55, 0.8, f64::INFINITY];
    limits
        .windows(2)
        .map(|ends| {
            let inside = |&pixel: &usize| (ends[0]..ends[1]).contains(&offset(pixel));
            let pixels = (0..SIDE * SIDE).filter(inside).collect();
            (format!("rays that pass at {:.2}..{:.2} m", ends[0], ends[1]), pixels)
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

    #[test]
    fn rings_are_apart_and_symmetric() {
        let rings = rings();
        let mut all: Vec<usize> = rings.iter().flat_map(|(_, pixels)| pixels.clone()).collect();
        assert!(rings.iter().all(|(_, pixels)| pixels.len() % 4 == 0 && pixels.len() >= 16));
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
    }
}
