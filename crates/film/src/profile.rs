//! Spreading one contribution over the cells of a pixel.
//!
//! Uniform over `[s, e]`: the part of cell `[t1, t2]` is `(min(t2, e) − max(t1, s))/(e − s)`.
//!
//! Exponential: with depth `d ≥ 0` and `x = (t − s)/(e − s)`, the part of `[x1, x2]` is
//! `S(x1) · (−expm1(−d (x2 − x1)))`, where `S(x) = exp(−d x)/(−expm1(−d))`: nothing cancels,
//! however small or large `d` and the interval are. A negative depth is a positive one seen from
//! the end, with `x = (e − t)/(e − s)` measured from there. Along the cells
//! `S(x2) = S(x1) + S(x1)·expm1(−d (x2 − x1))` (or a product with `exp`, where that sum would
//! cancel): the parts telescope, so that they add up to the whole to rounding, and bins between the
//! first and the last share their `expm1`. The tail is the same with `d x = rate (t − s)` and
//! total 1; what is left after the last edge goes to the cell after the window.
//!
//! General densities: `quadrature`, then scaled to unit area.

use std::ops::Range;

use tpb_optics::Spectrum;

use crate::arrival::TemporalProfile;
use crate::layout::Clock;
use crate::quadrature::{Density, Piece, Segment, refine};

/// Marks a contribution that is not finite, so that it is counted and kept out.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct NotFinite;

/// Buffers of the general profiles, kept from deposit to deposit.
pub(crate) struct Workspace<const C: usize> {
    /// Cells and what falls into them.
    parts: Vec<(usize, Piece<C>)>,
    stack: Vec<Piece<C>>,
}

impl<const C: usize> Default for Workspace<C> {
    fn default() -> Self {
        Self { parts: Vec::new(), stack: Vec::new() }
    }
}

/// Adds `energy` to `cells` (all cells of one pixel); profile times are `shift` later than the
/// clock's. Returns the cells that it may have changed, at least one. On `Err` nothing was added.
pub(crate) fn spread<const C: usize>(
    profile: &TemporalProfile<'_, C>,
    energy: Spectrum<C>,
    shift: f64,
    clock: &Clock,
    cells: &mut [Spectrum<C>],
    workspace: &mut Workspace<C>,
) -> Result<Range<usize>, NotFinite> {
    match *profile {
        TemporalProfile::Uniform { start, end } => {
            let Some(span) = Span::new(start - shift, end - shift)? else {
                return instant(start - shift, energy, clock, cells);
            };
            uniform(span, energy, clock, cells);
            Ok(span.cells(clock))
        }
        TemporalProfile::Exponential { start, end, depth } => {
            if depth.0.iter().any(|d| d.is_nan()) {
                return Err(NotFinite);
            }
            let Some(span) = Span::new(start - shift, end - shift)? else {
                return instant(start - shift, energy, clock, cells);
            };
            for channel in 0..C {
                if energy[channel] != 0.0 {
                    exponential(span, depth[channel], energy[channel], channel, clock, cells);
                }
            }
            Ok(span.cells(clock))
        }
        TemporalProfile::ExponentialTail { start, rate } => {
            let start = start - shift;
            let decays = |c: usize| rate[c] > 0.0 || (energy[c] == 0.0 && !rate[c].is_nan());
            if !start.is_finite() || !(0..C).all(decays) {
                return Err(NotFinite);
            }
            let mut end = clock.cell(start) + 1;
            for channel in 0..C {
                if energy[channel] != 0.0 {
                    end =
                        end.max(tail(start, rate[channel], energy[channel], channel, clock, cells));
                }
            }
            Ok(clock.cell(start)..end)
        }
        TemporalProfile::General { start, end, breaks, density } => {
            if Span::new(start, end)?.is_none() {
                return instant(start - shift, energy, clock, cells);
            }
            let given = (start, end, breaks);
            general(given, density, energy, shift, clock, cells, workspace)?;
            Ok(clock.cell(start - shift)..clock.cell(end - shift) + 1)
        }
    }
}

/// Adds an instant; returns its cell.
#[inline]
pub(crate) fn instant<const C: usize>(
    opl: f64,
    energy: Spectrum<C>,
    clock: &Clock,
    cells: &mut [Spectrum<C>],
) -> Result<Range<usize>, NotFinite> {
    if !opl.is_finite() {
        return Err(NotFinite);
    }
    let cell = clock.cell(opl);
    cells[cell] += energy;
    Ok(cell..cell + 1)
}

/// A finite interval of positive length.
#[derive(Clone, Copy)]
struct Span {
    start: f64,
    end: f64,
    length: f64,
}

impl Span {
    /// `None` for an instant.
    fn new(start: f64, end: f64) -> Result<Option<Self>, NotFinite> {
        let length = end - start;
        // Infinite or NaN ends make the length infinite or NaN.
        if !length.is_finite() || length < 0.0 {
            return Err(NotFinite);
        }
        Ok((length > 0.0).then_some(Self { start, end, length }))
    }

    /// The cells that it touches.
    fn cells(self, clock: &Clock) -> Range<usize> {
        clock.cell(self.start)..clock.cell(self.end) + 1
    }

    /// How much of it is in a cell \[m\].
    fn inside(self, cell: usize, clock: &Clock) -> f64 {
        clock.upper(cell).min(self.end) - clock.lower(cell).max(self.start)
    }
}

fn uniform<const C: usize>(
    span: Span,
    energy: Spectrum<C>,
    clock: &Clock,
    cells: &mut [Spectrum<C>],
) {
    let touched = span.cells(clock);
    if touched.len() == 1 {
        cells[touched.start] += energy;
        return;
    }
    for (cell, sum) in touched.clone().zip(&mut cells[touched]) {
        *sum += energy * (span.inside(cell, clock) / span.length);
    }
}

/// Energy that decays from cell to cell.
struct Decay {
    survival: f64,
    /// What of it a whole bin absorbs, and what survives one.
    bin: (f64, f64),
}

impl Decay {
    /// Of some energy, for a number of whole bins of some depth.
    fn new(survival: f64, bins: usize, depth: f64) -> Self {
        let bin = if bins > 0 { Self::parts(depth) } else { (0.0, 1.0) };
        Self { survival, bin }
    }

    fn parts(depth: f64) -> (f64, f64) {
        let absorbed = -(-depth).exp_m1();
        // The difference is exact enough while most survives, and saves an exponential.
        (absorbed, if absorbed < 0.5 { 1.0 - absorbed } else { (-depth).exp() })
    }

    /// What is absorbed over a depth.
    fn absorb(&mut self, depth: f64) -> f64 {
        self.take(Self::parts(depth))
    }

    /// What a whole bin absorbs.
    fn absorb_bin(&mut self) -> f64 {
        self.take(self.bin)
    }

    #[inline]
    fn take(&mut self, (absorbed, surviving): (f64, f64)) -> f64 {
        let taken = self.survival * absorbed;
        // As above; and so the parts add up to the whole.
        self.survival =
            if absorbed < 0.5 { self.survival - taken } else { self.survival * surviving };
        taken
    }
}

/// One channel of an exponential.
fn exponential<const C: usize>(
    span: Span,
    depth: f64,
    energy: f64,
    channel: usize,
    clock: &Clock,
    cells: &mut [Spectrum<C>],
) {
    // Infinite depths are their limit; the largest finite one does the same.
    let depth = depth.clamp(-f64::MAX, f64::MAX);
    let steepness = depth.abs();
    let whole = -(-steepness).exp_m1();
    let touched = span.cells(clock);
    let sums = touched.clone().zip(&mut cells[touched.clone()]);
    if touched.len() == 1 || whole < f64::MIN_POSITIVE {
        for (cell, sum) in sums {
            sum[channel] += energy * (span.inside(cell, clock) / span.length);
        }
        return;
    }
    let (first, last) = (touched.start, touched.end - 1);
    let bin_depth = steepness * (clock.bin_width() / span.length);
    let mut decay = Decay::new(energy / whole, last - first - 1, bin_depth);
    let step = |(cell, sum): (usize, &mut Spectrum<C>)| {
        sum[channel] += if cell == first || cell == last {
            decay.absorb(steepness * (span.inside(cell, clock) / span.length))
        } else {
            decay.absorb_bin()
        };
    };
    if depth > 0.0 {
        sums.for_each(step);
    } else {
        sums.rev().for_each(step);
    }
}

/// One channel of an exponential tail; returns the end of the cells that it changed.
fn tail<const C: usize>(
    start: f64,
    rate: f64,
    energy: f64,
    channel: usize,
    clock: &Clock,
    cells: &mut [Spectrum<C>],
) -> usize {
    let first = clock.cell(start);
    let (after, inner) = cells.split_last_mut().expect("a pixel has cells");
    let mut decay =
        Decay::new(energy, inner.len().saturating_sub(first + 1), rate * clock.bin_width());
    for (cell, sum) in inner.iter_mut().enumerate().skip(first) {
        sum[channel] += if cell == first {
            decay.absorb(rate * (clock.upper(cell) - start))
        } else {
            decay.absorb_bin()
        };
        if decay.survival == 0.0 {
            return cell + 1;
        }
    }
    after[channel] += decay.survival;
    cells.len()
}

fn general<const C: usize>(
    (start, end, breaks): (f64, f64, &[f64]),
    density: Density<'_, C>,
    energy: Spectrum<C>,
    shift: f64,
    clock: &Clock,
    cells: &mut [Spectrum<C>],
    workspace: &mut Workspace<C>,
) -> Result<(), NotFinite> {
    if breaks.iter().any(|b| b.is_nan()) {
        return Err(NotFinite);
    }
    let Workspace { parts, stack } = workspace;
    parts.clear();
    let mut from = start;
    for &to in breaks.iter().filter(|&&b| start < b && b < end).chain([&end]) {
        if to <= from {
            continue;
        }
        let segment = Segment { from, to };
        for cell in clock.cell(from - shift)..=clock.cell(to - shift) {
            let lower = (clock.lower(cell) + shift).max(from);
            let upper = (clock.upper(cell) + shift).min(to);
            if upper > lower {
                parts.push((cell, Piece::new(segment, lower, upper, density)));
            }
        }
        from = to;
    }
    let total = |parts: &[(usize, Piece<C>)]| parts.iter().map(|p| p.1.value).sum::<Spectrum<C>>();
    let estimate = total(parts);
    if !estimate.is_finite() {
        return Err(NotFinite);
    }
    let mean = estimate / parts.len() as f64;
    refine(parts.iter_mut().map(|part| &mut part.1), mean, density, stack);
    let whole = total(parts);
    if !(0..C).all(|c| whole[c].is_finite() && (whole[c] > 0.0 || energy[c] == 0.0)) {
        return Err(NotFinite);
    }
    for (cell, piece) in parts.iter() {
        for channel in (0..C).filter(|&c| energy[c] != 0.0) {
            cells[*cell][channel] += energy[channel] * (piece.value[channel] / whole[channel]);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
