//! From the tree to the structs of the vocabulary, through serde.
//!
//! A deserialiser over the tree whose errors know their place. It differs from a plain one in
//! what the scene format needs:
//!
//! * an enum may be an object whose `type` names the variant; `type` is looked at first wherever
//!   it stands, so a wrong one is reported before anything else in the object;
//! * keys are checked against the fields of the struct here, where the right error can be made;
//! * `null` is no value, and a list has exactly the length that is asked for.

use serde::de::value::StrDeserializer;
use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, IntoDeserializer, Visitor};

use super::tree::{Member, Node, Value};
use super::trouble::{Outcome, Trouble};
use super::vocabulary;
use crate::description::Kind;

/// Reads a value of the vocabulary.
pub(crate) fn read<'de, T: Deserialize<'de>>(node: &'de Node) -> Outcome<T> {
    T::deserialize(node)
}

impl<'de> Deserializer<'de> for &'de Node {
    type Error = Trouble;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Outcome<V::Value> {
        let outcome = match &self.value {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Number(number) => match (number.as_u64(), number.as_i64(), number.as_f64()) {
                (Some(value), _, _) => visitor.visit_u64(value),
                (_, Some(value), _) => visitor.visit_i64(value),
                (_, _, value) => visitor.visit_f64(value.unwrap_or(f64::INFINITY)),
            },
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Array(items) => visit_items(items, visitor),
            Value::Object(members) => visitor.visit_map(Entries::new(self, members, false)),
        };
        outcome.map_err(|trouble| trouble.at(self))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Outcome<V::Value> {
        if matches!(self.value, Value::Null) {
            return Err(Trouble::new("expected a value, found `null`")
                .at(self)
                .hint("leave the key out to get its default"));
        }
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Outcome<V::Value> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Outcome<V::Value> {
        match &self.value {
            Value::Array(items) if items.len() != length => {
                Err(<Trouble as de::Error>::invalid_length(items.len(), &visitor).at(self))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        visit_struct(self, fields, false, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        let variant = vocabulary::variant(self, name, variants)?;
        let content = Kind::of_enum(name).map(|_| self);
        visitor.visit_enum(Choice { variant, content }).map_err(|trouble| trouble.at(self))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple_struct map identifier ignored_any
    }
}

/// A list, which serde must read to its end.
fn visit_items<'de, V: Visitor<'de>>(items: &'de [Node], visitor: V) -> Outcome<V::Value> {
    let mut rest = Items(items.iter());
    let value = visitor.visit_seq(&mut rest)?;
    match rest.0.len() {
        0 => Ok(value),
        more => Err(Trouble::new(format!("this list has {more} elements too many"))),
    }
}

struct Items<'de>(std::slice::Iter<'de, Node>);

impl<'de> de::SeqAccess<'de> for &mut Items<'de> {
    type Error = Trouble;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Outcome<Option<S::Value>> {
        let read = |node: &'de Node| seed.deserialize(node).map_err(|trouble| trouble.at(node));
        self.0.next().map(read).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// An object as a struct; with `tagged`, its `type` has been dealt with.
fn visit_struct<'de, V: Visitor<'de>>(
    node: &'de Node,
    fields: &'static [&'static str],
    tagged: bool,
    visitor: V,
) -> Outcome<V::Value> {
    let Value::Object(members) = &node.value else {
        return node.deserialize_any(visitor);
    };
    for member in members {
        let is_tag = tagged && member.key == "type";
        if !is_tag && !fields.contains(&member.key.as_str()) {
            return Err(vocabulary::unknown_key(node, member, fields));
        }
    }
    let outcome = visitor.visit_map(Entries::new(node, members, tagged));
    outcome.map_err(|trouble| vocabulary::in_plugin(trouble, node).at(node))
}

/// The entries of an object: `type` first (or never, once it has been dealt with), then the
/// others as they stand in the file.
struct Entries<'de> {
    tag: Option<&'de Member>,
    rest: std::slice::Iter<'de, Member>,
    value: Option<&'de Node>,
}

impl<'de> Entries<'de> {
    fn new(node: &'de Node, members: &'de [Member], tagged: bool) -> Self {
        let tag = if tagged { None } else { node.member("type") };
        Self { tag, rest: members.iter(), value: None }
    }
}

impl<'de> de::MapAccess<'de> for Entries<'de> {
    type Error = Trouble;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Outcome<Option<K::Value>> {
        let next = self.tag.take().or_else(|| self.rest.find(|member| member.key != "type"));
        let Some(member) = next else {
            return Ok(None);
        };
        self.value = Some(&member.value);
        let key: StrDeserializer<Trouble> = member.key.as_str().into_deserializer();
        seed.deserialize(key).map(Some).map_err(|trouble| trouble.at_key(member))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Outcome<S::Value> {
        let node = self.value.take().ok_or_else(|| Trouble::new("a value without a key"))?;
        seed.deserialize(node).map_err(|trouble| trouble.at(node))
    }
}

/// A variant by its name; the content of a plugin is its own object, less its `type`.
struct Choice<'de> {
    variant: &'static str,
    content: Option<&'de Node>,
}

impl<'de> de::EnumAccess<'de> for Choice<'de> {
    type Error = Trouble;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Outcome<(S::Value, Self)> {
        let name: StrDeserializer<Trouble> = self.variant.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de> de::VariantAccess<'de> for Choice<'de> {
    type Error = Trouble;

    fn unit_variant(self) -> Outcome<()> {
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Outcome<S::Value> {
        let node = self.content.ok_or_else(|| Trouble::new("a name cannot stand here"))?;
        seed.deserialize(Body(node))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Outcome<V::Value> {
        Err(Trouble::new("the vocabulary has no plugin that is a list"))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        let node = self.content.ok_or_else(|| Trouble::new("a name cannot stand here"))?;
        visit_struct(node, fields, true, visitor)
    }
}

/// An object whose `type` has been read.
struct Body<'de>(&'de Node);

impl<'de> Deserializer<'de> for Body<'de> {
    type Error = Trouble;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Outcome<V::Value> {
        self.0.deserialize_any(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Outcome<V::Value> {
        visit_struct(self.0, fields, true, visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
        unit unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}
