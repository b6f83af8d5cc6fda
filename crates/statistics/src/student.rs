//! Student's t: tail probabilities and quantiles, also where they are 1e-12 and smaller.
//!
//! The tail is the regularised incomplete beta function, P(T > t) = I_x(ν/2, 1/2)/2 with
//! x = ν/(ν + t²), which keeps its relative accuracy however small it is (`statrs`). Degrees of
//! freedom need not be whole, and may be infinite (the normal distribution).

use statrs::distribution::{Continuous, ContinuousCDF, StudentsT};

/// Beyond so many degrees the distribution is taken as normal: a tail of 1e-12 changes by 7e-6 of
/// itself, quantiles by 1e-7.
const MANY: f64 = 1e8;

/// Student's t with `freedom` degrees of freedom; `None` unless `freedom` > 0.
fn distribution(freedom: f64) -> Option<StudentsT> {
    let freedom = if freedom > MANY { f64::INFINITY } else { freedom };
    StudentsT::new(0.0, 1.0, freedom).ok()
}

/// P(T > t) with `freedom` > 0 degrees of freedom.
pub fn upper_tail(t: f64, freedom: f64) -> f64 {
    if t.is_nan() {
        return 1.0;
    }
    if t == f64::INFINITY {
        return 0.0;
    }
    if t == f64::NEG_INFINITY {
        return 1.0;
    }
    distribution(freedom).map_or(1.0, |student| student.sf(t))
}

/// P(|T| > |t|).
pub fn two_sided(t: f64, freedom: f64) -> f64 {
    (2.0 * upper_tail(t.abs(), freedom)).min(1.0)
}

/// The t that is exceeded with probability `tail`, 0 < `tail` < 1.
///
/// Newton's method on the logarithm of the tail, which is nearly straight; kept within a bracket.
pub fn quantile(tail: f64, freedom: f64) -> f64 {
    if tail > 0.5 {
        return -quantile(1.0 - tail, freedom);
    }
    let Some(student) = distribution(freedom) else { return f64::NAN };
    let (mut low, mut high) = (0.0, 1.0);
    while student.sf(high) > tail && high < 1e150 {
        (low, high) = (high, 2.0 * high);
    }
    let mut t = 0.5 * (low + high);
    for _ in 0..200 {
        let above = student.sf(t);
        if above > tail {
            low = t;
        } else {
            high = t;
        }
        let newton = t + (above / tail).ln() * above / student.pdf(t);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let moved = (next - t).abs();
        t = next;
        if moved <= 4.0 * f64::EPSILON * t {
            break;
        }
    }
    t
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn one_degree_of_freedom_is_cauchy_far_into_the_tail() {
        // P(T > t) = atan(1/t)/π.
        for t in [0.1, 1.0, 31.8, 1e4, 1e8] {
            let exact = (1.0_f64 / t).atan() / PI;
            assert!((upper_tail(t, 1.0) / exact - 1.0).abs() < 1e-9, "t = {t}");
        }
    }

    #[test]
    fn quantiles_are_those_of_the_printed_tables_and_invert_the_tail() {
        // Abramowitz & Stegun, table 26.10.
        assert!((quantile(0.025, 10.0) - 2.228).abs() < 5e-4);
        assert!((quantile(0.005, 30.0) - 2.750).abs() < 5e-4);
        assert!((quantile(0.975, 10.0) + 2.228).abs() < 5e-4);
        for tail in [0.3, 1e-3, 1e-9, 1e-14] {
            let t = quantile(tail, 31.0);
            assert!((upper_tail(t, 31.0) / tail - 1.0).abs() < 1e-6, "{tail}");
        }
    }

    #[test]
    fn limits_are_no_nan() {
        assert_eq!(two_sided(f64::INFINITY, 31.0), 0.0);
        assert_eq!(two_sided(0.0, 31.0), 1.0);
        assert_eq!(two_sided(f64::NAN, 31.0), 1.0);
    }

    #[test]
    fn very_many_degrees_are_normal() {
        for freedom in [1e7, 1e8, 1.1e8, 1e12, u64::MAX as f64, f64::INFINITY] {
            assert!((quantile(0.025, freedom) - 1.959_963_984_540_054).abs() < 1e-6, "{freedom}");
            assert!((quantile(1e-12, freedom) - 7.034_483_825).abs() < 2e-5, "{freedom}");
        }
    }

    proptest! {
        #[test]
        fn more_freedom_is_narrower(a in 1.0..1e7_f64, more in 0.0..1e9_f64) {
            let (wide, narrow) = (quantile(0.025, a), quantile(0.025, a + more));
            prop_assert!(wide >= narrow * (1.0 - 1e-9) && narrow > 1.9599 && wide < 12.71);
        }
    }
}
