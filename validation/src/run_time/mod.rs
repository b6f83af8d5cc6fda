//! Error against run time: how fast a method's error falls.
//!
//! Each method renders n independent replicates, in turn with the others, so that whatever else the
//! machine does meets all alike. A replicate is one run with checkpoints after 1, 2, 4, … passes:
//! the film is read there, off the clock. The first replicate goes on while the next checkpoint is
//! expected within the time that a run is given; the others repeat its numbers of passes, so that a
//! checkpoint compares equal work, and all but the seconds repeats to the bit.
//!
//! At each checkpoint the error over the judged pixels is split over replicates
//! ([`crate::statistics::split`]): NMSE = variance + squared bias, with intervals that hold the
//! reference's own noise. *Inverse efficiency* is variance · CPU seconds: constant where variance
//! falls as 1/time. Preparation of the method counts; it is shown apart.
//!
//! The slope of ln error over ln CPU seconds is fitted to the checkpoints at which the error is
//! resolved: −1 for independent samples without bias, −4/5 in the long run for beams
//! whose radius shrinks at its best rate, 0 once a bias that does not shrink is all that is left.

mod draw;
pub(crate) mod measure;
mod slope;
mod table;

use std::time::Duration;

use serde::{Deserialize, Serialize};
use tpb_scene::Scene;

use crate::measure::Estimator;
use crate::reference_cube::{Provenance, ReferenceCube};
use crate::statistics::split::Estimate;
use crate::suite::Circumstances;

pub use draw::Clock;

/// Confidence of all intervals.
pub const CONFIDENCE: f64 = 0.95;

/// What to measure.
pub struct RunTimePlan<'a> {
    /// Name of the scene.
    pub name: String,
    /// The scene.
    pub scene: &'a Scene,
    /// Its reference.
    pub reference: &'a ReferenceCube,
    /// The methods.
    pub methods: Vec<Estimator>,
    /// Wall time of a run.
    pub time: Duration,
    /// Runs of each method, at least 3.
    pub replicates: u64,
    /// Seed: each run has one of its own ([`tpb_optics::seed_of`]).
    pub seed: u64,
    /// Where and how it is measured; noted, not used.
    pub circumstances: Circumstances,
    /// Methods that are not among them, each with the reason; noted, not used.
    pub left_out: Vec<String>,
}

/// Errors of all methods on one scene against run time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorAgainstTime {
    /// Name of the scene.
    pub scene: String,
    /// What errors are measured from.
    pub reference: Provenance,
    /// NMSE of the reference itself, from its own variance.
    pub reference_nmse: f64,
    /// Pixels that are judged, and all.
    pub pixels: [usize; 2],
    /// Replicates of each method.
    pub replicates: u64,
    /// Seed of the first.
    pub seed: u64,
    /// Threads that the methods ran on.
    pub threads: usize,
    /// Where and how it was measured, for readers.
    #[serde(default)]
    pub circumstances: Circumstances,
    /// Methods that were left out, each with the reason.
    #[serde(default)]
    pub left_out: Vec<String>,
    /// One for each method.
    pub curves: Vec<Curve>,
}

/// The error of one method against run time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the method.
    pub method: String,
    /// Its effective options.
    pub options: serde_json::Value,
    /// Wall time of its preparation, counted in all others, mean over replicates \[s\].
    pub setup_seconds: f64,
    /// In the order of time.
    pub checkpoints: Vec<Checkpoint>,
    /// d ln NMSE/d ln CPU seconds, where two checkpoints at least are resolved.
    pub slope: Option<Estimate>,
    /// The same of the variance alone.
    pub variance_slope: Option<Estimate>,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Passes made.
    pub passes: u64,
    /// Wall time since the start, mean over replicates \[s\].
    pub wall_seconds: f64,
    /// CPU time of the process since the start, mean over replicates \[s\].
    pub cpu_seconds: f64,
    /// Root of the mean squared error of a cell \[W m⁻² sr⁻¹\].
    pub rmse: Estimate,
    /// Normalised mean squared error.
    pub nmse: Estimate,
    /// Its part that is variance.
    pub variance: Estimate,
    /// Its part that is squared bias; negative by chance where there is little.
    pub squared_bias: Estimate,
    /// Variance times CPU seconds \[s\].
    pub inverse_efficiency: Estimate,
}

#[cfg(test)]
mod tests;
