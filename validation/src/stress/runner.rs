//! Runs cases, whatever they do: a panic is caught, a case that does not end is given up.
//!
//! Each row runs in a thread of its own with a pool of its own. One that is given up goes on in the
//! background until the program ends; the guard is there so that a table can be written at all.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use tpb_render::with_threads;

use crate::error::{Result, ValidationError};
use crate::stress::case::{Case, Finding, Method, Setup};

/// A row takes seconds; after this long it counts as one that does not end.
pub const GUARD: Duration = Duration::from_mins(5);

/// How a row ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// A right answer, or a clear error.
    Passed,
    /// Neither.
    Failed,
    /// Not run, for a reason.
    LeftOut,
}

/// One row of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// `group/name`.
    pub case: String,
    /// The method; `-` where none takes part.
    pub method: String,
    /// What could break.
    pub risk: String,
    /// What happened.
    pub result: String,
    /// How it ended.
    pub verdict: Verdict,
    /// Chance of calling a sound program wrong.
    pub false_alarm: f64,
    /// Wall time \[s\].
    pub seconds: f64,
}

/// All rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StressResult {
    /// In the order of the cases.
    pub records: Vec<Record>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Wall time \[s\].
    pub seconds: f64,
}

impl StressResult {
    /// How many rows ended so.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.records.iter().filter(|record| record.verdict == verdict).count()
    }

    /// Whether no row failed, and some passed.
    pub fn passed(&self) -> bool {
        self.count(Verdict::Failed) == 0 && self.count(Verdict::Passed) > 0
    }

    /// Sum of the rows' false-alarm probabilities.
    pub fn false_alarm(&self) -> f64 {
        self.records.iter().map(|record| record.false_alarm).sum()
    }
}

/// Runs all rows of all cases, telling `each` record as it is made.
pub fn run_cases(
    cases: &[Case],
    setup: &Setup,
    threads: Option<usize>,
    mut each: impl FnMut(&Record),
) -> StressResult {
    let started = Instant::now();
    let mut records = Vec::new();
    for case in cases {
        let left_out = case.left_out.iter().map(|&(method, reason)| left_out(case, method, reason));
        let run = case.methods.iter().map(|&method| run_row(case, setup, method, threads, GUARD));
        for record in run.chain(left_out) {
            each(&record);
            records.push(record);
        }
    }
    StressResult { records, seed: setup.seed, seconds: started.elapsed().as_secs_f64() }
}

fn left_out(case: &Case, method: Method, reason: &str) -> Record {
    Record {
        case: case.name.clone(),
        method: method.name().to_owned(),
        risk: case.risk.to_owned(),
        result: reason.to_owned(),
        verdict: Verdict::LeftOut,
        false_alarm: 0.0,
        seconds: 0.0,
    }
}

/// Runs one row.
pub(crate) fn run_row(
    case: &Case,
    setup: &Setup,
    method: Option<Method>,
    threads: Option<usize>,
    guard: Duration,
) -> Record {
    let started = Instant::now();
    let finding = guarded(case, setup, method, threads, guard);
    let (verdict, result, false_alarm) = match finding {
        Ok(Finding { passed: true, text, false_alarm }) => (Verdict::Passed, text, false_alarm),
        Ok(Finding { passed: false, text, .. }) => (Verdict::Failed, text, 0.0),
        Err(error) => (Verdict::Failed, chain(&error), 0.0),
    };
    Record {
        case: case.name.clone(),
        method: method.map_or("-", Method::name).to_owned(),
        risk: case.risk.to_owned(),
        result,
        verdict,
        false_alarm,
        seconds: started.elapsed().as_secs_f64(),
    }
}

fn guarded(
    case: &Case,
    setup: &Setup,
    method: Option<Method>,
    threads: Option<usize>,
    guard: Duration,
) -> Result<Finding> {
    let (done, end) = channel();
    let (inner, setup) = (case.clone(), setup.clone());
    let worker = thread::Builder::new()
        .name(case.name.clone())
        .spawn(move || {
            let finding = with_threads(threads, || inner.run(&setup, method));
            // Nobody listens any more if the case was given up.
            let _ = done.send(());
            finding
        })
        .map_err(|error| ValidationError::unusable("a thread", error))?;
    if end.recv_timeout(guard) == Err(RecvTimeoutError::Timeout) {
        let text = format!("did not end within {} s", guard.as_secs_f64());
        return Ok(Finding::exact(false, text));
    }
    match worker.join() {
        Ok(finding) => finding.map_err(|error| ValidationError::unusable("threads", error))?,
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
            Ok(Finding::exact(false, format!("panicked: {}", text.unwrap_or("no message"))))
        }
    }
}

/// An error with its causes, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}
