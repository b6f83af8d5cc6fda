//! Which of a tile's rays come near a beam's line.
//!
//! Rays of one sample cross the film in a lattice: the ray at column i and row j of a tile has the
//! direction e = e₀ + i x + j y, not normalised, with x ⟂ y. With M the moment of the beam about the
//! eye and d its direction, the ray passes the beam's line within R if
//!
//! ```text
//! (M·e)² < R² |d × e|² = R² (|e|² − (d·e)²).
//! ```
//!
//! Along a row this is a quadratic inequality in i: a i² + 2 b i + c < 0 with u = M·(e₀ + j y),
//! β = (d × x)·(d × (e₀ + j y)), q = d·(x × (e₀ + j y)) and
//!
//! ```text
//! a = (M·x)² − R² |d × x|²,    b = (M·x) u − R² β,    b² − a c = R² (|M|² − R²) q²,
//! ```
//!
//! the last because M ⟂ d. So the rays lie between two straight lines of the film, the tangent
//! planes of the cylinder around the beam: with h = R √(|M|² − R²) |q|,
//!
//! ```text
//! (−b − h)/a < i < (−b + h)/a,    b and q linear in j.
//! ```
//!
//! Where the line runs along the rows (|M·x| < |M·y|), columns take their place; where a is small
//! against (M·x)², the line passes the eye within a few radii, and every ray of the beam's extent is
//! taken. What is found, in f32, is a superset, with allowance for rounding; the kernel decides.

use glam::DVec3;
use tpb_film::Tile;
use tpb_lanes::{F32s, F64s, Simd, Vectors};
use tpb_scene::Sensor;

use crate::sight::Sight;

/// Rows per step: as many as the widest vector has f32.
const ROWS: usize = 16;
/// Where a/(M·x)² is below this, all rays are taken.
const FLAT: f64 = 0.02;
/// Ends of intervals are found in f32 where they are smaller, in pixels.
const LARGEST_END: f32 = 4096.0;
/// Allowance for the rounding of an interval's ends, in pixels: eight of 2⁻¹³, half a step of f32 at
/// [`LARGEST_END`], and more.
const END_SLACK: f32 = 2e-3;
/// Allowance for the rounding of a beam's extent, in pixels.
const EXTENT_SLACK: f64 = 1e-6;
/// Allowance for the rounding of M·e, relative to its parts.
const SLACK: f64 = 1e-12;
const STEPS: [f32; ROWS] = [0., 1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 13., 14., 15.];
/// Rays stored at a time, wanted or not.
const STORED: usize = 4;
/// Added to an f32 below 2²², it rounds to the nearest integer, which its low bits then hold.
const ROUND: f32 = 12_582_912.0;

/// The lattice of one tile's rays.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// e₀.
    pub(crate) corner: DVec3,
    /// x.
    pub(crate) column: DVec3,
    /// y.
    pub(crate) row: DVec3,
    /// Film coordinates of e₀.
    pub(crate) at: [f64; 2],
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// At least the length of any e.
    farthest: f64,
}

/// A beam's line, in a lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// d and M.
    pub(crate) d: DVec3,
    pub(crate) m: DVec3,
    /// M·e.
    pub(crate) moment: Form,
    /// d·e.
    pub(crate) cosine: Form,
    /// How near rays may pass \[m\].
    pub(crate) radius: f64,
}

/// One of the two directions of a lattice, cut to a beam's extent.
#[derive(Clone, Copy)]
struct Side {
    step: DVec3,
    /// Which part of a [`Form`].
    part: usize,
    first: usize,
    /// One past the last.
    end: usize,
    /// Where a [`Knot`] keeps its number.
    shift: u32,
}

/// A quantity that is linear in the direction of a lattice's rays: at the first, per column, per row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form(pub(crate) [f64; 3]);

impl Form {
    #[inline(always)]
    pub(crate) fn at(&self, column: f64, row: f64) -> f64 {
        let Self([first, per_column, per_row]) = *self;
        first + column * per_column + row * per_row
    }

    /// At several places.
    #[inline(always)]
    pub(crate) fn over<S: Simd>(self, columns: F64s<S>, rows: F64s<S>) -> F64s<S> {
        let Self([first, per_column, per_row]) = self;
        columns * per_column + first + rows * per_row
    }
}

impl Lattice {
    /// v·e for all rays.
    #[inline(always)]
    pub(crate) fn form(&self, v: DVec3) -> Form {
        Form([v.dot(self.corner), v.dot(self.column), v.dot(self.row)])
    }

    /// d × e for all rays, by axis.
    #[inline(always)]
    pub(crate) fn cross(&self, d: DVec3) -> [Form; 3] {
        let (a, b, c) = (d.cross(self.corner), d.cross(self.column), d.cross(self.row));
        [Form([a.x, b.x, c.x]), Form([a.y, b.y, c.y]), Form([a.z, b.z, c.z])]
    }

    /// The place of a ray in its tile, row by row.
    #[inline(always)]
    pub(crate) fn place(&self, knot: Knot) -> u32 {
        knot.row() * self.columns as u32 + knot.column()
    }

    /// The rays of a tile through the point `offset` of its pixels (from their top left corner, in
    /// pixels).
    pub fn new<const C: usize>(sensor: &Sensor, tile: &Tile<'_, C>, offset: [f64; 2]) -> Self {
        let plane = sensor.plane();
        let (columns, rows) = (tile.columns(), tile.rows());
        let at = [columns.start as f64 + offset[0], rows.start as f64 + offset[1]];
        let corner = plane.corner + at[0] * plane.column + at[1] * plane.row;
        let (columns, rows) = (columns.len(), rows.len());
        let (right, down) = ((columns - 1) as f64 * plane.column, (rows - 1) as f64 * plane.row);
        let corners = [corner, corner + right, corner + down, corner + right + down];
        Self {
            corner,
            column: plane.column,
            row: plane.row,
            at,
            columns,
            rows,
            farthest: corners.into_iter().map(DVec3::length).fold(0.0, f64::max),
        }
    }

    /// e of all rays, row by row.
    pub(crate) fn rays(&self) -> impl Iterator<Item = DVec3> + use<> {
        let Self { corner, column, row, columns, rows, .. } = *self;
        let at = move |i: usize, j: usize| corner + i as f64 * column + j as f64 * row;
        (0..rows).flat_map(move |j| (0..columns).map(move |i| at(i, j)))
    }

    /// Unit directions of the rays, row by row.
    pub fn directions(&self) -> impl Iterator<Item = DVec3> + use<> {
        self.rays().map(DVec3::normalize)
    }

    /// Whether the camera may see a beam among these rays.
    #[inline(always)]
    pub(crate) fn sees(&self, sight: &Sight) -> bool {
        let (left, top) = (self.at[0] as f32, self.at[1] as f32);
        let (right, bottom) = (left + self.columns as f32, top + self.rows as f32);
        sight.columns[0] <= right
            && sight.columns[1] >= left - 1.0
            && sight.rows[0] <= bottom
            && sight.rows[1] >= top - 1.0
    }

    /// Writes each ray that may come near the beam to `found`, [`Lattice::room`] long, and returns
    /// how many.
    #[inline(always)]
    pub(crate) fn scan<S: Simd>(
        &self,
        simd: S,
        sight: &Sight,
        line: &Line,
        found: &mut [Knot],
    ) -> usize {
        let &Line { radius, moment, .. } = line;
        let [m0, across, along] = moment.0;
        let (across, along) = (across.abs(), along.abs());
        // The line passes the tile by: |M·e| is too large in its middle.
        let (nx, ny) = (0.5 * (self.columns - 1) as f64, 0.5 * (self.rows - 1) as f64);
        let (height, reach) = (moment.at(nx, ny).abs(), radius * self.farthest);
        let rounding = SLACK * (m0.abs() + across * nx + along * ny + reach);
        if height > across * nx + along * ny + reach + rounding {
            return 0;
        }
        let (fast, slow) = if across > along { (1, 2) } else { (2, 1) };
        let (fast, slow) = (self.side(fast, sight), self.side(slow, sight));
        if fast.first >= fast.end || slow.first >= slow.end {
            return 0;
        }
        match self.band(line, fast, slow) {
            Some(band) => band.scan(simd, fast, slow, found),
            None => all(fast, slow, found),
        }
    }

    /// The columns (1) or rows (2) that may see a beam.
    #[inline(always)]
    fn side(&self, part: usize, sight: &Sight) -> Side {
        let (step, [first, last], count) = match part {
            1 => (self.column, sight.columns, self.columns),
            _ => (self.row, sight.rows, self.rows),
        };
        let at = self.at[part - 1];
        // Conversions saturate.
        let first = (f64::from(first) - at - EXTENT_SLACK).ceil().max(0.0) as usize;
        let end = (f64::from(last) - at + EXTENT_SLACK).floor() + 1.0;
        let end = (end.max(0.0) as usize).min(count);
        Side { step, part, first, end, shift: 16 * (part as u32 - 1) }
    }

    /// Room that [`Lattice::scan`] needs.
    pub(crate) fn room(&self) -> usize {
        self.columns * self.rows + STORED
    }

    /// What lies between the tangents; `None` where they are no help.
    #[inline(always)]
    fn band(&self, line: &Line, fast: Side, slow: Side) -> Option<Band> {
        let &Line { d, m, moment, cosine, radius } = line;
        let squared = radius * radius;
        let (m0, mx, my) = (moment.0[0], moment.0[fast.part], moment.0[slow.part]);
        let (d0, dx, dy) = (cosine.0[0], cosine.0[fast.part], cosine.0[slow.part]);
        let a = mx * mx - squared * (fast.step.length_squared() - dx * dx);
        let beyond = m.length_squared() - squared;
        if a < FLAT * mx * mx || mx == 0.0 || beyond <= 0.0 {
            return None;
        }
        let inverse = 1.0 / a;
        // x ⟂ y: β has no share of y·x.
        let middle = (squared * (self.corner.dot(fast.step) - dx * d0) - mx * m0) * inverse;
        let middle_per_row = -(squared * dx * dy + mx * my) * inverse;
        let wide = radius * beyond.sqrt() * inverse;
        let half = wide * d.dot(fast.step.cross(self.corner));
        let half_per_row = wide * d.dot(fast.step.cross(slow.step));
        let band = Band {
            middle: [middle as f32, middle_per_row as f32],
            half: [half as f32, half_per_row as f32],
        };
        let rows = slow.end as f32;
        let largest = band.middle[0].abs()
            + band.half[0].abs()
            + rows * (band.middle[1].abs() + band.half[1].abs());
        (largest < LARGEST_END).then_some(band)
    }
}

/// The interval along one side, linear in the step along the other: its middle and half its width.
#[derive(Clone, Copy, Debug)]
struct Band {
    middle: [f32; 2],
    half: [f32; 2],
}

impl Band {
    #[inline(always)]
    fn scan<S: Simd>(&self, simd: S, fast: Side, slow: Side, found: &mut [Knot]) -> usize {
        let (first, last) = (fast.first as f32, (fast.end - 1) as f32);
        let (before, after) = (first - 1.0, last + 1.0);
        let mut count = 0;
        let mut start = slow.first;
        while start < slow.end {
            let (mut lower, mut upper) = ([0.0_f32; ROWS], [0.0_f32; ROWS]);
            for index in 0..ROWS / S::F32_LANES {
                let j = STEPS.vector(simd, index) + start as f32;
                let middle = j * self.middle[1] + self.middle[0];
                // Rounded to the nearest, both ends become the outermost integers inside.
                let half = (j * self.half[1] + self.half[0]).abs() - (0.5 - END_SLACK);
                let low = (middle - half).max(F32s::splat(simd, first));
                let high = (middle + half).min(F32s::splat(simd, last));
                let low = low.min(F32s::splat(simd, after)) + ROUND;
                let high = high.max(F32s::splat(simd, before)) + ROUND;
                low.store(&mut lower, index);
                high.store(&mut upper, index);
            }
            for lane in 0..ROWS.min(slow.end - start) {
                let (low, high) = (lower[lane].to_bits(), upper[lane].to_bits());
                let many = (high + 1).saturating_sub(low) as usize;
                let from = knot((low - ROUND.to_bits()) as usize, fast, start + lane, slow);
                count += put(from, many, 1 << fast.shift, &mut found[count..]);
            }
            start += ROWS;
        }
        count
    }
}

/// Writes `many` knots in a row; returns `many`. [`STORED`] of them are written without a branch.
#[inline(always)]
fn put(Knot(from): Knot, many: usize, step: u32, found: &mut [Knot]) -> usize {
    for (k, knot) in (0..).zip(&mut found[..STORED]) {
        *knot = Knot(from.wrapping_add(k * step));
    }
    if many > STORED {
        for (k, knot) in (0..).zip(&mut found[..many]).skip(STORED) {
            *knot = Knot(from.wrapping_add(k * step));
        }
    }
    many
}

/// All rays of both sides.
#[cold]
fn all(fast: Side, slow: Side, found: &mut [Knot]) -> usize {
    let mut count = 0;
    for j in slow.first..slow.end {
        let (from, many) = (knot(fast.first, fast, j, slow), fast.end - fast.first);
        count += put(from, many, 1 << fast.shift, &mut found[count..]);
    }
    count
}

/// The ray of a tile at step `i` of one side and step `j` of the other.
#[inline(always)]
fn knot(i: usize, fast: Side, j: usize, slow: Side) -> Knot {
    Knot((i as u32) << fast.shift | (j as u32) << slow.shift)
}

/// A ray of a lattice: its column and its row.
#[derive(Clone, Copy, Debug, Default)]
pub struct Knot(u32);

impl Knot {
    #[inline(always)]
    pub(crate) fn column(self) -> u32 {
        self.0 & 0xFFFF
    }

    #[inline(always)]
    pub(crate) fn row(self) -> u32 {
        self.0 >> 16
    }
}
