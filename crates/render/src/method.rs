//! What a rendering method is.
//!
//! A pass is a pure function of (scene, plan, options, seed, pass index): a method holds the first
//! three, a [`PassId`] the rest. Radius and photon count of a pass come from scene, film and pass
//! index, never from the clock.

use serde::{Deserialize, Serialize};
use tpb_film::{Ledger, TransientFilm};

/// Which pass of which run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassId {
    /// Seed of the run.
    pub seed: u64,
    /// Index of the pass, from 0.
    pub index: u64,
}

/// A rendering method on `C` transported channels.
pub trait Method<const C: usize>: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// Its effective options, defaults filled in, as they go into the report.
    fn options(&self) -> serde_json::Value;

    /// What its ledger balances, with the unit.
    fn carrier(&self) -> &'static str {
        "light [W]"
    }

    /// Adds one pass — one independent, complete estimate of the image — to the film, with exactly
    /// one call of [`TransientFilm::add_pass`].
    fn pass(&self, id: PassId, film: &mut TransientFilm<C>) -> PassReport;
}

/// What happened in a pass, or summed over passes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassReport {
    /// Where the method's carrier went, see [`Method::carrier`].
    pub ledger: Ledger,
    /// How much work was done.
    pub counts: Counts,
}

/// Work done; what a method does not do stays 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Camera paths or camera rays started.
    pub camera_paths: u64,
    /// Photons emitted.
    pub photon_paths: u64,
    /// Beams stored.
    pub beams: u64,
    /// Surface photons stored.
    pub surface_photons: u64,
    /// Photons' vertices whose connection to the eye was tried.
    #[serde(default)]
    pub connections: u64,
    /// Ray-beam pairs tested.
    pub pairs_tested: u64,
    /// Ray-beam pairs that contributed.
    pub pairs_accepted: u64,
}

impl PassReport {
    /// Adds another pass.
    pub fn add(&mut self, other: &Self) {
        self.ledger.add(&other.ledger);
        self.counts.add(&other.counts);
    }
}

impl Counts {
    /// Adds other work.
    pub fn add(&mut self, other: &Self) {
        self.camera_paths += other.camera_paths;
        self.photon_paths += other.photon_paths;
        self.beams += other.beams;
        self.surface_photons += other.surface_photons;
        self.connections += other.connections;
        self.pairs_tested += other.pairs_tested;
        self.pairs_accepted += other.pairs_accepted;
    }
}
