//! How a pass enters the statistics of a tile's pixels.
//!
//! Where pixels have many cells, only those that were reached are visited: deposits mark blocks of
//! [`BLOCK`] cells in the scratch, and groups of 64 of them where there are very many. Sums of such
//! films are in no cache: all that a pixel's pass reached are touched first, one independent read each, so
//! that the machine waits for memory once and not once for each. So a pass of few samples on a film
//! of very many bins hardly pays for its bins. The scratch is cleared on the way.

use std::hint::black_box;
use std::mem::replace;
use std::ops::Range;

use tpb_optics::Spectrum;

use crate::stats::{Pass, add_to_moments};
use crate::tile::{BLOCK, Reached, Scratch};

/// Statistics of some pixels, one after the other; what is not kept is empty.
pub(crate) struct Statistics<'a> {
    /// Number of the first sum in the film.
    pub(crate) first: usize,
    /// (pixel, bin, channel).
    pub(crate) sums: &'a mut [f32],
    /// Squared deviations, like sums.
    pub(crate) squares: &'a mut [f32],
    /// (pixel, block): the pass that last reached it, 0 for none; kept with squares.
    pub(crate) reached: &'a mut [u32],
    /// Sums before and after, (pixel, 2, channel), if they are kept.
    pub(crate) outside: &'a mut [f64],
    /// (pixel, channel).
    pub(crate) steady_mean: &'a mut [f64],
    pub(crate) steady_squares: &'a mut [f64],
}

/// Values of each kind per pixel.
#[derive(Clone, Copy)]
pub(crate) struct Sizes {
    pub(crate) sums: usize,
    pub(crate) squares: usize,
    pub(crate) reached: usize,
    pub(crate) outside: usize,
    pub(crate) steady: usize,
}

/// The statistics of one tile.
pub(crate) struct Part<'a> {
    pub(crate) columns: Range<usize>,
    pub(crate) rows: Range<usize>,
    /// Row by row.
    pub(crate) statistics: Vec<Statistics<'a>>,
}

impl<'a> Statistics<'a> {
    /// Takes the first pixels off.
    pub(crate) fn split_off(&mut self, pixels: usize, sizes: Sizes) -> Statistics<'a> {
        let first = self.first;
        self.first += pixels * sizes.sums;
        let cover = "tiles cover the film";
        Statistics {
            first,
            sums: self.sums.split_off_mut(..pixels * sizes.sums).expect(cover),
            squares: self.squares.split_off_mut(..pixels * sizes.squares).expect(cover),
            reached: self.reached.split_off_mut(..pixels * sizes.reached).expect(cover),
            outside: self.outside.split_off_mut(..pixels * sizes.outside).expect(cover),
            steady_mean: self.steady_mean.split_off_mut(..pixels * sizes.steady).expect(cover),
            steady_squares: self
                .steady_squares
                .split_off_mut(..pixels * sizes.steady)
                .expect(cover),
        }
    }
}

impl Part<'_> {
    /// Adds a pass from the scratch; `keep` makes the kept channels of a cell.
    pub(crate) fn add<const C: usize, const K: usize>(
        self,
        scratch: &mut Scratch<C>,
        sizes: Sizes,
        keep: impl Fn(&Spectrum<C>) -> [f64; K] + Copy,
        pass: Pass,
    ) {
        let pixels = self.columns.len();
        let rows = self.statistics.into_iter();
        let all = rows.flat_map(|mut row| (0..pixels).map(move |_| row.split_off(1, sizes)));
        for (index, mut pixel) in all.enumerate() {
            let reached = scratch.pixel(index);
            let sum = if sizes.sums == 0 {
                keep(&replace(&mut reached.cells[0], Spectrum::ZERO))
            } else {
                pixel.add(reached, keep, pass)
            };
            let mean = pixel.steady_mean.as_chunks_mut().0;
            let squares = pixel.steady_squares.as_chunks_mut().0;
            add_to_moments(&mut mean[0], &mut squares[0], sum, pass.number());
        }
    }
}

impl Statistics<'_> {
    /// Adds a pass to the cells of one pixel; returns its sum over cells.
    fn add<const C: usize, const K: usize>(
        &mut self,
        mut reached: Reached<'_, C>,
        keep: impl Fn(&Spectrum<C>) -> [f64; K] + Copy,
        pass: Pass,
    ) -> [f64; K] {
        let after = self.sums.len() / K + 1;
        if reached.marking {
            reached.list();
            self.touch::<K>(reached.blocks);
        }
        let Reached { cells, marks, marking, blocks, .. } = reached;
        let mut total = [0.0; K];
        self.add_outside(0, keep(&replace(&mut cells[0], Spectrum::ZERO)), &mut total);
        let mut add = |block: usize| {
            let range = (BLOCK * block).max(1)..(BLOCK * (block + 1)).min(after);
            self.add_block(block, range, cells, keep, pass, &mut total);
        };
        if marking {
            for &block in blocks.iter() {
                add(block as usize);
            }
        } else {
            for block in 0..marks.len() {
                add(block);
            }
        }
        self.add_outside(1, keep(&replace(&mut cells[after], Spectrum::ZERO)), &mut total);
        total
    }

    /// Reads one value of each block, all of which are needed next.
    fn touch<const K: usize>(&self, blocks: &[u32]) {
        let mut read = 0;
        for &block in blocks {
            // Bin b is cell b + 1.
            let first = ((BLOCK * block as usize).max(1) - 1) * K;
            for values in [&*self.sums, &*self.squares] {
                read ^= values.get(first).map_or(0, |value| value.to_bits());
            }
        }
        black_box(read);
    }

    /// Adds what arrived before (0) or after (1), if it is kept.
    fn add_outside<const K: usize>(&mut self, which: usize, value: [f64; K], total: &mut [f64; K]) {
        if self.outside.is_empty() {
            return;
        }
        for channel in 0..K {
            self.outside[which * K + channel] += value[channel];
            total[channel] += value[channel];
        }
    }

    /// Adds the cells of a block, a `range` of bins counted from 1.
    fn add_block<const C: usize, const K: usize>(
        &mut self,
        block: usize,
        range: Range<usize>,
        cells: &mut [Spectrum<C>],
        keep: impl Fn(&Spectrum<C>) -> [f64; K],
        pass: Pass,
        total: &mut [f64; K],
    ) {
        let mut index = (range.start - 1) * K;
        let kept = index..index + range.len() * K;
        let (sums, squares) = (&mut self.sums[kept.clone()], self.squares.get_mut(kept));
        let sums = sums.as_chunks_mut::<K>().0;
        index += self.first;
        let mut each = |cell: &mut Spectrum<C>| {
            let value = keep(&replace(cell, Spectrum::ZERO));
            for channel in 0..K {
                total[channel] += value[channel];
            }
            value
        };
        let Some(squares) = squares else {
            for (cell, sums) in cells[range].iter_mut().zip(sums) {
                for (sum, value) in sums.iter_mut().zip(each(cell)) {
                    pass.add(sum, value, index);
                    index += 1;
                }
            }
            return;
        };
        let lag = pass.lag(replace(&mut self.reached[block], pass.mark()));
        let both = sums.iter_mut().zip(squares.as_chunks_mut::<K>().0);
        for (cell, (sums, squares)) in cells[range].iter_mut().zip(both) {
            let value = each(cell);
            for channel in 0..K {
                let statistics = (&mut sums[channel], &mut squares[channel]);
                pass.add_both(statistics, value[channel], lag, index);
                index += 1;
            }
        }
    }
}
