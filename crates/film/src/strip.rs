//! A strip of pixels during one pass: where integrators deposit.
//!
//! A strip is a run of consecutive pixels (index `y · width + x`, row 0 at the top) with a zeroed
//! f64 buffer of all their cells. Strips share nothing, so passes run in parallel without atomics,
//! and their division depends on the film alone, so that results do not depend on threads.

use std::ops::Range;

use tpb_optics::Spectrum;

use crate::arrival::Arrival;
use crate::layout::{Clock, Layout};
use crate::profile::{Workspace, instant, spread};

/// Scratch of one strip stays within this many bytes, if a pixel does.
const SCRATCH_BYTES: usize = 256 * 1024;

/// A pass has at least this many strips, if it has as many pixels: enough for any thread count.
const MIN_STRIPS: usize = 1024;

/// Pixels per strip.
pub(crate) fn strip_pixels(layout: &Layout, bytes_per_pixel: usize) -> usize {
    let fitting = SCRATCH_BYTES / bytes_per_pixel.max(1);
    fitting.min(layout.pixels() / MIN_STRIPS).max(1)
}

/// Consecutive pixels of one pass, open for deposits.
pub struct Strip<'a, const C: usize> {
    pixels: Range<usize>,
    clock: Option<Clock>,
    unwarp: bool,
    cells_per_pixel: usize,
    cells: &'a mut [Spectrum<C>],
    workspace: &'a mut Workspace<C>,
    non_finite: u64,
}

impl<'a, const C: usize> Strip<'a, C> {
    /// `cells` are those of `pixels`, all zero.
    pub(crate) fn new(
        pixels: Range<usize>,
        clock: Option<Clock>,
        unwarp: bool,
        cells: &'a mut [Spectrum<C>],
        workspace: &'a mut Workspace<C>,
    ) -> Self {
        let cells_per_pixel = clock.map_or(1, |clock| clock.cells());
        Self { pixels, clock, unwarp, cells_per_pixel, cells, workspace, non_finite: 0 }
    }

    /// The pixels of this strip: indices `y · width + x`, row 0 at the top.
    #[inline]
    pub fn pixels(&self) -> Range<usize> {
        self.pixels.clone()
    }

    /// Contributions of this strip that were not finite and were kept out.
    #[inline]
    pub fn non_finite(&self) -> u64 {
        self.non_finite
    }

    /// Adds `energy` (time-integrated radiance \[W m^-2 sr^-1\]) that arrives at `pixel` as
    /// `arrival` says. `unwarp_opl` \[m\] is the OPL from the eye to the first surface of this
    /// camera ray that is not null (0 where there is none): an unwarping film subtracts it from
    /// all times. A contribution whose energy or times are not finite is counted and kept out;
    /// a film without a time axis does not look at times.
    ///
    /// # Panics
    /// If `pixel` is not one of [`Strip::pixels`].
    #[inline]
    pub fn deposit(
        &mut self,
        pixel: usize,
        unwarp_opl: f64,
        arrival: &Arrival<'_, C>,
        energy: Spectrum<C>,
    ) {
        assert!(self.pixels.contains(&pixel), "a deposit outside its strip");
        if !energy.is_finite() {
            self.non_finite += 1;
            return;
        }
        let first = (pixel - self.pixels.start) * self.cells_per_pixel;
        let Some(clock) = &self.clock else {
            self.cells[first] += energy;
            return;
        };
        let shift = if self.unwarp { unwarp_opl } else { 0.0 };
        let cells = &mut self.cells[first..first + self.cells_per_pixel];
        let added = match arrival {
            Arrival::Instant(opl) => instant(opl - shift, energy, clock, cells),
            Arrival::Profile(profile) => {
                spread(profile, energy, shift, clock, cells, self.workspace)
            }
        };
        self.non_finite += u64::from(added.is_err());
    }
}
