//! `to_world`: a list of steps, of which the first listed acts first.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use serde::{Serialize, Serializer};

/// A point or vector \[m\]: three numbers.
pub type Vector = [f64; 3];

/// A list of steps from local coordinates to the world's; the first listed acts first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, serde::Deserialize, JsonSchema)]
pub struct Transform(pub Vec<Step>);

/// One step of a transform: exactly one of its keys.
#[derive(Clone, Debug, Default, PartialEq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct Step {
    /// Moves by this vector \[m\].
    #[serde(default)]
    pub translate: Option<Vector>,
    /// Turns about an axis through the origin.
    #[serde(default)]
    pub rotate: Option<Rotate>,
    /// Scales by one factor, or by one per axis.
    #[serde(default)]
    pub scale: Option<Scale>,
    /// Moves the origin to a point, from which local +z then looks at another.
    #[serde(default)]
    pub look_at: Option<LookAt>,
    /// A matrix of four rows; the last row is 0, 0, 0, 1.
    #[serde(default)]
    pub matrix: Option<[[f64; 4]; 4]>,
}

/// A rotation, counter-clockwise when the axis points at the viewer.
#[derive(Clone, Debug, PartialEq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotate {
    /// Direction of the axis, of any length greater than 0.
    pub axis: Vector,
    /// Angle in degrees.
    pub angle: f64,
}

/// Local +z looks from `origin` to `target`; local +y is as near to `up` as that allows, and
/// local +x points to the left of the view.
#[derive(Clone, Debug, PartialEq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LookAt {
    /// Where the local origin goes \[m\].
    pub origin: Vector,
    /// The point looked at \[m\].
    pub target: Vector,
    /// Direction that appears upwards, not parallel to the view.
    pub up: Vector,
}

/// One factor for all axes, or one for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(pub Vector);

impl Serialize for Scale {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScaleVisitor)
    }
}

struct ScaleVisitor;

impl<'de> Visitor<'de> for ScaleVisitor {
    type Value = Scale;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a factor, or a list of 3 factors")
    }

    fn visit_f64<E: de::Error>(self, factor: f64) -> Result<Scale, E> {
        Ok(Scale([factor; 3]))
    }

    fn visit_u64<E: de::Error>(self, factor: u64) -> Result<Scale, E> {
        self.visit_f64(factor as f64)
    }

    fn visit_i64<E: de::Error>(self, factor: i64) -> Result<Scale, E> {
        self.visit_f64(factor as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Scale, A::Error> {
        Vector::deserialize(de::value::SeqAccessDeserializer::new(seq)).map(Scale)
    }
}

impl JsonSchema for Scale {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Scale".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "One factor for all axes, or one for each.",
            "anyOf": [{ "type": "number" }, Vector::json_schema(generator)]
        })
    }
}
