//! Shapes, and what they carry: a BSDF, an area light, the media on their sides.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::emitters::ShapeEmitter;
use super::materials::{Bsdf, Medium};
use super::transform::{Transform, Vector};
use super::values::Positive;

/// A surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Shape {
    /// The square from (-1, -1, 0) to (1, 1, 0), with normal +z.
    Rectangle(Box<Rectangle>),
    /// The cube from (-1, -1, -1) to (1, 1, 1), with normals outwards.
    Cube(Box<Cube>),
    /// The disc of radius 1 about the origin, with normal +z.
    Disk(Box<Disk>),
    /// A sphere, with normals outwards.
    Sphere(Box<Sphere>),
    /// The side of a cylinder, without caps, with normals outwards.
    Cylinder(Box<Cylinder>),
    /// Triangles from a Wavefront OBJ file.
    Obj(Box<Mesh>),
    /// Triangles from a PLY file.
    Ply(Box<Mesh>),
}

/// What every shape can have besides its own parameters.
pub struct Attributes<'a> {
    /// From local coordinates to the world's.
    pub to_world: &'a Transform,
    /// Whether normals point the other way.
    pub flip_normals: bool,
    /// The BSDF, if given.
    pub bsdf: Option<&'a Bsdf>,
    /// The area light, if any.
    pub emitter: Option<&'a ShapeEmitter>,
    /// The medium opposite to the normal, if given.
    pub interior: Option<&'a Medium>,
    /// The medium on the side of the normal, if given.
    pub exterior: Option<&'a Medium>,
}

macro_rules! shape {
    ($(#[$doc:meta])* $name:ident { $($fields:tt)* }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $($fields)*
            /// Steps from local coordinates to the world's.
            #[serde(default)]
            pub to_world: Transform,
            /// Turns the normals around.
            #[serde(default)]
            pub flip_normals: bool,
            /// What the surface does to light; unless given, `diffuse` with reflectance 0.5 (0 on
            /// an emitter), as in Mitsuba.
            #[serde(default)]
            pub bsdf: Option<Bsdf>,
            /// Makes the surface shine.
            #[serde(default)]
            pub emitter: Option<ShapeEmitter>,
            /// The medium on the side opposite to the normal.
            #[serde(default)]
            pub interior: Option<Medium>,
            /// The medium on the side of the normal.
            #[serde(default)]
            pub exterior: Option<Medium>,
        }

        impl $name {
            fn attributes(&self) -> Attributes<'_> {
                Attributes {
                    to_world: &self.to_world,
                    flip_normals: self.flip_normals,
                    bsdf: self.bsdf.as_ref(),
                    emitter: self.emitter.as_ref(),
                    interior: self.interior.as_ref(),
                    exterior: self.exterior.as_ref(),
                }
            }
        }
    };
}

shape! {
    /// `rectangle`: the square from (-1, -1, 0) to (1, 1, 0), with normal +z, moved by `to_world`.
    Rectangle {}
}

shape! {
    /// `cube`: from (-1, -1, -1) to (1, 1, 1), with normals outwards, moved by `to_world`.
    Cube {}
}

shape! {
    /// `disk`: radius 1 about the origin, with normal +z, moved by `to_world`.
    Disk {}
}

shape! {
    /// `sphere`: with normals outwards; `to_world` may scale it only uniformly.
    Sphere {
        /// Centre \[m\].
        #[serde(default)]
        pub center: Vector,
        /// Radius \[m\], greater than 0.
        #[serde(default = "one")]
        pub radius: Positive,
    }
}

shape! {
    /// `cylinder`: the side only, without caps, with normals outwards; `to_world` may scale it
    /// only uniformly.
    Cylinder {
        /// One end of the axis \[m\].
        #[serde(default)]
        pub p0: Vector,
        /// The other end of the axis \[m\].
        #[serde(default = "z_axis")]
        pub p1: Vector,
        /// Radius \[m\], greater than 0.
        #[serde(default = "one")]
        pub radius: Positive,
    }
}

shape! {
    /// `obj` and `ply`: triangles from a file, with normals and texture coordinates. Polygons are
    /// cut into fans. The faces' right-hand rule says which side is the front.
    Mesh {
        /// Path of the mesh file, relative to the scene file.
        pub filename: String,
        /// Whether the normals of the faces are used for shading instead of those of the vertices,
        /// which are computed where the file has none.
        #[serde(default)]
        pub face_normals: bool,
        /// Whether the second texture coordinate counts from the other end; unless given it does in
        /// `obj` files, but not in `ply` files.
        #[serde(default)]
        pub flip_tex_coords: Option<bool>,
    }
}

impl Shape {
    /// What all shapes have in common.
    pub fn attributes(&self) -> Attributes<'_> {
        match self {
            Self::Rectangle(s) => s.attributes(),
            Self::Cube(s) => s.attributes(),
            Self::Disk(s) => s.attributes(),
            Self::Sphere(s) => s.attributes(),
            Self::Cylinder(s) => s.attributes(),
            Self::Obj(s) | Self::Ply(s) => s.attributes(),
        }
    }
}

const fn one() -> Positive {
    Positive::ONE
}

const fn z_axis() -> Vector {
    [0.0, 0.0, 1.0]
}
