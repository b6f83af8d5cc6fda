//! Beams sorted into tiles of the image, for the rays that come straight from the eye.
//!
//! All rays of a tile start at the eye and lie within the pyramid through the tile's borders. A
//! beam is put on a tile's list unless one of these, each conservative, excludes it (P: points of
//! the beam relative to the eye, M = P × d its moment, h = |M| the distance of its line):
//!
//! * **a side of the pyramid** with inward normal n: both ends of the beam have n·P < −R. The
//!   kernels join a beam to a point of the ray within R of some point of the beam, and n·P is
//!   largest at an end.
//! * **the plane through eye and beam**: a ray ω meets the beam's line within R only if
//!   |ω·M| < R |d × ω| ≤ R. For ω within the angle α of the tile's axis a,
//!   |a·M| ≥ h sin(α + γ) with sinγ = R/h excludes that.
//!
//! A ray then runs through its tile's list: (ω·M/R)² < |d × ω|² in f32 with slack for its rounding,
//! many beams at a time; what passes is evaluated in f64. Compared with a hierarchy there is
//! nothing to build or to walk, and neighbouring rays share the search. Rays that mirrors or
//! glass have turned do not start at the eye: they need [`crate::beam_map`].

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use tpb_scene::{MediumId, Scene};

use crate::beam::{Beam, CameraRay};
use crate::beam_map::Pairs;
use crate::kernel::RayBeamKernel;

/// Tiles along an image edge at most.
const MOST_TILES: usize = 32;
/// Pixels along a tile's edge at least.
const LEAST_PIXELS: usize = 4;
/// Beams per step of the f32 test; lists are padded to a multiple.
const LANES: usize = 32;
/// Error of ω·M in f32 relative to h, with the roundings of M and ω: at most 5·2⁻²⁴ < 4e-7.
const MOMENT_SLACK: f64 = 1e-6;
/// Error of |d × ω|² = 1 − (d·ω)² in f32, likewise.
const SINE_SLACK: f32 = 2e-6;
/// Relative slack of the f64 tests of tiles.
const TILE_SLACK: f64 = 1e-9;

/// The beams of one pass by tiles.
pub struct Tiles<'a, const C: usize> {
    beams: &'a [Beam<C>],
    tile_pixels: usize,
    columns: usize,
    /// Row by row.
    lists: Vec<List>,
}

/// The beams that rays of one tile may meet.
#[derive(Clone, Default)]
struct List {
    indices: Vec<u32>,
    lanes: Vec<Lanes>,
}

/// What the f32 test of [`LANES`] beams reads.
#[derive(Clone, Copy)]
struct Lanes {
    /// M/R.
    moment: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    /// Slack of ω·M/R; −∞ where there is no beam.
    slack: [f32; LANES],
}

/// A beam as tiles see it.
struct Seen {
    moment: DVec3,
    /// h.
    distance: f64,
    /// h cosγ; negative where the eye is within the radius and planes exclude nothing.
    adjacent: f64,
    /// Rounding allowance of the tests \[m\].
    slack: f64,
    /// First and last column that no side of a pyramid excludes.
    columns: (u32, u32),
    /// Likewise.
    rows: (u32, u32),
}

impl Seen {
    fn new<const C: usize>(beam: &Beam<C>, eye: DVec3, radius: f64, borders: &Borders) -> Self {
        let first = beam.origin - eye;
        let ends = [first, first + beam.length * beam.direction];
        let moment = first.cross(beam.direction);
        let distance = moment.length();
        let slack = TILE_SLACK * (first.length() + beam.length);
        let adjacent =
            if distance > radius { (distance - radius) * (distance + radius) } else { -1.0 };
        Self {
            moment,
            distance,
            adjacent: if adjacent > 0.0 { adjacent.sqrt() } else { -1.0 },
            slack,
            columns: range(&borders.columns, ends, radius + slack),
            rows: range(&borders.rows, ends, radius + slack),
        }
    }
}

/// First and last of the slabs between consecutive borders that a segment may reach; an empty
/// range (1, 0) if none.
fn range(borders: &[DVec3], ends: [DVec3; 2], reach: f64) -> (u32, u32) {
    let mut found = (1, 0);
    let heights = |border: DVec3| ends.map(|end| border.dot(end));
    let mut here = heights(borders[0]);
    for (slab, &border) in borders[1..].iter().enumerate() {
        let next = heights(border);
        let outside = here[0].max(here[1]) < -reach || next[0].min(next[1]) > reach;
        if !outside {
            let first = if found.0 > found.1 { slab as u32 } else { found.0 };
            found = (first, slab as u32);
        }
        here = next;
    }
    found
}

/// Planes through the eye between columns of tiles and between rows; normals point to larger x
/// and y.
struct Borders {
    columns: Vec<DVec3>,
    rows: Vec<DVec3>,
}

impl Borders {
    fn new(scene: &Scene, tile_pixels: usize, (columns, rows): (usize, usize)) -> Self {
        let (width, height) = (scene.film.width, scene.film.height);
        let toward = |x: usize, y: usize| scene.sensor.direction(x as f64, y as f64);
        let plane = |from: DVec3, to: DVec3, inside: DVec3| {
            let normal = from.cross(to).normalize();
            normal * normal.dot(inside).signum()
        };
        let column = |x: usize| plane(toward(x, 0), toward(x, height), toward(x + 1, 0));
        let row = |y: usize| plane(toward(0, y), toward(width, y), toward(0, y + 1));
        Self {
            columns: (0..=columns).map(|c| column(c * tile_pixels)).collect(),
            rows: (0..=rows).map(|r| row(r * tile_pixels)).collect(),
        }
    }
}

/// A cone around a tile.
struct Cone {
    axis: DVec3,
    cosine: f64,
    sine: f64,
}

impl Cone {
    /// Whether the plane through eye and beam stays clear of it by more than the radius.
    #[inline]
    fn misses(&self, seen: &Seen, radius: f64) -> bool {
        // α + γ of 90° and more excludes nothing.
        let acute = self.cosine * seen.adjacent > self.sine * radius;
        let limit = self.sine * seen.adjacent + self.cosine * radius + seen.slack;
        acute && self.axis.dot(seen.moment).abs() > limit
    }
}

impl<'a, const C: usize> Tiles<'a, C> {
    /// For kernels of `radius` and the scene's camera.
    pub fn new(scene: &Scene, beams: &'a [Beam<C>], radius: f64) -> Self {
        let (width, height) = (scene.film.width, scene.film.height);
        let tile_pixels = LEAST_PIXELS.max(width.max(height).div_ceil(MOST_TILES));
        let (columns, rows) = (width.div_ceil(tile_pixels), height.div_ceil(tile_pixels));
        let eye = scene.sensor.position;
        let borders = Borders::new(scene, tile_pixels, (columns, rows));
        let seen: Vec<_> =
            beams.par_iter().map(|beam| Seen::new(beam, eye, radius, &borders)).collect();
        let toward = |x: usize, y: usize| scene.sensor.direction(x as f64, y as f64);
        let lists = (0..rows)
            .into_par_iter()
            .flat_map_iter(|row| {
                let cones: Vec<_> = (0..columns)
                    .map(|column| {
                        let (x, y) = (column * tile_pixels, row * tile_pixels);
                        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)]
                            .map(|(i, j)| toward(x + i * tile_pixels, y + j * tile_pixels));
                        cone(corners)
                    })
                    .collect();
                let mut lists = vec![List::default(); columns];
                let row = row as u32;
                for (index, seen) in seen.iter().enumerate() {
                    if row < seen.rows.0 || row > seen.rows.1 {
                        continue;
                    }
                    for column in seen.columns.0..=seen.columns.1 {
                        let column = column as usize;
                        if !cones[column].misses(seen, radius) {
                            let direction = beams[index].direction;
                            lists[column].push(index as u32, seen, direction, radius);
                        }
                    }
                }
                lists
            })
            .collect();
        Self { beams, tile_pixels, columns, lists }
    }

    /// Shows `found` every beam of `medium` that the kernel joins to the ray, once. The ray lies
    /// on a line from the eye through pixel (`x`, `y`).
    #[inline]
    pub fn query<K: RayBeamKernel>(
        &self,
        kernel: K,
        medium: MediumId,
        (x, y): (usize, usize),
        ray: &CameraRay<C>,
        mut found: impl FnMut(&Beam<C>, &K::Meeting),
    ) -> Pairs {
        let list = &self.lists[y / self.tile_pixels * self.columns + x / self.tile_pixels];
        let omega = ray.direction.as_vec3();
        let mut pairs = Pairs { tested: list.indices.len() as u64, accepted: 0 };
        for (lanes, indices) in list.lanes.iter().zip(list.indices.chunks(LANES)) {
            let (kept, count) = lanes.near(omega);
            for &lane in &kept[..count] {
                let beam = &self.beams[indices[usize::from(lane)] as usize];
                let meeting = kernel.meet(
                    beam.origin,
                    beam.direction,
                    beam.length,
                    ray.origin,
                    ray.direction,
                    ray.length,
                );
                if let Some(meeting) = meeting
                    && beam.medium == medium
                {
                    pairs.accepted += 1;
                    found(beam, &meeting);
                }
            }
        }
        pairs
    }
}

impl List {
    fn push(&mut self, index: u32, seen: &Seen, direction: DVec3, radius: f64) {
        let lane = self.indices.len() % LANES;
        if lane == 0 {
            self.lanes.push(Lanes::EMPTY);
        }
        self.indices.push(index);
        let lanes = self.lanes.last_mut().expect("pushed above");
        let moment = (seen.moment / radius).as_vec3().to_array();
        let direction = direction.as_vec3().to_array();
        for axis in 0..3 {
            lanes.moment[axis][lane] = moment[axis];
            lanes.direction[axis][lane] = direction[axis];
        }
        lanes.slack[lane] = (MOMENT_SLACK * seen.distance / radius) as f32;
    }
}

impl Lanes {
    const EMPTY: Self = Self {
        moment: [[0.0; LANES]; 3],
        direction: [[0.0; LANES]; 3],
        slack: [f32::NEG_INFINITY; LANES],
    };

    /// The lanes whose lines may come within the radius of the ray's, and how many.
    #[inline]
    fn near(&self, omega: Vec3) -> ([u8; LANES], usize) {
        let Self { moment: [mx, my, mz], direction: [dx, dy, dz], slack } = self;
        let mut near = [false; LANES];
        for lane in 0..LANES {
            let across = omega.x * mx[lane] + omega.y * my[lane] + omega.z * mz[lane];
            let cosine = omega.x * dx[lane] + omega.y * dy[lane] + omega.z * dz[lane];
            let least = (across.abs() - slack[lane]).max(0.0);
            near[lane] = least * least < 1.0 - cosine * cosine + SINE_SLACK;
        }
        let (mut kept, mut count) = ([0; LANES], 0);
        for (lane, &near) in near.iter().enumerate() {
            kept[count] = lane as u8;
            count += usize::from(near);
        }
        (kept, count)
    }
}

/// The cone around four directions.
fn cone(corners: [DVec3; 4]) -> Cone {
    let axis = corners.iter().sum::<DVec3>().normalize();
    // From the cross product: a narrow cone has a cosine of 1 to rounding.
    let sine = corners.iter().map(|c| c.cross(axis).length()).fold(0.0, f64::max);
    let cosine = corners.iter().map(|c| c.dot(axis)).fold(1.0, f64::min);
    Cone { axis, cosine: cosine.max(0.0), sine: if cosine > 0.0 { sine } else { 1.0 } }
}
