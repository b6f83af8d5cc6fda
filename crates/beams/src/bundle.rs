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
//! All of this is f32 and culls only: allowances cover its rounding. They are relative to each line's
//! own moment, so that a few beams of kilometres in thin media do not blur the rest.

use glam::DVec3;
use tpb_accel::Aabb;
use tpb_lanes::{F32s, Simd, Vectors};

use crate::beam::{Beam, CameraRay};

/// Beams, or rays, that are tested together.
pub(crate) const BLOCK: usize = 16;

/// Allowance for the rounding of f32, relative: a dozen roundings of 2⁻²⁴, of sums of six products, and
/// more.
const SLACK: f32 = 4e-6;
/// Allowance for the rounding of f64, of places at distances of 1.
const ROUNDING: f64 = 1e-14;
/// Radii below this are taken as this: their squares would leave the range of f32.
const LEAST_RADIUS: f32 = 1e-16;
/// Beams whose origins tell where most are.
const ASKED: usize = 1001;

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
    /// Allowance for the rounding of each ray's moment.
    rounding: Numbers,
}

/// A ray within the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    direction: DVec3,
    moment: DVec3,
    ends: Aabb,
    /// Allowance for the rounding of both, of f64.
    rounding: f64,
}

impl Frame {
    /// Around beams with what lies within `radius` of them.
    pub(crate) fn new<const C: usize>(beams: &[Beam<C>], radius: f64) -> Self {
        if beams.is_empty() {
            return Self { centre: DVec3::ZERO, scale: 1.0 };
        }
        let ends = beams.iter().flat_map(|beam| [beam.origin, end(beam)]);
        let around = Aabb::around(ends);
        let centre = centre(beams);
        let reach = (around.max - centre).max(centre - around.min).length() + radius;
        Self { centre, scale: 1.0 / reach.max(f64::MIN_POSITIVE) }
    }

    /// A length in this frame, rounded up.
    pub(crate) fn radius(&self, radius: f64) -> f32 {
        let radius = (radius * self.scale + ROUNDING) as f32;
        (radius * (1.0 + SLACK)).max(LEAST_RADIUS)
    }

    fn point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    /// A ray, cut to the ball around all; `None` if it misses that.
    pub(crate) fn line<const C: usize>(&self, ray: &CameraRay<C>) -> Option<Line> {
        let (origin, direction) = (self.point(ray.origin), ray.direction);
        let along = -origin.dot(direction);
        let foot = origin + along * direction;
        // A far origin's rounding must not lose the ray.
        let rounding = ROUNDING * origin.length();
        let ball = 1.0 + f64::from(SLACK) + rounding;
        let half = (ball * ball - foot.length_squared()).max(0.0).sqrt();
        let (first, last) = ((along - half).max(0.0), (along + half).min(ray.length * self.scale));
        if first > last || foot.length_squared() > ball * ball {
            return None;
        }
        let ends = Aabb::around([origin + first * direction, origin + last * direction]);
        Some(Line { direction, moment: foot.cross(direction), ends, rounding })
    }
}

/// Where most beams start, by axis.
fn centre<const C: usize>(beams: &[Beam<C>]) -> DVec3 {
    let asked = beams.iter().step_by(beams.len().div_ceil(ASKED));
    DVec3::from_array([0, 1, 2].map(|axis| {
        let mut places: Vec<_> = asked.clone().map(|beam| beam.origin[axis]).collect();
        let middle = places.len() / 2;
        *places.select_nth_unstable_by(middle, f64::total_cmp).1
    }))
}

/// A number in f32 with allowance for its rounding, downward and upward.
fn outward(number: f64, rounding: f64) -> [f32; 2] {
    let allowance = rounding + f64::from(SLACK) * number.abs();
    [(number - allowance) as f32, (number + allowance) as f32]
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
                [block.low[axis][lane], _] = outward(from[axis].min(to[axis]), 0.0);
                [_, block.high[axis][lane]] = outward(from[axis].max(to[axis]), 0.0);
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
        let rounding = lines.clone().map(|line| line.rounding).fold(0.0, f64::max);
        let direction = Aabb::around(lines.clone().map(|line| line.direction));
        let moment = Aabb::around(lines.clone().map(|line| line.moment));
        let ends = lines.map(|line| line.ends).fold(Aabb::EMPTY, Aabb::union);
        (direction.min.x <= direction.max.x).then(|| Self {
            direction: [0, 1, 2].map(|axis| Range::of(direction, axis, 0.0)),
            moment: [0, 1, 2].map(|axis| Range::of(moment, axis, rounding)),
            low: [0, 1, 2].map(|axis| outward(ends.min[axis], rounding)[0]),
            high: [0, 1, 2].map(|axis| outward(ends.max[axis], rounding)[1]),
        })
    }
}

impl Range {
    /// One axis of a box, with allowance for rounding.
    fn of(all: Aabb, axis: usize, rounding: f64) -> Self {
        let (min, max) = (all.min[axis], all.max[axis]);
        let middle = 0.5 * (min + max) as f32;
        let half = (max - f64::from(middle)).max(f64::from(middle) - min);
        let [_, half] = outward(half, rounding + f64::from(SLACK) * min.abs().max(max.abs()));
        Self { middle, half }
    }
}

impl RayBlock {
    /// Of up to [`BLOCK`] rays. What is no ray is far from most beams; the kernel joins it to none.
    pub(crate) fn new(lines: &[Option<Line>]) -> Self {
        let mut block = Self {
            direction: [[0.0; BLOCK]; 3],
            moment: [[FAR; BLOCK]; 3],
            rounding: [0.0; BLOCK],
        };
        for (lane, line) in lines.iter().enumerate() {
            let Some(line) = line else { continue };
            for axis in 0..3 {
                block.direction[axis][lane] = line.direction[axis] as f32;
                block.moment[axis][lane] = line.moment[axis] as f32;
            }
            let size = line.moment.abs().element_sum();
            [_, block.rounding[lane]] = outward(f64::from(SLACK) * size, line.rounding);
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
        let size: f32 = (0..3).map(|axis| beams.moment[axis][lane].abs()).sum();
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
            let rounding = self.rounding.vector(simd, index) + SLACK * size;
            let beyond = (form.abs() - rounding).max(F32s::splat(simd, 0.0));
            let is_near = (beyond * beyond).at_most(sine2 * (radius * radius));
            is_near.of(F32s::splat(simd, 1.0)).store(&mut near, index);
        }
        near
    }
}

/// The moment of what is no ray.
const FAR: f32 = 1e9;
