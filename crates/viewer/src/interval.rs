//! How wide a 95 % interval is, if the standard error was itself estimated.
//!
//! A variance from n independent batches (passes, replicates) has n − 1 degrees of freedom, and the
//! interval is ± t standard errors with the quantile t of Student's t: 12.7 for two batches, 2.78 for
//! five, 1.96 for very many. A sum of independent variances V_i with f_i degrees has about
//! `(Σ V_i)²/Σ(V_i²/f_i)` degrees (Satterthwaite 1946, Welch 1947).
//!
//! Where the number of batches is not known, it counts as large: the interval may be too narrow, and
//! the page says that the number is unknown.

use statrs::distribution::{ContinuousCDF, StudentsT};
use tpb_film::Arrays;

/// Probability above the interval, and below it.
const TAIL: f64 = 0.025;

/// Standard errors of a normal distribution that leave [`TAIL`] above.
const NORMAL: f64 = 1.959_963_984_540_054;

/// Beyond so many degrees of freedom Student's t has that quantile, to 1e-5.
const MANY: f64 = 1e6;

/// No interval is wider, in standard errors: one degree of freedom has 12.7.
const WIDEST: f64 = 13.0;

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
    if freedom.is_nan() || freedom < 1.0 {
        return None;
    }
    if freedom > MANY {
        return Some(NORMAL);
    }
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
    let (mut low, mut high) = (0.0, WIDEST);
    // Halved until neighbouring numbers.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if student.sf(middle) > TAIL {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}

/// A sum of independent variances, each with its degrees of freedom.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    variance: f64,
    /// Σ V²/f.
    uncertainty: f64,
}

impl Sum {
    /// With another variance added, or with others, all of `freedom`: their sum, and that of their
    /// squares.
    pub(crate) fn and(self, variance: f64, squares: f64, freedom: f64) -> Self {
        // What is no variance needs no freedom.
        let uncertainty = if squares > 0.0 { squares / freedom } else { 0.0 };
        Self { variance: self.variance + variance, uncertainty: self.uncertainty + uncertainty }
    }

    /// Half the width of the 95 % interval.
    pub(crate) fn half(self) -> Option<f64> {
        if self.variance == 0.0 {
            return Some(0.0);
        }
        let freedom = self.variance * self.variance / self.uncertainty;
        Some(standard_errors(freedom)? * self.variance.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

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

    #[test]
    fn sums_have_the_freedom_of_their_parts() {
        let one = Sum::default().and(4.0, 16.0, 7.0);
        assert!((one.half().unwrap() - 2.0 * standard_errors(7.0).unwrap()).abs() < 1e-12);
        // Equal parts: freedoms add up.
        let two = one.and(4.0, 16.0, 7.0).half().unwrap();
        assert!((two - 8.0_f64.sqrt() * standard_errors(14.0).unwrap()).abs() < 1e-12);
        // A part that is known exactly adds none.
        assert_eq!(one.and(0.0, 0.0, 0.0).half(), one.half());
        assert_eq!(Sum::default().half(), Some(0.0));
        assert_eq!(one.and(1.0, 1.0, 0.0).half(), None, "a variance from one batch is none");
    }

    proptest! {
        #[test]
        fn more_freedom_is_narrower(a in 1.0..1e7_f64, more in 0.0..1e7_f64) {
            let (wide, narrow) = (standard_errors(a).unwrap(), standard_errors(a + more).unwrap());
            prop_assert!(wide >= narrow - 1e-6 && narrow > 1.9599 && wide < 12.71);
        }
    }
}
