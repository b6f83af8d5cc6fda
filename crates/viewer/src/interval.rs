//! How wide a 95 % interval is, if the standard error was itself estimated.
//!
//! A variance from n independent batches (passes, replicates) has n − 1 degrees of freedom, and the
//! interval is ± t standard errors with the quantile t of Student's t: 12.7 for two batches, 2.78 for
//! five, 1.96 for very many. Sums of variances: [`tpb_statistics::welch`].
//!
//! Where the number of batches is not known, it counts as large: the interval may be too narrow, and
//! the page says that the number is unknown.

use tpb_film::Arrays;
use tpb_statistics::{VarianceSum, student};

/// Probability above the interval, and below it.
const TAIL: f64 = 0.025;

/// Arrays, and from how many independent batches their variance was estimated.
#[derive(Clone, Copy, Debug)]
pub struct Estimate<'a> {
    /// The arrays.
    pub arrays: &'a Arrays,
    /// The number of batches; `None` if it is not known.
    pub batches: Option<u64>,
}

impl<'a> From<&'a Arrays> for Estimate<'a> {
    fn from(arrays: &'a Arrays) -> Self {
        Self { arrays, batches: None }
    }
}

impl Estimate<'_> {
    /// Degrees of freedom of its variances; infinite if they are not known.
    pub(crate) fn freedom(&self) -> f64 {
        self.batches.map_or(f64::INFINITY, |batches| batches.saturating_sub(1) as f64)
    }
}

/// Standard errors on each side of a 95 % interval, for a variance with so many degrees of freedom;
/// `None` for less than one.
pub(crate) fn standard_errors(freedom: f64) -> Option<f64> {
    (freedom >= 1.0).then(|| student::quantile(TAIL, freedom))
}

/// Half the width of the 95 % interval of a sum of independent variances; `None` if less than one
/// degree of freedom is left.
pub(crate) fn half(sum: VarianceSum) -> Option<f64> {
    sum.half_width(TAIL)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression: intervals were ±1.96 standard errors whatever the number of batches.
    #[test]
    fn few_batches_have_wide_intervals() {
        // The table of Student's t, two-sided 5 %.
        let table = [
            (2, 12.706_205),
            (3, 4.302_653),
            (5, 2.776_445),
            (8, 2.364_624),
            (32, 2.039_513),
            (1001, 1.962_339),
            (u64::MAX, 1.959_964),
        ];
        let arrays = crate::testing::cube(1, 1, 1, 1);
        for (batches, exact) in table {
            let estimate = Estimate { arrays: &arrays, batches: Some(batches) };
            let found = standard_errors(estimate.freedom()).unwrap();
            assert!((found - exact).abs() < 2e-6, "{batches}: {found} for {exact}");
        }
        assert_eq!(standard_errors(Estimate::from(&arrays).freedom()), standard_errors(1e9));
        for batches in [0, 1] {
            let estimate = Estimate { arrays: &arrays, batches: Some(batches) };
            assert_eq!(standard_errors(estimate.freedom()), None, "{batches} batches");
        }
    }
}
