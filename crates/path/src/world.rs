//! What all camera paths share.

use tpb_scene::{IntegratorSpec, Scene};
use tpb_transport::Horizon;

/// The scene, and how to look for light in it.
#[derive(Clone, Copy)]
pub(crate) struct World<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) integrator: IntegratorSpec,
    pub(crate) strategies: Strategies,
    /// Of one path in its pixel: 1/samples.
    pub(crate) share: f64,
    /// What can still arrive in time; `None`: all counts.
    pub(crate) horizon: Option<Horizon>,
}

impl World<'_> {
    /// Whether light that comes from so far away \[m\] to a path arrives too late.
    #[inline]
    pub(crate) fn is_beyond(&self, opl: f64, distance: f64) -> bool {
        self.horizon.as_ref().is_some_and(|horizon| horizon.is_beyond(opl, distance))
    }
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
