//! BSDFs, phase functions and media.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Reference;
use super::textures::Reflectance;
use super::values::{Colour, Fraction, Index, Ior, MeanCosine, NonNegative, Roughness, grey};

/// What a surface does to light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Bsdf {
    /// Lambertian reflection, on the side of the normal only.
    Diffuse(Diffuse),
    /// A perfect mirror, on the side of the normal only.
    Conductor(Conductor),
    /// A rough metal, on the side of the normal only.
    Roughconductor(RoughConductor),
    /// A smooth interface between two refractive indices.
    Dielectric(Dielectric),
    /// A rough interface between two refractive indices.
    Roughdielectric(RoughDielectric),
    /// A thin slab.
    Thindielectric(ThinDielectric),
    /// No surface at all: the boundary of an index-matched medium.
    Null(Null),
    /// Gives each side of an opaque surface its own BSDF.
    Twosided(Box<Twosided>),
    /// A BSDF that stands elsewhere in the file.
    Ref(Reference),
}

/// `diffuse`: Lambertian reflection on the side of the normal; the other side is black.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Diffuse {
    /// Part of the light that is reflected, 0 to 1: the same all over, or a texture.
    #[serde(default = "half")]
    pub reflectance: Reflectance,
}

impl Default for Diffuse {
    fn default() -> Self {
        Self { reflectance: half() }
    }
}

/// `conductor`: a mirror on the side of the normal; the other side is black.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Conductor {
    /// The metal. Only `none`, a perfect mirror, is supported; it must be written, because
    /// Mitsuba's default is a real metal.
    pub material: Metal,
    /// Part of the light that is reflected, 0 to 1.
    #[serde(default = "white")]
    pub specular_reflectance: Colour<Fraction>,
}

/// The metals that `conductor` and `roughconductor` know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Metal {
    /// No metal: reflects everything at every angle.
    None,
}

/// `roughconductor`: a metal of microfacets on the side of the normal; the other side is black.
/// What one microfacet sends into another is lost, as in Mitsuba: the rougher, the darker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoughConductor {
    /// The distribution of microfacets. Only `ggx` is supported; it must be written, because
    /// Mitsuba's default is `beckmann`.
    pub distribution: Distribution,
    /// Roughness, 1e-4 (a mirror, nearly) to 1; 0.1 unless given.
    #[serde(default)]
    pub alpha: Option<Roughness>,
    /// Roughness along one tangent: must be `alpha_v`, for surfaces are alike in all directions.
    #[serde(default)]
    pub alpha_u: Option<Roughness>,
    /// Roughness along the other tangent: must be `alpha_u`.
    #[serde(default)]
    pub alpha_v: Option<Roughness>,
    /// The metal: `none` reflects everything; instead of `eta` and `k`.
    #[serde(default)]
    pub material: Option<Metal>,
    /// Real part of the metal's refractive index, relative to what is outside; with `k`.
    #[serde(default)]
    pub eta: Option<Colour<NonNegative>>,
    /// Imaginary part of the metal's refractive index, relative to what is outside; with `eta`.
    #[serde(default)]
    pub k: Option<Colour<NonNegative>>,
    /// Factor on reflected light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_reflectance: Colour<Fraction>,
}

/// The distributions of microfacets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Trowbridge-Reitz.
    Ggx,
}

/// `dielectric`: a smooth interface with Fresnel reflection and refraction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dielectric {
    /// Refractive index on the side opposite to the normal.
    #[serde(default = "bk7")]
    pub int_ior: Ior,
    /// Refractive index on the side of the normal.
    #[serde(default = "air")]
    pub ext_ior: Ior,
    /// Factor on reflected light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_reflectance: Colour<Fraction>,
    /// Factor on transmitted light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_transmittance: Colour<Fraction>,
}

/// `roughdielectric`: an interface of microfacets that reflect and refract. What one microfacet
/// sends into another is lost, as in Mitsuba.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoughDielectric {
    /// The distribution of microfacets. Only `ggx` is supported; it must be written, because
    /// Mitsuba's default is `beckmann`.
    pub distribution: Distribution,
    /// Roughness, 1e-4 (clear glass, nearly) to 1; 0.1 unless given.
    #[serde(default)]
    pub alpha: Option<Roughness>,
    /// Roughness along one tangent: must be `alpha_v`, for surfaces are alike in all directions.
    #[serde(default)]
    pub alpha_u: Option<Roughness>,
    /// Roughness along the other tangent: must be `alpha_u`.
    #[serde(default)]
    pub alpha_v: Option<Roughness>,
    /// Refractive index on the side opposite to the normal.
    #[serde(default = "bk7")]
    pub int_ior: Ior,
    /// Refractive index on the side of the normal.
    #[serde(default = "air")]
    pub ext_ior: Ior,
    /// Factor on reflected light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_reflectance: Colour<Fraction>,
    /// Factor on transmitted light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_transmittance: Colour<Fraction>,
}

/// `thindielectric`: a slab of `int_ior` in `ext_ior`, thinner than anything else. All reflections
/// within it are summed; light passes without a change of direction, and the time that it takes
/// within the slab is neglected: echoes need a real slab of `dielectric`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThinDielectric {
    /// Refractive index of the slab.
    #[serde(default = "bk7")]
    pub int_ior: Ior,
    /// Refractive index around it.
    #[serde(default = "air")]
    pub ext_ior: Ior,
    /// Factor on reflected light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_reflectance: Colour<Fraction>,
    /// Factor on transmitted light, 0 to 1; 1 is physical.
    #[serde(default = "white")]
    pub specular_transmittance: Colour<Fraction>,
}

/// `null`: light passes unchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Null {}

/// `twosided`: opaque BSDFs on both sides of a surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Twosided {
    /// The BSDF of the front, and of the back too unless `back` is given: `diffuse`, `conductor` or
    /// `roughconductor`.
    pub bsdf: Bsdf,
    /// The BSDF of the back (the side opposite to the normal).
    #[serde(default)]
    pub back: Option<Bsdf>,
}

/// A participating medium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Medium {
    /// A medium that is the same everywhere.
    Homogeneous(Box<Homogeneous>),
    /// A medium that stands elsewhere in the file.
    Ref(Reference),
}

/// `homogeneous`: coefficients in 1/m, given as `sigma_t` and `albedo` (Mitsuba's way) or as
/// `sigma_s` and `sigma_a` (extension). What comes out is 0, or from 1e-100 to 1e100 per metre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Homogeneous {
    /// Extinction coefficient \[1/m\], at least 0; default 1.
    #[serde(default)]
    pub sigma_t: Option<Colour<NonNegative>>,
    /// Part of the extinction that is scattering, 0 to 1; default 0.75.
    #[serde(default)]
    pub albedo: Option<Colour<Fraction>>,
    /// Scattering coefficient \[1/m\], at least 0; with `sigma_a`.
    #[serde(default)]
    pub sigma_s: Option<Colour<NonNegative>>,
    /// Absorption coefficient \[1/m\], at least 0; with `sigma_s`.
    #[serde(default)]
    pub sigma_a: Option<Colour<NonNegative>>,
    /// Factor on all coefficients, at least 0.
    #[serde(default = "unscaled")]
    pub scale: NonNegative,
    /// Phase function; isotropic unless given.
    #[serde(default)]
    pub phase: Option<Phase>,
    /// Refractive index inside the medium, 1e-6 to 1e6 (extension); default 1.
    #[serde(default)]
    pub eta: Option<Index>,
}

/// The distribution of scattered directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Phase {
    /// All directions alike.
    Isotropic(Isotropic),
    /// Henyey-Greenstein.
    Hg(Hg),
    /// A phase function that stands elsewhere in the file.
    Ref(Reference),
}

/// `isotropic`: all directions alike.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Isotropic {}

/// `hg`: the Henyey-Greenstein phase function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hg {
    /// Mean cosine of the scattering angle, between -1 and 1 (exclusive); positive is forward.
    #[serde(default = "forward")]
    pub g: MeanCosine,
}

const fn half() -> Reflectance {
    Reflectance::Colour(grey(0.5))
}

const fn white() -> Colour<Fraction> {
    grey(1.0)
}

const fn bk7() -> Ior {
    Ior::BK7
}

const fn air() -> Ior {
    Ior::AIR
}

const fn unscaled() -> NonNegative {
    NonNegative::ONE
}

const fn forward() -> MeanCosine {
    MeanCosine::MITSUBA
}
