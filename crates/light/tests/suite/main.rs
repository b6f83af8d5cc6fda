//! The light tracer against closed forms, and against the path tracer where both find the light.

#[path = "../../../beams/tests/suite/scenes.rs"]
mod scenes;

mod exact;
mod fog;
mod statistics;
mod structure;
