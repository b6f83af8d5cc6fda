//! The kinds of plugins, and which type names belong to each.

use std::fmt;

use serde::de::{self, Deserialize, Deserializer, Visitor};

use super::{Bsdf, Emitter, Film, Integrator, Medium, Phase, Rfilter, Sensor, Shape, ShapeEmitter};

/// A kind of plugin: what can be exchanged for what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A method and its depths.
    Integrator,
    /// A camera.
    Sensor,
    /// What a camera records.
    Film,
    /// A reconstruction filter.
    Rfilter,
    /// A surface.
    Shape,
    /// A lamp that stands by itself.
    Emitter,
    /// A lamp that belongs to a shape.
    ShapeEmitter,
    /// What a surface does to light.
    Bsdf,
    /// A participating medium.
    Medium,
    /// A phase function.
    Phase,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 10] = [
        Self::Integrator,
        Self::Sensor,
        Self::Film,
        Self::Rfilter,
        Self::Shape,
        Self::Emitter,
        Self::ShapeEmitter,
        Self::Bsdf,
        Self::Medium,
        Self::Phase,
    ];

    /// The kinds that may stand in the scene itself, not only inside another plugin.
    pub const TOP_LEVEL: [Self; 7] = [
        Self::Integrator,
        Self::Sensor,
        Self::Shape,
        Self::Emitter,
        Self::Bsdf,
        Self::Medium,
        Self::Phase,
    ];

    /// The kind that has a plugin of this type name.
    pub fn of_type(type_name: &str) -> Option<Self> {
        let has = |kind: &Self| type_name != "ref" && kind.type_names().contains(&type_name);
        Self::ALL.into_iter().find(has)
    }

    /// The kind whose plugins form the enum of this Rust name.
    pub(crate) fn of_enum(rust_name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| format!("{kind:?}") == rust_name)
    }

    /// The type names of its plugins, with `ref` where a reference may stand instead.
    pub fn type_names(self) -> &'static [&'static str] {
        match self {
            Self::Integrator => variants::<Integrator>(),
            Self::Sensor => variants::<Sensor>(),
            Self::Film => variants::<Film>(),
            Self::Rfilter => variants::<Rfilter>(),
            Self::Shape => variants::<Shape>(),
            Self::Emitter => variants::<Emitter>(),
            Self::ShapeEmitter => variants::<ShapeEmitter>(),
            Self::Bsdf => variants::<Bsdf>(),
            Self::Medium => variants::<Medium>(),
            Self::Phase => variants::<Phase>(),
        }
    }

    /// The key under which other plugins hold one of this kind.
    pub fn key(self) -> &'static str {
        match self {
            Self::Integrator => "integrator",
            Self::Sensor => "sensor",
            Self::Film => "film",
            Self::Rfilter => "rfilter",
            Self::Shape => "shape",
            Self::Emitter | Self::ShapeEmitter => "emitter",
            Self::Bsdf => "bsdf",
            Self::Medium => "medium",
            Self::Phase => "phase",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Integrator => "an integrator",
            Self::Sensor => "a sensor",
            Self::Film => "a film",
            Self::Rfilter => "a reconstruction filter",
            Self::Shape => "a shape",
            Self::Emitter => "an emitter",
            Self::ShapeEmitter => "an emitter of a shape",
            Self::Bsdf => "a BSDF",
            Self::Medium => "a medium",
            Self::Phase => "a phase function",
        })
    }
}

/// The names that serde knows for the variants of an enum: asks its derived code, so that no
/// second list has to be kept.
fn variants<T: for<'de> Deserialize<'de>>() -> &'static [&'static str] {
    match T::deserialize(Probe) {
        Err(Variants(names)) => names,
        Ok(_) => &[],
    }
}

/// A deserialiser that holds no data and fails with the question it was asked.
struct Probe;

#[derive(Debug)]
struct Variants(&'static [&'static str]);

impl fmt::Display for Variants {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl std::error::Error for Variants {}

impl de::Error for Variants {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self(&[])
    }
}

impl<'de> Deserializer<'de> for Probe {
    type Error = Variants;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Variants> {
        Err(Variants(&[]))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Variants> {
        Err(Variants(variants))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
        unit unit_struct newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_knows_its_plugins_and_is_found_by_them() {
        for kind in Kind::ALL {
            assert!(!kind.type_names().is_empty(), "{kind:?}");
            for name in kind.type_names().iter().filter(|&&name| name != "ref") {
                assert_eq!(Kind::of_type(name), Some(kind), "{name}");
            }
            assert_eq!(Kind::of_enum(&format!("{kind:?}")), Some(kind));
        }
        assert_eq!(Kind::of_type("ref"), None);
    }
}
