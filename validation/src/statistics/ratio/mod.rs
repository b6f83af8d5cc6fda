//! How many times less error one method has than another: a ratio with its confidence interval.
//!
//! | | numerator and denominator | where it holds |
//! | --- | --- | --- |
//! | [`delta`] | means of positive values of replicates | both far above 0 relative to their noise: on the logarithm, to first order; gives a p value |
//! | [`fieller`] | estimates with standard errors | everywhere: exact for normal errors, also where noise leaves an end open |
//!
//! Equal-time experiments, which test a claim about whole cubes, use the first; tables of single
//! bins and kinds of cells, many of which are hardly resolved, the second.

pub mod delta;
pub mod fieller;

pub use delta::{RATIO_LEVEL, RatioInterval, ratio_of_means};
pub(crate) use fieller::short;
pub use fieller::{Factor, Winner};
