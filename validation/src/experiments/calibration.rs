//! Is the false-alarm rate what it is said to be?
//!
//! A suite that is green says something only if it would seldom be red without a reason. Here sound
//! "programs" are simulated many times, each is judged by the suite's own [`judge`] at a level of
//! 1e-3, and the share of those that are found to be different is compared with that level. The
//! suite's own levels cannot be observed; what can go wrong with them (correlated contrasts, skewed
//! or heavy-tailed contributions, few batches) shows at 1e-3 too.
//!
//! Contributions are like those of beams to a film: of random weight, each spread over three
//! neighbouring time bins of 24; judged are all energy, its first moment, and six parts of the
//! window, in the fewest batches that are admitted. Bins close to a ring: expectations follow from
//! symmetry.
//!
//! | case | weight of a contribution | contributions |
//! | --- | --- | --- |
//! | gaussian | none: batches are normal, contrasts independent | – |
//! | heavy tails | Pareto with index 3, so that the third moment is infinite | 7·10⁴ to the poorest contrast: no fewer suffice for an interval within 1 % |
//! | heavy tails, few | the same | 1500; with fewer than 1000 nothing is judged |
//!
//! A heavy-tailed weight w ≥ 1 has P(w > x) = x⁻³, as 1/sinψ of a 1D kernel has x⁻² to x⁻⁴. Where
//! there are many contributions, those below 6 are summed as a normal variate, which they are
//! nearly; those above, in which the tail lies, are drawn one by one.
//!
//! The rate may be at most 1.5 times the level (3 times with few contributions, which no passing
//! experiment has), with 99 % confidence. As a negative control the same batches are judged with
//! the tails of the normal distribution in place of Student's: that must be found out.

use std::f64::consts::{PI, SQRT_2};
use std::sync::Arc;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use statrs::function::beta::beta_reg;
use statrs::function::erf::erfc;
use tpb_optics::Stream;

use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::registry::Experiments;
use crate::statistics::agreement::FEWEST_BATCHES;
use crate::statistics::{Batches, Criterion, Finding, Target, judge};

/// Level at which the simulated experiments are judged.
pub const LEVEL: f64 = 1e-3;

const BINS: usize = 24;
/// Contrasts that are parts of the window, of four bins each.
const PARTS: usize = 6;
/// Bins that a contribution covers.
const SPREAD: usize = 3;
/// Weights above this are drawn one by one.
const LARGE: f64 = 6.0;

/// The experiment.
pub struct Calibration;

/// The one experiment.
pub fn all() -> Experiments {
    vec![Arc::new(Calibration)]
}

/// An observed rate of false alarms at [`LEVEL`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// Which null case.
    pub case: String,
    /// False alarms.
    pub alarms: u64,
    /// Simulated experiments.
    pub trials: u64,
    /// 99 % interval of the rate (Clopper & Pearson 1934).
    pub interval: [f64; 2],
}

/// What the contributions of a sound program are like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Null {
    Gaussian,
    HeavyTails,
    Few,
}

impl Null {
    fn name(self) -> &'static str {
        match self {
            Self::Gaussian => "gaussian",
            Self::HeavyTails => "heavy tails",
            Self::Few => "heavy tails, few contributions",
        }
    }

    /// How often the level the rate may be.
    fn tolerance(self) -> f64 {
        if self == Self::Few { 3.0 } else { 1.5 }
    }

    fn trials(self, effort: Effort) -> u64 {
        match self {
            Self::HeavyTails => effort.pick(100_000, 400_000),
            Self::Gaussian => effort.pick(0, 400_000),
            Self::Few => effort.pick(0, 100_000),
        }
    }

    /// Contributions that start in a bin, in each batch, on average.
    fn per_bin(self) -> f64 {
        // A part of 4 bins is reached from 6; E w²/(E w)² = 4/3; the outer ones reach it in part.
        if self == Self::Few { 13.0 } else { 600.0 }
    }

    /// The sum of the weights that start in one bin of a batch; its mean is [`Null::mean`].
    fn start(self, rng: &mut Stream) -> f64 {
        let pareto = |rng: &mut Stream, least: f64| least / (1.0 - rng.uniform()).cbrt();
        if self == Self::Few {
            return (0..poisson(self.per_bin(), rng)).map(|_| pareto(rng, 1.0)).sum();
        }
        // ∫ w and ∫ w² of the density 3 w⁻⁴ from 1 to LARGE, and what lies above.
        let (first, second) = (1.5 * (1.0 - LARGE.powi(-2)), 3.0 * (1.0 - 1.0 / LARGE));
        let small = self.per_bin() * first + (self.per_bin() * second).sqrt() * normal(rng);
        let large = poisson(self.per_bin() * LARGE.powi(-3), rng);
        small + (0..large).map(|_| pareto(rng, LARGE)).sum::<f64>()
    }

    fn mean(self) -> f64 {
        1.5 * self.per_bin()
    }

    /// The contrasts of a batch, each divided by its expectation.
    fn batch(self, rng: &mut Stream) -> Vec<f64> {
        if self == Self::Gaussian {
            return (0..PARTS + 2).map(|_| 1.0 + 0.02 * normal(rng)).collect();
        }
        let mut bins = [0.0; BINS];
        for start in 0..BINS {
            let share = self.start(rng) / (SPREAD as f64 * self.mean());
            for offset in 0..SPREAD {
                bins[(start + offset) % BINS] += share;
            }
        }
        let all = bins.iter().sum::<f64>() / BINS as f64;
        let moment: f64 = bins.iter().enumerate().map(|(i, v)| (i as f64 + 0.5) * v).sum();
        let width = BINS / PARTS;
        let parts = bins.chunks(width).map(|part| part.iter().sum::<f64>() / width as f64);
        [all, 2.0 * moment / (BINS * BINS) as f64].into_iter().chain(parts).collect()
    }

    /// Whether a sound experiment is found to be different: with Student's tails, and with those
    /// of the normal distribution.
    fn alarm(self, seed: u64, trial: u64) -> [bool; 2] {
        let mut rng = Stream::new(seed, trial, self as u64);
        let mut batches = Batches::new();
        for _ in 0..FEWEST_BATCHES {
            batches.push(self.batch(&mut rng));
        }
        let target = Target { name: String::new(), expected: 1.0, error: 0.0 };
        let criterion = Criterion { margin: 0.01, confidence: 0.99, level: LEVEL };
        let judgement = judge(&vec![target; batches.contrasts()], &batches, &criterion);
        let largest = judgement.contrasts.iter().map(|c| c.z.abs()).fold(0.0, f64::max);
        let normal = erfc(largest / SQRT_2) * batches.contrasts() as f64;
        [judgement.finding == Finding::Different, normal <= LEVEL]
    }

    /// The rates with Student's and with normal tails.
    fn rates(self, seed: u64, trials: u64) -> [Rate; 2] {
        let alarms = (0..trials)
            .into_par_iter()
            .map(|trial| self.alarm(seed, trial).map(u64::from))
            .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        alarms.map(|alarms| Rate {
            case: self.name().into(),
            alarms,
            trials,
            interval: clopper_pearson(alarms, trials, 0.99),
        })
    }
}

impl Rate {
    /// The observed rate.
    pub fn rate(&self) -> f64 {
        self.alarms as f64 / self.trials as f64
    }

    /// For a reader.
    pub fn line(&self) -> String {
        format!(
            "{}: {} false alarms in {} sound experiments at level {LEVEL:.0e}: rate {:.2e} (99 % interval {:.2e} to {:.2e})",
            self.case,
            self.alarms,
            self.trials,
            self.rate(),
            self.interval[0],
            self.interval[1]
        )
    }
}

/// A normal variate (Box & Muller 1958).
fn normal(rng: &mut Stream) -> f64 {
    let radius = (-2.0 * (1.0 - rng.uniform()).ln()).sqrt();
    radius * (2.0 * PI * rng.uniform()).cos()
}

/// A Poisson variate of a small mean: arrivals within 1.
fn poisson(mean: f64, rng: &mut Stream) -> u32 {
    let (mut count, mut product) = (0, 1.0 - rng.uniform());
    let end = (-mean).exp();
    while product > end {
        product *= 1.0 - rng.uniform();
        count += 1;
    }
    count
}

/// P(at least `alarms` of `trials`) at a rate.
fn at_least(alarms: u64, trials: u64, rate: f64) -> f64 {
    match alarms {
        0 => 1.0,
        _ if alarms > trials => 0.0,
        _ => beta_reg(alarms as f64, (trials - alarms) as f64 + 1.0, rate),
    }
}

/// The exact interval of a rate.
fn clopper_pearson(alarms: u64, trials: u64, confidence: f64) -> [f64; 2] {
    let tail = 0.5 * (1.0 - confidence);
    // The rate at which `count` or more have this probability; it grows with the rate.
    let rate_of = |count: u64, probability: f64| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if at_least(count, trials, middle) > probability {
                high = middle;
            } else {
                low = middle;
            }
        }
        0.5 * (low + high)
    };
    let low = if alarms == 0 { 0.0 } else { rate_of(alarms, tail) };
    let high = if alarms == trials { 1.0 } else { rate_of(alarms + 1, 1.0 - tail) };
    [low, high]
}

impl Experiment for Calibration {
    fn name(&self) -> String {
        "statistics/calibration".into()
    }

    fn description(&self) -> String {
        "false alarms among simulated sound experiments, judged at 1e-3, against that level".into()
    }

    fn kind(&self) -> Kind {
        Kind::SelfControlled
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (mut sound, mut notes, mut rates) = (true, Vec::new(), Vec::new());
        for null in [Null::Gaussian, Null::HeavyTails, Null::Few] {
            let trials = null.trials(context.effort);
            if trials == 0 {
                continue;
            }
            let [student, normal] = null.rates(context.seed, trials);
            let limit = null.tolerance() * LEVEL;
            // Claimed only where a rate at the limit would hardly ever give so many.
            sound &= at_least(student.alarms, trials, limit) > context.level;
            notes.push(student.line());
            let found_out = at_least(normal.alarms, trials, limit) <= context.level;
            sound &= found_out;
            let verdict = if found_out { "rejected, as it must be" } else { "NOT rejected" };
            notes.push(format!("  control with normal tails: {:.2e}, {verdict}", normal.rate()));
            rates.push(student);
        }
        let mut outcome = Outcome::exact(sound, notes);
        outcome.false_alarm = context.level;
        outcome.calibration = rates;
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_of_rates_are_those_of_the_printed_tables() {
        // Clopper & Pearson: 2 of 10 at 95 %, 0 of 10 at 95 %.
        let close = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() + (b - d).abs() < 2e-4;
        assert!(close(clopper_pearson(2, 10, 0.95), [0.0252, 0.5561]));
        assert!(close(clopper_pearson(0, 10, 0.95), [0.0, 0.3085]));
        assert!(close(clopper_pearson(10, 10, 0.95), [0.6915, 1.0]));
    }

    #[test]
    fn batches_have_the_means_that_they_are_judged_by() {
        for null in [Null::Gaussian, Null::HeavyTails, Null::Few] {
            let mut rng = Stream::new(3, 0, 0);
            let n = 4000;
            let mut sums = vec![0.0; PARTS + 2];
            for _ in 0..n {
                for (sum, value) in sums.iter_mut().zip(null.batch(&mut rng)) {
                    *sum += value / f64::from(n);
                }
            }
            // The poorest has a relative spread of 0.17 per batch: 6 sd of the mean are 1.6 %.
            assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 0.016), "{null:?} {sums:?}");
        }
    }
}
