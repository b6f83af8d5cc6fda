//! The infinite homogeneous medium, all orders of scattering.

use crate::registry::Solution;

pub(crate) static SOLUTIONS: &[Solution] = &[];
