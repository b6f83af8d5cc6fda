//! What went wrong, before it is known how to show it.
//!
//! Inside the loader an error carries only the number of the value that it is about. The tree
//! turns that into a JSON path, and the source into line and column, once, at the end.

use std::fmt;
use std::ops::Range;

use super::names;
use super::tree::{Member, Node};

/// An error of the loader on its way up.
#[derive(Debug)]
pub(crate) struct Trouble {
    pub(crate) site: Option<Site>,
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

/// What an error points at.
#[derive(Clone, Debug)]
pub(crate) enum Site {
    /// Bytes of a text that is no tree (yet).
    Bytes(Range<usize>),
    /// These bytes, which belong to the value with this id.
    Value(u32, Range<usize>),
}

pub(crate) type Outcome<T> = Result<T, Trouble>;

impl Trouble {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { site: None, message: message.into(), hint: None }
    }

    /// Points at a value, unless something more precise is pointed at already.
    pub(crate) fn at(mut self, node: &Node) -> Self {
        self.site.get_or_insert_with(|| Site::Value(node.id, node.headline()));
        self
    }

    /// Points at a key.
    pub(crate) fn at_key(mut self, member: &Member) -> Self {
        let site = || Site::Value(member.value.id, member.key_span.clone());
        self.site.get_or_insert_with(site);
        self
    }

    pub(crate) fn at_bytes(mut self, span: Range<usize>) -> Self {
        self.site.get_or_insert(Site::Bytes(span));
        self
    }

    /// Adds a hint, unless there is one.
    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint.get_or_insert_with(|| hint.into());
        self
    }

    /// The override that the value comes from, if it does.
    pub(crate) fn origin(&self, root: &Node) -> Option<usize> {
        match self.site {
            Some(Site::Value(id, _)) => root.locate(id)?.from_override,
            _ => None,
        }
    }

    pub(crate) fn maybe_hint(self, hint: Option<impl Into<String>>) -> Self {
        match hint {
            Some(hint) => self.hint(hint),
            None => self,
        }
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Trouble {}

impl serde::de::Error for Trouble {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(message.to_string())
    }

    fn invalid_type(found: serde::de::Unexpected, expected: &dyn serde::de::Expected) -> Self {
        Self::new(format!("expected {}, found {}", plainly(expected), found_plainly(found)))
    }

    fn invalid_value(found: serde::de::Unexpected, expected: &dyn serde::de::Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn serde::de::Expected) -> Self {
        Self::new(format!("expected {}, found a list of length {length}", plainly(expected)))
    }

    fn unknown_variant(found: &str, expected: &'static [&'static str]) -> Self {
        Self::new(format!("unknown name `{found}`, expected {}", names::one_of(expected)))
            .maybe_hint(names::did_you_mean(found, expected.iter().copied()))
    }

    fn missing_field(field: &'static str) -> Self {
        let trouble = Self::new(format!("`{field}` is missing"));
        match field {
            "material" => trouble.hint(
                "Mitsuba's default is a real metal, which is not supported; write \
                 `\"material\": \"none\"` for a perfect mirror and `specular_reflectance` for its \
                 reflectance",
            ),
            "distribution" => trouble.hint(
                "Mitsuba's default is `beckmann`, which is not supported; write \
                 `\"distribution\": \"ggx\"`",
            ),
            "fov" => trouble.hint("write the field of view in degrees, for example `\"fov\": 40`"),
            "id" => trouble.hint("a reference names the object it means: `\"id\": \"...\"`"),
            _ => trouble,
        }
    }
}

/// Serde's names for Rust types in the words of the scene format.
fn plainly(expected: &dyn serde::de::Expected) -> String {
    let text = expected.to_string();
    match text.as_str() {
        "f64" => "a number".to_owned(),
        "i64" => "a whole number".to_owned(),
        "u32" | "u64" | "usize" => "a whole number that is at least 0".to_owned(),
        "a sequence" => "a list".to_owned(),
        "an array of length 3" => "a list of 3 numbers".to_owned(),
        "an array of length 4" => "a list of 4 rows of 4 numbers".to_owned(),
        _ => match text.split_once(' ') {
            Some(("struct" | "tuple", _)) => "an object".to_owned(),
            _ => text,
        },
    }
}

fn found_plainly(found: serde::de::Unexpected) -> String {
    use serde::de::Unexpected as U;
    match found {
        U::Bool(value) => format!("`{value}`"),
        U::Unsigned(value) => format!("{value}"),
        U::Signed(value) => format!("{value}"),
        U::Float(value) => format!("{value}"),
        U::Str(text) => format!("the text \"{}\"", names::shortened(text)),
        U::Unit | U::Option => "`null`".to_owned(),
        U::Seq => "a list".to_owned(),
        U::Map | U::StructVariant | U::NewtypeVariant => "an object".to_owned(),
        other => other.to_string(),
    }
}
