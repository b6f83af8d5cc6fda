//! Diffusion: approximate solutions, labelled so.

use crate::registry::Solution;

pub(crate) static SOLUTIONS: &[Solution] = &[];
