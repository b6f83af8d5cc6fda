//! Planar primitives tested several at once, in vectors of f64: the leaves of the hierarchy.
//!
//! A packet holds up to [`LANES`] parallelograms or triangles. Its test is that of
//! [`Planar`](crate::geometry::Planar) operation by operation, so that it finds the same distances, to the
//! bit. Ellipses, spheres and cylinders are tested one by one.

use glam::DVec3;
use tpb_accel::Bvh;
use tpb_lanes::{F64s, LANES, Mask, Simd, Vectors, vectors};

use crate::Primitive;
use crate::geometry::{Outline, Planar};

/// A number that is no primitive's.
pub(crate) const NOBODY: f64 = -1.0;

/// Components of several vectors.
type Columns = [[f64; LANES]; 3];

/// Up to [`LANES`] primitives of one outline. Empty places have a normal of 0, and are never met.
#[derive(Clone)]
#[repr(align(64))]
pub(crate) struct Packet {
    origin: Columns,
    normal: Columns,
    dual_u: Columns,
    dual_v: Columns,
    /// The primitives' numbers.
    number: [f64; LANES],
    /// How many places are taken, from the first.
    filled: usize,
    /// Whether they are triangles.
    triangles: bool,
}

/// A ray in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct RayLanes<S: Simd> {
    simd: S,
    origin: [F64s<S>; 3],
    direction: [F64s<S>; 3],
    /// The number of the primitive that it starts on: never met.
    but: F64s<S>,
}

impl<S: Simd> RayLanes<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, origin: DVec3, direction: DVec3, but: Option<u32>) -> Self {
        Self {
            simd,
            origin: splat(simd, origin),
            direction: splat(simd, direction),
            but: F64s::splat(simd, number(but)),
        }
    }
}

/// The number of a primitive, as packets have it.
#[inline(always)]
pub(crate) fn number(primitive: Option<u32>) -> f64 {
    match primitive {
        Some(primitive) => f64::from(primitive),
        None => NOBODY,
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, v: DVec3) -> [F64s<S>; 3] {
    [F64s::splat(simd, v.x), F64s::splat(simd, v.y), F64s::splat(simd, v.z)]
}

#[inline(always)]
fn dot<S: Simd>(a: [F64s<S>; 3], b: [F64s<S>; 3]) -> F64s<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Packet {
    /// Of primitives of one outline, with their numbers.
    fn new(outline: Outline, members: &[(u32, &Planar)]) -> Self {
        let empty = [[0.0; LANES]; 3];
        let mut packet = Self {
            origin: empty,
            normal: empty,
            dual_u: empty,
            dual_v: empty,
            number: [NOBODY; LANES],
            filled: members.len(),
            triangles: outline == Outline::Triangle,
        };
        for (lane, (number, planar)) in members.iter().enumerate() {
            packet.number[lane] = f64::from(*number);
            for axis in 0..3 {
                packet.origin[axis][lane] = planar.origin[axis];
                packet.normal[axis][lane] = planar.normal[axis];
                packet.dual_u[axis][lane] = planar.dual_u[axis];
                packet.dual_v[axis][lane] = planar.dual_v[axis];
            }
        }
        packet
    }

    #[inline(always)]
    fn numbers<S: Simd>(&self, simd: S, index: usize) -> F64s<S> {
        self.number.vector(simd, index)
    }

    /// Whether some place of vector `index` is taken.
    #[inline(always)]
    fn reaches<S: Simd>(&self, index: usize) -> bool {
        self.filled > index * (LANES / vectors::<S>())
    }

    /// Which primitives of vector `index` the ray meets at a distance in (0, `end`), and these distances.
    #[inline(always)]
    fn meets<S: Simd>(&self, index: usize, ray: &RayLanes<S>, end: F64s<S>) -> (Mask<S>, F64s<S>) {
        let simd = ray.simd;
        let (o, d) = (ray.origin, ray.direction);
        let origin = columns(&self.origin, simd, index);
        let normal = columns(&self.normal, simd, index);
        let to_plane = [origin[0] - o[0], origin[1] - o[1], origin[2] - o[2]];
        let t = dot(to_plane, normal) / dot(d, normal);
        let local = [t * d[0] - to_plane[0], t * d[1] - to_plane[1], t * d[2] - to_plane[2]];
        let a = dot(local, columns(&self.dual_u, simd, index));
        let b = dot(local, columns(&self.dual_v, simd, index));
        let (zero, one) = (F64s::splat(simd, 0.0), F64s::splat(simd, 1.0));
        let within = if self.triangles {
            zero.at_most(a).and(zero.at_most(b)).and((a + b).at_most(one))
        } else {
            a.abs().at_most(one).and(b.abs().at_most(one))
        };
        let along = zero.less(t).and(t.less(end));
        (along.and(within).and(!self.numbers(simd, index).equals(ray.but)), t)
    }
}

#[inline(always)]
fn columns<S: Simd>(of: &Columns, simd: S, index: usize) -> [F64s<S>; 3] {
    [of[0].vector(simd, index), of[1].vector(simd, index), of[2].vector(simd, index)]
}

/// The leaves of a scene's hierarchy.
#[derive(Clone, Default)]
pub(crate) struct Leaves {
    ends: Vec<Leaf>,
    packets: Vec<Packet>,
    /// Primitives that are tested one by one.
    single: Vec<u32>,
}

/// The ends of a leaf's part of each list.
#[derive(Clone, Copy, Default)]
struct Leaf {
    packets: (u32, u32),
    single: (u32, u32),
}

/// Whether a primitive can be one of a packet.
pub(crate) fn joins(primitive: &Primitive) -> bool {
    matches!(primitive, Primitive::Planar(planar) if planar.outline != Outline::Ellipse)
}

impl Leaves {
    /// Of a hierarchy over these primitives.
    pub(crate) fn new(bvh: &Bvh, primitives: &[Primitive]) -> Self {
        let mut all = Self::default();
        for members in bvh.leaves() {
            let mut leaf = Leaf {
                packets: (all.packets.len() as u32, 0),
                single: (all.single.len() as u32, 0),
            };
            let of = |wanted: Outline| -> Vec<(u32, &Planar)> {
                let planar =
                    members.iter().filter_map(|&index| match &primitives[index as usize] {
                        Primitive::Planar(planar) if planar.outline == wanted => {
                            Some((index, planar))
                        }
                        _ => None,
                    });
                planar.collect()
            };
            for outline in [Outline::Parallelogram, Outline::Triangle] {
                let packets = of(outline);
                all.packets.extend(packets.chunks(LANES).map(|few| Packet::new(outline, few)));
            }
            let single = members.iter().filter(|&&index| !joins(&primitives[index as usize]));
            all.single.extend(single);
            leaf.packets.1 = all.packets.len() as u32;
            leaf.single.1 = all.single.len() as u32;
            all.ends.push(leaf);
        }
        all
    }

    /// The packets of a leaf, and its other primitives.
    #[inline(always)]
    pub(crate) fn leaf(&self, leaf: usize) -> (&[Packet], &[u32]) {
        let Leaf { packets, single } = self.ends[leaf];
        (
            &self.packets[packets.0 as usize..packets.1 as usize],
            &self.single[single.0 as usize..single.1 as usize],
        )
    }
}

/// The nearest of all primitives that the ray meets before `end`: its distance and number. Where lanes
/// are equally near, the smallest number, so that the width of vectors does not matter.
#[inline(always)]
pub(crate) fn nearest<S: Simd>(
    packets: &[Packet],
    ray: &RayLanes<S>,
    end: f64,
) -> Option<(f64, u32)> {
    let never = F64s::splat(ray.simd, f64::INFINITY);
    let (mut nearest, mut number) = (end, f64::INFINITY);
    for index in 0..vectors::<S>() {
        let mut best = F64s::splat(ray.simd, end);
        let mut who = never;
        for packet in packets.iter().filter(|packet| packet.reaches::<S>(index)) {
            let (closer, t) = packet.meets(index, ray, best);
            who = closer.choose(packet.numbers(ray.simd, index), who);
            best = closer.choose(t, best);
        }
        let closest = best.smallest();
        let first = best.equals(F64s::splat(ray.simd, closest)).choose(who, never).smallest();
        number = if closest == nearest { number.min(first) } else { number };
        (nearest, number) = if closest < nearest { (closest, first) } else { (nearest, number) };
    }
    (nearest < end).then_some((nearest, number as u32))
}

/// Numbers of the primitives of a packet that the ray meets before `end`, or, if their number is
/// `last`, before `last_end`; [`NOBODY`] for the others. `None` if there are none.
#[inline(always)]
pub(crate) fn met<S: Simd>(
    packet: &Packet,
    ray: &RayLanes<S>,
    end: f64,
    (last, last_end): (f64, f64),
) -> Option<[f64; LANES]> {
    let simd = ray.simd;
    let nobody = F64s::splat(simd, NOBODY);
    let (end, last_end) = (F64s::splat(simd, end), F64s::splat(simd, last_end));
    let (mut numbers, mut largest) = ([NOBODY; LANES], NOBODY);
    for index in (0..vectors::<S>()).filter(|&index| packet.reaches::<S>(index)) {
        let number = packet.numbers(simd, index);
        let ends = number.equals(F64s::splat(simd, last)).choose(last_end, end);
        let met = packet.meets(index, ray, ends).0.choose(number, nobody);
        met.store(&mut numbers, index);
        largest = largest.max(met.largest());
    }
    (largest > NOBODY).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use tpb_lanes::{Scalar, WithSimd, dispatch};
    use tpb_optics::{Stream, warp};

    use super::*;

    /// What both questions answer.
    #[derive(Debug, PartialEq)]
    struct Answers {
        nearest: Option<(f64, u32)>,
        met: Vec<u32>,
    }

    #[derive(Clone, Copy)]
    struct Question<'a> {
        leaves: &'a [Packet],
        origin: DVec3,
        direction: DVec3,
        but: Option<u32>,
        end: f64,
        last: (f64, f64),
    }

    impl WithSimd for Question<'_> {
        type Output = Answers;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Answers {
            let ray = RayLanes::new(simd, self.origin, self.direction, self.but);
            let mut all = vec![];
            for packet in self.leaves {
                if let Some(numbers) = met(packet, &ray, self.end, self.last) {
                    let some = numbers.into_iter().filter(|&number| number != NOBODY);
                    all.extend(some.map(|number| number as u32));
                }
            }
            Answers { nearest: nearest(self.leaves, &ray, self.end), met: all }
        }
    }

    /// 13 parallelograms and 21 triangles.
    fn primitives(rng: &mut Stream) -> Vec<Primitive> {
        let mut draw = || warp::uniform_sphere(rng.uniform(), rng.uniform());
        let primitive = |index| {
            let outline = if index < 13 { Outline::Parallelogram } else { Outline::Triangle };
            Primitive::Planar(Planar::new(draw(), draw(), draw(), outline))
        };
        (0..34).map(primitive).collect()
    }

    /// On this machine's vectors and on none, packets find what [`Primitive::intersect`] finds, to the
    /// bit: with a primitive that the ray starts on, and with another that only counts up to a distance.
    #[test]
    fn packets_answer_as_primitives_do_one_by_one() {
        let mut rng = Stream::new(1, 2, 3);
        let primitives = primitives(&mut rng);
        let boxes: Vec<_> = primitives.iter().map(Primitive::bounds).collect();
        let leaves = Leaves::new(&Bvh::build(&boxes, |_| true), &primitives);
        let (mut hits, mut shortened) = (0, 0);
        for _ in 0..20_000 {
            let origin = 2.0 * warp::uniform_sphere(rng.uniform(), rng.uniform());
            let direction = warp::uniform_sphere(rng.uniform(), rng.uniform());
            let (but, last) = (rng.index(40) as u32, rng.index(34) as u32);
            let but = Some(but).filter(|&but| but < 34);
            let end = if rng.uniform() < 0.5 { f64::INFINITY } else { 3.0 * rng.uniform() };
            let last_end = end.min(4.0) * rng.uniform();
            let distance = |&index: &u32, end| {
                let p = &primitives[index as usize];
                p.intersect(origin, direction, end, but == Some(index))
            };
            let all = (0..34).filter_map(|index| distance(&index, end).map(|t| (t, index)));
            let expected = Answers {
                nearest: all.min_by(|a, b| a.0.total_cmp(&b.0)),
                met: (0..34)
                    .filter(|i| distance(i, if *i == last { last_end } else { end }).is_some())
                    .collect(),
            };
            hits += usize::from(expected.nearest.is_some());
            shortened +=
                usize::from(distance(&last, end).is_some() && distance(&last, last_end).is_none());
            let (leaves, last) = (&leaves.packets, (f64::from(last), last_end));
            let question = Question { leaves, origin, direction, but, end, last };
            for mut answers in [dispatch(question), question.with_simd(Scalar)] {
                answers.met.sort_unstable();
                assert_eq!(answers, expected);
            }
        }
        assert!(hits > 2000 && shortened > 50, "{hits} {shortened}");
    }
}
