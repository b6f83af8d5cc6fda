//! Light scattered once in an infinite homogeneous medium.

mod radiance;

pub(crate) use radiance::check_medium;
pub use radiance::{
    OnceScattered, SingleScatter, SingleScatterBin, once_scattered_fluence,
    single_scatter_radiance, single_scatter_radiance_bins,
};

use crate::registry::Solution;
use crate::registry::ToleranceClass::{ClosedForm, Quadrature};
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("single_scatter_radiance", ClosedForm, single_scatter_radiance)
        .describe("radiance of once-scattered light of a point pulse", "W/(m^2 sr)"),
    solution!("single_scatter_radiance_bins", Quadrature, single_scatter_radiance_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
    solution!("once_scattered_fluence", ClosedForm, once_scattered_fluence)
        .describe("fluence rate of light scattered once and isotropically", "W/m^2"),
];
