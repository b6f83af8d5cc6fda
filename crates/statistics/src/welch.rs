//! A sum of independent variances V_i, each estimated with f_i degrees of freedom, is about
//! distributed as one with `(Σ V_i)²/Σ(V_i²/f_i)` degrees (Satterthwaite 1946, eq. 17; Welch 1947).
//!
//! A variance from n independent batches has n − 1 degrees; one that is known exactly has infinitely
//! many. The approximation needs independent, about normal estimates.

use crate::student;

/// A sum of independent variances, each with its degrees of freedom.
#[derive(Clone, Copy, Debug, Default)]
pub struct VarianceSum {
    variance: f64,
    /// Σ V²/f.
    uncertainty: f64,
}

impl VarianceSum {
    /// With another variance of `freedom` degrees.
    #[must_use]
    pub fn and(self, variance: f64, freedom: f64) -> Self {
        self.and_many(variance, variance * variance, freedom)
    }

    /// With several variances, each of `freedom` degrees: their sum, and the sum of their squares.
    #[must_use]
    pub fn and_many(self, variance: f64, squares: f64, freedom: f64) -> Self {
        // What is no variance needs no freedom.
        let uncertainty = if squares > 0.0 { squares / freedom } else { 0.0 };
        Self { variance: self.variance + variance, uncertainty: self.uncertainty + uncertainty }
    }

    /// The sum.
    pub fn variance(self) -> f64 {
        self.variance
    }

    /// Its degrees of freedom: infinitely many if every part is known exactly or 0, none if a part
    /// has none.
    pub fn freedom(self) -> f64 {
        if self.uncertainty == 0.0 {
            return f64::INFINITY;
        }
        self.variance * self.variance / self.uncertainty
    }

    /// Half the width of the interval that leaves probability `tail` above, and below; `None` if
    /// less than one degree of freedom is left to tell it.
    pub fn half_width(self, tail: f64) -> Option<f64> {
        if self.variance == 0.0 {
            return Some(0.0);
        }
        let freedom = self.freedom();
        (freedom >= 1.0).then(|| student::quantile(tail, freedom) * self.variance.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAIL: f64 = 0.025;

    #[test]
    fn sums_have_the_freedom_of_their_parts() {
        let one = VarianceSum::default().and(4.0, 7.0);
        assert!((one.half_width(TAIL).unwrap() - 2.0 * student::quantile(TAIL, 7.0)).abs() < 1e-12);
        // Equal parts: freedoms add up, one by one or together.
        let two = one.and(4.0, 7.0);
        assert!((two.freedom() - 14.0).abs() < 1e-12);
        let together = VarianceSum::default().and_many(8.0, 32.0, 7.0);
        assert_eq!(two.half_width(TAIL), together.half_width(TAIL));
        // A part that is known exactly adds none.
        assert_eq!(one.and(0.0, 0.0).half_width(TAIL), one.half_width(TAIL));
        assert_eq!(VarianceSum::default().half_width(TAIL), Some(0.0));
        assert_eq!(one.and(1.0, 0.0).half_width(TAIL), None, "a variance from one batch is none");
    }

    /// Moser, Stevens, Watts (1989): of two samples, between the smaller freedom and their sum.
    #[test]
    fn freedom_lies_between_the_smallest_part_and_the_sum() {
        for (a, b) in [(1.0, 1e-6), (1.0, 0.3), (1.0, 1.0), (2e-9, 5.0)] {
            let freedom = VarianceSum::default().and(a, 4.0).and(b, 9.0).freedom();
            assert!((4.0..=13.0 + 1e-12).contains(&freedom), "{a}, {b}: {freedom}");
        }
    }
}
