//! Bundles of rays against bundles of beams: which may come near each other.
//!
//! In Plücker coordinates, about the middle of all beams and in units of their extent, a beam is
//! (d, M) with M = o × d and a ray (ω, m) likewise. Their lines pass each other at the distance
//!
//! ```text
//! |d·m + M·ω| / |d × ω| ≥ |d·m + M·ω|,
//! ```
//!
//! which is linear in the ray. For a bundle, whose ω and m lie in boxes, the form is bounded by its
//! value in their middle and the half edges times |d| and |M|, axis by axis: a beam for which that
//! exceeds the radius comes near no ray of the bundle. Beams whose boxes miss that of the bundle
//! drop out too. (Plücker coordinates: Shoemake 1998, "Plücker Coordinate Tutorial".)
//!
//! All of this is f32 and culls only: allowances cover its rounding.

use glam::DVec3;
use tpb_accel::Aabb;
use tpb_lanes::{F32s, Simd, Vectors};

use crate::beam::{Beam, CameraRay};

/// Beams, or rays, that are tested together.
pub(crate) const BLOCK: usize = 16;

/// Allowance for the rounding of the form, of lengths about 1: a dozen roundings of 2⁻²⁴, of sums
/// of six products.
const SLACK: f32 = 4e-6;

/// As many numbers as a block has lines.
pub(crate) type Numbers = [f32; BLOCK];

/// The coordinates in which lines are compared.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    centre: DVec3,
    /// One over the radius of the ball around all that is compared \[1/m\].
    scale: f64,
}

/// Some beams. Places beyond the last hold lines that are near nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BeamBlock {
    direction: [Numbers; 3],
    moment: [Numbers; 3],
    low: [Numbers; 3],
    high: [Numbers; 3],
    /// Which beams they are.
    pub(crate) index: [u32; BLOCK],
}

/// Rays that travel much the same way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bundle {
    direction: [Range; 3],
    moment: [Range; 3],
    low: [f32; 3],
    high: [f32; 3],
}

/// Some rays, one by one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayBlock {
    direction: [Numbers; 3],
    moment: [Numbers; 3],
}

/// A ray within the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    direction: DVec3,
    moment: DVec3,
    ends: Aabb,
}

impl Frame {
    /// Around beams with what lies within `radius` of them.
    pub(crate) fn new<const C: usize>(beams: &[Beam<C>], radius: f64) -> Self {
        let ends = beams.iter().flat_map(|beam| [beam.origin, end(beam)]);
        let around = Aabb::around(ends);
        if beams.is_empty() {
            return Self { centre: DVec3::ZERO, scale: 1.0 };
        }
        let centre = around.min + 0.5 * (around.max - around.min);
        let reach = 0.5 * (around.max - around.min).length() + radius;
        Self { centre, scale: 1.0 / reach.max(f64::MIN_POSITIVE) }
    }

    /// A length in this frame, rounded up.
    pub(crate) fn radius(&self, radius: f64) -> f32 {
        ((radius * self.scale) as f32).next_up() + SLACK
    }

    fn point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    /// A ray, cut to the ball around all; `None` if it misses that.
    pub(crate) fn line<const C: usize>(&self, ray: &CameraRay<C>) -> Option<Line> {
        let (origin, direction) = (self.point(ray.origin), ray.direction);
        let along = -origin.dot(direction);
        let foot = origin + along * direction;
        let half = (1.0 - foot.length_squared() + f64::from(SLACK)).max(0.0).sqrt();
        let (first, last) = ((along - half).max(0.0), (along + half).min(ray.length * self.scale));
        // A far origin's rounding must not lose the ray.
        let sure = origin.length() < 1e9;
        if sure && (first > last || foot.length_squared() > 1.0 + f64::from(SLACK)) {
            return None;
        }
        let ends = Aabb::around([origin + first * direction, origin + last * direction]);
        Some(Line { direction, moment: foot.cross(direction), ends })
    }
}

fn end<const C: usize>(beam: &Beam<C>) -> DVec3 {
    beam.origin + beam.length * beam.direction
}

impl BeamBlock {
    /// The number of no beam.
    pub(crate) const NONE: u32 = u32::MAX;

    const NOWHERE: Self = Self {
        direction: [[0.0; BLOCK]; 3],
        moment: [[0.0; BLOCK]; 3],
        low: [[f32::INFINITY; BLOCK]; 3],
        high: [[f32::NEG_INFINITY; BLOCK]; 3],
        index: [Self::NONE; BLOCK],
    };

    /// Of up to [`BLOCK`] beams, the first of which is number `first`.
    pub(crate) fn new<const C: usize>(frame: &Frame, beams: &[Beam<C>], first: usize) -> Self {
        let mut block = Self::NOWHERE;
        for (lane, beam) in beams.iter().enumerate() {
            let (from, to) = (frame.point(beam.origin), frame.point(end(beam)));
            let moment = from.cross(beam.direction);
            for axis in 0..3 {
                block.direction[axis][lane] = beam.direction[axis] as f32;
                block.moment[axis][lane] = moment[axis] as f32;
                block.low[axis][lane] = from[axis].min(to[axis]) as f32 - SLACK;
                block.high[axis][lane] = from[axis].max(to[axis]) as f32 + SLACK;
            }
            block.index[lane] = (first + lane) as u32;
        }
        block
    }

    /// Which of them may come within `radius` of some ray of a bundle: 1 or 0 each.
    #[inline(always)]
    pub(crate) fn near<S: Simd>(&self, simd: S, bundle: &Bundle, radius: f32) -> Numbers {
        let mut near = [0.0; BLOCK];
        for index in 0..BLOCK / S::F32_LANES {
            let mut form = F32s::splat(simd, 0.0);
            let mut reach = F32s::splat(simd, radius);
            let mut apart = F32s::splat(simd, 0.0);
            for axis in 0..3 {
                let d = self.direction[axis].vector(simd, index);
                let m = self.moment[axis].vector(simd, index);
                let (direction, moment) = (bundle.direction[axis], bundle.moment[axis]);
                form = form + d * moment.middle + m * direction.middle;
                reach = reach + d.abs() * moment.half + m.abs() * direction.half;
                let low = self.low[axis].vector(simd, index);
                let high = self.high[axis].vector(simd, index);
                apart = apart.max(low - bundle.high[axis]);
                apart = apart.max(F32s::splat(simd, bundle.low[axis]) - high);
            }
            let within = apart.at_most(F32s::splat(simd, radius));
            let is_near = form.abs().at_most(reach).and(within);
            is_near.of(F32s::splat(simd, 1.0)).store(&mut near, index);
        }
        near
    }

    /// Adds its beam number `lane` to `blocks`, which hold `count` so far.
    #[inline(always)]
    pub(crate) fn push(&self, lane: usize, blocks: &mut Vec<Self>, count: usize) {
        let place = count % BLOCK;
        if place == 0 {
            blocks.push(Self::NOWHERE);
        }
        let Some(last) = blocks.last_mut() else { return };
        for axis in 0..3 {
            last.direction[axis][place] = self.direction[axis][lane];
            last.moment[axis][place] = self.moment[axis][lane];
            last.low[axis][place] = self.low[axis][lane];
            last.high[axis][place] = self.high[axis][lane];
        }
        last.index[place] = self.index[lane];
    }
}

/// Middle and half the width of a range.
#[derive(Clone, Copy, Debug)]
struct Range {
    middle: f32,
    half: f32,
}

impl Bundle {
    /// Around rays; `None` if there are none.
    pub(crate) fn around(lines: impl Iterator<Item = Line> + Clone) -> Option<Self> {
        let ranges = |all: Aabb| {
            [0, 1, 2].map(|axis| {
                let middle = (0.5 * (all.min[axis] + all.max[axis])) as f32;
                let half =
                    (all.max[axis] - f64::from(middle)).max(f64::from(middle) - all.min[axis]);
                Range { middle, half: (half as f32).next_up() }
            })
        };
        let direction = Aabb::around(lines.clone().map(|line| line.direction));
        let moment = Aabb::around(lines.clone().map(|line| line.moment));
        let ends = lines.map(|line| line.ends).fold(Aabb::EMPTY, Aabb::union);
        (direction.min.x <= direction.max.x).then(|| Self {
            direction: ranges(direction),
            moment: ranges(moment),
            low: [0, 1, 2].map(|axis| (ends.min[axis] as f32).next_down()),
            high: [0, 1, 2].map(|axis| (ends.max[axis] as f32).next_up()),
        })
    }
}

impl RayBlock {
    /// Of up to [`BLOCK`] rays; what is no ray is near nothing.
    pub(crate) fn new(lines: &[Option<Line>]) -> Self {
        let mut block = Self { direction: [[0.0; BLOCK]; 3], moment: [[FAR; BLOCK]; 3] };
        for (lane, line) in lines.iter().enumerate() {
            let Some(line) = line else { continue };
            for axis in 0..3 {
                block.direction[axis][lane] = line.direction[axis] as f32;
                block.moment[axis][lane] = line.moment[axis] as f32;
            }
        }
        block
    }

    /// Which of them may pass the line of beam number `lane` of `beams` within `radius`: 1 or 0 each.
    #[inline(always)]
    pub(crate) fn near<S: Simd>(
        &self,
        simd: S,
        beams: &BeamBlock,
        lane: usize,
        radius: f32,
    ) -> Numbers {
        let mut near = [0.0; BLOCK];
        for index in 0..BLOCK / S::F32_LANES {
            let mut form = F32s::splat(simd, 0.0);
            let mut cosine = F32s::splat(simd, 0.0);
            for axis in 0..3 {
                let direction = self.direction[axis].vector(simd, index);
                let (d, m) = (beams.direction[axis][lane], beams.moment[axis][lane]);
                form = form + self.moment[axis].vector(simd, index) * d + direction * m;
                cosine = cosine + direction * d;
            }
            // |d × ω|², which cancels for parallel lines.
            let sine2 = F32s::splat(simd, 1.0 + SLACK) - cosine * cosine;
            let beyond = (form.abs() - SLACK).max(F32s::splat(simd, 0.0));
            let is_near = (beyond * beyond).at_most(sine2 * (radius * radius));
            is_near.of(F32s::splat(simd, 1.0)).store(&mut near, index);
        }
        near
    }
}

/// The moment of what is no ray.
const FAR: f32 = 1e9;
