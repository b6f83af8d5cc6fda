//! Triangle meshes from files.
//!
//! A mesh becomes a list of triangles in world coordinates. Polygons are cut into fans about their
//! first vertex, as Mitsuba cuts them. A broken mesh is an error that names the file and the face:
//! a hole in a boundary of a medium would otherwise show up as light in the wrong place.
//!
//! **Normals.** Faces are oriented by the right-hand rule; that decides sides. Unless
//! `face_normals` is given, shading uses the normals of the vertices: those of the file, or, where
//! it has none, the mean of the faces' around each vertex, weighted by their angles there (Thürmer
//! & Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets"), as Mitsuba's loaders do.

mod obj;
mod ply;
mod triangles;

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use glam::{DAffine3, DVec2, DVec3};

pub(crate) use triangles::Triangle;

/// Larger mesh files are refused \[bytes\].
const LARGEST_FILE: u64 = 1 << 30;

/// A file format for meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Obj,
    Ply,
}

/// How a mesh is placed and read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading<'a> {
    pub(crate) to_world: &'a DAffine3,
    /// Turns the normals around.
    pub(crate) flip: bool,
    /// Flat shading.
    pub(crate) face_normals: bool,
    /// The second texture coordinate is counted from the other end.
    pub(crate) flip_uv: bool,
}

/// Vertices and faces as a file gives them.
#[derive(Debug, Default)]
struct Polygons {
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
    uvs: Vec<DVec2>,
    /// For each face the number of its vertices, and the line of the file if there are lines.
    faces: Vec<(usize, Option<usize>)>,
    /// The corners of all faces, one face after the other.
    corners: Vec<Corner>,
}

/// A corner of a face: indices into the lists of the file.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    vertex: usize,
    normal: Option<usize>,
    uv: Option<usize>,
}

/// Reads a mesh and moves it into the world.
pub(crate) fn load(
    path: &Path,
    format: Format,
    reading: &Reading,
) -> Result<Vec<Triangle>, String> {
    let bytes = read(path)?;
    let polygons = match format {
        Format::Obj => obj::parse(&bytes),
        Format::Ply => ply::parse(&bytes),
    };
    polygons.and_then(|polygons| polygons.triangles(reading))
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
