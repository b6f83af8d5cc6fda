//! Scattering events that take time of their own.

use crate::registry::Solution;

pub(crate) static SOLUTIONS: &[Solution] = &[];
