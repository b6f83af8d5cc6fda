//! `--set a.b.c=VALUE`: changes to the tree before anything else reads it.

use std::ops::Range;

use serde_json::Value as Json;

use super::error::SceneError;
use super::names;
use super::source::Source;
use super::tree::{Member, Node, Value};
use super::trouble::{Outcome, Trouble};

/// One change of a scene: a path and the value to put there.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    text: String,
    path: Vec<String>,
    value: Json,
}

impl Override {
    /// Reads `a.b.c=VALUE`. The value is JSON, or else a text; a step of the path is a key, or
    /// the index of an element of a list.
    pub fn parse(text: &str) -> Result<Self, SceneError> {
        let error = |message: &str| {
            let source = Source::new("--set", text.to_owned());
            SceneError::new(source, None, Trouble::new(message).at_bytes(0..text.len()))
                .with_hint("for example `--set sensor.film.width=128`")
        };
        let Some((path, value)) = text.split_once('=') else {
            return Err(error("expected a path and a value with `=` between them"));
        };
        let path: Vec<_> = path.trim().split('.').map(str::to_owned).collect();
        if path.iter().any(String::is_empty) {
            return Err(error("the path has an empty step"));
        }
        let value = match serde_json::from_str(value) {
            Ok(value) => value,
            // Its errors have no kind to ask for.
            Err(e) if e.to_string().starts_with("number out of range") => {
                return Err(error("a number is out of range; the largest is 1.8e308"));
            }
            Err(_) => Json::from(value),
        };
        Ok(Self { text: text.to_owned(), path, value })
    }

    /// The text that it was read from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Puts the value into the tree; `index` is remembered as its origin.
    pub(crate) fn apply(&self, root: &mut Node, index: usize) -> Outcome<()> {
        let Some((last, way)) = self.path.split_last() else {
            return Ok(());
        };
        let mut node = root;
        for step in way {
            node = existing(node, step)?;
        }
        let span = node.headline();
        match &mut node.value {
            Value::Object(members) if members.iter().all(|m| m.key != *last) => {
                let value = planted(&self.value, span.clone(), index);
                members.push(Member { key: last.clone(), key_span: span, value });
            }
            _ => {
                let place = existing(node, last)?;
                *place = planted(&self.value, place.span.clone(), index);
            }
        }
        Ok(())
    }
}

/// The value that a step leads to.
fn existing<'a>(node: &'a mut Node, step: &str) -> Outcome<&'a mut Node> {
    let absent = no_such_step(node, step);
    let found = match &mut node.value {
        Value::Object(members) => members.iter_mut().find(|m| m.key == step).map(|m| &mut m.value),
        Value::Array(items) => step.parse().ok().and_then(|index: usize| items.get_mut(index)),
        _ => None,
    };
    found.ok_or(absent)
}

fn no_such_step(node: &Node, step: &str) -> Trouble {
    let step = names::shortened(step);
    match &node.value {
        Value::Object(members) => Trouble::new(format!("there is no `{step}` here to set"))
            .maybe_hint(names::did_you_mean(&step, members.iter().map(|m| m.key.as_str())))
            .hint("only the last step of a path may be new; set the whole object instead"),
        Value::Array(items) => Trouble::new(format!("there is no element `{step}` here to set"))
            .hint(format!("the list has length {}, and its elements count from 0", items.len())),
        _ => Trouble::new(format!("`{step}` cannot be set inside a value that is no object")),
    }
    .at(node)
}

/// The value as a part of the tree, in the place of what it changes.
fn planted(json: &Json, span: Range<usize>, index: usize) -> Node {
    let value = match json {
        Json::Null => Value::Null,
        Json::Bool(value) => Value::Bool(*value),
        Json::Number(number) => Value::Number(number.clone()),
        Json::String(text) => Value::String(text.clone()),
        Json::Array(items) => {
            Value::Array(items.iter().map(|item| planted(item, span.clone(), index)).collect())
        }
        Json::Object(entries) => {
            let member = |(key, value): (&String, &Json)| Member {
                key: key.clone(),
                key_span: span.clone(),
                value: planted(value, span.clone(), index),
            };
            Value::Object(entries.iter().map(member).collect())
        }
    };
    Node { id: 0, span, from_override: Some(index), value }
}
