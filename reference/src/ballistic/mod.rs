//! Ballistic light: what arrives without having been scattered.

mod disc;
mod point;
mod pulse;

pub use disc::{BallisticDiscBin, ballistic_disc_bins};
pub use point::{BallisticPoint, ballistic_point_fluence};
pub use pulse::{BoxPulseBin, GaussPulseBin, ballistic_box_pulse, ballistic_gauss_pulse};

use crate::registry::Solution;
use crate::registry::ToleranceClass::ClosedForm;
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("ballistic_point_fluence", ClosedForm, ballistic_point_fluence)
        .describe("fluence that the unscattered wave of a point pulse carries past r", "J/m^2"),
    solution!("ballistic_disc_bins", ClosedForm, ballistic_disc_bins)
        .describe("unscattered energy that reaches a coaxial disc within a bin of time", "J"),
    solution!(
        "ballistic_pulse_shapes",
        ClosedForm,
        "box" => ballistic_box_pulse,
        "gauss" => ballistic_gauss_pulse
    )
    .describe("unscattered fluence of a pulse of finite length within a bin of time", "J/m^2"),
];
