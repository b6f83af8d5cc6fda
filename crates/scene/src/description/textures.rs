//! Reflectances that change over a surface.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserialize, Deserializer, MapAccess, Visitor};
use serde::{Serialize, Serializer};

use super::transform::Transform;
use super::values::{Colour, Fraction, grey};

/// A reflectance: a number, linear RGB, or a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Reflectance {
    /// The same all over.
    Colour(Colour<Fraction>),
    /// Squares of two colours.
    Checkerboard(Checkerboard),
    /// An image.
    Bitmap(Bitmap),
}

/// `checkerboard`: squares of half a unit of the texture coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Checkerboard {
    /// Reflectance where both coordinates are in the same half of their unit.
    #[serde(default = "brighter")]
    pub color0: Colour<Fraction>,
    /// Reflectance of the other squares.
    #[serde(default = "darker")]
    pub color1: Colour<Fraction>,
    /// Steps that move texture coordinates (z is not used): scale 4 makes 8 x 8 squares.
    #[serde(default)]
    pub to_uv: Transform,
}

/// `bitmap`: an image over the unit square of the texture coordinates, its first row at v = 0.
#[derive(Clone, Debug, PartialEq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bitmap {
    /// Path of a PNG (sRGB) or OpenEXR (linear) file, relative to the scene file.
    pub filename: String,
    /// What is seen between texels.
    #[serde(default)]
    pub filter_type: FilterType,
    /// What is seen beyond the unit square.
    #[serde(default)]
    pub wrap_mode: WrapMode,
    /// Whether a PNG holds linear values.
    #[serde(default)]
    pub raw: bool,
    /// Steps that move texture coordinates (z is not used).
    #[serde(default)]
    pub to_uv: Transform,
}

/// Filters of `bitmap`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FilterType {
    /// Bilinear interpolation.
    #[default]
    Bilinear,
    /// The nearest texel.
    Nearest,
}

/// Continuations of `bitmap`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WrapMode {
    /// The image again.
    #[default]
    Repeat,
    /// The image again, every other time mirrored.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

const fn brighter() -> Colour<Fraction> {
    grey(0.4)
}

const fn darker() -> Colour<Fraction> {
    grey(0.2)
}

impl Serialize for Reflectance {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        #[serde(tag = "type", rename_all = "snake_case")]
        enum Tagged<'a> {
            Checkerboard(&'a Checkerboard),
            Bitmap(&'a Bitmap),
        }
        match self {
            Self::Colour(colour) => colour.serialize(serializer),
            Self::Checkerboard(board) => Tagged::Checkerboard(board).serialize(serializer),
            Self::Bitmap(bitmap) => Tagged::Bitmap(bitmap).serialize(serializer),
        }
    }
}

/// What the `type` of an object here may be.
#[derive(serde::Deserialize)]
#[serde(rename = "TextureType", rename_all = "snake_case")]
enum Kind {
    Rgb,
    Uniform,
    Spectrum,
    Checkerboard,
    Bitmap,
}

struct ReflectanceVisitor;

impl<'de> Visitor<'de> for ReflectanceVisitor {
    type Value = Reflectance;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, linear RGB as a list of 3 numbers, or a texture")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Reflectance, E> {
        let value = de::IntoDeserializer::<E>::into_deserializer(value);
        Colour::deserialize(value).map(Reflectance::Colour)
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Reflectance, E> {
        self.visit_f64(value as f64)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Reflectance, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, seq: A) -> Result<Reflectance, A::Error> {
        let list = de::value::SeqAccessDeserializer::new(seq);
        Colour::deserialize(list).map(Reflectance::Colour)
    }

    /// The loader shows `type` first.
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Reflectance, A::Error> {
        match map.next_key::<String>()?.as_deref() {
            Some("type") => {}
            _ => return Err(de::Error::missing_field("type")),
        }
        let kind = map.next_value::<Kind>()?;
        let rest = MapAccessDeserializer::new(map);
        match kind {
            Kind::Rgb | Kind::Uniform | Kind::Spectrum => {
                let Value { value } = Value::deserialize(rest)?;
                Ok(Reflectance::Colour(value))
            }
            Kind::Checkerboard => Checkerboard::deserialize(rest).map(Reflectance::Checkerboard),
            Kind::Bitmap => Bitmap::deserialize(rest).map(Reflectance::Bitmap),
        }
    }
}

/// The rest of a colour with a `type`.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Value {
    value: Colour<Fraction>,
}

impl<'de> Deserialize<'de> for Reflectance {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ReflectanceVisitor)
    }
}

impl JsonSchema for Reflectance {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Reflectance".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        /// The textures by their `type`.
        #[derive(JsonSchema)]
        #[schemars(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
        #[expect(dead_code, reason = "only its schema is used")]
        enum Texture {
            /// Squares of two colours.
            Checkerboard(Checkerboard),
            /// An image.
            Bitmap(Bitmap),
        }
        let colour = generator.subschema_for::<Colour<Fraction>>();
        let texture = generator.subschema_for::<Texture>();
        json_schema!({
            "description": "A number, linear RGB, or a texture.",
            "anyOf": [colour, texture]
        })
    }
}
