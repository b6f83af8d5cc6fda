//! The statistics of comparison: what may be concluded from noisy estimates, and how often it is
//! concluded wrongly.
//!
//! * [`batches`]: independent batches of a few linear contrasts, their means and standard errors.
//!   A beam fills many cells, so cells are correlated and never serve as samples themselves.
//! * [`student`]: tail probabilities and quantiles of Student's t, far into the tails
//!   (`crates/statistics`).
//! * [`multiple`]: Holm and Šidák corrections for many simultaneous tests.
//! * [`agreement`]: the verdict on a set of contrasts with known expectations: *different*
//!   (significant after Holm), *equivalent* (every confidence interval within the margin), or
//!   *unresolved* (too noisy to tell, which is a failure for lack of power, never a pass).
//! * [`mod@chi_square`]: histograms against densities.
//! * [`ratio`] (by the delta method, and Fieller's) and [`bootstrap`] (of medians): how many times
//!   better one method is than another.
//! * [`regression`]: slopes, exponents of power laws, and jackknife pseudo-values.
//! * [`split`]: the error of a cube, split into variance and squared bias without bias.
//!
//! No variance is ever raised to a floor. Every verdict carries its false-alarm probability: how
//! likely it is to find a difference where there is none; a suite adds them up. Apart from it stands
//! the chance that noise leaves a question unresolved, which a larger budget lowers.

pub mod agreement;
pub mod batches;
pub mod bootstrap;
pub mod chi_square;
pub mod multiple;
pub mod ratio;
pub mod regression;
pub mod split;

pub use agreement::{Contrast, Criterion, Finding, Judgement, Target, judge};
pub use batches::Batches;
pub use chi_square::{ChiSquare, chi_square};
pub use multiple::{holm, sidak};
pub use ratio::{Factor, RatioInterval, Winner, ratio_of_means};
pub use split::{Gram, ReferenceNoise, Split};
pub use tpb_statistics::student;

/// The larger of two errors; a NaN is worse than any.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_worse_than_a_nan() {
        assert_eq!(worse(1.0, 2.0), 2.0);
        assert_eq!([0.1, f64::NAN, 0.2].into_iter().fold(0.0, worse), f64::INFINITY);
    }
}
