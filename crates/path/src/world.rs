//! What all camera paths share.

use tpb_scene::{IntegratorSpec, Scene};

/// The scene, and how to look for light in it.
#[derive(Clone, Copy)]
pub(crate) struct World<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) integrator: IntegratorSpec,
    pub(crate) strategies: Strategies,
    /// Of one path in its pixel: 1/samples.
    pub(crate) share: f64,
}

/// Which strategies find emitters that a path could connect to. All of them, but in tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strategies {
    /// Connect vertices to points on lights.
    pub(crate) next_event: bool,
    /// Count emitters that a scattered direction meets.
    pub(crate) hits: bool,
    /// Draw distances towards lights, on flights seen from the eye.
    pub(crate) equiangular: bool,
}
