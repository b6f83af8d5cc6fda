//! Refraction and mirrors: where and when light arrives, and how much of it.

mod ball_lens;
pub(crate) mod fresnel;
mod parallel_mirrors;
mod point_through_slab;
mod slab_echoes;

pub use ball_lens::{BallLens, ball_lens_landing, ball_lens_time};
pub use parallel_mirrors::{ParallelMirrors, parallel_mirrors_time, parallel_mirrors_weight};
pub use point_through_slab::{
    PointThroughSlab, point_through_slab_irradiance, point_through_slab_sine,
    point_through_slab_time,
};
pub use slab_echoes::{
    SlabEcho, slab_echo_time, slab_echo_weight_sp, slab_echo_weight_unpolarised,
};

use crate::registry::Solution;
use crate::registry::ToleranceClass::ClosedForm;
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("slab_echoes", ClosedForm, "time" => slab_echo_time,
        "weight_sp" => slab_echo_weight_sp, "weight_unpol" => slab_echo_weight_unpolarised)
    .describe("echo of a plane pulse through a slab: time inside, transmitted fraction", "1")
    .units(&["s", "1", "1"])
    .defaults(&[("thickness", "1"), ("speed", "1")]),
    solution!("point_through_slab", ClosedForm, "irradiance" => point_through_slab_irradiance,
        "sin1" => point_through_slab_sine, "time" => point_through_slab_time)
    .describe("direct pulse of a point light behind a slab: irradiance, sine, arrival", "1")
    .units(&["J/m^2", "1", "s"])
    .defaults(&[("energy", "1"), ("speed", "1")]),
    solution!("ball_lens", ClosedForm, "time" => ball_lens_time, "y_out" => ball_lens_landing)
        .describe("ray through a ball lens, from plane to plane: time, height of landing", "m")
        .units(&["s", "m"])
        .defaults(&[("radius", "1"), ("distance", "4"), ("speed", "1")]),
    solution!("parallel_mirrors", ClosedForm,
        "time" => parallel_mirrors_time, "weight" => parallel_mirrors_weight)
    .describe("image of a point pulse between two mirrors: arrival, fluence per energy", "1")
    .units(&["s", "1/m^2"])
    .defaults(&[
        ("bounces_first", "null"),
        ("bounces_second", "null"),
        ("first_reflectance", "0.9"),
        ("second_reflectance", "0.8"),
        ("speed", "1"),
    ]),
];
