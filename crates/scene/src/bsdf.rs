//! What a surface does to light.
//!
//! One-sided materials act on the side of the normal and are black on the other, as in Mitsuba;
//! `twosided` gives each side its own.

use tpb_optics::Rgb;

/// The material of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Nothing: an index-matched boundary that light crosses unchanged.
    Null,
    /// A smooth interface between two refractive indices.
    Dielectric(Dielectric),
    /// An opaque surface with a reflector on each side.
    Opaque {
        /// On the side of the normal.
        front: Reflector,
        /// On the other side.
        back: Reflector,
    },
}

/// A smooth dielectric interface; `interior` is opposite to the normal.
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
    /// A perfect mirror with this reflectance, 0 to 1.
    Mirror(Rgb),
}

impl Bsdf {
    /// The reflector on the side that `facing_front` names; `None` if light can pass.
    #[inline]
    pub fn reflector(&self, facing_front: bool) -> Option<Reflector> {
        match *self {
            Self::Opaque { front, back } => Some(if facing_front { front } else { back }),
            Self::Null | Self::Dielectric(_) => None,
        }
    }

    /// Whether some side scatters diffusely.
    pub fn scatters_diffusely(&self) -> bool {
        let diffuse = |r| matches!(r, Reflector::Diffuse(rho) if !Rgb::is_zero(rho));
        matches!(*self, Self::Opaque { front, back } if diffuse(front) || diffuse(back))
    }

    /// Whether some side reflects as a mirror.
    pub fn is_mirror(&self) -> bool {
        let mirror = |r| matches!(r, Reflector::Mirror(rho) if !Rgb::is_zero(rho));
        matches!(*self, Self::Opaque { front, back } if mirror(front) || mirror(back))
    }

    /// Every factor on light that the material applies (for finding colour).
    pub(crate) fn factors(&self) -> Vec<Rgb> {
        let of = |r| match r {
            Reflector::Black => Rgb::ZERO,
            Reflector::Diffuse(rho) | Reflector::Mirror(rho) => rho,
        };
        match *self {
            Self::Null => vec![],
            Self::Dielectric(d) => vec![d.reflectance, d.transmittance],
            Self::Opaque { front, back } => vec![of(front), of(back)],
        }
    }
}
