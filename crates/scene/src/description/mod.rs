//! The vocabulary of the scene format: what may stand in a scene file, and nothing else.
//!
//! A scene is a JSON dictionary in Mitsuba 3's words: arbitrary ids lead to objects, and the
//! `type` of an object says which plugin it is. The structs here are the single source of truth.
//! Serde reads them from the file, schemars writes the JSON schema from them, and every bound
//! (positive, a fraction, ...) lives in the type of a field. Names and defaults are Mitsuba's;
//! what is ours alone is marked as an extension.
//!
//! Serde sees an enum of plugins as a plain enum. The loader's own deserialiser presents an object
//! with a `type` as the variant of that name, so nothing is buffered and every error keeps its
//! place in the file. Only the schema speaks of tags.
//!
//! What is *not* here: references are not followed, files are not opened, and nothing is checked
//! that needs two values at once; that is the work of [`crate::load`].

mod emitters;
mod kinds;
mod materials;
mod refused;
mod schema;
mod sensors;
mod shapes;
mod textures;
mod transform;
mod values;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use emitters::{Area, Directional, Emitter, Laser, Point, ShapeEmitter, Spot};
pub use kinds::Kind;
pub use materials::{
    Bsdf, Conductor, Dielectric, Diffuse, Distribution, Hg, Homogeneous, Isotropic, Medium, Metal,
    Null, Phase, RoughConductor, RoughDielectric, ThinDielectric, Twosided,
};
pub use refused::{Refused, refused_parameter, refused_plugin};
pub use schema::{schema, schema_text};
pub use sensors::{
    BoxFilter, Depths, Film, FovAxis, HdrFilm, Integrator, MaxDepth, PathDepth, Perspective,
    PixelCount, PixelFormat, Rfilter, Sensor, TransientHdrFilm,
};
pub use shapes::{Attributes, Cube, Cylinder, Disk, Mesh, Rectangle, Shape, Sphere};
pub use textures::{Bitmap, Checkerboard, FilterType, Reflectance, WrapMode};
pub use transform::{LookAt, Rotate, Scale, Step, Transform, Vector};
pub use values::{
    Colour, ConeAngle, FieldOfView, Fraction, Index, Ior, Light, MATERIALS, MeanCosine,
    NonNegative, Positive, Roughness,
};

/// `{"type": "ref", "id": ...}`: the object of that id, which may stand later in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// The id of the object, a key of the scene.
    pub id: String,
}
