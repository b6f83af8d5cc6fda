//! Texture coordinates of shapes, as Mitsuba has them.
//!
//! | shape | u | v |
//! | --- | --- | --- |
//! | `rectangle` | (x + 1)/2 | (y + 1)/2 |
//! | `cube` | 0 to 1 over each face | 0 to 1 over each face |
//! | `disk` | distance from the centre | azimuth/2π |
//! | `sphere` | azimuth/2π | polar angle/π |
//! | `cylinder` | azimuth/2π | height/length |
//! | `obj`, `ply` | the file's | the file's |
//!
//! in the local coordinates of the shape (sphere: of radius 1 about its centre; cylinder: along its
//! axis from `p0`), azimuths from 0 to 2π.

use std::f64::consts::PI;

use glam::{DAffine3, DVec2, DVec3};

use crate::Primitive;

/// Texture coordinates of the points of a shape; each but the last holds the map from the world to
/// the shape's local coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Coordinates {
    /// The square from (−1, −1, 0) to (1, 1, 0).
    Rectangle(DAffine3),
    /// The cube from (−1, −1, −1) to (1, 1, 1).
    Cube(DAffine3),
    /// The unit disc.
    Disk(DAffine3),
    /// The unit sphere.
    Sphere(DAffine3),
    /// The cylinder of radius 1 from z = 0 to z = 1.
    Cylinder(DAffine3),
    /// Those of a mesh's vertices.
    Vertices,
}

impl Coordinates {
    /// At a point of the shape, on this primitive of it.
    pub fn uv(&self, primitive: &Primitive, position: DVec3) -> DVec2 {
        match self {
            Self::Rectangle(to_local) => {
                let p = to_local.transform_point3(position);
                0.5 * (DVec2::new(p.x, p.y) + DVec2::ONE)
            }
            Self::Cube(to_local) => on_cube(to_local.transform_point3(position)),
            Self::Disk(to_local) => {
                let p = to_local.transform_point3(position);
                DVec2::new(p.x.hypot(p.y), turn(p))
            }
            Self::Sphere(to_local) => {
                let p = to_local.transform_point3(position);
                DVec2::new(turn(p), p.x.hypot(p.y).atan2(p.z) / PI)
            }
            Self::Cylinder(to_local) => {
                let p = to_local.transform_point3(position);
                DVec2::new(turn(p), p.z)
            }
            Self::Vertices => match primitive {
                Primitive::Planar(triangle) => triangle.vertex_uv(position).unwrap_or_default(),
                Primitive::Sphere(_) | Primitive::Cylinder(_) => DVec2::ZERO,
            },
        }
    }
}

/// Azimuth over 2π, from 0 to 1.
fn turn(p: DVec3) -> f64 {
    let turn = p.y.atan2(p.x) / (2.0 * PI);
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// On the face of the cube that a point lies on, in the order of Mitsuba's faces.
fn on_cube(p: DVec3) -> DVec2 {
    let size = p.abs();
    let (u, v) = if size.y >= size.x && size.y >= size.z {
        if p.y < 0.0 { (p.z, p.x) } else { (-p.x, -p.z) }
    } else if size.x >= size.z {
        if p.x > 0.0 { (p.y, -p.z) } else { (p.y, p.z) }
    } else if p.z > 0.0 {
        (p.y, p.x)
    } else {
        (-p.y, p.x)
    };
    0.5 * (DVec2::new(u, v) + DVec2::ONE)
}
