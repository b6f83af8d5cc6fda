//! The camera, its film, and the integrator.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::materials::Medium;
use super::transform::Transform;
use super::values::{FieldOfView, Positive};

/// A camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Sensor {
    /// A pinhole camera.
    Perspective(Box<Perspective>),
}

/// `perspective`: a pinhole that looks along local +z, with local +y up and +x to the left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Perspective {
    /// Field of view in degrees, at least 1e-10 and below 180, along `fov_axis`.
    pub fov: FieldOfView,
    /// The extent of the image that `fov` measures.
    #[serde(default)]
    pub fov_axis: FovAxis,
    /// Steps that place the camera: rotations and translations, or a `look_at`.
    #[serde(default)]
    pub to_world: Transform,
    /// The film, which also gives the size of the image.
    pub film: Film,
    /// The medium around the camera; found from the shapes around it unless given.
    #[serde(default)]
    pub medium: Option<Medium>,
}

/// The extent of the image that a field of view measures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FovAxis {
    /// Horizontal.
    #[default]
    X,
    /// Vertical.
    Y,
    /// Corner to corner.
    Diagonal,
    /// The smaller of horizontal and vertical.
    Smaller,
    /// The larger of horizontal and vertical.
    Larger,
}

/// What the camera records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Film {
    /// An image with a time axis.
    TransientHdrFilm(TransientHdrFilm),
    /// A steady image.
    Hdrfilm(HdrFilm),
}

/// `transient_hdr_film`: bins of optical path length in every pixel, and the steady image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TransientHdrFilm {
    /// Pixels per row, at least 1.
    #[serde(default = "width")]
    pub width: PixelCount,
    /// Rows, at least 1.
    #[serde(default = "height")]
    pub height: PixelCount,
    /// One channel or three.
    #[serde(default)]
    pub pixel_format: PixelFormat,
    /// Reconstruction filter.
    #[serde(default)]
    pub rfilter: Rfilter,
    /// Number of bins; 0, the default, leaves out the time axis.
    #[serde(default)]
    pub temporal_bins: u32,
    /// First edge of the first bin \[m\].
    #[serde(default)]
    pub start_opl: f64,
    /// Width of a bin \[m\], greater than 0.
    #[serde(default = "bin_width")]
    pub bin_width_opl: Positive,
}

/// `hdrfilm`: a steady image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HdrFilm {
    /// Pixels per row, at least 1.
    #[serde(default = "width")]
    pub width: PixelCount,
    /// Rows, at least 1.
    #[serde(default = "height")]
    pub height: PixelCount,
    /// One channel or three.
    #[serde(default)]
    pub pixel_format: PixelFormat,
    /// Reconstruction filter.
    #[serde(default)]
    pub rfilter: Rfilter,
}

/// Channels of a film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PixelFormat {
    /// One channel.
    Luminance,
    /// Linear RGB, Rec. 709 primaries.
    #[default]
    Rgb,
}

/// How a pixel weighs the light on the image plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Rfilter {
    /// The mean over the pixel's own area.
    Box(BoxFilter),
}

impl Default for Rfilter {
    fn default() -> Self {
        Self::Box(BoxFilter {})
    }
}

/// `box`: the mean over the pixel's own area.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxFilter {}

/// Defaults for the method and its depths; the command line overrides them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type", deny_unknown_fields)]
pub enum Integrator {
    /// The path tracer (all of these names mean the one that we have: it handles media and
    /// time whenever the scene has them).
    Path(Depths),
    /// The path tracer.
    Volpath(Depths),
    /// The path tracer.
    TransientPath(Depths),
    /// The path tracer.
    TransientVolpath(Depths),
    /// The path tracer.
    TransientPrbvolpath(Depths),
    /// Photon beams (extension).
    PhotonBeams(Depths),
    /// Photon beams (extension).
    TransientPhotonBeams(Depths),
    /// The light tracer: photons connected to the pinhole.
    Ptracer(Depths),
    /// The light tracer (extension).
    TransientPtracer(Depths),
}

/// Which lengths of paths count. Depth 1 is an emitter seen directly, 2 has one scattering event
/// in a medium or on a surface; crossings of `null` surfaces do not count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Depths {
    /// Deepest paths that count; -1 is no limit.
    #[serde(default)]
    pub max_depth: MaxDepth,
    /// Shallowest paths that count, at least 1 (extension).
    #[serde(default = "one")]
    pub min_depth: PathDepth,
    /// Depth from which Russian roulette may end a path, at least 1.
    #[serde(default = "five")]
    pub rr_depth: PathDepth,
}

macro_rules! whole_number {
    ($(#[$doc:meta])* $name:ident, $expected:literal, $maximum:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
        pub struct $name(u32);

        impl $name {
            /// The number.
            pub const fn get(self) -> u32 {
                self.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let value = u32::deserialize(deserializer)?;
                if (1..=$maximum).contains(&value) {
                    return Ok(Self(value));
                }
                Err(de::Error::invalid_value(de::Unexpected::Unsigned(value.into()), &$expected))
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn inline_schema() -> bool {
                true
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({ "type": "integer", "minimum": 1, "maximum": $maximum })
            }
        }
    };
}

whole_number!(
    /// A number of pixels along one side of the image.
    PixelCount, "a whole number from 1 to 65536", 65_536
);
whole_number!(
    /// A number of vertices of a path.
    PathDepth, "a whole number that is at least 1", u32::MAX
);

/// A depth, or none (-1 in the file).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaxDepth(pub Option<u32>);

impl Serialize for MaxDepth {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.map_or(-1, i64::from).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MaxDepth {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_i64(MaxDepthVisitor)
    }
}

struct MaxDepthVisitor;

impl Visitor<'_> for MaxDepthVisitor {
    type Value = MaxDepth;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a whole number that is at least 0, or -1 for no limit")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<MaxDepth, E> {
        match u32::try_from(value) {
            Ok(depth) => Ok(MaxDepth(Some(depth))),
            Err(_) if value == -1 => Ok(MaxDepth(None)),
            Err(_) => Err(E::invalid_value(de::Unexpected::Signed(value), &self)),
        }
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<MaxDepth, E> {
        self.visit_i64(i64::try_from(value).unwrap_or(i64::MAX))
    }
}

impl JsonSchema for MaxDepth {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "MaxDepth".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": -1, "maximum": u32::MAX })
    }
}

const fn width() -> PixelCount {
    PixelCount(768)
}

const fn height() -> PixelCount {
    PixelCount(576)
}

const fn bin_width() -> Positive {
    Positive::THREE_MILLIMETRES
}

const fn one() -> PathDepth {
    PathDepth(1)
}

const fn five() -> PathDepth {
    PathDepth(5)
}
