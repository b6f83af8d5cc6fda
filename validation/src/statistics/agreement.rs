//! Does an estimator have the expectation that it should have?
//!
//! For each pre-registered contrast k there are batch means with standard error s_k, and an
//! expectation r_k known to within e_k. Two questions are asked.
//!
//! 1. *Is there a significant difference?* t = max(0, |x̄ − r| − e)/s, Student with B − 1 degrees of
//!    freedom, Holm over the contrasts at the level of the criterion. Yes: [`Finding::Different`].
//! 2. *Is a relevant difference excluded?* The confidence interval of the relative error
//!    (x̄ − r)/r, widened by e/|r|, must lie within ± margin for every contrast
//!    (Schuirmann's equivalence test). Yes: [`Finding::Equivalent`]. No: [`Finding::Unresolved`],
//!    which counts as failed: noise is no excuse.
//!
//! What is not fit to be judged is never equivalent: fewer than 32 batches, more than 64 contrasts,
//! a contrast of fewer than 1000 independent contributions. These are counted as Kish (1965) does:
//! contributions of unequal size w are worth (Σw)²/Σw² equal ones, and the relative variance of
//! their sum is the inverse of that, so that (mean/s)² is their number (or more, where sampling is
//! stratified). An interval within a margin of 0.5 % at 99 % needs 280 000 of them, within 1 %
//! 70 000.
//!
//! The false-alarm probability, the chance to call an unbiased estimator different, is the level of
//! question 1. The chance that its noise leaves it unresolved is, by Bonferroni and conditional on
//! the observed s_k, Σ_k P(|T| > (margin − half width)/s_k): a matter of the budget.
//! Likewise the miss probability, for a negative control, is the chance that a difference as
//! large as observed stays below the critical value of at least one contrast: that of the most
//! significant one.

use serde::{Deserialize, Serialize};

use super::batches::{Batches, Summary};
use super::multiple::holm;
use super::student;

/// More contrasts than these are no pre-registered choice.
pub const MOST_CONTRASTS: usize = 64;
/// With fewer batches, their spread is not known.
pub const FEWEST_BATCHES: usize = 32;
/// With fewer independent contributions, a batch's sum is not nearly normal.
pub const FEWEST_CONTRIBUTIONS: f64 = 1000.0;

/// The expectation of a contrast.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// What it is.
    pub name: String,
    /// Its expectation, not 0.
    pub expected: f64,
    /// Bound of the absolute error of `expected`.
    pub error: f64,
}

/// What is asked of a set of contrasts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Criterion {
    /// Largest relative error that is no defect.
    pub margin: f64,
    /// Confidence of the intervals that must lie within the margin.
    pub confidence: f64,
    /// Level of the tests for a difference, all contrasts together.
    pub level: f64,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finding {
    /// Within the margin, with confidence.
    Equivalent,
    /// Neither within the margin with confidence, nor significantly different.
    Unresolved,
    /// Significantly different from the expectation.
    Different,
}

/// The result for one contrast.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contrast {
    /// What it is.
    pub name: String,
    /// Its expectation.
    pub expected: f64,
    /// Bound of the expectation's error.
    pub expected_error: f64,
    /// Mean over batches.
    pub mean: f64,
    /// Standard error of the mean.
    pub standard_error: f64,
    /// Independent contributions of equal size that would have this error; `None` without noise.
    pub contributions: Option<f64>,
    /// (mean − expected)/standard error.
    pub z: f64,
    /// Confidence interval of the relative error.
    pub interval: [f64; 2],
    /// Two-sided p value of the difference.
    pub p: f64,
    /// After Holm.
    pub adjusted_p: f64,
}

/// The result for all contrasts of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// What was found.
    pub finding: Finding,
    /// One result for each contrast, in their order.
    pub contrasts: Vec<Contrast>,
    /// The smallest p value after Holm.
    pub worst_p: f64,
    /// The interval that reaches farthest from 0.
    pub interval: [f64; 2],
    /// Chance of calling an estimator different though nothing is wrong.
    pub false_alarm: f64,
    /// Chance that a sound estimator of this noise is left unresolved.
    pub unresolved: f64,
    /// Chance of missing a difference of the size that was observed.
    pub miss: f64,
    /// Independent batches.
    pub batches: usize,
    /// Why this may not be judged at all.
    pub unfit: Vec<String>,
}

/// Compares batches with their targets.
pub fn judge(targets: &[Target], batches: &Batches, criterion: &Criterion) -> Judgement {
    let freedom = batches.freedom();
    let critical = student::quantile(0.5 * (1.0 - criterion.confidence), freedom);
    let mut contrasts: Vec<Contrast> = targets
        .iter()
        .enumerate()
        .map(|(k, target)| contrast(target, batches.summary(k), critical, freedom))
        .collect();
    let p: Vec<f64> = contrasts.iter().map(|c| c.p).collect();
    for (contrast, adjusted) in contrasts.iter_mut().zip(holm(&p)) {
        contrast.adjusted_p = adjusted;
    }
    let worst_p = contrasts.iter().map(|c| c.adjusted_p).fold(1.0, f64::min);
    let within = |c: &Contrast| c.interval.iter().all(|end| end.abs() <= criterion.margin);
    let unfit = unfit(&contrasts, batches.len());
    let finding = if worst_p <= criterion.level {
        Finding::Different
    } else if unfit.is_empty() && !contrasts.is_empty() && contrasts.iter().all(within) {
        Finding::Equivalent
    } else {
        Finding::Unresolved
    };
    let reach = |c: &Contrast| c.interval[0].abs().max(c.interval[1].abs());
    let interval = contrasts
        .iter()
        .max_by(|a, b| reach(a).total_cmp(&reach(b)))
        .map_or([0.0, 0.0], |c| c.interval);
    let outside: f64 =
        contrasts.iter().map(|c| leaves_margin(c, criterion, critical, freedom)).sum();
    Judgement {
        finding,
        worst_p,
        interval,
        false_alarm: criterion.level,
        unresolved: outside.min(1.0),
        miss: miss(&contrasts, criterion, freedom),
        batches: batches.len(),
        unfit,
        contrasts,
    }
}

/// What makes the comparison unfit to be judged.
fn unfit(contrasts: &[Contrast], batches: usize) -> Vec<String> {
    let mut reasons = Vec::new();
    if batches < FEWEST_BATCHES {
        reasons.push(format!("{batches} batches, fewer than {FEWEST_BATCHES}"));
    }
    if contrasts.len() > MOST_CONTRASTS {
        reasons.push(format!("{} contrasts, more than {MOST_CONTRASTS}", contrasts.len()));
    }
    let poor = contrasts.iter().filter_map(|c| Some((&c.name, c.contributions?)));
    reasons.extend(
        poor.filter(|(_, count)| *count < FEWEST_CONTRIBUTIONS)
            .map(|(name, count)| format!("\"{name}\" has only {count:.0} contributions")),
    );
    reasons
}

fn contrast(target: &Target, summary: Summary, critical: f64, freedom: f64) -> Contrast {
    let Summary { mean, standard_error } = summary;
    let Target { expected, error, .. } = *target;
    let difference = mean - expected;
    let excess = (difference.abs() - error).max(0.0);
    let size = mean.abs().max(expected.abs()) / standard_error;
    let contributions = (size * size).is_finite().then_some(size * size);
    let p = match (excess, standard_error) {
        _ if difference.is_nan() => 0.0,
        _ if contributions.is_some_and(|count| count < FEWEST_CONTRIBUTIONS) => 1.0,
        (0.0, _) => 1.0,
        (_, 0.0) => 0.0,
        _ => student::two_sided(excess / standard_error, freedom),
    };
    let half_width = critical * standard_error + error;
    let ends =
        [(difference - half_width) / expected.abs(), (difference + half_width) / expected.abs()];
    Contrast {
        name: target.name.clone(),
        expected,
        expected_error: error,
        mean,
        standard_error,
        contributions,
        z: if difference == 0.0 { 0.0 } else { difference / standard_error },
        interval: ends,
        p,
        adjusted_p: p,
    }
}

/// The chance that the interval of an unbiased estimate with this noise leaves the margin.
fn leaves_margin(contrast: &Contrast, criterion: &Criterion, critical: f64, freedom: f64) -> f64 {
    let room = criterion.margin * contrast.expected.abs()
        - contrast.expected_error
        - critical * contrast.standard_error;
    if room <= 0.0 {
        return 1.0;
    }
    if contrast.standard_error == 0.0 {
        return 0.0;
    }
    student::two_sided(room / contrast.standard_error, freedom)
}

/// The chance that the most significant contrast, were its difference as observed, is not seen.
fn miss(contrasts: &[Contrast], criterion: &Criterion, freedom: f64) -> f64 {
    let level = criterion.level / contrasts.len().max(1) as f64;
    let critical = student::quantile(0.5 * level, freedom);
    let fit = |c: &&Contrast| c.contributions.is_none_or(|n| n >= FEWEST_CONTRIBUTIONS);
    let strongest = contrasts.iter().filter(fit).map(|c| {
        let excess = ((c.mean - c.expected).abs() - c.expected_error).max(0.0);
        if excess == 0.0 { 0.0 } else { excess / c.standard_error }
    });
    student::upper_tail(strongest.fold(0.0, f64::max) - critical, freedom)
}

#[cfg(test)]
#[path = "agreement_tests.rs"]
mod tests;
