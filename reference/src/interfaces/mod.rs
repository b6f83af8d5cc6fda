//! Refraction and mirrors: where and when light arrives.

use crate::registry::Solution;

pub(crate) static SOLUTIONS: &[Solution] = &[];
