//! A flight: a straight path through null boundaries to the first surface that acts on light.
//!
//! Everything that happens along a straight line — transmittance, free flight, optical path
//! length, beams — is asked of a flight, so that null boundaries are handled once.

use glam::DVec3;
use smallvec::SmallVec;
use tpb_optics::Spectrum;

use crate::{Region, Scene};

/// A place on a path, and what surrounds the ray that leaves it.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Position \[m\].
    pub position: DVec3,
    /// The primitive it lies on, if it does.
    pub primitive: Option<u32>,
    /// The region that the leaving ray starts in.
    pub region: Region,
}

/// Where a flight met a surface.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Distance from the flight's origin \[m\].
    pub distance: f64,
    /// Index into [`Scene::primitives`].
    pub primitive: u32,
    /// Position \[m\].
    pub position: DVec3,
    /// Unit geometric normal of the shape (not turned to the ray).
    pub normal: DVec3,
}

/// A part of a flight within one region.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Distance from the flight's origin where it begins \[m\].
    pub start: f64,
    /// Distance where it ends; infinite when nothing is met.
    pub end: f64,
    /// What fills it.
    pub region: Region,
}

/// A straight path from its origin to the first non-null surface, or to infinity.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Origin \[m\].
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Consecutive spans from distance 0; never empty.
    pub spans: SmallVec<[Span; 4]>,
    /// The surface at the end; `None` at infinity (or at a chosen end point).
    pub hit: Option<Hit>,
}

/// What lies on a straight way that no surface is in.
#[derive(Clone, Copy, Debug)]
pub struct Connection<const C: usize> {
    /// Optical path length \[m\].
    pub opl: f64,
    /// Optical depth.
    pub depth: Spectrum<C>,
}

impl<const C: usize> Connection<C> {
    /// Its transmittance.
    #[inline]
    pub fn transmittance(&self) -> Spectrum<C> {
        tpb_optics::medium::transmittance(self.depth)
    }
}

impl Flight {
    /// Its length \[m\]; infinite when nothing is met.
    #[inline]
    pub fn length(&self) -> f64 {
        self.spans[self.spans.len() - 1].end
    }

    /// The point at a finite distance.
    #[inline]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.direction
    }

    /// The region in which it arrives.
    #[inline]
    pub fn last_region(&self) -> Region {
        self.spans[self.spans.len() - 1].region
    }

    /// Optical path length \[m\] from the origin to `distance`.
    #[inline]
    pub fn opl(&self, distance: f64) -> f64 {
        self.parts(distance).map(|(span, length)| span.region.eta * length).sum()
    }

    /// Optical depth from the origin to `distance`, per channel.
    #[inline]
    pub fn depth<const C: usize>(&self, scene: &Scene, distance: f64) -> Spectrum<C> {
        let mut depth = Spectrum::ZERO;
        for (span, length) in self.parts(distance) {
            if let Some(medium) = span.region.medium {
                depth += scene.medium(medium).coefficients.channels::<C>().depth(length);
            }
        }
        depth
    }

    /// Transmittance from the origin to `distance`, per channel.
    #[inline]
    pub fn transmittance<const C: usize>(&self, scene: &Scene, distance: f64) -> Spectrum<C> {
        tpb_optics::medium::transmittance(self.depth(scene, distance))
    }

    /// The spans before `distance`, each with the length of it that lies before.
    #[inline]
    fn parts(&self, distance: f64) -> impl Iterator<Item = (&Span, f64)> {
        self.spans
            .iter()
            .take_while(move |span| span.start < distance)
            .map(move |span| (span, span.end.min(distance) - span.start))
    }
}
