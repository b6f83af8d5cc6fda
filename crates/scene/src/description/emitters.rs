//! Lamps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::materials::Medium;
use super::transform::{Transform, Vector};
use super::values::{Colour, ConeAngle, Light, NonNegative, Positive, grey};

/// A lamp that stands by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Emitter {
    /// A point that shines in all directions alike.
    Point(Point),
    /// A point that shines into a cone.
    Spot(Spot),
    /// Parallel light that covers all shapes.
    Directional(Directional),
    /// A round collimated beam (extension).
    Laser(Laser),
}

/// A lamp that belongs to a shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum ShapeEmitter {
    /// Diffuse emission from the surface, on the side of the normal.
    Area(Area),
}

/// `point`: shines in all directions alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Where it stands \[m\]; instead of `to_world`.
    #[serde(default)]
    pub position: Option<Vector>,
    /// Steps whose image of the origin is where it stands; instead of `position`.
    #[serde(default)]
    pub to_world: Option<Transform>,
    /// Radiant intensity \[W/sr\]: 0, or from 1e-100 to 1e100.
    #[serde(default = "unit")]
    pub intensity: Colour<Light>,
    /// The medium around it; found from the shapes around it unless given.
    #[serde(default)]
    pub medium: Option<Medium>,
}

/// `spot`: shines along local +z into a cone, with a linear falloff at its rim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spot {
    /// Steps that place the lamp: rotations and translations, or a `look_at`.
    #[serde(default)]
    pub to_world: Transform,
    /// Radiant intensity on the axis \[W/sr\]: 0, or from 1e-100 to 1e100.
    #[serde(default = "unit")]
    pub intensity: Colour<Light>,
    /// Angle from the axis beyond which it is dark, in degrees, at least 0.01.
    #[serde(default = "twenty_degrees")]
    pub cutoff_angle: ConeAngle,
    /// Angle from the axis up to which it is fully bright, in degrees; 3/4 of `cutoff_angle`
    /// unless given.
    #[serde(default)]
    pub beam_width: Option<NonNegative>,
    /// The medium around it; found from the shapes around it unless given.
    #[serde(default)]
    pub medium: Option<Medium>,
}

/// `directional`: parallel light, over all shapes. Optical path lengths count from the plane that
/// it reaches first of the sphere around all shapes (about the middle of their box, 0.1 % larger).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Directional {
    /// Where the light goes; instead of `to_world`.
    #[serde(default)]
    pub direction: Option<Vector>,
    /// Steps that turn local +z to where the light goes; instead of `direction`.
    #[serde(default)]
    pub to_world: Option<Transform>,
    /// Irradiance across the direction \[W/m^2\]: 0, or from 1e-100 to 1e100.
    #[serde(default = "unit")]
    pub irradiance: Colour<Light>,
}

/// `laser` (extension): a disc that sends a collimated beam along local +z, uniform over the
/// disc. Optical path lengths count from the disc.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Laser {
    /// Steps that place the disc: rotations and translations, or a `look_at`.
    #[serde(default)]
    pub to_world: Transform,
    /// Radius of the beam \[m\], greater than 0.
    pub radius: Positive,
    /// Total power \[W\]: 0, or from 1e-100 to 1e100.
    #[serde(default = "unit")]
    pub power: Colour<Light>,
    /// The medium around it; found from the shapes around it unless given.
    #[serde(default)]
    pub medium: Option<Medium>,
}

/// `area`: makes a shape shine, on the side of its normal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// Radiance in all directions \[W m^-2 sr^-1\]: 0, or from 1e-100 to
    /// 1e100.
    #[serde(default = "unit")]
    pub radiance: Colour<Light>,
}

const fn unit() -> Colour<Light> {
    grey(1.0)
}

const fn twenty_degrees() -> ConeAngle {
    ConeAngle::MITSUBA
}
