//! Reflections in a sphere with a diffuse wall, one scattering order at a time.
//!
//! Point light and camera at the centre of a unit sphere with albedo ρ. Light that was reflected k
//! times arrives with the exact law of k − 1 chords (`tpb_reference::diffuse_sphere`), the same in
//! every pixel. Depth k + 1 isolates it. Order 1 is an instant, the others are spread over
//! 2 … 2k radii; the total has no variance at all, so that it is compared to rounding.

use tpb_path::PathOptions;
use tpb_reference::diffuse_sphere::{Order, SphereCentreBin, sphere_centre_radiance_bins};
use tpb_scene::TimeSpec;

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Experiment, Outcome, Sabotage};
use crate::measure::{BatchPlan, Estimator, layout};
use crate::scenes::{View, diffuse_sphere, only_depth};
use crate::statistics::Criterion;

const ALBEDO: f64 = 0.7;

/// No edge at 2, where the first order arrives.
const TIME: TimeSpec = TimeSpec { start_opl: 1.95, bin_width_opl: 0.1, bins: 90 };

/// One order, seen by the path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereOrder {
    /// Number of reflections.
    pub order: u32,
    /// A deliberate defect.
    pub sabotage: Option<Sabotage>,
}

impl SphereOrder {
    /// The sound experiment.
    pub fn new(order: u32) -> Self {
        Self { order, sabotage: None }
    }

    fn expected(&self, side: usize) -> Result<Cube> {
        let bin = |i: usize| {
            let edge = |i: usize| TIME.start_opl + i as f64 * TIME.bin_width_opl;
            let order = Order::Exactly(self.order);
            let input = SphereCentreBin { albedo: ALBEDO, order, t0: edge(i), t1: edge(i + 1) };
            sphere_centre_radiance_bins(&input)
        };
        let bins = (0..TIME.bins).map(bin).collect::<std::result::Result<Vec<_>, _>>()?;
        let mut cube = Cube::zero(side, side, TIME.bins);
        for pixel in 0..cube.pixels() {
            cube.pixel_mut(pixel)[1..=TIME.bins].copy_from_slice(&bins);
        }
        Ok(cube)
    }
}

impl Experiment for SphereOrder {
    fn name(&self) -> String {
        format!("sphere-order-{}/path", self.order)
    }

    fn description(&self) -> String {
        format!("{} diffuse reflections in a sphere, per bin, against the exact law", self.order)
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let side = 16;
        let integrator = only_depth(self.order + 1);
        let scene = diffuse_sphere(
            &View { pixels: side, fov: 70.0, time: Some(TIME), integrator },
            ALBEDO,
        )?;
        let expected = self.expected(side)?;
        let quadrant = |pixel: usize| (pixel % side) / (side / 2) + 2 * (pixel / side / (side / 2));
        let groups: Vec<(String, Vec<usize>)> = (0..4)
            .map(|q| {
                let pixels = (0..side * side).filter(|&p| quadrant(p) == q).collect();
                (format!("quadrant {q}"), pixels)
            })
            .collect();
        let contrasts = standard(&expected, &groups, context.effort.pick(6, 12));
        let samples = if self.order == 1 { 4 } else { 1200 };
        let estimator = Estimator::Path(PathOptions { samples_per_pass: samples.try_into().ok() });
        let plan = BatchPlan {
            batches: 64,
            passes: if self.order == 1 { 1 } else { context.effort.pick(1, 4) },
            seed: context.seed,
        };
        let shift = Sabotage::shift_bins(self.sabotage) * TIME.bin_width_opl;
        Comparison {
            scene: &scene,
            estimator,
            layout: layout(&scene.film, shift)?,
            plan,
            factor: 1.0,
            expected: &expected,
            coarser: None,
            contrasts: &contrasts,
            criterion: Criterion::UNBIASED,
        }
        .run()
    }
}
