//! The pass loop, written once for every method.
//!
//! A run is a sequence of passes with consecutive indices into one film. What it computes depends
//! on (method, seed, first pass, number of passes) alone; the clock and the interrupt decide only
//! *how many* passes there are, and threads only how fast they are.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tpb_film::{Arrays, Ledger, TransientFilm};

use crate::{Budget, Counts, Method, PassId, PassReport, RenderError, Stopwatch};

/// Which passes a run makes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RunSettings {
    /// Seed of all random numbers.
    pub seed: u64,
    /// How long to go on.
    pub budget: Budget,
    /// Index of the first pass: 0, or where another run or machine leaves off.
    pub first_pass: u64,
}

/// Who watches a run and may end it. `()` does neither; an [`AtomicBool`] ends it once it is true.
pub trait Control {
    /// Asked after each pass: whether the run should end here.
    fn interrupted(&self) -> bool {
        false
    }

    /// Told after each pass; `steady` develops the steady image so far ([`TransientFilm::develop_steady`]).
    fn progress(&mut self, _progress: &Progress, _steady: &dyn Fn() -> Arrays) {}
}

impl Control for () {}

impl Control for &AtomicBool {
    fn interrupted(&self) -> bool {
        self.load(Ordering::Relaxed)
    }
}

/// Where a run stands after a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Passes made by this run.
    pub passes: u64,
    /// Wall time since the stopwatch was started.
    pub elapsed: Duration,
    /// Expected to be left.
    pub remaining: Duration,
    /// [`TransientFilm::relative_error`].
    pub relative_error: Option<f64>,
}

/// What a run did.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSummary {
    /// Passes made.
    pub passes: u64,
    /// Wall time from the stopwatch's start to the end of the last pass \[s\].
    pub wall_seconds: f64,
    /// CPU time of the process over the same time \[s\]; `None` where the system does not tell.
    pub cpu_seconds: Option<f64>,
    /// The part of the wall time that went before the first pass: preparation of the method \[s\].
    pub setup_seconds: f64,
    /// Work of all passes.
    pub counts: Counts,
    /// Where the light or the importance of a pass went.
    pub ledger: LedgerRecord,
    /// [`TransientFilm::relative_error`] at the end, from two passes on.
    pub relative_error: Option<f64>,
    /// The same after 2, 4, 8, … passes.
    pub history: Vec<Milestone>,
    /// Whether it was asked to end before its budget was used up.
    pub interrupted: bool,
}

/// Where the light or the importance of a pass went, on average over the passes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LedgerRecord {
    /// What it balances, with the unit: [`Method::carrier`].
    pub carrier: String,
    /// The balance.
    pub mean_of_a_pass: Ledger,
}

/// A point of a run's convergence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Milestone {
    /// Passes made.
    pub passes: u64,
    /// Wall time so far \[s\].
    pub wall_seconds: f64,
    /// [`TransientFilm::relative_error`].
    pub relative_error: f64,
}

/// Adds passes of `method` to `film` until the budget is used up or `control` interrupts.
/// `started` is the stopwatch that was started before the method was prepared; what it shows now
/// is the setup, and counts towards a time budget.
///
/// To start passes from within a pool of threads of a certain size, see [`with_threads`].
pub fn run<const C: usize>(
    method: &dyn Method<C>,
    film: &mut TransientFilm<C>,
    settings: &RunSettings,
    started: &Stopwatch,
    control: &mut dyn Control,
) -> RunSummary {
    let setup = started.wall();
    let mut summary = RunSummary { setup_seconds: setup.as_secs_f64(), ..RunSummary::default() };
    let mut total = PassReport::default();
    let (mut elapsed, mut mean) = (setup, Duration::ZERO);
    while settings.budget.allows_another(summary.passes, elapsed, mean) {
        if summary.passes > 0 && control.interrupted() {
            summary.interrupted = true;
            break;
        }
        let index = settings.first_pass.wrapping_add(summary.passes);
        let report = method.pass(PassId { seed: settings.seed, index }, film);
        total.add(&report);
        summary.passes += 1;
        elapsed = started.wall();
        mean = elapsed.saturating_sub(setup).div_f64(summary.passes as f64);
        summary.relative_error = film.relative_error();
        summary.remember(elapsed);
        let progress = Progress {
            passes: summary.passes,
            elapsed,
            remaining: settings.budget.remaining(summary.passes, elapsed, mean),
            relative_error: summary.relative_error,
        };
        control.progress(&progress, &|| film.develop_steady());
    }
    summary.counts = total.counts;
    let mean_of_a_pass = total.ledger.mean(summary.passes);
    summary.ledger = LedgerRecord { carrier: method.carrier().to_owned(), mean_of_a_pass };
    summary.wall_seconds = elapsed.as_secs_f64();
    summary.cpu_seconds = started.cpu().map(|cpu| cpu.as_secs_f64());
    summary
}

impl RunSummary {
    fn remember(&mut self, elapsed: Duration) {
        let Some(relative_error) = self.relative_error else { return };
        if self.passes.is_power_of_two() && relative_error.is_finite() {
            let (passes, wall_seconds) = (self.passes, elapsed.as_secs_f64());
            self.history.push(Milestone { passes, wall_seconds, relative_error });
        }
    }

    /// A count of work per second of passes, setup excluded.
    pub fn per_second(&self, count: u64) -> f64 {
        let seconds = self.wall_seconds - self.setup_seconds;
        if seconds > 0.0 { count as f64 / seconds } else { 0.0 }
    }
}

/// Calls `work` in a pool of `threads` threads (`None`: as many as the machine has). What work
/// computes must not depend on it; all methods see to that.
///
/// # Errors
/// [`RenderError::Threads`] if the system does not give that many.
pub fn with_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, RenderError> {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    let pool = builder.build().map_err(|e| RenderError::Threads(e.to_string()))?;
    Ok(pool.install(work))
}
