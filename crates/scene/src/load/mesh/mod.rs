//! Triangle meshes from files.
//!
//! A mesh becomes a list of triangles in world coordinates. Polygons are cut into fans about their
//! first vertex, as Mitsuba cuts them; shading is flat, with the normals of the faces by the
//! right-hand rule, so normals and texture coordinates in the file are not read. A broken mesh is
//! an error that names the file and the face: a hole in a boundary of a medium would otherwise
//! show up as light in the wrong place.

mod obj;
mod ply;

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use glam::{DAffine3, DVec3};

/// Larger mesh files are refused \[bytes\].
const LARGEST_FILE: u64 = 1 << 30;

/// Meshes with more triangles are refused.
const MOST_TRIANGLES: usize = 50_000_000;

/// A file format for meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Obj,
    Ply,
}

/// Vertices and faces as a file gives them.
#[derive(Debug, Default)]
struct Polygons {
    vertices: Vec<DVec3>,
    /// For each face the number of its vertices, and the line of the file if there are lines.
    faces: Vec<(usize, Option<usize>)>,
    /// The vertices of all faces, one face after the other.
    corners: Vec<usize>,
}

/// Reads a mesh and moves it into the world.
pub(crate) fn load(
    path: &Path,
    format: Format,
    to_world: &DAffine3,
) -> Result<Vec<[DVec3; 3]>, String> {
    let bytes = read(path)?;
    let polygons = match format {
        Format::Obj => obj::parse(&bytes),
        Format::Ply => ply::parse(&bytes),
    };
    polygons.and_then(|polygons| polygons.triangles(to_world))
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    let metadata = fs::metadata(path).map_err(|error| error.to_string())?;
    if !metadata.is_file() {
        return Err("this is not a file".to_owned());
    }
    if metadata.len() > LARGEST_FILE {
        return Err(format!("the file is larger than {} MiB", LARGEST_FILE >> 20));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|error| error.to_string())?;
    file.take(LARGEST_FILE).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}

impl Polygons {
    fn triangles(&self, to_world: &DAffine3) -> Result<Vec<[DVec3; 3]>, String> {
        if self.faces.is_empty() {
            return Err("the mesh has no faces".to_owned());
        }
        let count = self.corners.len().saturating_sub(2 * self.faces.len());
        if count > MOST_TRIANGLES {
            return Err(format!("the mesh has more than {MOST_TRIANGLES} triangles"));
        }
        let vertices: Vec<_> =
            self.vertices.iter().map(|&v| to_world.transform_point3(v)).collect();
        let mut triangles = Vec::with_capacity(count);
        let mut corners = self.corners.as_slice();
        for (index, &(length, line)) in self.faces.iter().enumerate() {
            let (face, rest) = corners.split_at(length.min(corners.len()));
            corners = rest;
            fan(face, &vertices, &mut triangles).map_err(|problem| match line {
                Some(line) => format!("face {} (line {line}): {problem}", index + 1),
                None => format!("face {}: {problem}", index + 1),
            })?;
        }
        Ok(triangles)
    }
}

fn fan(face: &[usize], vertices: &[DVec3], triangles: &mut Vec<[DVec3; 3]>) -> Result<(), String> {
    if face.len() < 3 {
        return Err(format!("it has {} vertices, at least 3 are needed", face.len()));
    }
    let vertex = |index: usize| {
        let found = vertices.get(index).copied();
        let count = vertices.len();
        found.ok_or_else(|| format!("there is no vertex {index} (counted from 0) among {count}"))
    };
    for pair in face[1..].windows(2) {
        let corners = [vertex(face[0])?, vertex(pair[0])?, vertex(pair[1])?];
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err("a vertex is not finite".to_owned());
        }
        if is_degenerate(&corners) {
            return Err("it has a triangle without area".to_owned());
        }
        triangles.push(corners);
    }
    Ok(())
}

/// Whether the normal of a triangle is mere rounding.
fn is_degenerate([a, b, c]: &[DVec3; 3]) -> bool {
    let (u, v) = (b - a, c - a);
    let scale = u.length().max(v.length());
    if !scale.is_normal() {
        return true;
    }
    let sine = (u / scale).cross(v / scale).length();
    sine.is_nan() || sine <= 1e-12
}
