//! A tile of pixels during one pass: where integrators deposit.
//!
//! A tile is a rectangle of pixels with a zeroed f64 buffer of all their cells, and a mark for each
//! block of cells that a deposit reached. Tiles share nothing, so passes run in parallel without
//! atomics, and their division depends on the film and the method's [`Grain`] alone, so that results
//! do not depend on threads.

use std::ops::Range;

use tpb_optics::Spectrum;

use crate::arrival::Arrival;
use crate::layout::{Clock, Layout};
use crate::profile::{NotFinite, Workspace, instant, spread};

/// Cells that share a mark.
pub(crate) const BLOCK: usize = 16;

/// Pixels of fewer cells are visited whole: finding out which of them were reached is dearer.
const FEW_CELLS: usize = 512;

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
    /// Scratch of one tile stays within this many bytes, if a pixel does; of coarse tiles on a film of
    /// `film` bytes, within a part of them.
    fn scratch_bytes(self, film: usize) -> usize {
        match self {
            Self::Fine => 256 << 10,
            Self::Coarse => (8 << 20).max(film / 64),
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
        let film = layout.pixels().saturating_mul(bytes_per_pixel) / 2;
        let fitting = self.scratch_bytes(film) / bytes_per_pixel.max(1);
        let pixels = fitting.min(layout.pixels() / self.least_tiles());
        pixels.isqrt().clamp(1, MOST_PIXELS)
    }
}

/// The cells of a tile, kept from tile to tile and from pass to pass; all zero in between.
pub(crate) struct Scratch<const C: usize> {
    /// (pixel, cell), `stride` cells per pixel.
    cells: Vec<Spectrum<C>>,
    /// (pixel, block); not used without a time axis.
    marks: Vec<u8>,
    stride: usize,
    workspace: Workspace<C>,
}

impl<const C: usize> Default for Scratch<C> {
    fn default() -> Self {
        let workspace = Workspace::default();
        Self { cells: Vec::new(), marks: Vec::new(), stride: 1, workspace }
    }
}

impl<const C: usize> Scratch<C> {
    /// Room for so many pixels.
    pub(crate) fn prepare(&mut self, pixels: usize, clock: Option<Clock>) {
        self.stride = clock.map_or(1, |clock| clock.cells().next_multiple_of(BLOCK));
        self.cells.resize(pixels * self.stride, Spectrum::ZERO);
        self.marks.clear();
        self.marks.resize(pixels * self.stride.div_ceil(BLOCK), u8::from(!self.marks_cells()));
    }

    /// Whether deposits mark blocks; else all are marked from the start.
    fn marks_cells(&self) -> bool {
        self.stride > FEW_CELLS
    }

    /// Cells and marks of each pixel.
    pub(crate) fn pixels(&mut self) -> impl Iterator<Item = (&mut [Spectrum<C>], &mut [u8])> {
        let cells = self.cells.chunks_exact_mut(self.stride);
        cells.zip(self.marks.chunks_exact_mut(self.stride.div_ceil(BLOCK)))
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
    pub(crate) marks: &'a mut [u8],
    /// Whether deposits have to mark what they reach.
    pub(crate) marking: bool,
    workspace: &'a mut Workspace<C>,
    non_finite: u64,
}

impl<'a, const C: usize> Tile<'a, C> {
    /// `scratch` is [prepared](Scratch::prepare) for the pixels in `columns` and `rows` of a film of
    /// `width` columns.
    pub(crate) fn new(
        (columns, rows): (Range<usize>, Range<usize>),
        width: usize,
        clock: Option<Clock>,
        unwarp: bool,
        scratch: &'a mut Scratch<C>,
    ) -> Self {
        let marking = scratch.marks_cells();
        let Scratch { cells, marks, stride, workspace } = scratch;
        let cells_per_pixel = *stride;
        Self {
            columns,
            rows,
            width,
            clock,
            unwarp,
            cells_per_pixel,
            cells,
            marks,
            marking,
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
        let Some(clock) = &self.clock else {
            self.cells[first] += energy;
            return;
        };
        let cells = &mut self.cells[first..first + clock.cells()];
        let shift = if self.unwarp { unwarp_opl } else { 0.0 };
        let added = match arrival {
            Arrival::Instant(opl) => instant(opl - shift, energy, clock, cells),
            Arrival::Profile(profile) => {
                spread(profile, energy, shift, clock, cells, self.workspace)
            }
        };
        match added {
            Ok(_) if !self.marking => {}
            Ok(reached) => {
                let blocks = (first + reached.start) / BLOCK..=(first + reached.end - 1) / BLOCK;
                self.marks[blocks].fill(1);
            }
            Err(NotFinite) => self.non_finite += 1,
        }
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
