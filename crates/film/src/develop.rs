//! From statistics to arrays, in place.

use rayon::prelude::*;

use crate::arrays::{Arrays, Quantity};
use crate::film::{Raw, TransientFilm};
use crate::layout::Layout;
use crate::stats::{lag, variance_factor};
use crate::tile::BLOCK;

impl<const C: usize> TransientFilm<C> {
    /// The arrays of the passes so far, as a copy: [`TransientFilm::into_arrays`] needs no second
    /// cube.
    pub fn develop(&self) -> Arrays {
        let Raw { sums, squares, .. } = self.raw();
        self.arrays(sums.to_vec(), squares.to_vec())
    }

    /// The arrays of all passes, made of the film's own memory.
    pub fn into_arrays(mut self) -> Arrays {
        let (sums, squares) = self.take();
        self.arrays(sums, squares)
    }

    /// The steady image of the passes so far alone: arrays without bins.
    pub fn develop_steady(&self) -> Arrays {
        let Layout { width, height, .. } = *self.layout();
        Arrays {
            width,
            height,
            bins: 0,
            channels: self.output_channels(),
            quantity: Quantity::BinEnergy,
            opl_edges: vec![],
            transient: vec![],
            variance: None,
            before: vec![],
            after: vec![],
            steady: self.steady(),
        }
    }

    fn steady(&self) -> Vec<f64> {
        let Raw { steady_mean, kept, .. } = self.raw();
        let channels = self.output_channels();
        let pixels = steady_mean.chunks_exact(kept);
        pixels.flat_map(|p| (0..channels).map(move |c| p[c.min(kept - 1)])).collect()
    }

    fn arrays(&self, mut sums: Vec<f32>, mut squares: Vec<f32>) -> Arrays {
        let (layout, channels, raw) = (self.layout(), self.output_channels(), self.raw());
        let (bins, kept) = (layout.bins(), raw.kept);
        let factor = variance_factor(self.passes()).filter(|_| self.options().variance && bins > 0);
        // Squares need the sums, so they come first.
        let variance = factor.map(|factor| {
            self.finish_squares(&sums, &mut squares, factor);
            repeat(&mut squares, kept, channels);
            squares
        });
        let passes = self.passes().max(1) as f64;
        sums.par_iter_mut().for_each(|sum| *sum = (f64::from(*sum) / passes) as f32);
        repeat(&mut sums, kept, channels);
        // Output channel → kept channel: itself, or the only one.
        let source = |channel: usize| channel.min(kept - 1);
        let outside = |which: usize| -> Vec<f64> {
            if raw.outside.is_empty() && bins > 0 {
                return vec![0.0; layout.pixels() * channels];
            }
            let pixels = raw.outside.chunks_exact(2 * kept);
            let all = pixels.flat_map(|p| (0..channels).map(move |c| p[which * kept + source(c)]));
            all.map(|sum| sum / passes).collect()
        };
        Arrays {
            width: layout.width,
            height: layout.height,
            bins,
            channels,
            quantity: Quantity::BinEnergy,
            opl_edges: layout.time.map_or_else(Vec::new, |time| time.edges()),
            transient: sums,
            variance,
            before: outside(0),
            after: outside(1),
            steady: self.steady(),
        }
    }

    /// Squared deviations, brought up to date, times a factor.
    fn finish_squares(&self, sums: &[f32], squares: &mut [f32], factor: f64) {
        let (bins, kept) = (self.layout().bins(), self.raw().kept);
        let reached = self.raw().reached.par_chunks_exact((bins + 2).div_ceil(BLOCK));
        let pixels =
            squares.par_chunks_exact_mut(bins * kept).zip(sums.par_chunks_exact(bins * kept));
        pixels.zip(reached).for_each(|((squares, sums), reached)| {
            for (i, (square, &sum)) in squares.iter_mut().zip(sums).enumerate() {
                // Bin b is cell b + 1 of its pixel.
                let lag = lag(reached[(i / kept + 1) / BLOCK], self.passes());
                let sum = f64::from(sum);
                *square = ((f64::from(*square) + sum * sum * lag) * factor) as f32;
            }
        });
    }
}

/// Repeats the only channel, from the end, so that nothing is overwritten before it is read.
fn repeat(cells: &mut Vec<f32>, kept: usize, channels: usize) {
    if kept == channels {
        return;
    }
    let count = cells.len();
    cells.reserve_exact(count * channels - count);
    cells.resize(count * channels, 0.0);
    for from in (0..count).rev() {
        let value = cells[from];
        cells[from * channels..(from + 1) * channels].fill(value);
    }
}
