//! Rough surfaces of microfacets: metal and glass with the Trowbridge-Reitz distribution.
//!
//! * [`Ggx`]: the microfacets, their masking and shadowing, and normals as they are seen;
//! * [`RoughConductor`] and [`RoughDielectric`]: what they make of a carrier of light.
//!
//! Directions are unit vectors in a frame with +z along the normal, on the side that the carrier
//! comes from; both point away from the surface. Each microfacet scatters once: what it sends into
//! another one is lost, and is not put back. That is the field's usual model; the loss grows with α
//! and is measured by the tests ([`RoughConductor`] tells some numbers).

mod conductor;
mod dielectric;
mod ggx;
#[cfg(test)]
mod tests;

pub use conductor::{Metal, RoughConductor};
pub use dielectric::RoughDielectric;
pub use ggx::Ggx;

use glam::DVec3;

/// Scattering into a given direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Towards<V> {
    /// f |cosθ| \[1/sr\]: the part of a flux that goes there, per steradian.
    pub value: V,
    /// Density with which `sample` draws it \[1/sr\].
    pub density: f64,
}

/// A drawn direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn<V> {
    /// The direction.
    pub direction: DVec3,
    /// Value over density, 0 to 1.
    pub weight: V,
    /// Density of the direction \[1/sr\].
    pub density: f64,
}

impl Ggx {
    /// Density of the direction `to` that the visible normal `half` reflects `from` into, and
    /// f·cosθ without Fresnel's factor.
    #[inline]
    fn reflected(self, from: DVec3, to: DVec3, half: DVec3) -> (f64, f64) {
        let density = self.density(half);
        let (a, b) = (self.stretched(from), self.stretched(to));
        (0.5 * density / (from.z + a), 0.5 * density * to.z / (to.z * a + from.z * b))
    }
}
