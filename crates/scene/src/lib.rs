//! Floor 1: the scene, from its file to what integrators ask of it.
//!
//! * [`load`]: JSON file → [`SceneParts`], with errors that name line, column, path and a hint;
//!   [`description`] is its vocabulary and the source of the JSON schema.
//! * [`Scene`]: shapes, media, emitters and camera, consistent; [`Scene::fly`] and
//!   [`Scene::connect`] answer all questions about straight lines as a [`Flight`].
//! * [`Plan`]: what a run of this scene needs, and what it leaves out.

mod assemble;
mod bsdf;
pub mod description;
mod emitter;
mod flight;
pub mod geometry;
pub mod load;
mod medium;
mod packet;
mod plan;
mod probe;
mod query;
mod sensor;
pub mod texture;
mod world;

pub use assemble::{AssembleError, EmitterPart, SceneParts, ShapePart};
pub use bsdf::{Bsdf, Dielectric, Reflector, RoughMetal};
pub use emitter::{Emission, Emitter, EmitterKind, Incident, LightPoint};
pub use flight::{Connection, Flight, Hit, Span, Vertex};
pub use geometry::Primitive;
pub use medium::{Medium, MediumBoundary, MediumId, Region};
pub use plan::{Item, Kernel, Media, Plan, Transport};
pub use sensor::{
    FilmPoint, FilmSpec, FovAxis, ImagePlane, IntegratorSpec, MethodName, PixelFormat, Sensor,
    TimeSpec,
};
pub use texture::{Texture, TextureId};
pub use world::{Scene, Shape};
