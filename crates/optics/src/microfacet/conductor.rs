//! A rough metal: mirrors of every direction that the distribution has.
//!
//! ```text
//! f(a → b) = F(a·h) G2 D(h) / (4 a_z b_z),     h = (a + b)/|a + b|     (Walter et al. 2007, eq. 20)
//! ```
//!
//! Drawn by visible normals, the weight f b_z/density is F G2/G1. Light that a microfacet sends
//! into another is lost (single scattering): at normal incidence a perfect metal reflects 0.99 of the
//! light for α = 0.1, 0.88 for 0.3, 0.69 for 0.5, and 0.31 for 1.

use glam::DVec3;

use super::{Drawn, Ggx, Towards};
use crate::{Rgb, fresnel};

/// A metal's reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Metal {
    /// Reflects all, at every angle.
    Perfect,
    /// Fresnel's reflectance of the complex index η − ik, both relative to what is outside.
    Index {
        /// η of each channel.
        eta: Rgb,
        /// k of each channel.
        k: Rgb,
    },
}

impl Metal {
    /// Reflectance at a cosine of incidence.
    #[inline]
    pub fn reflectance(&self, cosine: f64) -> Rgb {
        match *self {
            Self::Perfect => Rgb::ONE,
            Self::Index { eta, k } => {
                crate::Spectrum(std::array::from_fn(|c| fresnel::conductor(cosine, eta[c], k[c])))
            }
        }
    }
}

/// A rough metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor {
    /// Its microfacets.
    pub ggx: Ggx,
    /// What each of them reflects.
    pub metal: Metal,
}

impl RoughConductor {
    /// For light from `from` (z > 0: where it comes from) to `to`.
    #[inline]
    pub fn towards(&self, from: DVec3, to: DVec3) -> Towards<Rgb> {
        if from.z <= 0.0 || to.z <= 0.0 {
            return Towards { value: Rgb::ZERO, density: 0.0 };
        }
        let half = (from + to).normalize();
        let cosine = from.dot(half);
        let (density, value) = self.ggx.reflected(from, to, half);
        Towards { value: self.metal.reflectance(cosine) * value, density }
    }

    /// A direction for light from `from` (z > 0); `None` if another microfacet is met.
    #[inline]
    pub fn sample(&self, from: DVec3, u: [f64; 2]) -> Option<Drawn<Rgb>> {
        let half = self.ggx.sample_visible(from, u);
        let direction = fresnel::reflect(-from, half);
        if direction.z <= 0.0 {
            return None;
        }
        let (density, _) = self.ggx.reflected(from, direction, half);
        let left = self.ggx.shadowing_same_side(from, direction);
        let weight = self.metal.reflectance(from.dot(half)) * left;
        Some(Drawn { direction, weight, density })
    }
}
