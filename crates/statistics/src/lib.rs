//! Intervals from variances that were themselves estimated.
//!
//! * [`student`]: tail probabilities and quantiles of Student's t, far into the tails.
//! * [`welch`]: sums of independent variances, and their degrees of freedom.

pub mod student;
pub mod welch;

pub use welch::VarianceSum;
