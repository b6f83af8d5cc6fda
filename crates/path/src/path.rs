//! The state of a camera path between two flights, and how it got its direction.

use glam::DVec3;
use tpb_optics::Spectrum;
use tpb_optics::warp::Equiangular;
use tpb_scene::{Flight, Vertex};
use tpb_transport::FreeFlight;

/// The state of a path at the start of a flight.
pub(crate) struct Path<const C: usize> {
    pub(crate) vertex: Vertex,
    pub(crate) direction: DVec3,
    /// Throughput of importance: 1 at the eye.
    pub(crate) weight: Spectrum<C>,
    /// What refraction made of radiance beside: (η at the eye / η here)².
    pub(crate) radiance_factor: f64,
    /// From the eye to the vertex \[m\].
    pub(crate) opl: f64,
    /// Scattering events so far, plus 1: the depth of an emitter that is met next.
    pub(crate) depth: u32,
    pub(crate) found: Found,
}

/// How the path got its direction: which other strategies could find what it meets.
#[derive(Clone, Copy)]
pub(crate) enum Found {
    /// From the eye, through mirrors and glass at most.
    FromEye,
    /// Through mirrors or glass after some scattering.
    BySpecular,
    /// Scattered with this density per steradian, on a flight seen from the eye or not.
    ByScattering { density: f64, seen: Option<SeenFrom> },
}

impl Found {
    /// After a further mirror or glass surface.
    #[inline]
    pub(crate) fn after_specular(self) -> Self {
        if matches!(self, Self::FromEye) { Self::FromEye } else { Self::BySpecular }
    }
}

impl<const C: usize> Path<C> {
    /// Throughput of radiance.
    #[inline]
    pub(crate) fn radiance_throughput(&self) -> Spectrum<C> {
        self.weight * self.radiance_factor
    }
}

/// A distance on a flight seen from the eye at which the path scattered, for weighing what it
/// meets next against equiangular sampling.
#[derive(Clone, Copy)]
pub(crate) struct SeenFrom {
    origin: DVec3,
    direction: DVec3,
    extent: (f64, f64),
    distance: f64,
    density: f64,
}

impl SeenFrom {
    /// The scattering at `distance`, chosen by `free`.
    #[inline]
    pub(crate) fn new<const C: usize>(
        flight: &Flight,
        free: &FreeFlight<'_, C>,
        distance: f64,
    ) -> Option<Self> {
        Some(Self {
            origin: flight.origin,
            direction: flight.direction,
            extent: free.extent()?,
            distance,
            density: free.density(distance),
        })
    }

    /// e: what equiangular sampling towards `light` would have had for this distance.
    #[inline]
    pub(crate) fn equiangular_ratio(&self, light: DVec3) -> f64 {
        let (start, end) = self.extent;
        let towards = Equiangular::new(self.origin, self.direction, start, end, light);
        towards.pdf(self.distance) / self.density
    }
}
