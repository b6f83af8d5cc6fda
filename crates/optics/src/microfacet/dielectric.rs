//! Rough glass: microfacets that reflect and refract.
//!
//! With a the direction that the carrier comes from (index η_a), b the one that it goes to (index
//! η_b), and h the normal of the microfacet that turns one into the other (Walter et al. 2007,
//! "Microfacet Models for Refraction through Rough Surfaces", eq. 16, 20 and 21)
//!
//! ```text
//! reflected   h = (a + b)/|a + b|           f |b_z| = F G2 D / (4 a_z)
//! refracted   h = ∓(η_a a + η_b b)/|…|      f |b_z| = (1 − F) G2 D |a·h| |b·h| η_b² / (a_z (η_a a·h + η_b b·h)²)
//! ```
//!
//! f is what a *flux* becomes: over all b, f |b_z| integrates to what is not lost. A photon and the
//! importance of a camera's ray are both such fluxes; *radiance* along a camera's ray changes by
//! (η_a/η_b)² besides, which the caller applies. f/η_b² is symmetric in a and b.

use glam::DVec3;

use super::{Drawn, Ggx, Towards};
use crate::fresnel;

/// A rough interface, for a carrier that comes from one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    /// Its microfacets.
    pub ggx: Ggx,
    /// Refractive index on the side that the carrier comes from.
    pub eta_before: f64,
    /// Refractive index beyond; never that before.
    pub eta_beyond: f64,
}

impl RoughDielectric {
    /// For a carrier from `from` (z > 0: where it comes from) to `to`, on either side.
    #[inline]
    pub fn towards(&self, from: DVec3, to: DVec3) -> Towards<f64> {
        let nothing = Towards { value: 0.0, density: 0.0 };
        if from.z <= 0.0 || to.z == 0.0 {
            return nothing;
        }
        if to.z > 0.0 {
            let half = (from + to).normalize();
            let part = self.reflectance(from.dot(half));
            let (density, value) = self.ggx.reflected(from, to, half);
            return Towards { value: part * value, density: part * density };
        }
        let sum = self.eta_before * from + self.eta_beyond * to;
        // Of the two unit vectors along it the one on the side of `from`'s normal.
        let half = if sum.z > 0.0 { sum.normalize() } else { -sum.normalize() };
        if from.dot(half) <= 0.0 || to.dot(half) >= 0.0 {
            return nothing;
        }
        let part = 1.0 - self.reflectance(from.dot(half));
        let density = part * self.ggx.visible_density(from, half) * self.jacobian(from, to, half);
        Towards { value: density * self.ggx.shadowing_two_sides(from, -to), density }
    }

    /// A direction for a carrier from `from` (z > 0): below 0 it is refracted. `choice` decides
    /// between the two. `None` if another microfacet is met.
    #[inline]
    pub fn sample(&self, from: DVec3, u: [f64; 2], choice: f64) -> Option<Drawn<f64>> {
        let half = self.ggx.sample_visible(from, u);
        let cosine = from.dot(half).clamp(0.0, 1.0);
        let f = fresnel::dielectric(cosine, self.eta_before, self.eta_beyond);
        if choice < f.reflectance {
            let direction = fresnel::reflect(-from, half);
            if direction.z <= 0.0 {
                return None;
            }
            let (density, _) = self.ggx.reflected(from, direction, half);
            let weight = self.ggx.shadowing_same_side(from, direction);
            return Some(Drawn { direction, weight, density: f.reflectance * density });
        }
        let ratio = self.eta_before / self.eta_beyond;
        let direction = fresnel::refract(-from, half, ratio, f.cos_transmitted);
        if direction.z >= 0.0 {
            return None;
        }
        let seen = self.ggx.visible_density(from, half);
        let density = (1.0 - f.reflectance) * seen * self.jacobian(from, direction, half);
        let weight = self.ggx.shadowing_two_sides(from, -direction);
        Some(Drawn { direction, weight, density })
    }

    fn reflectance(&self, cosine: f64) -> f64 {
        fresnel::dielectric(cosine.clamp(0.0, 1.0), self.eta_before, self.eta_beyond).reflectance
    }

    /// Steradians of normals per steradian of refracted directions.
    #[inline]
    fn jacobian(&self, from: DVec3, to: DVec3, half: DVec3) -> f64 {
        let (a, b) = (from.dot(half), to.dot(half));
        let bottom = self.eta_before * a + self.eta_beyond * b;
        self.eta_beyond * self.eta_beyond * b.abs() / (bottom * bottom)
    }
}
