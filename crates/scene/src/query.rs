//! What a ray asks of a scene's surfaces: the nearest, or whether any stands in the way.
//!
//! One query is compiled for each set of vector instructions (`tpb_lanes`) and chosen when it is asked.

use glam::DVec3;
use tpb_accel::{Next, Visitor};
use tpb_lanes::{LANES, Simd, WithSimd};

use crate::packet::{self, RayLanes};
use crate::{Bsdf, Scene, Vertex};

/// A hit that lies within this relative distance of a connection's end belongs to the end's own
/// primitive (curved ones; a plane is never met again). It shortens the *test* only: transmittance
/// and time use the full distance.
pub(crate) const END_TOLERANCE: f64 = 1e-9;

/// Asks for the nearest primitive within `end`: its distance and number.
pub(crate) struct Nearest<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) from: &'a Vertex,
    pub(crate) direction: &'a DVec3,
    pub(crate) end: f64,
}

/// On its way.
struct NearestWalk<'a, S: Simd> {
    asked: Nearest<'a>,
    ray: RayLanes<S>,
    found: Option<(f64, u32)>,
}

impl WithSimd for Nearest<'_> {
    type Output = Option<(f64, u32)>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { scene, from, direction, end } = self;
        let ray = RayLanes::new(simd, from.position, *direction, from.primitive);
        let mut walk = NearestWalk { asked: self, ray, found: None };
        scene.bvh.walk(from.position, *direction, end, &mut walk);
        walk.found
    }
}

impl<S: Simd> Visitor for NearestWalk<'_, S> {
    #[inline(always)]
    fn meet(&mut self, leaf: usize) -> Next {
        let Nearest { scene, from, direction, .. } = self.asked;
        let mut next = Next::On;
        let (packets, single) = scene.leaves.leaf(leaf);
        if let Some((t, number)) = packet::nearest(packets, &self.ray, self.asked.end) {
            (self.asked.end, self.found, next) = (t, Some((t, number)), Next::Until(t));
        }
        for &index in single {
            let p = &scene.primitives[index as usize];
            let stands_on = from.primitive == Some(index);
            let end = self.asked.end;
            if let Some(t) = p.intersect(from.position, *direction, end, stands_on) {
                (self.asked.end, self.found, next) = (t, Some((t, index)), Next::Until(t));
            }
        }
        next
    }
}

/// Asks what stands between a vertex and a point at distance `end`, which lies on `end_primitive`.
pub(crate) struct Obstacles<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) from: &'a Vertex,
    pub(crate) direction: &'a DVec3,
    pub(crate) end: f64,
    pub(crate) end_primitive: Option<u32>,
}

/// What stands on a straight way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Obstacle {
    /// Nothing.
    None,
    /// Null boundaries alone.
    Boundaries,
    /// A surface that acts on light.
    Surface,
}

/// On its way: it stops at the first surface that acts on light.
struct ObstacleWalk<'a, S: Simd> {
    asked: Obstacles<'a>,
    ray: RayLanes<S>,
    found: Obstacle,
}

impl WithSimd for Obstacles<'_> {
    type Output = Obstacle;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Obstacle {
        let Self { scene, from, direction, end, .. } = self;
        let ray = RayLanes::new(simd, from.position, *direction, from.primitive);
        let mut walk = ObstacleWalk { asked: self, ray, found: Obstacle::None };
        scene.bvh.walk(from.position, *direction, end, &mut walk);
        walk.found
    }
}

impl<S: Simd> Visitor for ObstacleWalk<'_, S> {
    #[inline(always)]
    fn meet(&mut self, leaf: usize) -> Next {
        let Obstacles { scene, from, direction, end, end_primitive } = self.asked;
        let last = (packet::number(end_primitive), last_end(end));
        let (packets, single) = scene.leaves.leaf(leaf);
        for packet in packets {
            if let Some(numbers) = packet::met(packet, &self.ray, end, last)
                && self.in_the_way(&numbers)
            {
                return Next::Stop;
            }
        }
        for &index in single {
            let p = &scene.primitives[index as usize];
            let stands_on = from.primitive == Some(index);
            let t = p.intersect(from.position, *direction, end, stands_on);
            let own_end = end_primitive == Some(index);
            if t.is_some_and(|t| !own_end || t < last_end(end)) && self.blocks(index) {
                return Next::Stop;
            }
        }
        Next::On
    }
}

impl<S: Simd> ObstacleWalk<'_, S> {
    /// Whether one of these primitives, which the ray meets, acts on light.
    fn in_the_way(&mut self, numbers: &[f64; LANES]) -> bool {
        numbers.iter().any(|&number| number != packet::NOBODY && self.blocks(number as u32))
    }

    /// Whether a primitive that the ray meets acts on light.
    #[inline]
    fn blocks(&mut self, primitive: u32) -> bool {
        if matches!(self.asked.scene.shape(primitive).bsdf, Bsdf::Null) {
            self.found = Obstacle::Boundaries;
            return false;
        }
        self.found = Obstacle::Surface;
        true
    }
}

/// Where the end's own primitive is no longer in the way.
#[inline(always)]
fn last_end(end: f64) -> f64 {
    end * (1.0 - END_TOLERANCE)
}
