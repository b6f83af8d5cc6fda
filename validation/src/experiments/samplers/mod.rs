//! Every sampler against its density.
//!
//! Each group is one experiment of several chi-square tests, a million samples each; the p values
//! are corrected by Holm. A rejected test names the sampler.

mod distances;
mod emission;
mod histogram;
mod microfacet;
mod phase;
mod surfaces;
mod warps;

use std::sync::Arc;

use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome, Verdict};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::statistics::{Finding, holm};

pub use histogram::Tested;

/// Random numbers of a group of tests, and a twin's additional power in every warp (1 in sound
/// programs).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Draws {
    seed: u64,
    exponent: f64,
}

/// A group of samplers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Samplers {
    /// Phase functions around several axes.
    Phase,
    /// Directions, discs and triangles.
    Warps,
    /// Free flights, their channels, and equiangular distances.
    Distances,
    /// Points on every kind of primitive.
    Surfaces,
    /// Photons of every kind of emitter.
    Emission,
    /// Normals of microfacets, and directions from rough surfaces.
    Microfacet,
}

/// Each group; the quick suite leaves out the one whose densities take long to integrate.
pub fn all(effort: Effort) -> Experiments {
    let kept = |group: &Samplers| effort == Effort::Full || *group != Samplers::Microfacet;
    Samplers::ALL.into_iter().filter(kept).map(|group| Arc::new(group) as _).collect()
}

impl Samplers {
    /// All groups.
    pub const ALL: [Self; 6] = [
        Self::Phase,
        Self::Warps,
        Self::Distances,
        Self::Surfaces,
        Self::Emission,
        Self::Microfacet,
    ];

    fn tests(self, samples: u64, seed: Draws) -> Result<Vec<Tested>> {
        Ok(match self {
            Self::Phase => phase::tests(samples, seed),
            Self::Warps => warps::tests(samples, seed),
            Self::Distances => distances::tests(samples, seed),
            Self::Surfaces => surfaces::tests(samples, seed),
            Self::Emission => emission::tests(samples, seed)?,
            Self::Microfacet => microfacet::tests(samples, seed),
        })
    }

    fn label(self) -> &'static str {
        match self {
            Self::Phase => "phase",
            Self::Warps => "warps",
            Self::Distances => "distances",
            Self::Surfaces => "surfaces",
            Self::Emission => "emission",
            Self::Microfacet => "microfacet",
        }
    }
}

impl Experiment for Samplers {
    fn name(&self) -> String {
        format!("samplers/{}", self.label())
    }

    fn description(&self) -> String {
        let what = match self {
            Self::Phase => "phase functions, in angle and around three axes",
            Self::Warps => "directions, discs, triangles",
            Self::Distances => "free flights, channel choice, equiangular distances",
            Self::Surfaces => "points on every primitive",
            Self::Emission => "positions, directions and weights of every emitter",
            Self::Microfacet => "visible normals, directions from rough metal and glass",
        };
        format!("{what}: chi-square against the density")
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        let tried = effort == Effort::Full || *self == Self::Distances;
        if tried { vec![Sabotage::WARP] } else { vec![] }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let samples = context.effort.pick(1_000_000, 20_000_000);
        let exponent = if let Some(Sabotage::Warp(power)) = context.sabotage { power } else { 1.0 };
        let tests = self.tests(samples, Draws { seed: context.seed, exponent })?;
        let p: Vec<f64> = tests.iter().map(|test| test.p).collect();
        let adjusted = holm(&p);
        let worst_p = adjusted.iter().copied().fold(1.0, f64::min);
        let failed = tests.iter().zip(&adjusted).filter(|(_, p)| **p <= context.level);
        let mut notes = vec![format!("{} tests of {samples} samples", tests.len())];
        notes.extend(
            failed.map(|(test, _)| format!("{}: {} (p = {:.1e})", test.name, test.detail, test.p)),
        );
        let mut outcome = Outcome::exact(worst_p > context.level, notes);
        debug_assert!(
            (outcome.verdict == Verdict::Passed) == (outcome.finding == Finding::Equivalent)
        );
        outcome.worst_p = Some(worst_p);
        outcome.false_alarm = context.level;
        Ok(outcome)
    }
}

/// A right-handed basis around `z`, built apart from the programs' own.
fn axes(z: glam::DVec3) -> [glam::DVec3; 3] {
    let helper = if z.x.abs() < 0.6 { glam::DVec3::X } else { glam::DVec3::Y };
    let x = helper.cross(z).normalize();
    [x, z.cross(x), z]
}

/// Cosine to, and azimuth around, the last of three axes.
fn polar(direction: glam::DVec3, [x, y, z]: [glam::DVec3; 3]) -> [f64; 2] {
    [direction.dot(z).clamp(-1.0, 1.0), direction.dot(y).atan2(direction.dot(x))]
}

/// The direction with this cosine and azimuth in the world's axes.
fn world(cosine: f64, azimuth: f64) -> glam::DVec3 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    glam::DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine)
}
