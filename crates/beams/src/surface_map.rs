//! Photons on surfaces, and the density estimate over a disc around a point.
//!
//! Radiance reflected at x is estimated as ρ/π · Σ Φ_p / A over the photons within `radius` of x
//! on the same oriented surface (Jensen 1996), where A is the area of surface within the radius:
//!
//! * on a sphere π R² exactly (Archimedes: a cap's area depends on its chord alone), and never
//!   more than the sphere;
//! * on a parallelogram the exact area of the disc inside it: photons of that primitive alone
//!   count, and its border loses no light;
//! * on meshes, discs and cylinders π R², with the photons of the shape whose normal is within 60°:
//!   dark at the borders of open ones, and approximate where curvature is strong.
//!
//! The disc is not shortened where another object stands on the surface: there the estimate is
//! dark within a radius.
//!
//! **Time.** A photon p arrives at p, not at x. To first order the wave that it belongs to is plane
//! around it, and passes x later by η ω·(x − p): with that shift the disc blurs time to second
//! order in the radius only.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, I64Vec3};
use tpb_optics::Frame;
use tpb_scene::{Hit, Primitive, Scene};

use crate::beam::SurfacePhoton;

/// Photons whose normals differ by more (60°) are of another surface.
const LEAST_COSINE: f64 = 0.5;

/// The surface photons of one pass, sorted into cells of twice the radius.
pub struct SurfaceMap<const C: usize> {
    photons: Vec<SurfacePhoton<C>>,
    /// Theirs, apart: most candidates lie beyond the radius, and nothing else of them is read.
    positions: Vec<DVec3>,
    /// Bucket b holds photons `starts[b]..starts[b + 1]`.
    starts: Vec<u32>,
    radius: f64,
    cells: Cells,
}

impl<const C: usize> SurfaceMap<C> {
    /// For density estimates within `radius`.
    pub fn new(mut photons: Vec<SurfacePhoton<C>>, radius: f64) -> Self {
        let count = photons.len().next_power_of_two().max(1);
        let cells = Cells { per_metre: 1.0 / (ROOM * radius), buckets: count };
        let buckets: Vec<u32> =
            photons.iter().map(|p| cells.bucket(cells.of(p.position)) as u32).collect();
        let mut starts = vec![0_u32; count + 1];
        for bucket in &buckets {
            starts[*bucket as usize + 1] += 1;
        }
        for b in 0..count {
            starts[b + 1] += starts[b];
        }
        // A stable counting sort, in place: photons are held once.
        let mut next = starts.clone();
        let mut order = vec![0_u32; photons.len()];
        for (index, bucket) in buckets.into_iter().enumerate() {
            let slot = &mut next[bucket as usize];
            order[*slot as usize] = index as u32;
            *slot += 1;
        }
        permute(&mut photons, order);
        let positions = photons.iter().map(|photon| photon.position).collect();
        Self { photons, positions, starts, radius, cells }
    }

    /// Shows `found` every photon of the disc around `hit`, on the side of `normal`.
    #[inline]
    pub fn query(
        &self,
        scene: &Scene,
        hit: &Hit,
        normal: DVec3,
        mut found: impl FnMut(&SurfacePhoton<C>),
    ) {
        if self.photons.is_empty() {
            return;
        }
        let same_surface = Surface::new(scene, hit.primitive);
        let squared = self.radius * self.radius;
        // The disc lies in eight cells. Several may share a bucket, which is looked at once: each photon is
        // in one bucket.
        let lowest = self.cells.of(hit.position - DVec3::splat(self.radius));
        let mut seen = [usize::MAX; 8];
        for corner in 0..8 {
            let cell = lowest + I64Vec3::new(corner & 1, (corner >> 1) & 1, corner >> 2);
            let bucket = self.cells.bucket(cell);
            if seen.contains(&bucket) {
                continue;
            }
            seen[corner as usize] = bucket;
            let range = self.starts[bucket] as usize..self.starts[bucket + 1] as usize;
            for (position, photon) in self.positions[range.clone()].iter().zip(&self.photons[range])
            {
                if (*position - hit.position).length_squared() < squared
                    && photon.normal.dot(normal) > LEAST_COSINE
                    && same_surface.holds(photon.primitive)
                {
                    found(photon);
                }
            }
        }
    }

    /// The area of surface that [`SurfaceMap::query`] looks at.
    pub fn area(&self, scene: &Scene, hit: &Hit) -> f64 {
        let disc = PI * self.radius * self.radius;
        match &scene.primitives[hit.primitive as usize] {
            Primitive::Sphere(_) => disc.min(scene.primitives[hit.primitive as usize].area()),
            Primitive::Planar(plane) => plane.parallelogram().map_or(disc, |corners| {
                let frame = Frame::from_z(hit.normal);
                let flat = corners.map(|corner| {
                    let local = frame.to_local(corner - hit.position);
                    DVec2::new(local.x, local.y)
                });
                covered_area(&flat, self.radius)
            }),
            Primitive::Cylinder(_) => disc,
        }
    }
}

/// Brings `items[order[i]]` to place i, for all i, along the cycles of the permutation.
fn permute<T: Copy>(items: &mut [T], mut order: Vec<u32>) {
    for first in 0..items.len() {
        let (held, mut place) = (items[first], first);
        loop {
            // A place that is done points to itself; its cycle has been closed.
            let source = std::mem::replace(&mut order[place], place as u32) as usize;
            if source == first {
                items[place] = held;
                break;
            }
            items[place] = items[source];
            place = source;
        }
    }
}

/// The primitives that a density estimate takes photons from.
enum Surface {
    /// One alone.
    Primitive(u32),
    /// All of a shape.
    Shape(std::ops::Range<u32>),
}

impl Surface {
    fn new(scene: &Scene, primitive: u32) -> Self {
        let alone = match &scene.primitives[primitive as usize] {
            Primitive::Sphere(_) => true,
            Primitive::Planar(plane) => plane.parallelogram().is_some(),
            Primitive::Cylinder(_) => false,
        };
        if alone {
            Self::Primitive(primitive)
        } else {
            Self::Shape(scene.shape(primitive).primitives.clone())
        }
    }

    #[inline]
    fn holds(&self, primitive: u32) -> bool {
        match self {
            Self::Primitive(p) => *p == primitive,
            Self::Shape(range) => range.contains(&primitive),
        }
    }
}

/// Edge of a cell over the radius: a disc lies in two cells along each axis, whatever the rounding.
const ROOM: f64 = 2.0 * (1.0 + 1e-9);

/// Cells of space, and the buckets of a hash table that they are kept in.
struct Cells {
    /// 1/edge \[1/m\].
    per_metre: f64,
    /// A power of two.
    buckets: usize,
}

impl Cells {
    /// The cell of a point.
    #[inline]
    fn of(&self, position: DVec3) -> I64Vec3 {
        // `floor` is a call of a function on machines without SSE 4.1.
        let floor = |x: f64| {
            let whole = x as i64;
            whole - i64::from(whole as f64 > x)
        };
        let DVec3 { x, y, z } = position * self.per_metre;
        I64Vec3::new(floor(x), floor(y), floor(z))
    }

    #[inline]
    fn bucket(&self, cell: I64Vec3) -> usize {
        let mut hash = 0_u64;
        for coordinate in cell.to_array() {
            hash = (hash ^ coordinate as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            hash ^= hash >> 32;
        }
        hash as usize & (self.buckets - 1)
    }
}

/// Area of the disc of `radius` around the origin inside a parallelogram: over the edges, the
/// signed area of the disc within the triangle from the origin to the edge.
fn covered_area(corners: &[DVec2; 4], radius: f64) -> f64 {
    let edges = [0, 1, 2, 3].map(|i| (corners[i], corners[(i + 1) % 4]));
    // Nearly always the disc is within: the origin is on the inner side of all edges, farther than the
    // radius.
    let turn = (corners[1] - corners[0]).perp_dot(corners[2] - corners[1]);
    let inner = |(p, q): (DVec2, DVec2)| {
        let height = p.perp_dot(q - p);
        height * turn > 0.0 && height * height >= radius * radius * (q - p).length_squared()
    };
    if edges.into_iter().all(inner) {
        return PI * radius * radius;
    }
    edges.into_iter().map(|(p, q)| edge_area(p, q, radius)).sum::<f64>().abs()
}

/// Signed area of disc ∩ triangle(0, p, q): a triangle where the edge is inside the disc, sectors
/// where it is outside.
fn edge_area(p: DVec2, q: DVec2, radius: f64) -> f64 {
    let sector = |a: DVec2, b: DVec2| 0.5 * radius * radius * a.perp_dot(b).atan2(a.dot(b));
    let edge = q - p;
    let a = edge.length_squared();
    if a == 0.0 {
        return 0.0;
    }
    let middle = -p.dot(edge) / a;
    let distance = p.perp_dot(edge).abs() / a.sqrt();
    if distance >= radius {
        return sector(p, q);
    }
    let half = ((radius - distance) * (radius + distance) / a).sqrt();
    let (enter, leave) = ((middle - half).max(0.0), (middle + half).min(1.0));
    if enter >= leave {
        return sector(p, q);
    }
    let (first, last) = (p + enter * edge, p + leave * edge);
    let before = if enter > 0.0 { sector(p, first) } else { 0.0 };
    let after = if leave < 1.0 { sector(last, q) } else { 0.0 };
    before + 0.5 * first.perp_dot(last) + after
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_permuted_in_place() {
        let mut rng = tpb_optics::Stream::new(1, 2, 3);
        for count in [0_u32, 1, 2, 3, 10, 1000] {
            let mut order: Vec<u32> = (0..count).collect();
            for last in (1..order.len()).rev() {
                order.swap(last, rng.index(last + 1));
            }
            let mut items: Vec<u32> = (0..count).map(|i| 7 * i).collect();
            permute(&mut items, order.clone());
            assert!(items.iter().zip(&order).all(|(item, index)| *item == 7 * index));
        }
    }

    #[test]
    fn the_covered_area_is_what_a_fine_grid_counts() {
        let square = |x: f64, y: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(a, b)| DVec2::new(a - x, 0.4 * b + 0.3 * a - y))
        };
        for (x, y, radius) in
            [(0.0, 0.0, 0.2), (0.9, 0.3, 0.2), (-0.95, -0.6, 0.3), (0.2, 0.1, 3.0), (0.0, 0.0, 0.6)]
        {
            let n = 2000;
            let h = 2.0 * radius / f64::from(n);
            let mut count = 0;
            for i in 0..n {
                for j in 0..n {
                    let at = |k: i32| (f64::from(k) + 0.5) * h - radius;
                    let (dx, dy) = (at(i), at(j));
                    let a = x + dx;
                    let b = (y + dy - 0.3 * a) / 0.4;
                    let inside = a.abs() < 1.0 && b.abs() < 1.0;
                    count += i32::from(inside && dx * dx + dy * dy < radius * radius);
                }
            }
            let counted = f64::from(count) * h * h;
            let exact = covered_area(&square(x, y), radius);
            assert!((exact / counted - 1.0).abs() < 2e-3, "{x} {y} {radius}: {exact} {counted}");
        }
        let inside = covered_area(&square(0.1, 0.1), 0.1);
        assert!((inside / (PI * 0.01) - 1.0).abs() < 1e-12);
        assert!((covered_area(&square(0.1, 0.0), 9.0) / 1.6 - 1.0).abs() < 1e-12);
    }
}
