//! The ratio of two estimates by Fieller's theorem.
//!
//! The ratio A/B of two estimates a, b with independent errors s_a, s_b and Student's t: Fieller
//! (J. R. Stat. Soc. B 16, 1954). The ends of its interval are the roots ρ of (a − ρb)² = t²(s_a² + ρ²s_b²). If b is not
//! resolved from 0, b² ≤ t²s_b², there is no upper end; where a is not, the lower end is at most 0
//! and is given as 0, since errors are not negative. Both estimates hold the reference's noise,
//! which they share: the interval leaves that out, which makes it too wide, not too narrow, where
//! both err together.

use serde::{Deserialize, Serialize};

use crate::statistics::split::Estimate;
use crate::statistics::student;

/// A ratio and its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// a/b; `None` unless b is resolved from 0.
    pub value: Option<f64>,
    /// Lower end.
    pub low: f64,
    /// Upper end; `None` if there is none.
    pub high: Option<f64>,
}

/// Who has less error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Winner {
    /// The first method: the interval is below 1.
    First,
    /// The second: it is above 1.
    Second,
    /// Neither: it holds 1.
    Unresolved,
}

impl Factor {
    /// Of two estimates, with this many degrees of freedom; `None` without any error to compare.
    pub fn of(a: &Estimate, b: &Estimate, freedom: f64, confidence: f64) -> Option<Self> {
        let t = student::quantile(0.5 * (1.0 - confidence), freedom);
        let (ta, tb) = (t * a.standard_error, t * b.standard_error);
        let finite = [a.value, b.value, ta, tb].iter().all(|x| x.is_finite());
        if !finite || (a.value <= 0.0 && b.value <= 0.0) {
            return None;
        }
        let (p, square) = (a.value * b.value, b.value * b.value - tb * tb);
        let root = p * p - (a.value * a.value - ta * ta) * square;
        let resolved = b.value > 0.0 && square > 0.0;
        if resolved && root >= 0.0 {
            let low = ((p - root.sqrt()) / square).max(0.0);
            let high = (p + root.sqrt()) / square;
            return Some(Self { value: Some(a.value / b.value), low, high: Some(high) });
        }
        // The farthest that both may lie.
        let low = (a.value - ta).max(0.0) / (b.value + tb).max(f64::MIN_POSITIVE);
        Some(Self { value: None, low, high: None })
    }

    /// The same where both are multiplied by constants first.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value.map(|value| value * factor),
            low: self.low * factor,
            high: self.high.map(|high| high * factor),
        }
    }

    /// Who has less.
    pub fn winner(&self) -> Winner {
        match self.high {
            Some(high) if high < 1.0 => Winner::First,
            _ if self.low > 1.0 => Winner::Second,
            _ => Winner::Unresolved,
        }
    }

    /// `12.3 (95 % interval 10.1 to 14.9)`, without the words.
    pub fn text(&self) -> String {
        match (self.value, self.high) {
            (Some(value), Some(high)) => {
                format!("{} [{}, {}]", short(value), short(self.low), short(high))
            }
            _ if self.low > 0.0 => format!("at least {}", short(self.low)),
            _ => "not resolved".to_owned(),
        }
    }
}

/// Two digits at least.
pub(crate) fn short(value: f64) -> String {
    if value >= 99.5 {
        format!("{value:.0}")
    } else if value >= 9.95 {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tpb_optics::Stream;

    fn estimate(value: f64, standard_error: f64) -> Estimate {
        Estimate { value, standard_error, interval: [0.0; 2] }
    }

    /// Mean and standard error of 6 values around a mean.
    fn sample(rng: &mut Stream, mean: f64, spread: f64) -> Estimate {
        let values: Vec<f64> =
            (0..6).map(|_| mean + spread * 12.0_f64.sqrt() * (rng.uniform() - 0.5)).collect();
        let m = values.iter().sum::<f64>() / 6.0;
        let squares: f64 = values.iter().map(|v| (v - m) * (v - m)).sum();
        estimate(m, (squares / 30.0).sqrt())
    }

    #[test]
    fn the_interval_covers_the_true_ratio_as_often_as_it_says() {
        // 2000 intervals of 90 % at noise of 30 %: at most 200 missed plus six sd of 13.4, and more
        // than a quarter of that.
        let mut rng = Stream::new(31, 0, 0);
        let missed = (0..2000)
            .filter(|_| {
                let (a, b) = (sample(&mut rng, 3.0, 0.9), sample(&mut rng, 1.0, 0.3));
                let factor = Factor::of(&a, &b, 5.0, 0.9).unwrap();
                factor.low > 3.0 || factor.high.is_some_and(|high| high < 3.0)
            })
            .count();
        assert!((50..=280).contains(&missed), "{missed} of 2000");
    }

    #[test]
    fn what_is_not_resolved_has_no_upper_end() {
        let factor = Factor::of(&estimate(1.0, 0.01), &estimate(0.01, 0.02), 5.0, 0.95).unwrap();
        assert_eq!((factor.value, factor.high), (None, None));
        assert!(factor.low > 10.0 && factor.winner() == Winner::Second, "{factor:?}");
        assert_eq!(factor.text(), "at least 15.9");
        let none = Factor::of(&estimate(-1.0, 0.1), &estimate(0.0, 0.1), 5.0, 0.95);
        assert_eq!(none, None);
    }

    #[test]
    fn winners_and_words() {
        let factor = Factor::of(&estimate(0.1, 1e-3), &estimate(1.0, 1e-2), 5.0, 0.95).unwrap();
        assert_eq!(factor.winner(), Winner::First);
        assert_eq!(factor.scaled(10.0).winner(), Winner::Unresolved);
        assert_eq!(factor.scaled(123.0).winner(), Winner::Second);
        assert!(
            factor.scaled(123.0).text().starts_with("12.3 [11.9, 12.8]"),
            "{}",
            factor.scaled(123.0).text()
        );
    }
}
