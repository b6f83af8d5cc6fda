//! Pixels and time bins.
//!
//! Bin `i` holds the energy of arrival OPL in the half-open interval `[e_i, e_{i+1})`, with edges
//! `e_i = start_opl + i · bin_width_opl` in f64, exactly as reported: a lookup by division may be
//! off by one at an edge and is corrected against these edges. What arrives earlier or later is
//! kept in two cells of its own, so each pixel has `bins + 2` cells: before, the bins, after.

use serde::{Deserialize, Serialize};
use tpb_lanes::{F64s, Simd};

use crate::FilmError;

/// Equal bins of optical path length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeAxis {
    /// OPL of the first bin's lower edge \[m\].
    pub start_opl: f64,
    /// OPL that one bin spans \[m\].
    pub bin_width_opl: f64,
    /// Number of bins.
    pub bins: usize,
}

impl TimeAxis {
    /// The lower edge of bin `index` \[m\]; for `index == bins`, the end of the window.
    #[inline]
    pub fn edge(&self, index: usize) -> f64 {
        self.start_opl + index as f64 * self.bin_width_opl
    }

    /// The end of the window \[m\].
    #[inline]
    pub fn end(&self) -> f64 {
        self.edge(self.bins)
    }

    /// All `bins + 1` edges \[m\].
    pub fn edges(&self) -> Vec<f64> {
        (0..=self.bins).map(|i| self.edge(i)).collect()
    }

    fn validate(&self) -> Result<(), FilmError> {
        let bad = |reason| {
            let Self { start_opl, bin_width_opl, .. } = *self;
            Err(FilmError::TimeAxis { start_opl, bin_width_opl, reason })
        };
        if self.bins == 0 {
            return Err(FilmError::NoBins);
        }
        if !self.start_opl.is_finite() {
            return bad("the start must be finite");
        }
        if !(self.bin_width_opl.is_finite() && self.bin_width_opl > 0.0) {
            return bad("the bin width must be positive and finite");
        }
        if !self.end().is_finite() {
            return bad("the end of the window must be finite");
        }
        // Rounding of an edge is then at most 1/8 of a bin: edges increase, and a lookup by
        // division is off by at most one.
        let magnitude = self.start_opl.abs().max(self.end().abs());
        if self.bin_width_opl < 16.0 * f64::EPSILON * magnitude {
            return bad("the bins are narrower than the rounding of their edges");
        }
        Ok(())
    }
}

/// Size of the image and its time axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layout {
    /// Pixels in a row.
    pub width: usize,
    /// Rows; row 0 is at the top.
    pub height: usize,
    /// `None`: only the steady image; no bins are kept.
    pub time: Option<TimeAxis>,
}

impl Layout {
    /// A layout with at least one pixel and, where there is a time axis, a sound one.
    ///
    /// # Errors
    /// [`FilmError::Empty`], [`FilmError::NoBins`], [`FilmError::TimeAxis`].
    pub fn new(width: usize, height: usize, time: Option<TimeAxis>) -> Result<Self, FilmError> {
        let layout = Self { width, height, time };
        layout.validate()?;
        Ok(layout)
    }

    pub(crate) fn validate(&self) -> Result<(), FilmError> {
        if self.width == 0 || self.height == 0 {
            return Err(FilmError::Empty { width: self.width, height: self.height });
        }
        self.time.map_or(Ok(()), |time| time.validate())
    }

    /// Number of pixels.
    #[inline]
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// Number of bins, 0 without a time axis.
    #[inline]
    pub fn bins(&self) -> usize {
        self.time.map_or(0, |time| time.bins)
    }

    /// The error that this layout does not fit.
    pub(crate) fn too_large(&self) -> FilmError {
        FilmError::TooLarge { width: self.width, height: self.height, bins: self.bins() }
    }
}

/// A time axis ready for lookups. Cells of a pixel: 0 is before, 1..=bins the bins, bins + 1 after.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    axis: TimeAxis,
    inverse_width: f64,
    end: f64,
}

impl Clock {
    pub(crate) fn new(axis: TimeAxis) -> Self {
        Self { axis, inverse_width: 1.0 / axis.bin_width_opl, end: axis.end() }
    }

    /// Cells per pixel.
    #[inline]
    pub(crate) fn cells(&self) -> usize {
        self.axis.bins + 2
    }

    /// Where the window starts \[m\].
    #[inline]
    pub(crate) fn start(&self) -> f64 {
        self.axis.start_opl
    }

    /// OPL of one bin \[m\].
    #[inline]
    pub(crate) fn bin_width(&self) -> f64 {
        self.axis.bin_width_opl
    }

    /// The cell of an arrival at `opl`, which is finite.
    #[inline]
    pub(crate) fn cell(&self, opl: f64) -> usize {
        if opl < self.axis.start_opl {
            return 0;
        }
        if opl >= self.end {
            return self.axis.bins + 1;
        }
        let guess = ((opl - self.axis.start_opl) * self.inverse_width) as i64 as usize;
        let below = usize::from(opl < self.axis.edge(guess));
        let above = usize::from(opl >= self.axis.edge(guess + 1));
        1 + guess + above - below
    }

    /// [`Clock::cell`] of several arrivals, as whole numbers; of a NaN any cell.
    #[inline(always)]
    pub(crate) fn cells_of<S: Simd>(&self, simd: S, opl: F64s<S>) -> F64s<S> {
        let TimeAxis { start_opl, bin_width_opl, bins } = self.axis;
        let splat = [0.0, 1.0, bins as f64, bins as f64 + 1.0];
        let zero = F64s::splat(simd, splat[0]);
        let one = F64s::splat(simd, splat[1]);
        let last = F64s::splat(simd, splat[2]);
        // The nearest edge is the bin's lower or its upper.
        let guess = ((opl - start_opl) * self.inverse_width).round().max(zero).min(last);
        let edge = guess * bin_width_opl + start_opl;
        let next = (guess + 1.0) * bin_width_opl + start_opl;
        let inside = guess + 1.0 - opl.less(edge).of(one) + next.at_most(opl).of(one);
        let inside = F64s::splat(simd, start_opl).at_most(opl).of(inside);
        let after = F64s::splat(simd, self.end).at_most(opl);
        after.choose(F64s::splat(simd, splat[3]), inside)
    }

    /// Where cell `cell` starts \[m\]: −∞ for the cell before the window.
    #[inline]
    pub(crate) fn lower(&self, cell: usize) -> f64 {
        if cell == 0 { f64::NEG_INFINITY } else { self.axis.edge(cell - 1) }
    }

    /// Where cell `cell` ends \[m\]: ∞ for the cell after the window.
    #[inline]
    pub(crate) fn upper(&self, cell: usize) -> f64 {
        if cell > self.axis.bins { f64::INFINITY } else { self.axis.edge(cell) }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use tpb_lanes::{LANES, Vectors, WithSimd, dispatch};

    use super::*;

    /// [`Clock::cells_of`] of one arrival.
    fn at_once(clock: Clock, opl: f64) -> usize {
        struct Work(Clock, f64);
        impl WithSimd for Work {
            type Output = [f64; LANES];

            fn with_simd<S: Simd>(self, simd: S) -> [f64; LANES] {
                let mut cells = [0.0; LANES];
                let opl = [self.1; LANES].vector(simd, 0);
                self.0.cells_of(simd, opl).store(&mut cells, 0);
                cells
            }
        }
        dispatch(Work(clock, opl))[0] as usize
    }

    proptest! {
        #[test]
        fn cells_are_half_open_at_the_reported_edges(
            start in -1e3..1e3_f64, width in 1e-6..10.0_f64, bins in 1_usize..2000,
            pick in 0.0..1.0_f64,
        ) {
            let axis = TimeAxis { start_opl: start, bin_width_opl: width, bins };
            let clock = Clock::new(axis);
            let i = (pick * bins as f64) as usize;
            let edge = axis.edge(i);
            prop_assert_eq!(clock.cell(edge), i + 1);
            prop_assert_eq!(clock.cell(edge.next_down()), i);
            prop_assert_eq!(clock.cell(axis.end()), bins + 1);
            prop_assert_eq!(clock.cell(axis.end().next_down()), bins);
            let inside = start + pick * (axis.end() - start);
            let cell = clock.cell(inside);
            prop_assert!(clock.lower(cell) <= inside && inside < clock.upper(cell));
            for opl in [edge, edge.next_down(), axis.end(), axis.end().next_down(), inside] {
                prop_assert_eq!(at_once(clock, opl), clock.cell(opl));
            }
            for opl in [f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
                prop_assert_eq!(at_once(clock, opl), clock.cell(opl));
            }
        }
    }

    #[test]
    fn impossible_layouts_are_errors() {
        let axis =
            |start_opl, bin_width_opl, bins| Some(TimeAxis { start_opl, bin_width_opl, bins });
        assert!(matches!(Layout::new(0, 4, None), Err(FilmError::Empty { .. })));
        assert!(matches!(Layout::new(4, 0, None), Err(FilmError::Empty { .. })));
        assert!(matches!(Layout::new(4, 4, axis(0.0, 1.0, 0)), Err(FilmError::NoBins)));
        let broken = [
            (f64::NAN, 1.0, 3),
            (f64::INFINITY, 1.0, 3),
            (0.0, 0.0, 3),
            (0.0, -1.0, 3),
            (0.0, f64::NAN, 3),
            (0.0, f64::INFINITY, 3),
            (0.0, 1e300, usize::MAX),
            (1e9, 1e-9, 3),
        ];
        for (start, width, bins) in broken {
            let layout = Layout::new(4, 4, axis(start, width, bins));
            assert!(matches!(layout, Err(FilmError::TimeAxis { .. })), "{start} {width} {bins}");
        }
        assert!(Layout::new(1, 1, axis(-2.0, 0.1, 1)).is_ok());
    }
}
