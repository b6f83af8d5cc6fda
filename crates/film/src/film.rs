//! The film: statistics over passes of all pixels and cells.
//!
//! A pass is one independent estimate of the whole image. It is rendered tile by tile into f64
//! scratch and then added to the sum (and the squared deviations, if variance is asked for) of each
//! cell that it reached: f32, rounded without bias (see `stats`). What arrives outside the window, and
//! the steady image, the sum over a pixel's cells, are f64. [`TransientFilm::into_arrays`] makes the
//! sums into the result where they are: memory is that of the arrays that leave the film, with
//! variance and two bytes per bin more, and 32 bytes per pixel and channel.

use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use tpb_optics::Spectrum;

use crate::FilmError;
use crate::layout::{Clock, Layout};
use crate::part::{Part, Sizes, Statistics};
use crate::stats::{Pass, variance_factor};
use crate::tile::{BLOCK, Grain, Scratch, Tile};

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
    /// Keep the bins alone: neither what arrives outside the window nor the steady image, whose place
    /// the sum of the bins takes. Of no effect without a time axis.
    pub window_only: bool,
}

/// Time-resolved image of `C` transported channels, averaged over passes.
pub struct TransientFilm<const C: usize> {
    layout: Layout,
    options: FilmOptions,
    passes: u64,
    non_finite: u64,
    /// Sums over passes, (pixel, bin, channel); empty without a time axis.
    sums: Vec<f32>,
    /// Squared deviations, like `sums`; empty without variance.
    squares: Vec<f32>,
    /// (pixel, block of cells): the pass that last reached it; empty without variance.
    reached: Vec<u32>,
    /// Sums of what arrived before and after, (pixel, 2, channel); empty without a time axis, and if
    /// the window alone is kept.
    outside: Vec<f64>,
    /// (pixel, channel).
    steady_mean: Vec<f64>,
    steady_squares: Vec<f64>,
    /// As many as there were tiles at work at once.
    scratch: Mutex<Vec<Scratch<C>>>,
}

impl<const C: usize> TransientFilm<C> {
    /// An empty film.
    ///
    /// # Errors
    /// Those of [`Layout::new`], and [`FilmError::TooLarge`].
    pub fn new(layout: Layout, options: FilmOptions) -> Result<Self, FilmError> {
        layout.validate()?;
        let pixels = layout.width.checked_mul(layout.height).ok_or_else(|| layout.too_large())?;
        // Far from overflow, if the cells of one pixel can be numbered.
        if layout.bins() > isize::MAX as usize / 64 {
            return Err(layout.too_large());
        }
        let sizes = Self::sizes(&layout, options);
        Ok(Self {
            layout,
            options,
            passes: 0,
            non_finite: 0,
            sums: zeros(pixels, sizes.sums, &layout)?,
            squares: zeros(pixels, sizes.squares, &layout)?,
            reached: zeros(pixels, sizes.reached, &layout)?,
            outside: zeros(pixels, sizes.outside, &layout)?,
            steady_mean: zeros(pixels, sizes.steady, &layout)?,
            steady_squares: zeros(pixels, sizes.steady, &layout)?,
            scratch: Mutex::default(),
        })
    }

    /// Values of each kind per pixel.
    fn sizes(layout: &Layout, options: FilmOptions) -> Sizes {
        let kept = Self::kept(options.output);
        let sums = layout.bins() * kept;
        let outside = if options.window_only { 0 } else { 2 * kept };
        let (squares, reached) =
            if options.variance { (sums, (layout.bins() + 2).div_ceil(BLOCK)) } else { (0, 0) };
        match layout.time {
            Some(_) => Sizes { sums, squares, reached, outside, steady: kept },
            None => Sizes { sums: 0, squares: 0, reached: 0, outside: 0, steady: kept },
        }
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

    /// From when to when arrivals are kept \[m\], first to last edge, if all others are of no use:
    /// the film keeps its window alone, and all of a pixel's times are counted from the emitter.
    pub fn only_window(&self) -> Option<[f64; 2]> {
        let FilmOptions { window_only, unwarp, .. } = self.options;
        let time = self.layout.time.filter(|_| window_only && !unwarp);
        time.map(|time| [time.start_opl, time.end()])
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
        let pass = Pass::new(self.passes);
        let (layout, options) = (self.layout, self.options);
        let sizes = Self::sizes(&layout, options);
        let clock = layout.time.map(Clock::new);
        let pool = std::mem::take(&mut self.scratch);
        let parts = self.parts(self.tile_edge(grain), sizes);
        let results: Vec<(S, u64)> = parts
            .into_par_iter()
            .map(|part| {
                let free = lock(&pool).pop();
                let scratch = &mut free.unwrap_or_default();
                let area = (part.columns.clone(), part.rows.clone());
                scratch.prepare(area.0.len() * area.1.len(), clock);
                let mut tile = Tile::new(area, layout.width, clock, options.unwarp, scratch);
                let result = render(&mut tile);
                let non_finite = tile.non_finite();
                if Self::kept(options.output) == C {
                    part.add(scratch, sizes, |cell: &Spectrum<C>| cell.0, pass);
                } else {
                    part.add(scratch, sizes, |cell: &Spectrum<C>| [cell.luminance()], pass);
                }
                lock(&pool).push(std::mem::take(scratch));
                (result, non_finite)
            })
            .collect();
        self.scratch = pool;
        self.non_finite += results.iter().map(|r| r.1).sum::<u64>();
        results.into_iter().map(|r| r.0).collect()
    }

    /// Pixels along an edge of the tiles of a pass (fewer at the right and at the bottom).
    pub fn tile_edge(&self, grain: Grain) -> usize {
        let cells = self.layout.time.map_or(1, |time| time.bins + 2);
        grain.edge(&self.layout, cells * size_of::<Spectrum<C>>())
    }

    /// The statistics by tiles of `edge` pixels.
    fn parts(&mut self, edge: usize, sizes: Sizes) -> Vec<Part<'_>> {
        let Layout { width, height, .. } = self.layout;
        let mut rest = Statistics {
            first: 0,
            sums: &mut self.sums,
            squares: &mut self.squares,
            reached: &mut self.reached,
            outside: &mut self.outside,
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
                    part.statistics.push(rest.split_off(part.columns.len(), sizes));
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

    /// The raw statistics, for [`crate::Arrays`].
    pub(crate) fn raw(&self) -> Raw<'_> {
        Raw {
            kept: Self::kept(self.options.output),
            sums: &self.sums,
            squares: &self.squares,
            reached: &self.reached,
            outside: &self.outside,
            steady_mean: &self.steady_mean,
        }
    }

    /// Takes sums and squared deviations out.
    pub(crate) fn take(&mut self) -> (Vec<f32>, Vec<f32>) {
        (std::mem::take(&mut self.sums), std::mem::take(&mut self.squares))
    }
}

/// Borrowed statistics.
pub(crate) struct Raw<'a> {
    pub(crate) kept: usize,
    pub(crate) sums: &'a [f32],
    pub(crate) squares: &'a [f32],
    pub(crate) reached: &'a [u32],
    pub(crate) outside: &'a [f64],
    pub(crate) steady_mean: &'a [f64],
}

/// What is in the pool is sound, whatever happened to others.
fn lock<T>(pool: &Mutex<T>) -> MutexGuard<'_, T> {
    pool.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Zeros for all pixels. They take no memory until they are written to, where the system can do
/// that.
fn zeros<T: bytemuck::Zeroable>(
    pixels: usize,
    per_pixel: usize,
    layout: &Layout,
) -> Result<Vec<T>, FilmError> {
    let count =
        pixels.checked_mul(per_pixel).filter(|&n| n <= isize::MAX as usize / size_of::<T>());
    let zeros = count.map(bytemuck::allocation::try_zeroed_vec);
    zeros.and_then(Result::ok).ok_or_else(|| layout.too_large())
}
