//! Errors about words: unknown keys, unknown types, plugins in the wrong place.

use super::names;
use super::tree::{Member, Node, Value};
use super::trouble::{Outcome, Trouble};
use crate::description::{Kind, refused_parameter, refused_plugin};

/// The variant of an enum that a value names: a plain word by its text, a plugin by its `type`.
pub(crate) fn variant(
    node: &Node,
    enum_name: &str,
    variants: &'static [&'static str],
) -> Outcome<&'static str> {
    let found = match Kind::of_enum(enum_name) {
        Some(kind) => type_member(node, kind)?,
        None => node,
    };
    let Some(word) = found.as_str() else {
        let expected = names::one_of(variants);
        return Err(Trouble::new(format!("expected {expected}, as a text")).at(found));
    };
    let known = variants.iter().find(|&&variant| variant == word);
    known.copied().ok_or_else(|| unknown_variant(word, enum_name, variants).at(found))
}

/// The `type` of an object that is to be a plugin of this kind.
fn type_member(node: &Node, kind: Kind) -> Outcome<&Node> {
    match &node.value {
        Value::Object(_) => node.get("type").ok_or_else(|| {
            Trouble::new(format!("`type` is missing: this is to be {kind}"))
                .at(node)
                .hint(format!("write `\"type\": ...` with {}", names::one_of(kind.type_names())))
        }),
        Value::String(text) if kind.type_names().contains(&"ref") => {
            let text = names::shortened(text);
            Err(Trouble::new(format!("expected {kind} as an object, found the text \"{text}\""))
                .at(node)
                .hint(format!("a reference is written {{\"type\": \"ref\", \"id\": \"{text}\"}}")))
        }
        _ => Err(Trouble::new(format!("expected {kind}: an object with `type`")).at(node)),
    }
}

fn unknown_variant(word: &str, enum_name: &str, variants: &[&str]) -> Trouble {
    let shown = names::shortened(word);
    if enum_name == "Metal" {
        return Trouble::new(format!("the metal `{shown}` is not supported, only `none` is"))
            .hint("`\"material\": \"none\"` with `specular_reflectance` gives a coloured mirror");
    }
    if enum_name == "Distribution" {
        return Trouble::new(format!("the distribution `{shown}` is not supported, only `ggx` is"))
            .hint("`ggx` of the same `alpha` has longer tails than `beckmann`");
    }
    let kind = Kind::of_enum(enum_name);
    if (kind.is_some() || ["ColourType", "TextureType"].contains(&enum_name))
        && let Some(trouble) = refused(word)
    {
        return trouble;
    }
    let what = kind.map_or("a value here".to_owned(), |kind| kind.to_string());
    if let Some(other) = Kind::of_type(word).filter(|_| kind.is_some()) {
        return Trouble::new(format!("`{shown}` is {other}, but {what} is expected here"))
            .hint(format!("expected {}", names::one_of(variants)));
    }
    if word == "ref" {
        return Trouble::new(format!("a reference cannot stand here: write {what} in place"));
    }
    Trouble::new(format!("`{shown}` is not {what}, expected {}", names::one_of(variants)))
        .maybe_hint(names::did_you_mean(word, variants.iter().copied()))
}

/// The error about a Mitsuba plugin that is not supported.
pub(crate) fn refused(type_name: &str) -> Option<Trouble> {
    let refused = refused_plugin(type_name)?;
    let message =
        format!("`{type_name}` is {} of Mitsuba that this version does not support", refused.kind);
    Some(Trouble::new(message).hint(refused.instead))
}

/// The kind of an object of the scene, from its `type`.
pub(crate) fn kind_of_object(member: &Member) -> Outcome<Kind> {
    let node = &member.value;
    if !matches!(node.value, Value::Object(_)) {
        let key = names::shortened(&member.key);
        return Err(Trouble::new(format!(
            "expected an object with `type` as the value of `{key}`"
        ))
        .at(node)
        .hint("an entry of a scene is an id and an object, such as a shape or a BSDF"));
    }
    let Some(type_node) = node.get("type") else {
        let key = names::shortened(&member.key);
        return Err(Trouble::new(format!("`type` is missing: it says what `{key}` is"))
            .at_key(member)
            .hint("for example `\"type\": \"rectangle\"`"));
    };
    let Some(name) = type_node.as_str() else {
        return Err(Trouble::new("expected the name of a plugin as a text").at(type_node));
    };
    match Kind::of_type(name) {
        Some(kind) if Kind::TOP_LEVEL.contains(&kind) => Ok(kind),
        Some(kind) => Err(misplaced(name, kind).at(type_node)),
        None => Err(unknown_type(name).at(type_node)),
    }
}

fn misplaced(name: &str, kind: Kind) -> Trouble {
    let holder = match kind {
        Kind::ShapeEmitter => "a shape",
        Kind::Rfilter => "a film",
        _ => "a sensor",
    };
    Trouble::new(format!("`{name}` is {kind}: it cannot stand in the scene itself"))
        .hint(format!("put it into {holder}, under the key `{}`", kind.key()))
}

fn unknown_type(name: &str) -> Trouble {
    if let Some(trouble) = refused(name) {
        return trouble;
    }
    if name == "ref" {
        return Trouble::new("a reference can stand here only as `background`")
            .hint("references belong inside the objects that use them");
    }
    if name == "scene" {
        return Trouble::new("a scene cannot hold another scene");
    }
    let all = Kind::TOP_LEVEL.into_iter().flat_map(Kind::type_names);
    let known = all.copied().filter(|&name| name != "ref");
    Trouble::new(format!("unknown type `{}`", names::shortened(name)))
        .maybe_hint(names::did_you_mean(name, known))
}

/// The error about a key that its object does not have.
pub(crate) fn unknown_key(node: &Node, member: &Member, fields: &[&str]) -> Trouble {
    let key = names::shortened(&member.key);
    let place = match node.type_name() {
        Some(name) => format!("`{}`", names::shortened(name)),
        None => "this object".to_owned(),
    };
    let nearest = names::did_you_mean(&member.key, fields.iter().copied());
    let known = match fields {
        [] => format!("{place} has no parameters"),
        _ => format!("expected {}", names::one_of(fields)),
    };
    let trouble = if nearest.is_none() && refused_parameter(&member.key).is_some() {
        Trouble::new(format!("this version does not support the parameter `{key}` of {place}"))
    } else {
        Trouble::new(format!("unknown key `{key}` in {place}; {known}"))
    };
    trouble
        .at_key(member)
        .maybe_hint(nested(member, fields))
        .maybe_hint(nearest)
        .maybe_hint(refused_parameter(&member.key))
}

/// Mitsuba takes nested plugins under any key; here each kind has its own.
fn nested(member: &Member, fields: &[&str]) -> Option<String> {
    let kind = Kind::of_type(member.value.type_name()?)?;
    let key = kind.key();
    if kind == Kind::Medium && fields.contains(&"interior") {
        return Some("a shape holds media under the keys `interior` and `exterior`".to_owned());
    }
    fields.contains(&key).then(|| format!("{kind} goes under the key `{key}`"))
}

/// Names the plugin in errors that serde makes about the whole of it.
pub(crate) fn in_plugin(trouble: Trouble, node: &Node) -> Trouble {
    match (&trouble.site, node.type_name()) {
        (None, Some(name)) => {
            let message = format!("{} in `{}`", trouble.message, names::shortened(name));
            Trouble { message, ..trouble }
        }
        _ => trouble,
    }
}
