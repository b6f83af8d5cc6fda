//! Meshes of the gallery, made from formulas: `cargo xtask meshes` writes them, and a test keeps the
//! files under `scenes/meshes` equal to what is made here.
//!
//! Lengths are in metres. Faces follow the right-hand rule about their normals. Not handled: texture
//! coordinates; more than 65536 vertices, whose indices would not fit.

mod ply;
mod rose;
mod torus_knot;
mod tumbler;

use glam::DVec3;

pub use torus_knot::torus_knot;
pub use tumbler::{air_glass, glass_liquid, liquid_air};

/// A vertex: place \[m\] and unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub position: DVec3,
    /// The normal of the smooth surface there.
    pub normal: DVec3,
}

/// Triangles with smooth normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices.
    pub vertices: Vec<Vertex>,
    /// Corners of the triangles.
    pub triangles: Vec<[u16; 3]>,
}

/// A tracked mesh.
#[derive(Clone, Copy, Debug)]
pub struct MeshFile {
    /// Name of the file.
    pub name: &'static str,
    /// What is in it.
    pub make: fn() -> Mesh,
}

const fn file(name: &'static str, make: fn() -> Mesh) -> MeshFile {
    MeshFile { name, make }
}

/// All meshes.
pub const MESHES: [MeshFile; 10] = [
    file("rose-bars.ply", rose::bars),
    file("rose-inner-even.ply", rose::inner_even),
    file("rose-inner-odd.ply", rose::inner_odd),
    file("rose-outer-even.ply", rose::outer_even),
    file("rose-outer-odd.ply", rose::outer_odd),
    file("rose-wall.ply", rose::wall),
    file("torus-knot.ply", torus_knot),
    file("tumbler-air-glass.ply", air_glass),
    file("tumbler-glass-liquid.ply", glass_liquid),
    file("tumbler-liquid-air.ply", liquid_air),
];

impl Mesh {
    /// Adds a vertex and returns its index.
    fn push(&mut self, position: DVec3, normal: DVec3) -> u16 {
        let index = u16::try_from(self.vertices.len()).expect("meshes of the gallery are small");
        self.vertices.push(Vertex { position, normal });
        index
    }

    /// Adds a triangle, its corners in the order that the normals ask for; one without area is left
    /// out.
    fn triangle(&mut self, [a, b, c]: [u16; 3]) {
        if a == b || b == c || c == a {
            return;
        }
        let [va, vb, vc] = [a, b, c].map(|index| self.vertices[usize::from(index)]);
        let face = (vb.position - va.position).cross(vc.position - va.position);
        let front = face.dot(va.normal + vb.normal + vc.normal) > 0.0;
        self.triangles.push(if front { [a, b, c] } else { [a, c, b] });
    }

    /// Joins two rows of vertices by two triangles for each pair of neighbours; rows are closed
    /// into rings.
    fn strip(&mut self, upper: &[u16], lower: &[u16]) {
        for (k, (&a, &b)) in upper.iter().zip(lower).enumerate() {
            let next = (k + 1) % upper.len();
            self.triangle([a, b, lower[next]]);
            self.triangle([a, lower[next], upper[next]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use super::*;

    #[test]
    fn the_tracked_files_are_what_is_made_here() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/meshes");
        for MeshFile { name, make } in MESHES {
            let tracked = std::fs::read(folder.join(name)).expect(name);
            assert!(tracked == make().to_ply(), "{name} differs: `cargo xtask meshes` writes it");
            assert!(tracked.len() < 400_000, "{name} has {} bytes", tracked.len());
        }
        let files = std::fs::read_dir(&folder).expect("the folder").count();
        assert_eq!(files, MESHES.len(), "each file has a maker");
    }

    #[test]
    fn normals_have_length_one_and_are_those_of_the_faces_nearly() {
        for MeshFile { name, make } in MESHES {
            let mesh = make();
            for vertex in &mesh.vertices {
                assert!((vertex.normal.length() - 1.0).abs() < 1e-12, "{name}: {vertex:?}");
            }
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|index| mesh.vertices[usize::from(index)]);
                let face = (b.position - a.position).cross(c.position - a.position).normalize();
                for corner in [a, b, c] {
                    assert!(face.dot(corner.normal) > 0.85, "{name}: {face} {}", corner.normal);
                }
            }
        }
    }

    /// Each edge of a closed surface belongs to two triangles, once in each direction.
    fn open_edges<'a>(meshes: impl Iterator<Item = &'a (Mesh, bool)>) -> usize {
        let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
        for (mesh, turned) in meshes {
            let place = |index: u16| {
                let p = mesh.vertices[usize::from(index)].position;
                p.to_array().map(|x| (x as f32 + 0.0).to_bits())
            };
            for [a, b, c] in &mesh.triangles {
                for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
                    let (from, to) = if *turned { (to, from) } else { (from, to) };
                    let (from, to) = (place(from), place(to));
                    let sign = if from < to { 1 } else { -1 };
                    *edges.entry([from.min(to), from.max(to)]).or_default() += sign;
                }
            }
        }
        edges.values().filter(|&&balance| balance != 0).count()
    }

    #[test]
    fn the_knot_is_closed_and_so_are_glass_and_liquid() {
        assert_eq!(open_edges([(torus_knot(), false)].iter()), 0);
        // Seen from the glass, its liquid side faces the other way than its air side.
        assert_eq!(open_edges([(air_glass(), false), (glass_liquid(), false)].iter()), 0);
        assert_eq!(open_edges([(liquid_air(), false), (glass_liquid(), true)].iter()), 0);
        assert!(open_edges([(air_glass(), false)].iter()) > 0, "the line where the liquid ends");
    }

    /// Area of the triangles \[m²\].
    fn area(mesh: &Mesh) -> f64 {
        let parts = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|index| mesh.vertices[usize::from(index)].position);
            0.5 * (b - a).cross(c - a).length()
        });
        parts.sum()
    }

    /// Wall and glass, turned to one side, are one surface: only the wall's four edges are open.
    #[test]
    fn the_rose_window_fills_its_opening() {
        let glass = [rose::inner_even(), rose::inner_odd(), rose::outer_even(), rose::outer_odd()];
        let together = area(&rose::wall()) + glass.iter().map(area).sum::<f64>();
        assert!((together - 2.6 * 2.4).abs() < 1e-12, "{together}");
        let opening = glass.iter().map(area).sum::<f64>();
        let circle = std::f64::consts::PI * 0.95_f64.powi(2);
        // A polygon of 48 corners.
        assert!((0.997..0.998).contains(&(opening / circle)), "{opening}");
        let panes: Vec<_> = glass.into_iter().map(|mesh| (mesh, false)).collect();
        assert_eq!(open_edges(panes.iter()), 48, "the panes meet");
        let all: Vec<_> = panes.into_iter().chain([(rose::wall(), true)]).collect();
        // The 48 rays end on the border, with its four corners.
        assert_eq!(open_edges(all.iter()), 52);
    }

    /// Volume by the divergence theorem \[m³\].
    fn volume(mesh: &Mesh) -> f64 {
        let parts = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|index| mesh.vertices[usize::from(index)].position);
            a.dot(b.cross(c)) / 6.0
        });
        parts.sum()
    }

    #[test]
    fn volumes_are_those_of_the_smooth_bodies() {
        // Pappus: a tube that does not touch itself has its section's area times its length.
        let n = 100_000;
        let speed = |i: i32| {
            let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            let w = 2.0 + (3.0 * t).cos();
            (9.0 + 4.0 * w * w).sqrt()
        };
        let length = (0..n).map(speed).sum::<f64>() * std::f64::consts::TAU / f64::from(n);
        let tube: f64 = 0.56;
        let smooth = std::f64::consts::PI * tube * tube * length / (3.0 + tube).powi(3);
        // A polygon of 24 corners has 0.989 of its circle; bends take a little more.
        let ratio = volume(&torus_knot()) / smooth;
        assert!((0.98..0.99).contains(&ratio), "{ratio}");
        // The liquid: a cylinder of radius 33 mm from 8 to 66 mm, its edge rounded by 6 mm.
        let liquid = volume(&liquid_air()) - volume(&glass_liquid());
        let cylinder = std::f64::consts::PI * 0.033_f64.powi(2) * 0.058;
        assert!((0.97..0.999).contains(&(liquid / cylinder)), "{}", liquid / cylinder);
    }
}
