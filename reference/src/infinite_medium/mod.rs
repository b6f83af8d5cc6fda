//! The infinite homogeneous medium, all orders of scattering.

mod energy;
mod moments;
mod paasschens;

pub use energy::{Alive, AliveOfOrder, energy_alive, energy_of_order};
pub use moments::{
    Moment, mean_depth, mean_fourth_power_of_distance, mean_square_depth, mean_square_distance,
};
pub use paasschens::{Paasschens, VALIDITY_3D, paasschens_2d, paasschens_3d, paasschens_4d};

use crate::registry::Solution;
use crate::registry::ToleranceClass::ClosedForm;
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!(
        "infinite_medium_energy", ClosedForm,
        "alive" => energy_alive,
        "order" => energy_of_order
    )
    .describe("share of a pulse that is alive, in total or of one order of scattering", "1"),
    solution!(
        "infinite_medium_moments", ClosedForm,
        "r2" => mean_square_distance,
        "r4" => mean_fourth_power_of_distance,
        "z" => mean_depth,
        "z2" => mean_square_depth
    )
    .describe("moments of the distance (r) and, for a collimated start, of the depth (z)", "m^n"),
    solution!("paasschens_2d_4d", ClosedForm, "2D" => paasschens_2d, "4D" => paasschens_4d)
        .describe("density of scattered light of a point pulse in 2 and 4 dimensions", "1/mfp^d"),
    solution!("paasschens_3d", ClosedForm, "paasschens_closed" => paasschens_3d)
        .describe("density of scattered light of a point pulse in 3 dimensions", "1/mfp^3")
        .approximate(VALIDITY_3D),
];
