//! Wall and CPU time of a run.
//!
//! A stopwatch is started *before* a method is prepared, so that preparation counts in equal-time
//! comparisons. CPU time is that of the whole process: of all threads, and of whatever else the
//! process does meanwhile.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;

/// Measures from the moment it was started.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    wall: Instant,
    cpu: Option<ProcessTime>,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self { wall: Instant::now(), cpu: ProcessTime::try_now().ok() }
    }

    /// Wall time so far.
    pub fn wall(&self) -> Duration {
        self.wall.elapsed()
    }

    /// CPU time of the process so far; `None` where the system does not tell.
    pub fn cpu(&self) -> Option<Duration> {
        self.cpu?.try_elapsed().ok()
    }
}
