//! The infinite homogeneous medium, all orders of scattering.

mod angular_moments;
mod energy;
mod moments;
mod paasschens;
mod plane_pulse;
mod point_pulse;
mod radial_energy;
mod saddle;

pub use angular_moments::{SincMoment, infinite_medium_sinc_moment};
pub use energy::{Alive, AliveOfOrder, energy_alive, energy_of_order};
pub use moments::{
    Moment, mean_depth, mean_fourth_power_of_distance, mean_square_depth, mean_square_distance,
};
pub use paasschens::{Paasschens, VALIDITY_3D, paasschens_2d, paasschens_3d, paasschens_4d};
pub use plane_pulse::{
    PlanePulse, PlanePulseCell, PlanePulseOrder, plane_pulse_cells,
    plane_pulse_cells_with_ballistic, plane_pulse_fluence, plane_pulse_fluence_by_order,
};
pub use point_pulse::{
    PointPulse, PointPulseBin, PointPulseOrder, point_pulse_fluence, point_pulse_fluence_bins,
    point_pulse_fluence_by_order,
};
pub use radial_energy::{
    EnergyWithin, ShellEnergy, ShellEnergyOrder, scattered_energy_within_radius,
    scattered_shell_energy, scattered_shell_energy_by_order,
};

use crate::registry::Solution;
use crate::registry::ToleranceClass::{AllOrderBins, ClosedForm, Quadrature};
use crate::registry::solution;
use crate::sources::{FREE_PATHS, PATH_LENGTH};

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!(
        "infinite_medium_energy", ClosedForm,
        "alive" => energy_alive,
        "order" => energy_of_order
    )
    .describe("share of a pulse that is alive, in total or of one order of scattering", "1"),
    solution!("infinite_medium_sinc_moment", Quadrature, infinite_medium_sinc_moment)
        .describe("mean of sin(kr)/(kr) over the photons of a pulse, all orders, any g", "1")
        .inputs(PATH_LENGTH),
    solution!(
        "infinite_medium_moments", ClosedForm,
        "r2" => mean_square_distance,
        "r4" => mean_fourth_power_of_distance,
        "z" => mean_depth,
        "z2" => mean_square_depth
    )
    .describe("moments of the distance (r) and, for a collimated start, of the depth (z)", "m^n")
    .units(&["m^2", "m^4", "m", "m^2"])
    .inputs(PATH_LENGTH),
    solution!("point_pulse_fluence", Quadrature, point_pulse_fluence)
        .describe("fluence rate of the scattered light of a point pulse, all orders", "1/mfp^3")
        .inputs(FREE_PATHS),
    solution!("point_pulse_fluence_bins", AllOrderBins, point_pulse_fluence_bins)
        .describe("the same within a bin of time", "1/mfp^2")
        .inputs(FREE_PATHS),
    solution!("point_pulse_fluence_by_order", Quadrature, point_pulse_fluence_by_order)
        .describe("the same of one order of scattering, at albedo 1", "1/mfp^3")
        .inputs(FREE_PATHS),
    solution!("plane_pulse_fluence", Quadrature, "collided" => plane_pulse_fluence)
        .describe("fluence rate of the scattered light of a plane pulse, all orders", "1/mfp")
        .inputs(FREE_PATHS),
    solution!("plane_pulse_fluence_by_order", Quadrature, plane_pulse_fluence_by_order)
        .describe("the same of one order of scattering, at albedo 1", "1/mfp")
        .inputs(FREE_PATHS),
    solution!(
        "plane_pulse_cells", Quadrature,
        "collided" => plane_pulse_cells,
        "total" => plane_pulse_cells_with_ballistic
    )
    .describe("fluence rate of a plane pulse, mean over a cell", "1/mfp")
    .inputs(FREE_PATHS),
    solution!("scattered_energy_within_radius", Quadrature, scattered_energy_within_radius)
        .describe("share of a point pulse that is scattered light within a radius, any g", "1")
        .inputs(FREE_PATHS),
    solution!(
        "scattered_shell_energy", Quadrature,
        "all" => scattered_shell_energy,
        "order" => scattered_shell_energy_by_order
    )
    .describe("share of a point pulse that is scattered light in a shell, isotropic", "1")
    .inputs(FREE_PATHS),
    solution!("paasschens_2d_4d", ClosedForm, "2D" => paasschens_2d, "4D" => paasschens_4d)
        .describe("density of scattered light of a point pulse in 2 and 4 dimensions", "1/mfp^d")
        .units(&["1/mfp^2", "1/mfp^4"])
        .inputs(FREE_PATHS),
    solution!("paasschens_3d", ClosedForm, "paasschens_closed" => paasschens_3d)
        .describe("density of scattered light of a point pulse in 3 dimensions", "1/mfp^3")
        .inputs(FREE_PATHS)
        .approximate(VALIDITY_3D),
];
