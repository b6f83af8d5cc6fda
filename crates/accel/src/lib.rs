//! A bounding volume hierarchy that culls in f32, conservatively, for primitives tested in f64.
//!
//! The hierarchy itself is `obvhs` (PLOC construction, binary nodes). This crate owns what makes
//! it safe for us: coordinates are centred and scaled to about one, so that no scene size
//! overflows f32; rays that start far away are moved up to the boxes in f64 first; boxes are padded
//! by more than the rounding of the f32 slab test. A ray may therefore be shown primitives that it
//! misses, never the reverse.
//!
//! **Padding.** With |o|, |b| ≤ `REACH` the slab distance (b − o)·(1/d) carries at most three
//! roundings after those of o, b and d themselves, each ε/2 relative with ε = 2⁻²³; as a shift of
//! the plane that is at most (|o| + |b|)·3ε ≤ 2·4·3ε ≈ 2.9e-6. Boxes are padded by 4e-6.

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::ploc::PlocSearchDistance;
use obvhs::ray::{Ray, RayHit};
use obvhs::{BvhBuildParams, bvh2::Bvh2};

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

/// How much time to spend on building for faster queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Built anew in every pass (beams).
    FastBuild,
    /// Built once (scene geometry).
    FastQuery,
}

/// The hierarchy over boxes `0..n`; it answers with their indices.
#[derive(Clone)]
pub struct Bvh {
    nodes: Bvh2,
    centre: DVec3,
    per_metre: f64,
}

impl Bvh {
    /// Builds over finite boxes (an empty list is fine).
    pub fn build(boxes: &[Aabb], quality: Quality) -> Self {
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
        let params = match quality {
            Quality::FastBuild => BvhBuildParams {
                ploc_search_distance: PlocSearchDistance::Minimum,
                reinsertion_batch_ratio: 0.0,
                max_prims_per_leaf: 4,
                ..BvhBuildParams::fastest_build()
            },
            Quality::FastQuery => {
                // A box costs less than a primitive in f64: no leaf holds more than one.
                BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::slow_build() }
            }
        };
        let nodes = obvhs::bvh2::builder::build_bvh2(&scaled, params, &mut Duration::default());
        Self { nodes, centre, per_metre }
    }

    /// Shows `visit` every index whose box the ray may meet at a distance within 0..=`t_max`.
    /// `visit` returns the distance at which the ray now ends, or `None` to leave it as it is;
    /// nearer boxes tend to come first. `direction` is a unit vector.
    #[inline]
    pub fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        mut visit: impl FnMut(usize) -> Option<f64>,
    ) {
        let scaled = (origin - self.centre) * self.per_metre;
        // A far origin moves up to the ball that holds all boxes.
        let skipped = if scaled.length_squared() > REACH * REACH {
            (-scaled.dot(direction) - REACH).max(0.0)
        } else {
            0.0
        };
        let start = scaled + skipped * direction;
        if start.length_squared() > 4.0 * REACH * REACH {
            return; // passes by, or leads away
        }
        let end = |t: f64| ((t * self.per_metre - skipped) * SLACK + PADDING) as f32;
        let ray = Ray::new(start.as_vec3a(), nonzero(direction), 0.0, end(t_max).min(f32::MAX));
        if ray.tmax < 0.0 {
            return;
        }
        let indices = &self.nodes.primitive_indices;
        let mut leaf = |node: &obvhs::bvh2::node::Bvh2Node, ray: &mut Ray, _: &mut RayHit| {
            let first = node.first_index as usize;
            for &index in &indices[first..first + node.prim_count as usize] {
                if let Some(t) = visit(index as usize) {
                    ray.tmax = end(t);
                }
            }
            true
        };
        let mut hit = RayHit::none();
        obvhs::fast_stack!(u32, (96, 192), self.nodes.max_depth, stack, {
            self.nodes.ray_traverse_dynamic(&mut stack, ray, &mut hit, &mut leaf);
        });
    }
}

/// The direction in f32, no component so small that its inverse is not finite.
fn nonzero(direction: DVec3) -> Vec3A {
    let d = direction.as_vec3a();
    let tiny = Vec3A::splat(1e-30);
    Vec3A::select(d.abs().cmplt(tiny), tiny.copysign(d), d)
}
