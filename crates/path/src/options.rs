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
    /// Camera paths per pixel in one pass, stratified over the pixel. Default: a square number
    /// near one path for every 16 cells (bins, before and after) of a pixel, but at least 4, and
    /// fewer where a pass would exceed two million paths.
    pub samples_per_pass: Option<NonZeroU32>,
}

impl PathOptions {
    /// The number of samples, as given or chosen from the film.
    pub fn samples(&self, film: &FilmSpec) -> NonZeroU32 {
        self.samples_per_pass.unwrap_or_else(|| {
            let cells = film.time.map_or(1, |time| time.bins.saturating_add(2));
            let most = PATHS_PER_PASS / film.width.saturating_mul(film.height).max(1);
            let side = cells.div_ceil(CELLS_PER_PATH).min(most).isqrt().max(2.min(most.isqrt()));
            let side = NonZeroU32::new(side as u32).unwrap_or(NonZeroU32::MIN);
            side.saturating_mul(side)
        })
    }
}

/// The grid of sub-pixels, (columns, rows), with exactly `samples` cells and as square as that
/// allows.
pub(crate) fn grid(samples: NonZeroU32) -> (u32, u32) {
    let samples = samples.get();
    let rows = (1..=samples.isqrt()).rev().find(|rows| samples.is_multiple_of(*rows)).unwrap_or(1);
    (samples / rows, rows)
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
        assert_eq!(samples(64, 200), 9);
        assert_eq!(samples(64, 2000), 121);
        assert_eq!(samples(512, 2000), 4);
        assert_eq!(samples(4096, 2000), 1);
        let given = PathOptions { samples_per_pass: NonZeroU32::new(7) };
        assert_eq!(given.samples(&film(64, 200)).get(), 7);
    }

    #[test]
    fn grids_have_one_cell_for_each_sample() {
        for n in 1..200 {
            let (columns, rows) = grid(NonZeroU32::new(n).unwrap());
            assert!(columns * rows == n && columns >= rows);
        }
        assert_eq!(grid(NonZeroU32::new(12).unwrap()), (4, 3));
    }
}
