//! The film: statistics over passes of all pixels and cells.
//!
//! A pass is one independent estimate of the whole image. It is rendered tile by tile into
//! scratch and then added to the mean (and M2, if variance is asked for) of each cell. The steady
//! image, the sum over a pixel's cells, has mean and M2 of its own, always. Memory is 8 bytes per
//! cell, 16 with variance, and 16 per pixel and channel: with the f32 arrays that
//! [`TransientFilm::develop`] makes, three times those arrays.

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use tpb_optics::Spectrum;

use crate::FilmError;
use crate::layout::{Clock, Layout};
use crate::profile::Workspace;
use crate::stats::{add_to_means, add_to_moments, variance_factor};
use crate::tile::{Grain, Tile};

/// Which channels leave the film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutputChannels {
    /// Those that were transported.
    #[default]
    AsTransported,
    /// One: three transported channels are combined in each pass, before the statistics.
    Luminance,
    /// Three: a single transported channel is repeated when arrays are made.
    Rgb,
}

/// What the film does beside keeping means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FilmOptions {
    /// Keep the variance of each cell over passes.
    pub variance: bool,
    /// Which channels leave the film.
    pub output: OutputChannels,
    /// Subtract from arrival times the OPL from the eye to the first surface that is not null.
    pub unwarp: bool,
}

/// Time-resolved image of `C` transported channels, averaged over passes.
pub struct TransientFilm<const C: usize> {
    layout: Layout,
    options: FilmOptions,
    passes: u64,
    non_finite: u64,
    /// (pixel, cell, channel); empty without a time axis.
    mean: Vec<f64>,
    /// Like `mean`; empty without variance.
    squares: Vec<f64>,
    /// (pixel, channel).
    steady_mean: Vec<f64>,
    steady_squares: Vec<f64>,
}

impl<const C: usize> TransientFilm<C> {
    /// An empty film.
    ///
    /// # Errors
    /// Those of [`Layout::new`], and [`FilmError::TooLarge`].
    pub fn new(layout: Layout, options: FilmOptions) -> Result<Self, FilmError> {
        layout.validate()?;
        let zeros = |count: Option<usize>| -> Result<Vec<f64>, FilmError> {
            let count = count.ok_or_else(|| layout.too_large())?;
            let mut zeros = Vec::new();
            zeros.try_reserve_exact(count).map_err(|_| layout.too_large())?;
            zeros.resize(count, 0.0);
            Ok(zeros)
        };
        let kept = Self::kept(options.output);
        let per_pixel = layout.width.checked_mul(layout.height).and_then(|n| n.checked_mul(kept));
        let stored = match layout.time {
            None => Some(0),
            Some(time) => time.bins.checked_add(2).and_then(|cells| cells.checked_mul(per_pixel?)),
        };
        Ok(Self {
            layout,
            options,
            passes: 0,
            non_finite: 0,
            mean: zeros(stored)?,
            squares: zeros(if options.variance { stored } else { Some(0) })?,
            steady_mean: zeros(per_pixel)?,
            steady_squares: zeros(per_pixel)?,
        })
    }

    /// Channels that the statistics keep.
    fn kept(output: OutputChannels) -> usize {
        if output == OutputChannels::Luminance { 1 } else { C }
    }

    /// Size and time axis.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The options that it was made with.
    pub fn options(&self) -> &FilmOptions {
        &self.options
    }

    /// Passes so far.
    pub fn passes(&self) -> u64 {
        self.passes
    }

    /// Contributions so far that were not finite and were kept out.
    pub fn non_finite(&self) -> u64 {
        self.non_finite
    }

    /// Runs one pass in fine tiles: see [`TransientFilm::add_pass_by`].
    pub fn add_pass<S: Send>(&mut self, render: impl Fn(&mut Tile<'_, C>) -> S + Sync) -> Vec<S> {
        self.add_pass_by(Grain::Fine, render)
    }

    /// Runs one pass: `render` is called for each tile, in parallel, and deposits into it; then the
    /// pass enters the statistics. Returns what `render` returned, in the order of the tiles (row by
    /// row from the first pixel's to the last's). Tiles depend on the film and the grain alone: if
    /// `render` does not depend on the thread either, nor does the film, to the bit.
    pub fn add_pass_by<S: Send>(
        &mut self,
        grain: Grain,
        render: impl Fn(&mut Tile<'_, C>) -> S + Sync,
    ) -> Vec<S> {
        self.passes += 1;
        let n = self.passes;
        let (layout, options) = (self.layout, self.options);
        let kept = Self::kept(options.output);
        let clock = layout.time.map(Clock::new);
        let cells = clock.map_or(1, |clock| clock.cells());
        let parts =
            self.parts(self.tile_edge(grain), if clock.is_some() { cells * kept } else { 0 });
        let scratch = || (Vec::<Spectrum<C>>::new(), Workspace::<C>::default());
        let results: Vec<(S, u64)> = parts
            .into_par_iter()
            .map_init(scratch, |(buffer, workspace), part| {
                let area = (part.columns.clone(), part.rows.clone());
                buffer.clear();
                buffer.resize(area.0.len() * area.1.len() * cells, Spectrum::ZERO);
                let mut tile =
                    Tile::new(area, layout.width, clock, options.unwarp, buffer, workspace);
                let result = render(&mut tile);
                let non_finite = tile.non_finite();
                if kept == C {
                    part.add(buffer, cells, |cell: &Spectrum<C>| cell.0, n);
                } else {
                    part.add(buffer, cells, |cell: &Spectrum<C>| [cell.luminance()], n);
                }
                (result, non_finite)
            })
            .collect();
        self.non_finite += results.iter().map(|r| r.1).sum::<u64>();
        results.into_iter().map(|r| r.0).collect()
    }

    /// Pixels along an edge of the tiles of a pass (fewer at the right and at the bottom).
    pub fn tile_edge(&self, grain: Grain) -> usize {
        let cells = self.layout.time.map_or(1, |time| time.bins + 2);
        grain.edge(&self.layout, cells * size_of::<Spectrum<C>>())
    }

    /// The statistics by tiles of `edge` pixels, `stored` cells of each pixel being kept.
    fn parts(&mut self, edge: usize, stored: usize) -> Vec<Part<'_>> {
        let Layout { width, height, .. } = self.layout;
        let kept = Self::kept(self.options.output);
        let mut rest = RowPart {
            mean: &mut self.mean,
            squares: &mut self.squares,
            steady_mean: &mut self.steady_mean,
            steady_squares: &mut self.steady_squares,
        };
        let mut parts = Vec::with_capacity(width.div_ceil(edge) * height.div_ceil(edge));
        for top in (0..height).step_by(edge) {
            let (rows, first) = (top..height.min(top + edge), parts.len());
            parts.extend((0..width).step_by(edge).map(|left| Part {
                columns: left..width.min(left + edge),
                rows: rows.clone(),
                statistics: Vec::with_capacity(rows.len()),
            }));
            for _ in rows {
                for part in &mut parts[first..] {
                    let pixels = part.columns.len();
                    part.statistics.push(rest.split_off(pixels * stored, pixels * kept));
                }
            }
        }
        parts
    }

    /// Median relative error of a pixel of the steady image, over pixels whose mean is positive
    /// (of an even number of them, the upper of the middle two). A pixel's error is the sum over
    /// kept channels of the standard error of the mean, divided by the sum of the means: exact for
    /// one channel and for channels that vary together, else an upper bound for their sum. `None`
    /// under two passes or for a black image.
    pub fn relative_error(&self) -> Option<f64> {
        let factor = variance_factor(self.passes)?;
        let kept = Self::kept(self.options.output);
        let pixels =
            self.steady_mean.chunks_exact(kept).zip(self.steady_squares.chunks_exact(kept));
        let lit = pixels.filter_map(|(means, squares)| {
            let mean: f64 = means.iter().sum();
            let error: f64 = squares.iter().map(|s| (factor * s).sqrt()).sum();
            (mean > 0.0).then(|| error / mean)
        });
        let mut errors: Vec<f64> = lit.collect();
        let middle = errors.len() / 2;
        (!errors.is_empty()).then(|| *errors.select_nth_unstable_by(middle, f64::total_cmp).1)
    }

    /// Channels that leave the film.
    pub fn output_channels(&self) -> usize {
        match self.options.output {
            OutputChannels::AsTransported => C,
            OutputChannels::Luminance => 1,
            OutputChannels::Rgb => C.max(3),
        }
    }

    /// Channels of the statistics, and the raw statistics, for [`crate::Arrays`].
    pub(crate) fn statistics(&self) -> Statistics<'_> {
        Statistics {
            kept: Self::kept(self.options.output),
            mean: &self.mean,
            squares: &self.squares,
            steady_mean: &self.steady_mean,
        }
    }
}

/// Borrowed statistics.
pub(crate) struct Statistics<'a> {
    pub(crate) kept: usize,
    pub(crate) mean: &'a [f64],
    pub(crate) squares: &'a [f64],
    pub(crate) steady_mean: &'a [f64],
}

/// The statistics of one tile.
struct Part<'a> {
    columns: Range<usize>,
    rows: Range<usize>,
    /// Row by row.
    statistics: Vec<RowPart<'a>>,
}

/// The statistics of one row of a tile.
struct RowPart<'a> {
    mean: &'a mut [f64],
    squares: &'a mut [f64],
    steady_mean: &'a mut [f64],
    steady_squares: &'a mut [f64],
}

impl Part<'_> {
    /// Adds pass `n`; `keep` makes the kept channels of a cell.
    fn add<const C: usize, const K: usize>(
        self,
        buffer: &[Spectrum<C>],
        cells: usize,
        keep: impl Fn(&Spectrum<C>) -> [f64; K] + Copy,
        n: u64,
    ) {
        let rows = buffer.chunks_exact(self.columns.len() * cells);
        for (row, buffer) in self.statistics.into_iter().zip(rows) {
            row.add(buffer, cells, keep, n);
        }
    }
}

impl<'a> RowPart<'a> {
    /// Takes the first cells and pixels off.
    fn split_off(&mut self, cells: usize, steady: usize) -> RowPart<'a> {
        let take = "tiles cover the film";
        let squares = if self.squares.is_empty() { 0 } else { cells };
        RowPart {
            mean: self.mean.split_off_mut(..cells).expect(take),
            squares: self.squares.split_off_mut(..squares).expect(take),
            steady_mean: self.steady_mean.split_off_mut(..steady).expect(take),
            steady_squares: self.steady_squares.split_off_mut(..steady).expect(take),
        }
    }

    /// Adds pass `n`; `keep` makes the kept channels of a cell.
    fn add<const C: usize, const K: usize>(
        self,
        buffer: &[Spectrum<C>],
        cells: usize,
        keep: impl Fn(&Spectrum<C>) -> [f64; K] + Copy,
        n: u64,
    ) {
        if !self.mean.is_empty() {
            let values = buffer.iter().map(keep);
            if self.squares.is_empty() {
                add_to_means(self.mean, values, n);
            } else {
                add_to_moments(self.mean, self.squares, values, n);
            }
        }
        let sums = buffer.chunks_exact(cells).map(|pixel| {
            let mut sum = [0.0; K];
            for cell in pixel {
                for (sum, value) in sum.iter_mut().zip(keep(cell)) {
                    *sum += value;
                }
            }
            sum
        });
        add_to_moments(self.steady_mean, self.steady_squares, sums, n);
    }
}
