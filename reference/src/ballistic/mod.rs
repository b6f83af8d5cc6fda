//! Ballistic light: what arrives without having been scattered.

mod point;

pub use point::{BallisticPoint, ballistic_point_fluence};

use crate::registry::Solution;
use crate::registry::ToleranceClass::ClosedForm;
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] =
    &[solution!("ballistic_point_fluence", ClosedForm, ballistic_point_fluence)
        .describe("fluence that the unscattered wave of a point pulse carries past r", "J/m^2")];
