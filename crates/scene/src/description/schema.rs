//! The JSON schema of a scene file, made from the structs of the vocabulary.
//!
//! The committed `scene.schema.json` is [`schema_text`]; a test compares them, and
//! `cargo xtask schema --write` makes the file anew. The schema says what one value may be; what
//! needs several values at once (references, sigma_t against sigma_s, media on the two sides of
//! a boundary) only the loader knows.

use schemars::generate::SchemaSettings;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::{Bsdf, Emitter, Integrator, Kind, Medium, Phase, Sensor, Shape};

/// The JSON schema (draft 2020-12) of scene files.
pub fn schema() -> Value {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    let mut objects = Kind::TOP_LEVEL.map(|kind| subschema(kind, &mut generator).to_value());
    for object in &mut objects {
        tidy(object);
    }
    let background = generator.subschema_for::<Medium>().to_value();
    let mut definitions = Value::Object(generator.take_definitions(true));
    tidy(&mut definitions);
    json_schema!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Transient scene",
        "description": "A dictionary in Mitsuba 3's vocabulary: arbitrary ids lead to objects \
            whose `type` says what they are. Lengths are in metres, time is optical path length \
            in metres, angles are in degrees.",
        "type": "object",
        "properties": {
            "type": { "const": "scene" },
            "background": {
                "description": "The medium outside of all media that shapes bound (extension).",
                "anyOf": [background],
            },
        },
        "required": ["type"],
        "additionalProperties": { "anyOf": objects },
        "$defs": definitions,
    })
    .to_value()
}

/// The schema as the text of its file.
pub fn schema_text() -> String {
    format!("{:#}\n", schema())
}

fn subschema(kind: Kind, generator: &mut SchemaGenerator) -> Schema {
    match kind {
        Kind::Integrator => generator.subschema_for::<Integrator>(),
        Kind::Sensor => generator.subschema_for::<Sensor>(),
        Kind::Shape => generator.subschema_for::<Shape>(),
        Kind::Emitter => generator.subschema_for::<Emitter>(),
        Kind::Bsdf => generator.subschema_for::<Bsdf>(),
        Kind::Medium => generator.subschema_for::<Medium>(),
        Kind::Phase => generator.subschema_for::<Phase>(),
        // Never at the top level; each is reached through the plugin that holds it.
        Kind::Film | Kind::Rfilter | Kind::ShapeEmitter => false.into(),
    }
}

/// An optional value may be left out, but not be `null`: schemars writes both, we say one. And
/// doc comments become plain text.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(object) => {
            object.values_mut().for_each(tidy);
            remove_null_type(object);
            if let Some(Value::String(text)) = object.get_mut("description") {
                *text = text.replace("\n\n", "\r").replace('\n', " ").replace('\r', "\n\n");
                *text = text.replace("\\[", "[").replace("\\]", "]");
            }
        }
        _ => {}
    }
}

fn remove_null_type(object: &mut Map<String, Value>) {
    if object.get("default") == Some(&Value::Null) {
        object.remove("default");
    }
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            object.insert("type".into(), only);
        }
    }
    if let Some(Value::Array(choices)) = object.get_mut("anyOf") {
        choices.retain(|choice| *choice != json!({ "type": "null" }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plugins_are_closed_objects_with_a_constant_type_and_nothing_may_be_null() {
        let schema = schema();
        let sphere = schema["$defs"]["Shape"]["oneOf"]
            .as_array()
            .and_then(|all| all.iter().find(|s| s["properties"]["type"]["const"] == "sphere"))
            .expect("the sphere is one of the shapes");
        assert_eq!(sphere["additionalProperties"], false);
        assert_eq!(sphere["properties"]["radius"]["exclusiveMinimum"], 0);
        assert!(!schema.to_string().contains("\"null\"]"));
    }
}
