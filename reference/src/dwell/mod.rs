//! Scattering events that take time of their own.
//!
//! Each scattering holds the light for an exponential time of mean τ, in which it covers no path:
//! absorption and extinction act on the path length alone, never on the time.

mod flight;
mod radiance;
mod sphere;
mod spread;

pub use flight::{DwellFlight, DwellOrder, dwell_flight_fraction, dwell_order_in_flight};
pub use radiance::{DwellSingleScatter, dwell_single_scatter_radiance};
pub use sphere::{DwellSphere, dwell_sphere_cdf};
pub use spread::{DwellSpread, dwell_mean_square_distance};

use crate::registry::Solution;
use crate::registry::ToleranceClass::{ClosedForm, Quadrature};
use crate::registry::solution;
use crate::sources::DIAMETERS;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!(
        "dwell_flight_fraction",
        ClosedForm,
        dwell_flight_fraction,
        "n-th order in flight" => dwell_order_in_flight
    )
    .describe("share of the energy in flight where scatterings take time", "1"),
    solution!("dwell_mean_square_distance", ClosedForm, dwell_mean_square_distance)
        .describe("mean square distance of all light where scatterings take time", "m^2"),
    solution!("dwell_single_scatter_radiance", Quadrature, dwell_single_scatter_radiance)
        .describe("radiance of once-scattered light where the scattering takes time", "W/(m^2 sr)"),
    solution!("dwell_sphere_cdf", Quadrature, dwell_sphere_cdf)
        .describe("law of the delay x of n chords and n dwells, in diameters", "1")
        .inputs(DIAMETERS),
];
