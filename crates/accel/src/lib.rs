//! A bounding volume hierarchy that culls in f32, conservatively, for primitives tested in f64.
//!
//! The hierarchy is built by `obvhs` (PLOC construction, reinsertion) as a binary tree, and joined to nodes
//! of four, with leaves of several primitives. This crate owns what makes it safe for us: coordinates are centred and scaled to about one, so that no scene size
//! overflows f32; rays that start far away are moved up to the boxes in f64 first; boxes are padded
//! by more than the rounding of the f32 slab test. A ray may therefore be shown primitives that it
//! misses, never the reverse.
//!
//! **Padding.** With |o|, |b| ≤ `REACH` the slab distance (b − o)·(1/d) carries at most three
//! roundings after those of o, b and d themselves, each ε/2 relative with ε = 2⁻²³; as a shift of
//! the plane that is at most (|o| + |b|)·3ε ≤ 2·4·3ε ≈ 2.9e-6. Boxes are padded by 4e-6.

mod leaves;
mod wide;

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;

use crate::leaves::Leaves;
use crate::wide::{Ray, Wide};

/// Scaled ray origins lie within this distance of the centre; scaled boxes within 1.
const REACH: f64 = 4.0;
/// Padding of the scaled boxes, above the f32 slab test's error.
const PADDING: f64 = 4e-6;
/// Relative slack on distances that shorten a ray, for the same reason.
const SLACK: f64 = 1.0 + 4e-6;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner \[m\].
    pub min: DVec3,
    /// Largest corner \[m\].
    pub max: DVec3,
}

impl Aabb {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around points.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Grown by `margin` on every side.
    #[must_use]
    pub fn grown(self, margin: f64) -> Self {
        Self { min: self.min - DVec3::splat(margin), max: self.max + DVec3::splat(margin) }
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the diagonal.
    pub fn radius(&self) -> f64 {
        0.5 * (self.max - self.min).length()
    }
}

/// What asks for leaves on a ray. Its code belongs into that of [`Bvh::walk`]: it may use vector
/// instructions, so mark it `#[inline(always)]`.
pub trait Visitor {
    /// The ray may meet the box of this leaf.
    fn meet(&mut self, leaf: usize) -> Next;
}

/// How the walk along a ray goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Next {
    /// As it is.
    On,
    /// To this distance \[m\].
    Until(f64),
    /// Not at all.
    Stop,
}

/// The hierarchy over boxes `0..n`; its leaves hold one or several.
#[derive(Clone)]
pub struct Bvh {
    tree: Wide,
    leaves: Leaves,
    centre: DVec3,
    per_metre: f64,
}

impl Bvh {
    /// Builds over finite boxes (an empty list is fine), fewer than 2³¹ of them; those that `joins` names
    /// may share leaves. It takes its time: the geometry of a scene is built once.
    pub fn build(boxes: &[Aabb], joins: impl Fn(usize) -> bool) -> Self {
        let bounds = boxes.iter().fold(Aabb::EMPTY, |a, &b| a.union(b));
        let (centre, radius) =
            if boxes.is_empty() { (DVec3::ZERO, 1.0) } else { (bounds.centre(), bounds.radius()) };
        let per_metre = 1.0 / radius.max(f64::MIN_POSITIVE.sqrt());
        let scaled: Vec<_> = boxes
            .iter()
            .map(|b| {
                let min = (b.min - centre) * per_metre - DVec3::splat(PADDING);
                let max = (b.max - centre) * per_metre + DVec3::splat(PADDING);
                obvhs::aabb::Aabb::new(min.as_vec3a(), max.as_vec3a())
            })
            .collect();
        let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::slow_build() };
        let binary = obvhs::bvh2::builder::build_bvh2(&scaled, params, &mut Duration::default());
        let leaves = Leaves::new(&binary, joins);
        Self { tree: Wide::new(&binary, &leaves), leaves, centre, per_metre }
    }

    /// The boxes of each leaf, by the leaves' numbers from 0.
    pub fn leaves(&self) -> impl Iterator<Item = &[u32]> {
        self.leaves.members()
    }

    /// Shows a visitor every leaf with a box that the ray may meet at a distance within 0..=`t_max`, as
    /// far as the visitor lets it go; nearer leaves tend to come first. `direction` is a unit vector.
    #[inline(always)]
    pub fn walk(&self, origin: DVec3, direction: DVec3, t_max: f64, visitor: &mut impl Visitor) {
        match self.leaves.count() {
            0 => {}
            1 => {
                visitor.meet(0);
            }
            _ => {
                let Some((mut ray, skipped)) = self.enter(origin, direction, t_max) else { return };
                self.tree.walk(&mut ray, |t| self.end(t, skipped), visitor);
            }
        }
    }

    /// The ray in the boxes' coordinates, and the distance in them by which it was moved up; `None`
    /// if it meets no box.
    #[inline(always)]
    fn enter(&self, origin: DVec3, direction: DVec3, t_max: f64) -> Option<(Ray, f64)> {
        let scaled = (origin - self.centre) * self.per_metre;
        let (mut start, mut skipped) = (scaled, 0.0);
        if scaled.length_squared() > REACH * REACH {
            // A far origin moves up to the ball that holds all boxes.
            skipped = (-scaled.dot(direction) - REACH).max(0.0);
            start = scaled + skipped * direction;
            if start.length_squared() > 4.0 * REACH * REACH {
                return None; // passes by, or leads away
            }
        }
        let end = self.end(t_max, skipped).min(f32::MAX);
        (end >= 0.0).then(|| (Ray::new(start.as_vec3a(), inverse(direction), end), skipped))
    }

    /// A distance in the boxes' coordinates, rounded up.
    #[inline(always)]
    fn end(&self, t: f64, skipped: f64) -> f32 {
        ((t * self.per_metre - skipped) * SLACK + PADDING) as f32
    }
}

/// 1/direction in f32, finite.
#[inline(always)]
fn inverse(direction: DVec3) -> Vec3A {
    let d = direction.as_vec3a();
    let tiny = Vec3A::splat(1e-30);
    Vec3A::select(d.abs().cmplt(tiny), tiny.copysign(d), d).recip()
}
