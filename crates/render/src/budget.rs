//! When to stop: after a number of passes, or when the time is up.
//!
//! A pass is never cut short. Under a time budget B, with t elapsed and passes that took m on
//! average, the next pass is started while it is expected to end no further past B than stopping
//! now falls short of it: `t + m − B ≤ B − t`. So runs end within half a pass of their budget, on
//! average neither early nor late, and comparisons at equal time are fair to slow passes.

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};

/// How long a run goes on; at least one pass is always made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Budget {
    /// This many passes.
    Passes(u64),
    /// As many passes as fit this wall time, preparation of the method included.
    #[serde(rename = "seconds", with = "seconds")]
    Time(Duration),
}

impl Default for Budget {
    fn default() -> Self {
        Self::Time(Duration::from_secs(10))
    }
}

impl fmt::Display for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Passes(1) => write!(f, "1 pass"),
            Self::Passes(passes) => write!(f, "{passes} passes"),
            Self::Time(time) => write!(f, "{} s", time.as_secs_f64()),
        }
    }
}

impl Budget {
    /// Whether to start another pass after `passes`, with `elapsed` since the start and passes of
    /// `mean` duration.
    pub(crate) fn allows_another(self, passes: u64, elapsed: Duration, mean: Duration) -> bool {
        match self {
            _ if passes == 0 => true,
            Self::Passes(wanted) => passes < wanted,
            Self::Time(budget) => elapsed < budget && elapsed.saturating_add(mean / 2) <= budget,
        }
    }

    /// What is left of it.
    pub(crate) fn remaining(self, passes: u64, elapsed: Duration, mean: Duration) -> Duration {
        match self {
            Self::Passes(wanted) => {
                let left = wanted.saturating_sub(passes) as f64 * mean.as_secs_f64();
                Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX)
            }
            Self::Time(budget) => budget.saturating_sub(elapsed),
        }
    }
}

/// Durations as a number of seconds.
mod seconds {
    use std::time::Duration;

    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(time: &Duration, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_f64(time.as_secs_f64())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Duration, D::Error> {
        Duration::try_from_secs_f64(f64::deserialize(from)?).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Passes that all take `mean`, after a preparation.
    fn end_of_run(budget: Duration, setup: Duration, mean: Duration) -> Duration {
        let (mut elapsed, mut passes) = (setup, 0);
        while Budget::Time(budget).allows_another(passes, elapsed, mean) {
            elapsed += mean;
            passes += 1;
        }
        elapsed
    }

    proptest! {
        #[test]
        fn a_run_ends_within_half_a_pass_of_its_budget(
            budget in 1_u64..100_000, setup in 0_u64..1000, mean in 1_u64..20_000,
        ) {
            let [budget, setup, mean] = [budget, setup, mean].map(Duration::from_micros);
            let end = end_of_run(budget, setup, mean);
            prop_assert!(end >= setup + mean, "at least one pass");
            if setup + mean <= budget {
                prop_assert!(end.abs_diff(budget) <= mean / 2 + Duration::from_nanos(1));
            }
        }
    }

    #[test]
    fn passes_are_counted() {
        let second = Duration::from_secs(1);
        let budget = Budget::Passes(3);
        assert!(budget.allows_another(2, second, second));
        assert!(!budget.allows_another(3, second, second));
        assert!(Budget::Passes(0).allows_another(0, second, second), "always one pass");
        assert_eq!(budget.remaining(1, second, second), 2 * second);
        assert_eq!(Budget::Passes(u64::MAX).remaining(1, second, Duration::MAX), Duration::MAX);
    }

    #[test]
    fn it_is_plain_data() {
        let json = |budget: Budget| serde_json::to_string(&budget).unwrap();
        assert_eq!(json(Budget::Passes(7)), r#"{"passes":7}"#);
        assert_eq!(json(Budget::Time(Duration::from_millis(2500))), r#"{"seconds":2.5}"#);
        let back: Budget = serde_json::from_str(r#"{"seconds":0.25}"#).unwrap();
        assert_eq!(back, Budget::Time(Duration::from_millis(250)));
        assert!(serde_json::from_str::<Budget>(r#"{"seconds":-1}"#).is_err());
    }
}
