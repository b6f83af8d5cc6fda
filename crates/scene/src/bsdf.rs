//! What a surface does to light.
//!
//! One-sided materials act on the side of the normal and are black on the other, as in Mitsuba;
//! `twosided` gives each side its own.

use tpb_optics::Rgb;
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor};

use crate::texture::{Texture, TextureId};

/// The material of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Nothing: an index-matched boundary that light crosses unchanged.
    Null,
    /// A smooth interface between two refractive indices.
    Dielectric(Dielectric),
    /// An interface of microfacets between two refractive indices, which differ.
    RoughDielectric(Dielectric, Ggx),
    /// A slab of the interior index in the exterior one, thinner than anything else.
    ThinDielectric(Dielectric),
    /// An opaque surface with a reflector on each side.
    Opaque {
        /// On the side of the normal.
        front: Reflector,
        /// On the other side.
        back: Reflector,
    },
}

/// A dielectric interface; `interior` is opposite to the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Refractive index opposite to the normal.
    pub interior_eta: f64,
    /// Refractive index on the side of the normal.
    pub exterior_eta: f64,
    /// Factor on reflected light (1 for real glass).
    pub reflectance: Rgb,
    /// Factor on transmitted light (1 for real glass).
    pub transmittance: Rgb,
}

/// One side of an opaque surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflector {
    /// Absorbs all.
    Black,
    /// Lambertian with this reflectance, 0 to 1: BSDF value reflectance/π.
    Diffuse(Rgb),
    /// Lambertian with the reflectance of a texture.
    Textured(TextureId),
    /// A perfect mirror with this reflectance, 0 to 1.
    Mirror(Rgb),
    /// A rough metal.
    Rough(RoughMetal),
}

/// A rough metal with a colour of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughMetal {
    /// Microfacets and Fresnel's reflectance.
    pub surface: RoughConductor,
    /// Factor on all reflected light, 0 to 1.
    pub reflectance: Rgb,
}

impl Reflector {
    /// No light is reflected by more than this.
    pub fn most_reflectance(&self, textures: &[Texture]) -> Rgb {
        match *self {
            Self::Black => Rgb::ZERO,
            Self::Diffuse(rho) | Self::Mirror(rho) => rho,
            Self::Textured(TextureId(id)) => textures[id as usize].most(),
            // Fresnel's factor at grazing angles is 1.
            Self::Rough(metal) => metal.reflectance,
        }
    }
}

impl Bsdf {
    /// The reflector on the side that `facing_front` names; `None` if light can pass.
    #[inline]
    pub fn reflector(&self, facing_front: bool) -> Option<Reflector> {
        match *self {
            Self::Opaque { front, back } => Some(if facing_front { front } else { back }),
            _ => None,
        }
    }

    /// The interface between two refractive indices, smooth or rough, if it is one.
    #[inline]
    pub fn interface(&self) -> Option<&Dielectric> {
        match self {
            Self::Dielectric(glass) | Self::RoughDielectric(glass, _) => Some(glass),
            Self::Null | Self::ThinDielectric(_) | Self::Opaque { .. } => None,
        }
    }

    /// Whether light crosses it into the same refractive index.
    pub fn keeps_index(&self) -> bool {
        matches!(self, Self::Null | Self::ThinDielectric(_))
    }

    /// Whether it is smooth and lets light pass.
    pub fn is_smooth_glass(&self) -> bool {
        matches!(self, Self::Dielectric(_) | Self::ThinDielectric(_))
    }

    /// Whether some side is rough: it spreads light, but not diffusely.
    pub fn is_rough(&self) -> bool {
        let rough = |r| matches!(r, Reflector::Rough(metal) if !metal.reflectance.is_zero());
        matches!(*self, Self::RoughDielectric(..))
            || matches!(*self, Self::Opaque { front, back } if rough(front) || rough(back))
    }

    /// Whether some side scatters diffusely.
    pub fn scatters_diffusely(&self) -> bool {
        let diffuse = |r| match r {
            Reflector::Diffuse(rho) => !Rgb::is_zero(rho),
            Reflector::Textured(_) => true,
            _ => false,
        };
        matches!(*self, Self::Opaque { front, back } if diffuse(front) || diffuse(back))
    }

    /// Whether some side reflects as a mirror.
    pub fn is_mirror(&self) -> bool {
        let mirror = |r| matches!(r, Reflector::Mirror(rho) if !Rgb::is_zero(rho));
        matches!(*self, Self::Opaque { front, back } if mirror(front) || mirror(back))
    }

    /// Every factor on light that the material applies, textures apart (for finding colour).
    pub(crate) fn factors(&self) -> Vec<Rgb> {
        let of = |r: Reflector| match r {
            Reflector::Rough(RoughMetal { surface, reflectance }) => match surface.metal {
                Metal::Perfect => vec![reflectance],
                Metal::Index { eta, k } => vec![reflectance, eta, k],
            },
            Reflector::Diffuse(rho) | Reflector::Mirror(rho) => vec![rho],
            Reflector::Black | Reflector::Textured(_) => vec![],
        };
        match *self {
            Self::Null => vec![],
            Self::Dielectric(d) | Self::RoughDielectric(d, _) | Self::ThinDielectric(d) => {
                vec![d.reflectance, d.transmittance]
            }
            Self::Opaque { front, back } => [of(front), of(back)].concat(),
        }
    }
}
