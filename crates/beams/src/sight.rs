//! Where the camera's rays may meet a beam: the film's columns and rows that see any of it.
//!
//! The kernels join a beam to a point of a ray within R of a point of the beam. Seen from the eye,
//! the points within R of a segment in front of it lie between the tangents of the balls around its
//! ends. A beam that comes nearer to the plane of the eye than 2R is cut there: of what is nearer,
//! only points within R of the rays' first 3R matter, and if there are any, the beam may be met
//! anywhere.

use glam::DVec3;
use rayon::prelude::*;
use tpb_scene::Sensor;
use tpb_transport::Horizon;

use crate::beam::Beam;

/// Relative allowance for the rounding of what a radius is compared with.
const SLACK: f64 = 1e-9;
/// Allowance for the rounding of places, relative to their distances: some hundred of f64. Beams in
/// thin media are long, and a larger allowance would let all of them be seen from everywhere.
const ROUNDING: f64 = 1e-13;
/// Beams are listed by at least so many rows of the film.
const BAND: usize = 64;

/// A beam as the camera sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    /// First and last column that may meet it, as film coordinates; first > last if none.
    pub(crate) columns: [f32; 2],
    /// Likewise the rows.
    pub(crate) rows: [f32; 2],
}

const EVERYWHERE: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];
const NOWHERE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

impl Sight {
    /// Of a beam for kernels of `radius`; of what of it may arrive in time, if that matters.
    pub(crate) fn new<const C: usize>(
        sensor: &Sensor,
        beam: &Beam<C>,
        (radius, horizon): (f64, Option<Horizon>),
    ) -> Self {
        let origin = beam.origin - sensor.position;
        let in_time = horizon.as_ref().map_or(Some([0.0, beam.length]), |horizon| {
            horizon.seen((beam.origin, beam.direction), beam.length, beam.opl)
        });
        let Some([start, end]) = in_time else {
            return Self { columns: NOWHERE, rows: NOWHERE };
        };
        let (first, last) = (origin + start * beam.direction, origin + end * beam.direction);
        let radius = radius * (1.0 + SLACK) + ROUNDING * (origin.length() + beam.length);
        let [columns, rows] = extent(sensor, [first, last], radius);
        Self { columns, rows }
    }
}

/// Columns and rows that see a segment, relative to the eye, and all within `radius` of it.
fn extent(sensor: &Sensor, ends: [DVec3; 2], radius: f64) -> [[f32; 2]; 2] {
    let depths = ends.map(|end| end.dot(sensor.forward()));
    let near = 2.0 * radius;
    if depths[0].min(depths[1]) > near {
        return hull(sensor, ends, radius);
    }
    // The point of the segment at some depth; the depths differ if it is between them.
    let at = |depth: f64| {
        let share = (depth - depths[0]) / (depths[1] - depths[0]);
        ends[0] + share.clamp(0.0, 1.0) * (ends[1] - ends[0])
    };
    let (shallow, deep) = if depths[0] < depths[1] { (0, 1) } else { (1, 0) };
    if depths[deep] < -radius {
        return [NOWHERE; 2];
    }
    let cut = |end: usize, depth: f64, beyond: bool| if beyond { at(depth) } else { ends[end] };
    let from = cut(shallow, -radius, depths[shallow] < -radius);
    let to = cut(deep, near, depths[deep] > near);
    let reached = sensor.half_extents().iter().all(|&(axis, half)| {
        let (a, b) = (from.dot(axis), to.dot(axis));
        let reach = (3.0 * half + 1.0) * radius * (1.0 + SLACK);
        a.min(b) <= reach && a.max(b) >= -reach
    });
    if reached {
        return [EVERYWHERE; 2];
    }
    if depths[deep] > near { hull(sensor, [to, ends[deep]], radius) } else { [NOWHERE; 2] }
}

/// Of a segment whose ends lie in front of the eye by more than the radius.
fn hull(sensor: &Sensor, ends: [DVec3; 2], radius: f64) -> [[f32; 2]; 2] {
    let [Some(a), Some(b)] = ends.map(|end| sensor.extent(end, radius)) else {
        return [EVERYWHERE; 2];
    };
    [0, 1].map(|axis| {
        let (first, last) = (a[axis].0.min(b[axis].0), a[axis].1.max(b[axis].1));
        [(first as f32).next_down(), (last as f32).next_up()]
    })
}

/// The beams of one pass as the camera sees them, and by rows of the film.
pub struct Sights {
    /// The beams that may be seen in each band of rows, in their order. What is seen of them lies beside:
    /// a tile reads it of all, and most of the beams themselves never.
    bands: Vec<Vec<(u32, Sight)>>,
    /// Rows of a band.
    rows: usize,
}

impl Sights {
    /// For a film of `height` rows in tiles of `edge` rows, by kernels of some radius, of what may arrive
    /// in time.
    pub fn new<const C: usize>(
        sensor: &Sensor,
        beams: &[Beam<C>],
        near: (f64, Option<Horizon>),
        (height, edge): (usize, usize),
    ) -> Self {
        let all: Vec<_> = beams.par_iter().map(|beam| Sight::new(sensor, beam, near)).collect();
        let rows = edge * BAND.div_ceil(edge);
        let bands = (0..height.div_ceil(rows))
            .into_par_iter()
            .map(|band| {
                let (first, last) = ((band * rows) as f32, ((band + 1) * rows) as f32);
                let seen = |sight: &Sight| sight.rows[0] <= last && sight.rows[1] >= first;
                (0..).zip(all.iter().copied()).filter(|(_, sight)| seen(sight)).collect()
            })
            .collect();
        Self { bands, rows }
    }

    /// The beams that a tile may see, and more; `row` is its first.
    pub(crate) fn listed(&self, row: usize) -> &[(u32, Sight)] {
        &self.bands[row / self.rows]
    }
}
