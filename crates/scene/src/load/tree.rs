//! JSON as a tree in which every value knows where it stands in the file.

use std::ops::Range;

use serde_json::Number;

/// A JSON value and its place.
#[derive(Debug)]
pub(crate) struct Node {
    /// Unique within its tree.
    pub(crate) id: u32,
    /// Bytes of the file; for a value of an override, those of the place that it changes.
    pub(crate) span: Range<usize>,
    /// Which override the value comes from, if it does not come from the file.
    pub(crate) from_override: Option<usize>,
    pub(crate) value: Value,
}

#[derive(Debug)]
pub(crate) enum Value {
    Null,
    Bool(bool),
    Number(Number),
    String(String),
    Array(Vec<Node>),
    Object(Vec<Member>),
}

/// One entry of an object.
#[derive(Debug)]
pub(crate) struct Member {
    pub(crate) key: String,
    pub(crate) key_span: Range<usize>,
    pub(crate) value: Node,
}

impl Node {
    /// The entries, if this is an object.
    pub(crate) fn members(&self) -> Option<&[Member]> {
        match &self.value {
            Value::Object(members) => Some(members),
            _ => None,
        }
    }

    /// The entry of this key.
    pub(crate) fn member(&self, key: &str) -> Option<&Member> {
        self.members()?.iter().find(|member| member.key == key)
    }

    /// The value of this key.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.member(key).map(|member| &member.value)
    }

    /// The value of this key, or the object itself where the key is absent: a place to point at.
    pub(crate) fn get_or_self(&self, key: &str) -> &Node {
        self.get(key).unwrap_or(self)
    }

    /// The element of this index, or the value itself.
    pub(crate) fn element_or_self(&self, index: usize) -> &Node {
        match &self.value {
            Value::Array(items) => items.get(index).unwrap_or(self),
            _ => self,
        }
    }

    /// The text, if this is a string.
    pub(crate) fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// The `type` of an object.
    pub(crate) fn type_name(&self) -> Option<&str> {
        self.get("type")?.as_str()
    }

    /// The part of the value that stands for it in a message: of an object its `type`, or its
    /// opening brace; else all of it.
    pub(crate) fn headline(&self) -> Range<usize> {
        match &self.value {
            Value::Object(_) => match self.member("type") {
                Some(member) => member.key_span.start..member.value.span.end,
                None => self.opening(),
            },
            Value::Array(_) => self.opening(),
            _ => self.span.clone(),
        }
    }

    fn opening(&self) -> Range<usize> {
        self.span.start..self.span.end.min(self.span.start + 1)
    }

    /// The same value without places.
    pub(crate) fn to_json(&self) -> serde_json::Value {
        match &self.value {
            Value::Null => serde_json::Value::Null,
            Value::Bool(value) => (*value).into(),
            Value::Number(number) => serde_json::Value::Number(number.clone()),
            Value::String(text) => text.as_str().into(),
            Value::Array(items) => items.iter().map(Self::to_json).collect(),
            Value::Object(members) => {
                members.iter().map(|m| (m.key.clone(), m.value.to_json())).collect()
            }
        }
    }

    /// Visits the value and all that it holds.
    fn visit(&mut self, act: &mut impl FnMut(&mut Self)) {
        act(self);
        match &mut self.value {
            Value::Array(items) => items.iter_mut().for_each(|item| item.visit(act)),
            Value::Object(members) => members.iter_mut().for_each(|m| m.value.visit(act)),
            _ => {}
        }
    }

    /// Gives every value its own id; to be called whenever the tree has changed.
    pub(crate) fn renumber(&mut self) {
        let mut next = 0;
        self.visit(&mut |node| {
            node.id = next;
            next += 1;
        });
    }

    /// The way to the value with this id: its JSON path, and the override it comes from.
    pub(crate) fn locate(&self, id: u32) -> Option<Location> {
        if self.id == id {
            return Some(Location { path: String::new(), from_override: self.from_override });
        }
        // Ids grow along the file, so the value lies in the last child that does not exceed it.
        let (step, child) = match &self.value {
            Value::Array(items) => {
                let index = items.partition_point(|item| item.id <= id).checked_sub(1)?;
                (format!("[{index}]"), &items[index])
            }
            Value::Object(members) => {
                let index = members.partition_point(|m| m.value.id <= id).checked_sub(1)?;
                (path_step(&members[index].key), &members[index].value)
            }
            _ => return None,
        };
        let inner = child.locate(id)?;
        Some(Location {
            path: step + &inner.path,
            from_override: inner.from_override.or(self.from_override),
        })
    }
}

/// Where a value stands.
pub(crate) struct Location {
    /// JSON path below the root: `.sensor.film`.
    pub(crate) path: String,
    pub(crate) from_override: Option<usize>,
}

fn path_step(key: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(plain) {
        format!(".{key}")
    } else {
        format!("[{}]", serde_json::Value::from(key))
    }
}
