//! The ratio of two mean errors by the delta method.
//!
//! On the logarithm: ln(ā/b̄) has the standard error √(s_a²/ā² + s_b²/b̄²) by the delta method, s
//! being the standard errors of the means, and is compared with Student's t of the
//! Welch-Satterthwaite degrees of freedom. It suits errors that are far above 0 relative to their
//! own noise, such as the NMSE of whole cubes.

use serde::{Deserialize, Serialize};
use tpb_statistics::VarianceSum;

use crate::statistics::batches::summarise;
use crate::statistics::student;

/// A ratio of means.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RatioInterval {
    /// Mean of the first over mean of the second.
    pub ratio: f64,
    /// Lower end of the confidence interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Degrees of freedom.
    pub freedom: f64,
    /// One-sided p value of the hypothesis that the ratio is at most 1.
    pub p_at_most_one: f64,
    /// Chance that a true ratio as observed would not be seen at level 1e-3.
    pub miss: f64,
}

/// Level at which a ratio above 1 is claimed.
pub const RATIO_LEVEL: f64 = 1e-3;

/// The ratio of the means of independent positive values; `None` if a mean is not positive or
/// there are fewer than two values of either.
pub fn ratio_of_means(a: &[f64], b: &[f64], confidence: f64) -> Option<RatioInterval> {
    let (x, y) = (summarise(a), summarise(b));
    let positive = x.mean > 0.0 && y.mean > 0.0;
    if !positive || a.len() < 2 || b.len() < 2 {
        return None;
    }
    let relative = VarianceSum::default()
        .and((x.standard_error / x.mean).powi(2), a.len() as f64 - 1.0)
        .and((y.standard_error / y.mean).powi(2), b.len() as f64 - 1.0);
    // Histories are JSON, which knows no infinity.
    let (error, freedom) = (relative.variance().sqrt(), relative.freedom().min(1e6));
    let log = (x.mean / y.mean).ln();
    let half_width = student::quantile(0.5 * (1.0 - confidence), freedom) * error;
    let t = if log == 0.0 { 0.0 } else { log / error };
    Some(RatioInterval {
        ratio: log.exp(),
        low: (log - half_width).exp(),
        high: (log + half_width).exp(),
        freedom,
        p_at_most_one: student::upper_tail(t, freedom),
        miss: student::upper_tail(t - student::quantile(RATIO_LEVEL, freedom), freedom),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tpb_optics::Stream;

    fn errors(rng: &mut Stream, mean: f64) -> Vec<f64> {
        // Mean of 100 squares of centred uniform variates, variance 1/12.
        let one = |rng: &mut Stream| (rng.uniform() - 0.5).powi(2) * 12.0 * mean;
        (0..5).map(|_| (0..100).map(|_| one(rng)).sum::<f64>() / 100.0).collect()
    }

    #[test]
    fn the_interval_covers_the_true_ratio_as_often_as_it_says() {
        // 2000 intervals of 90 %: 200 misses expected, sd 13.4; six of them either way.
        let mut rng = Stream::new(11, 0, 0);
        let missed = (0..2000)
            .filter(|_| {
                let (a, b) = (errors(&mut rng, 3.0), errors(&mut rng, 1.0));
                let r = ratio_of_means(&a, &b, 0.9).unwrap();
                !(r.low..=r.high).contains(&3.0)
            })
            .count();
        assert!((120..=280).contains(&missed), "{missed} of 2000");
    }

    #[test]
    fn a_clear_advantage_is_certain_and_none_is_not_claimed() {
        let mut rng = Stream::new(12, 0, 0);
        let (a, b) = (errors(&mut rng, 10.0), errors(&mut rng, 1.0));
        assert!(ratio_of_means(&a, &b, 0.95).unwrap().p_at_most_one < 1e-5);
        assert!(ratio_of_means(&b, &a, 0.95).unwrap().p_at_most_one > 0.99);
        assert!(ratio_of_means(&[1.0, -2.0], &b, 0.95).is_none());
    }
}
