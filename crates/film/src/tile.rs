//! A tile of pixels during one pass: where integrators deposit.
//!
//! A tile is a rectangle of pixels with a zeroed f64 buffer of all their cells. Tiles share nothing,
//! so passes run in parallel without atomics, and their division depends on the film and the
//! method's [`Grain`] alone, so that results do not depend on threads.

use std::ops::Range;

use tpb_optics::Spectrum;

use crate::arrival::Arrival;
use crate::layout::{Clock, Layout};
use crate::profile::{Workspace, instant, spread};

/// Pixels along a tile's edge at most.
const MOST_PIXELS: usize = 64;

/// How much of the image a method works on at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grain {
    /// Few pixels: pixels share no work.
    Fine,
    /// Many: what is done once for a tile is dear.
    Coarse,
}

impl Grain {
    /// Scratch of one tile stays within this many bytes, if a pixel does.
    fn scratch_bytes(self) -> usize {
        match self {
            Self::Fine => 256 << 10,
            Self::Coarse => 8 << 20,
        }
    }

    /// A pass has at least this many tiles, if it has as many pixels: enough for any thread count.
    fn least_tiles(self) -> usize {
        match self {
            Self::Fine => 1024,
            Self::Coarse => 8,
        }
    }

    /// Pixels along a tile's edge.
    pub(crate) fn edge(self, layout: &Layout, bytes_per_pixel: usize) -> usize {
        let fitting = self.scratch_bytes() / bytes_per_pixel.max(1);
        let pixels = fitting.min(layout.pixels() / self.least_tiles());
        pixels.isqrt().clamp(1, MOST_PIXELS)
    }
}

/// A rectangle of pixels of one pass, open for deposits.
pub struct Tile<'a, const C: usize> {
    columns: Range<usize>,
    rows: Range<usize>,
    /// Of the film.
    width: usize,
    pub(crate) clock: Option<Clock>,
    pub(crate) unwarp: bool,
    pub(crate) cells_per_pixel: usize,
    pub(crate) cells: &'a mut [Spectrum<C>],
    workspace: &'a mut Workspace<C>,
    non_finite: u64,
}

impl<'a, const C: usize> Tile<'a, C> {
    /// `cells` are those of the pixels in `columns` and `rows` of a film of `width` columns, row by
    /// row, all zero.
    pub(crate) fn new(
        (columns, rows): (Range<usize>, Range<usize>),
        width: usize,
        clock: Option<Clock>,
        unwarp: bool,
        cells: &'a mut [Spectrum<C>],
        workspace: &'a mut Workspace<C>,
    ) -> Self {
        let cells_per_pixel = clock.map_or(1, |clock| clock.cells());
        Self {
            columns,
            rows,
            width,
            clock,
            unwarp,
            cells_per_pixel,
            cells,
            workspace,
            non_finite: 0,
        }
    }

    /// The columns of the film that it covers.
    #[inline]
    pub fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// The rows of the film that it covers; row 0 is at the top.
    #[inline]
    pub fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    /// The pixels of this tile, row by row: indices `y · width + x` into the film.
    #[inline]
    pub fn pixels(&self) -> impl Iterator<Item = usize> + use<C> {
        let (columns, width) = (self.columns(), self.width);
        self.rows().flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// Contributions of this tile that were not finite and were kept out.
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
    /// If `pixel` is not one of [`Tile::pixels`].
    #[inline]
    pub fn deposit(
        &mut self,
        pixel: usize,
        unwarp_opl: f64,
        arrival: &Arrival<'_, C>,
        energy: Spectrum<C>,
    ) {
        self.deposit_at(self.place(pixel), unwarp_opl, arrival, energy);
    }

    /// [`Tile::deposit`] at the pixel that comes at `place` in [`Tile::pixels`].
    ///
    /// # Panics
    /// If there is no such pixel.
    #[inline]
    pub fn deposit_at(
        &mut self,
        place: usize,
        unwarp_opl: f64,
        arrival: &Arrival<'_, C>,
        energy: Spectrum<C>,
    ) {
        if !energy.is_finite() {
            self.non_finite += 1;
            return;
        }
        let first = place * self.cells_per_pixel;
        let cells = &mut self.cells[first..first + self.cells_per_pixel];
        let Some(clock) = &self.clock else {
            cells[0] += energy;
            return;
        };
        let shift = if self.unwarp { unwarp_opl } else { 0.0 };
        let added = match arrival {
            Arrival::Instant(opl) => instant(opl - shift, energy, clock, cells),
            Arrival::Profile(profile) => {
                spread(profile, energy, shift, clock, cells, self.workspace)
            }
        };
        self.non_finite += u64::from(added.is_err());
    }

    /// Whether times are counted from the first surface that is not null.
    #[inline]
    pub fn unwarps(&self) -> bool {
        self.unwarp
    }

    /// Which of the tile's pixels this is, row by row.
    #[inline]
    fn place(&self, pixel: usize) -> usize {
        let (x, y) = (pixel % self.width, pixel / self.width);
        assert!(self.columns.contains(&x) && self.rows.contains(&y), "a deposit outside its tile");
        (y - self.rows.start) * self.columns.len() + x - self.columns.start
    }
}
