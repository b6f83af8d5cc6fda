//! Reflections in a sphere with a diffuse wall, one scattering order at a time.
//!
//! Point light and camera at the centre of a unit sphere with albedo ρ. Light that was reflected k
//! times arrives with the exact law of k − 1 chords (`tpb_reference::diffuse_sphere`), the same in
//! every pixel. Depth k + 1 isolates it. Order 1 is an instant, the others are spread over
//! 2 … 2k radii; the total has no variance at all, so that it is compared to rounding.

use std::sync::Arc;

use tpb_path::PathOptions;
use tpb_reference::diffuse_sphere::{Order, SphereCentreBin, sphere_centre_radiance_bins};
use tpb_scene::TimeSpec;

use crate::comparison::Comparison;
use crate::contrasts::standard;
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::{BatchPlan, Estimator};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, diffuse_sphere, only_depth};

const ALBEDO: f64 = 0.7;

/// No edge at 2, where the first order arrives.
const TIME: TimeSpec = TimeSpec { start_opl: 1.95, bin_width_opl: 0.1, bins: 90 };

/// One order, seen by the path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereOrder {
    /// Number of reflections.
    pub order: u32,
}

/// The first orders.
pub fn all(effort: Effort) -> Experiments {
    (1..=effort.pick(4, 8)).map(|order| Arc::new(SphereOrder { order }) as _).collect()
}

impl SphereOrder {
    fn expected(self, side: usize) -> Result<Cube> {
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

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        match (effort, self.order) {
            // Half a bin would put the instant of the first order on an edge.
            (Effort::Full, 1) => vec![Sabotage::Late(0.75)],
            (Effort::Full, _) | (Effort::Quick, 3) => vec![Sabotage::LATE],
            (Effort::Quick, _) => vec![],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let side = 16;
        let integrator = only_depth(self.order + 1);
        let scene = diffuse_sphere(
            context,
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
        Comparison {
            scene: &scene,
            estimator,
            plan,
            expected: &expected,
            coarser: None,
            contrasts: &contrasts,
            criterion: context.unbiased(),
            dropped: &[],
        }
        .run(context)
    }
}
