//! Options of the path tracer, and how their defaults follow from the film.

use std::num::NonZeroU32;

use serde::{Deserialize, Serialize};
use tpb_scene::FilmSpec;

/// Cells of a pixel per camera path. Adding a pass to the statistics costs 1 to 2 ns per cell, a
/// path 1 to 3 µs: with a path for every 16 cells the statistics take about 1 % of a pass.
const CELLS_PER_PATH: usize = 16;

/// A pass has at most this many paths (a few seconds of work), if that is one for each pixel: error
/// bars need several passes, and a run can only end after a whole pass.
const PATHS_PER_PASS: usize = 1 << 21;

/// Options of the path tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PathOptions {
    /// Camera paths per pixel in one pass, whose first numbers are spread evenly (best where this is a
    /// power of two). Default: the first power of two with one path for every 16 cells (bins, before and
    /// after) of a pixel, but at least 4, and fewer where a pass would exceed two million paths.
    pub samples_per_pass: Option<NonZeroU32>,
}

impl PathOptions {
    /// The number of samples, as given or chosen from the film.
    pub fn samples(&self, film: &FilmSpec) -> NonZeroU32 {
        self.samples_per_pass.unwrap_or_else(|| {
            let cells = film.time.map_or(1, |time| time.bins.saturating_add(2));
            let most = PATHS_PER_PASS / film.width.saturating_mul(film.height).max(1);
            let wanted = cells.div_ceil(CELLS_PER_PATH).max(4).checked_next_power_of_two();
            // The last power of two that is not above `most`.
            let samples = wanted.unwrap_or(most).min(1 << most.max(1).ilog2());
            NonZeroU32::new(samples as u32).unwrap_or(NonZeroU32::MIN)
        })
    }
}

#[cfg(test)]
mod tests {
    use tpb_scene::{PixelFormat, TimeSpec};

    use super::*;

    fn film(width: usize, bins: usize) -> FilmSpec {
        let time = TimeSpec { start_opl: 0.0, bin_width_opl: 1.0, bins };
        FilmSpec {
            width,
            height: width,
            pixel_format: PixelFormat::Luminance,
            time: Some(time).filter(|_| bins > 0),
        }
    }

    #[test]
    fn samples_grow_with_the_bins_and_a_pass_stays_short() {
        let samples = |width, bins| PathOptions::default().samples(&film(width, bins)).get();
        assert_eq!(samples(64, 0), 4);
        assert_eq!(samples(64, 200), 16);
        assert_eq!(samples(64, 2000), 128);
        assert_eq!(samples(512, 2000), 8);
        assert_eq!(samples(512, usize::MAX), 8);
        assert_eq!(samples(4096, 2000), 1);
        let given = PathOptions { samples_per_pass: NonZeroU32::new(7) };
        assert_eq!(given.samples(&film(64, 200)).get(), 7);
    }
}
