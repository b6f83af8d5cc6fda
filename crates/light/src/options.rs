//! Options of the light tracer, and how their defaults follow from the film.

use serde::{Deserialize, Serialize};
use tpb_scene::{FilmSpec, Plan};

/// Cells of the film per photon: adding a pass to the statistics costs 1 to 2 ns per cell, a photon
/// with its connections some microseconds.
const CELLS_PER_PHOTON: usize = 16;
/// Passes below this cost more in overhead than in light.
const FEWEST_PHOTONS: u64 = 1 << 14;
/// A pass takes a second or two and some hundred MB by default: error bars need several passes, and
/// a run can only end after a whole one.
const MOST_PHOTONS: u64 = 1 << 18;
/// Memory of a photon's contributions while they are sorted, each seen a dozen times. Measured on
/// cornell-blocks, one channel: 360; three take twice as much.
const PHOTON_BYTES: u64 = 1024;
/// Memory of a default pass: in thick media that absorb little, a photon is seen thousands of times.
const PASS_BYTES: f64 = 1e9;
/// Memory beyond which a pass is refused.
const MOST_BYTES: u64 = 16 << 30;

/// Options of the light tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightOptions {
    /// Photons emitted in a pass. Default: one for every 16 cells (bins, before and after) of the
    /// film, from 16384 to 262144; fewer where photons are seen so often, in a pilot run, that a pass
    /// would take more than 1 GB.
    pub photons_per_pass: Option<u64>,
}

/// All options, defaults filled in: what the report shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Settings {
    /// Photons emitted in a pass; 0 where none can be connected to the eye.
    pub photons_per_pass: u64,
}

/// A number of photons that makes no pass.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("photons_per_pass must be {expected}, not {found}")]
pub struct OptionError {
    /// What would do.
    pub expected: &'static str,
    /// What it is.
    pub found: u64,
}

impl Settings {
    /// Fills in the defaults.
    ///
    /// # Errors
    /// [`OptionError`] for no photons, and for more than fit into 16 GiB.
    pub fn new(film: &FilmSpec, plan: &Plan, options: &LightOptions) -> Result<Self, OptionError> {
        let cells = film.time.map_or(1, |time| time.bins.saturating_add(2));
        let cells = cells.saturating_mul(film.width).saturating_mul(film.height);
        let by_film = (cells / CELLS_PER_PHOTON) as u64;
        let default = by_film.clamp(FEWEST_PHOTONS, MOST_PHOTONS);
        let photons = options.photons_per_pass.unwrap_or(default);
        if photons == 0 {
            return Err(OptionError { expected: "at least 1", found: photons });
        }
        if photons > MOST_BYTES / PHOTON_BYTES {
            let expected = "few enough for 16 GiB (about 1000 bytes each)";
            return Err(OptionError { expected, found: photons });
        }
        Ok(Self { photons_per_pass: if plan.eye_connections { photons } else { 0 } })
    }

    /// Lowers the number of photons until a pass of so many bytes each fits into [`PASS_BYTES`].
    pub(crate) fn fit(&mut self, bytes_per_photon: f64) {
        let most = (PASS_BYTES / bytes_per_photon.max(1.0)) as u64;
        self.photons_per_pass = self.photons_per_pass.min(most.max(1));
    }
}
