//! The values inside plugins: bounded numbers, colours, refractive indices.
//!
//! Every bound lives in a type, so that it is checked where the value stands in the file (the
//! error then points at the number itself) and appears in the JSON schema.

use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Serialize, Serializer};
use tpb_optics::Rgb;
use tpb_optics::microfacet::Ggx;

macro_rules! bounded_number {
    ($(#[$doc:meta])* $name:ident, $expected:literal, $holds:expr, $($schema:tt)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
        pub struct $name(f64);

        impl $name {
            /// The number.
            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl From<$name> for f64 {
            fn from(value: $name) -> f64 {
                value.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let value = f64::deserialize(deserializer)?;
                let holds: fn(f64) -> bool = $holds;
                if value.is_finite() && holds(value) {
                    return Ok(Self(value));
                }
                Err(de::Error::invalid_value(de::Unexpected::Float(value), &$expected))
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
                json_schema!({ "type": "number", $($schema)* })
            }
        }
    };
}

bounded_number!(
    /// A number greater than 0.
    Positive, "a number greater than 0", |v| v > 0.0, "exclusiveMinimum": 0
);
bounded_number!(
    /// A number that is at least 0.
    NonNegative, "a number that is at least 0", |v| v >= 0.0, "minimum": 0
);
bounded_number!(
    /// An amount of light: 0, or a number from 1e-100 to 1e100, so that neither the image nor its
    /// variance leaves the range of f64 at any distance.
    Light, "0, or a number from 1e-100 to 1e100", |v| v == 0.0 || (1e-100..=1e100).contains(&v),
    "minimum": 0, "maximum": 1e100
);
bounded_number!(
    /// A refractive index.
    Index, "a refractive index from 1e-6 to 1e6", |v| (1e-6..=1e6).contains(&v),
    "minimum": 1e-6, "maximum": 1e6
);
bounded_number!(
    /// A number from 0 to 1.
    Fraction, "a number from 0 to 1", |v| (0.0..=1.0).contains(&v), "minimum": 0, "maximum": 1
);
bounded_number!(
    /// The roughness of microfacets, 1e-4 to 1.
    Roughness, "a roughness from 1e-4 to 1", |v| Ggx::RANGE.contains(&v),
    "minimum": 1e-4, "maximum": 1
);
bounded_number!(
    /// The mean cosine of a phase function, between -1 and 1 (exclusive).
    MeanCosine, "a number between -1 and 1 (exclusive)", |v| v.abs() < 1.0,
    "exclusiveMinimum": -1, "exclusiveMaximum": 1
);
bounded_number!(
    /// A field of view in degrees, from 1e-10 (f64 tells some 1e4 directions apart in it) to below
    /// 180.
    FieldOfView, "an angle in degrees, at least 1e-10 and below 180",
    |v| (1e-10..180.0).contains(&v), "minimum": 1e-10, "exclusiveMaximum": 180
);
bounded_number!(
    /// The half angle of a cone in degrees, 0.01 (below, its solid angle is lost in the cosine; a
    /// laser has none) to 180.
    ConeAngle, "an angle in degrees from 0.01 to 180", |v| (0.01..=180.0).contains(&v),
    "minimum": 0.01, "maximum": 180
);

impl NonNegative {
    /// 1.
    pub const ONE: Self = Self(1.0);
}

impl Positive {
    /// 1.
    pub const ONE: Self = Self(1.0);
    /// 3 mm, the default bin of mitransient's film.
    pub const THREE_MILLIMETRES: Self = Self(0.003);
}

impl Roughness {
    /// The default of Mitsuba's rough materials.
    pub const MITSUBA: Self = Self(0.1);
}

impl MeanCosine {
    /// The default of Mitsuba's `hg`.
    pub const MITSUBA: Self = Self(0.8);
}

impl ConeAngle {
    /// The default cutoff of Mitsuba's `spot`.
    pub const MITSUBA: Self = Self(20.0);
}

/// A number for all channels or linear RGB, each within the bounds of `T`.
///
/// Accepted forms: a number; a list of three numbers; `{"type": "rgb", "value": [r, g, b]}`;
/// `{"type": "uniform", "value": x}` (also under its name `spectrum`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour<T> {
    rgb: Rgb,
    bound: PhantomData<T>,
}

impl<T> Colour<T> {
    /// The three channels.
    pub const fn rgb(self) -> Rgb {
        self.rgb
    }

    const fn new(rgb: Rgb) -> Self {
        Self { rgb, bound: PhantomData }
    }
}

/// Defaults of the vocabulary; the caller keeps them within the bounds.
pub(super) const fn grey<T>(value: f64) -> Colour<T> {
    Colour::new(Rgb::splat(value))
}

impl<T> Serialize for Colour<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.rgb.is_achromatic() {
            self.rgb[0].serialize(serializer)
        } else {
            self.rgb.0.serialize(serializer)
        }
    }
}

impl<'de, T: Deserialize<'de> + Into<f64>> Deserialize<'de> for Colour<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColourVisitor { bound: PhantomData, wrapped: false })
    }
}

struct ColourVisitor<T> {
    bound: PhantomData<T>,
    /// Inside `{"type": ..., "value": ...}`, where no further object may follow.
    wrapped: bool,
}

impl<'de, T: Deserialize<'de> + Into<f64>> Visitor<'de> for ColourVisitor<T> {
    type Value = Colour<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, or linear RGB as a list of 3 numbers")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Self::Value, E> {
        Ok(Colour::new(Rgb::splat(T::deserialize(value.into_deserializer())?.into())))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut rgb = Rgb::ZERO;
        for channel in 0..3 {
            let value = seq.next_element::<T>()?;
            rgb[channel] = value.ok_or_else(|| de::Error::invalid_length(channel, &self))?.into();
        }
        let mut length = 3;
        while seq.next_element::<de::IgnoredAny>()?.is_some() {
            length += 1;
        }
        if length > 3 {
            return Err(de::Error::invalid_length(length, &self));
        }
        Ok(Colour::new(rgb))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        if self.wrapped {
            return Err(de::Error::invalid_type(de::Unexpected::Map, &self));
        }
        let (mut kind, mut colour) = (None, None);
        while let Some(key) = map.next_key::<WrapperKey>()? {
            match key {
                WrapperKey::Type => kind = Some(map.next_value::<WrapperType>()?),
                WrapperKey::Value => colour = Some(map.next_value::<Wrapped<T>>()?.0),
            }
        }
        kind.ok_or_else(|| de::Error::missing_field("type"))?;
        colour.ok_or_else(|| de::Error::missing_field("value"))
    }
}

#[derive(serde::Deserialize)]
#[serde(field_identifier, rename_all = "snake_case")]
enum WrapperKey {
    Type,
    Value,
}

/// The textures that are one colour.
#[derive(serde::Deserialize)]
#[serde(rename = "ColourType", rename_all = "snake_case")]
enum WrapperType {
    Rgb,
    Uniform,
    Spectrum,
}

struct Wrapped<T>(Colour<T>);

impl<'de, T: Deserialize<'de> + Into<f64>> Deserialize<'de> for Wrapped<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let visitor = ColourVisitor { bound: PhantomData, wrapped: true };
        deserializer.deserialize_any(visitor).map(Self)
    }
}

impl<T: JsonSchema> JsonSchema for Colour<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("ColourOf{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let channel = T::json_schema(generator);
        let list = json_schema!({
            "type": "array", "items": channel.clone(), "minItems": 3, "maxItems": 3
        });
        json_schema!({
            "description": "A number for all channels, or linear RGB.",
            "anyOf": [channel.clone(), list.clone(), {
                "type": "object",
                "properties": {
                    "type": { "enum": ["rgb", "uniform", "spectrum"] },
                    "value": { "anyOf": [channel, list] },
                },
                "required": ["type", "value"],
                "additionalProperties": false,
            }]
        })
    }
}

/// A refractive index as a number from 1e-6 to 1e6, or the name of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ior(f64);

/// Refractive indices by name, at about 589 nm: Mitsuba's names and values.
pub const MATERIALS: [(&str, f64); 23] = [
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

impl Ior {
    /// The glass BK7, Mitsuba's default inside of a dielectric.
    pub const BK7: Self = Self(1.5046);
    /// Air, Mitsuba's default outside of a dielectric.
    pub const AIR: Self = Self(1.000_277);

    /// The index.
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl Serialize for Ior {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Ior {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(IorVisitor)
    }
}

struct IorVisitor;

impl Visitor<'_> for IorVisitor {
    type Value = Ior;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a refractive index from 1e-6 to 1e6, or the name of a material")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Ior, E> {
        if (1e-6..=1e6).contains(&value) {
            return Ok(Ior(value));
        }
        Err(E::invalid_value(de::Unexpected::Float(value), &self))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Ior, E> {
        self.visit_f64(value as f64)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Ior, E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Ior, E> {
        const NAMES: [&str; MATERIALS.len()] = {
            let mut names = [""; MATERIALS.len()];
            let mut i = 0;
            while i < names.len() {
                names[i] = MATERIALS[i].0;
                i += 1;
            }
            names
        };
        let lower = name.to_lowercase();
        let found = MATERIALS.iter().find(|(material, _)| *material == lower);
        found.map(|&(_, ior)| Ior(ior)).ok_or_else(|| E::unknown_variant(name, &NAMES))
    }
}

impl JsonSchema for Ior {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Ior".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names = MATERIALS.map(|(name, _)| name);
        json_schema!({
            "description": "Refractive index: a number from 1e-6 to 1e6, or the name of a material.",
            "anyOf": [{ "type": "number", "minimum": 1e-6, "maximum": 1e6 }, { "enum": names }]
        })
    }
}
