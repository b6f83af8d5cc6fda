//! A tile of pixels during one pass: where integrators deposit.
//!
//! A tile is a rectangle of pixels with a zeroed f64 buffer of all their cells, and a mark for each
//! block of cells that a deposit reached. Tiles share nothing, so passes run in parallel without
//! atomics, and their division depends on the film and the method's [`Grain`] alone, so that results
//! do not depend on threads.

use std::mem::replace;
use std::ops::Range;

use tpb_optics::Spectrum;

use crate::arrival::Arrival;
use crate::layout::{Clock, Layout};
use crate::profile::{NotFinite, Workspace, instant, spread};

/// Cells that share a mark.
pub(crate) const BLOCK: usize = 16;

/// Cells that share a mark of the second level: marks of 64 blocks.
pub(crate) const GROUP: usize = 64 * BLOCK;

/// Pixels of fewer cells have no second level.
const MANY_CELLS: usize = 4096;

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
    /// (pixel, group of blocks); of use where pixels have [`MANY_CELLS`].
    groups: Vec<u8>,
    /// Blocks of one pixel.
    reached: Vec<u32>,
    stride: usize,
    workspace: Workspace<C>,
}

impl<const C: usize> Default for Scratch<C> {
    fn default() -> Self {
        let workspace = Workspace::default();
        Self {
            cells: Vec::new(),
            marks: Vec::new(),
            groups: Vec::new(),
            reached: Vec::new(),
            stride: 1,
            workspace,
        }
    }
}

impl<const C: usize> Scratch<C> {
    /// Room for so many pixels.
    pub(crate) fn prepare(&mut self, pixels: usize, clock: Option<Clock>) {
        self.stride = clock.map_or(1, |clock| {
            let cells = clock.cells();
            cells.next_multiple_of(if cells > MANY_CELLS { GROUP } else { BLOCK })
        });
        self.cells.resize(pixels * self.stride, Spectrum::ZERO);
        self.marks.clear();
        self.marks.resize(pixels * self.stride.div_ceil(BLOCK), u8::from(!self.marks_cells()));
        self.groups.clear();
        self.groups.resize((pixels * self.stride).div_ceil(GROUP), 0);
    }

    /// Whether deposits mark blocks; else all are marked from the start.
    fn marks_cells(&self) -> bool {
        self.stride > FEW_CELLS
    }

    /// The cells of pixel number `index`, and what of them was reached.
    #[inline]
    pub(crate) fn pixel(&mut self, index: usize) -> Reached<'_, C> {
        let marking = self.marks_cells();
        let Self { cells, marks, groups, reached, stride, .. } = self;
        let blocks = stride.div_ceil(BLOCK);
        let groups = if *stride > MANY_CELLS {
            let count = *stride / GROUP;
            &mut groups[index * count..(index + 1) * count]
        } else {
            &mut []
        };
        Reached {
            cells: &mut cells[index * *stride..(index + 1) * *stride],
            marks: &mut marks[index * blocks..(index + 1) * blocks],
            groups,
            marking,
            blocks: reached,
        }
    }
}

/// What a pass left in one pixel.
pub(crate) struct Reached<'a, const C: usize> {
    pub(crate) cells: &'a mut [Spectrum<C>],
    /// One for each block of cells.
    pub(crate) marks: &'a mut [u8],
    /// One for each 64 of them; empty without a second level.
    pub(crate) groups: &'a mut [u8],
    /// Whether marks say which blocks were reached; else all are visited.
    pub(crate) marking: bool,
    /// Room for a list of them.
    pub(crate) blocks: &'a mut Vec<u32>,
}

impl<const C: usize> Reached<'_, C> {
    /// Lists the blocks that were reached, in their order, and clears all marks.
    pub(crate) fn list(&mut self) {
        self.blocks.clear();
        if self.groups.is_empty() {
            return list_marks(self.marks, 0, self.blocks);
        }
        let marks = self.marks.chunks_exact_mut(GROUP / BLOCK);
        for ((group, marks), number) in self.groups.iter_mut().zip(marks).zip(0..) {
            if replace(group, 0) > 0 {
                list_marks(marks, number * (GROUP / BLOCK) as u32, self.blocks);
            }
        }
    }
}

/// Lists the marks that are set, counted from `first`, and clears them.
fn list_marks(marks: &mut [u8], first: u32, blocks: &mut Vec<u32>) {
    for (eight, first) in marks.chunks_mut(8).zip((first..).step_by(8)) {
        if eight.iter().fold(0, |any, mark| any | mark) == 0 {
            continue;
        }
        for (mark, block) in eight.iter_mut().zip(first..) {
            if replace(mark, 0) > 0 {
                blocks.push(block);
            }
        }
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
    pub(crate) groups: &'a mut [u8],
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
        let Scratch { cells, marks, groups, stride, workspace, .. } = scratch;
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
            groups,
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
                let (from, last) = (first + reached.start, first + reached.end - 1);
                self.marks[from / BLOCK..=last / BLOCK].fill(1);
                self.groups[from / GROUP..=last / GROUP].fill(1);
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
