//! No input makes the loader panic: it gives a scene, or an error that can be shown.

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use serde_json::{Map, Value, json};
use tpb_scene::load::{Override, SceneError, parse_scene};

use crate::{SHIPPED, parse, shipped_text};

/// What every answer of the loader must fulfil.
fn sound(answer: Result<(), SceneError>) {
    let Err(error) = answer else { return };
    assert!(!error.message().is_empty());
    assert!(!error.to_string().is_empty());
    assert!(error.to_string().len() < 20_000, "the message is as long as the scene");
    if let Some(span) = error.span() {
        assert!(span.start <= span.end && span.end <= error.source_text().len());
        assert!(error.source_text().get(span).is_some(), "the span cuts a character");
        assert!(error.position().is_some());
    }
}

fn load(text: &str) {
    sound(parse(text).map(drop));
}

/// Values that are unlike what a scene holds, or just beyond what it may hold.
fn odd_value() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<f64>().prop_filter("JSON has no others", |v| v.is_finite()).prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        prop::sample::select(vec![
            json!(0),
            json!(-1),
            json!(1e300),
            json!(1e-300),
            json!(-0.0),
            json!(u64::MAX),
            json!([]),
            json!({}),
            json!(""),
            json!([1, 2, 3]),
            json!([0, 0, 0]),
            json!("ref"),
            json!({"type": "ref", "id": "fog"}),
            json!({"type": "ref", "id": "lamp"}),
            json!({"type": "ref"}),
            json!({"type": "null"}),
            json!({"type": "diffuse"}),
            json!({"type": "homogeneous"}),
            json!({"type": "roughplastic"}),
            json!({"type": "area"}),
            json!([{"scale": 1e200}]),
            json!([{"translate": [1e300, 0, 0]}]),
            json!({"type": "obj", "filename": "."}),
            json!({"type": "rgb", "value": [1, 2]}),
            json!({"type": "dielectric", "int_ior": 3}),
        ]),
        "\\PC{0,12}".prop_map(Value::from),
        any_json(),
    ]
}

fn any_json() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i32>().prop_map(Value::from),
        "[a-z_]{0,8}".prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 32, 6, |inner| {
        prop_oneof![
            vec(inner.clone(), 0..6).prop_map(Value::from),
            vec((word(), inner), 0..6)
                .prop_map(|entries| Value::Object(entries.into_iter().collect::<Map<_, _>>())),
        ]
    })
}

/// Words of the vocabulary, so that random objects come close to valid ones.
fn word() -> impl Strategy<Value = String> {
    let known = prop::sample::select(vec![
        "type",
        "id",
        "bsdf",
        "emitter",
        "interior",
        "exterior",
        "to_world",
        "film",
        "phase",
        "g",
        "sigma_t",
        "sigma_s",
        "sigma_a",
        "albedo",
        "value",
        "radius",
        "center",
        "filename",
        "fov",
        "reflectance",
        "background",
        "sensor",
        "integrator",
        "eta",
        "scale",
        "position",
    ]);
    prop_oneof![4 => known.prop_map(str::to_owned), 1 => "\\PC{0,6}"]
}

/// One change at a place that the numbers choose.
#[derive(Clone, Debug)]
enum Mutation {
    Delete,
    Rename(String),
    Replace(Value),
    Insert(String, Value),
    SwapWith(prop::sample::Index),
}

fn mutation() -> impl Strategy<Value = (prop::sample::Index, Mutation)> {
    let kind = prop_oneof![
        Just(Mutation::Delete),
        word().prop_map(Mutation::Rename),
        odd_value().prop_map(Mutation::Replace),
        (word(), odd_value()).prop_map(|(k, v)| Mutation::Insert(k, v)),
        any::<prop::sample::Index>().prop_map(Mutation::SwapWith),
    ];
    (any::<prop::sample::Index>(), kind)
}

/// The JSON pointers of all values below the root.
fn pointers(value: &Value, prefix: &str, found: &mut Vec<String>) {
    let mut visit = |step: String, inner: &Value| {
        let path = format!("{prefix}/{}", step.replace('~', "~0").replace('/', "~1"));
        found.push(path.clone());
        pointers(inner, &path, found);
    };
    match value {
        Value::Array(items) => items.iter().enumerate().for_each(|(i, v)| visit(i.to_string(), v)),
        Value::Object(members) => members.iter().for_each(|(k, v)| visit(k.clone(), v)),
        _ => {}
    }
}

fn mutate(scene: &mut Value, place: prop::sample::Index, mutation: Mutation) {
    let mut places = Vec::new();
    pointers(scene, "", &mut places);
    if places.is_empty() {
        return;
    }
    let pointer = places[place.index(places.len())].clone();
    let (parent, key) = pointer.rsplit_once('/').expect("every pointer has a slash");
    let key = key.replace("~1", "/").replace("~0", "~");
    match mutation {
        Mutation::Delete => take(scene, parent, &key),
        Mutation::Rename(name) => {
            let value = scene.pointer(&pointer).cloned().unwrap_or_default();
            take(scene, parent, &key);
            put(scene, parent, name, value);
        }
        Mutation::Replace(value) => {
            if let Some(target) = scene.pointer_mut(&pointer) {
                *target = value;
            }
        }
        Mutation::Insert(name, value) => put(scene, &pointer, name, value),
        Mutation::SwapWith(other) => {
            let other = scene.pointer(&places[other.index(places.len())]).cloned();
            if let (Some(target), Some(value)) = (scene.pointer_mut(&pointer), other) {
                *target = value;
            }
        }
    }
}

fn take(scene: &mut Value, parent: &str, key: &str) {
    match scene.pointer_mut(parent) {
        Some(Value::Object(members)) => drop(members.remove(key)),
        Some(Value::Array(items)) => drop(key.parse().ok().map(|i: usize| items.remove(i))),
        _ => {}
    }
}

fn put(scene: &mut Value, parent: &str, key: String, value: Value) {
    match scene.pointer_mut(parent) {
        Some(Value::Object(members)) => drop(members.insert(key, value)),
        Some(Value::Array(items)) => items.push(value),
        _ => {}
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2048, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes(bytes in vec(any::<u8>(), 0..200)) {
        load(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_texts(text in "[{}\\[\\]\",:0-9a-z.+\\\\ \n-]{0,120}") {
        load(&text);
    }

    #[test]
    fn random_json(value in any_json(), key in word()) {
        load(&value.to_string());
        load(&json!({"type": "scene", key: value}).to_string());
    }

    #[test]
    fn mutated_scenes(which in 0..SHIPPED.len(), changes in vec(mutation(), 1..4)) {
        let mut scene: Value = serde_json::from_str(&shipped_text(SHIPPED[which])).expect("JSON");
        for (place, change) in changes {
            mutate(&mut scene, place, change);
        }
        load(&format!("{scene:#}"));
        load(&scene.to_string());
    }

    #[test]
    fn damaged_texts(
        which in 0..SHIPPED.len(),
        cut in any::<prop::sample::Index>(),
        length in 0_usize..40,
        plug in "\\PC{0,4}",
    ) {
        let text = shipped_text(SHIPPED[which]);
        let start = cut.index(text.len());
        let end = (start + length).min(text.len());
        load(&text[..start]);
        load(&format!("{}{plug}{}", &text[..start], &text[end..]));
    }

    #[test]
    fn random_overrides(path in "[a-z_.0-9]{0,20}", known in any::<bool>(), value in odd_value()) {
        let path = if known { format!("fog.{path}") } else { path };
        match Override::parse(&format!("{path}={value}")) {
            Ok(change) => {
                let text = shipped_text(SHIPPED[0]);
                sound(parse_scene(&text, "scene.json", Path::new("."), &[change]).map(drop));
            }
            Err(error) => sound(Err(error)),
        }
    }
}

/// Mesh files that are nearly right.
fn mesh_text() -> impl Strategy<Value = (String, Vec<u8>)> {
    let number = prop_oneof![
        8 => (-9..9_i32).prop_map(|n| n.to_string()),
        1 => "[-0-9.e/]{0,6}",
        1 => Just("nan".to_owned()),
        1 => Just("1e308".to_owned()),
    ];
    let line = ("(v|f|vn|#|)", vec(number.clone(), 0..6))
        .prop_map(|(w, n)| format!("{w} {}", n.join(" ")));
    let obj = vec(line, 0..20).prop_map(|lines| ("obj".to_owned(), lines.join("\n").into_bytes()));
    let header = ("(ascii|binary_little_endian|binary_big_endian)", 0..6_u64, 0..4_u64, any::<bool>())
        .prop_map(|(format, vertices, faces, huge)| {
            let faces = if huge { u64::MAX } else { faces };
            format!(
                "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
                 property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
            )
        });
    let body = prop_oneof![
        vec(any::<u8>(), 0..200),
        vec(vec(number, 0..6), 0..12).prop_map(|lines| {
            let lines: Vec<_> = lines.iter().map(|words| words.join(" ")).collect();
            lines.join("\n").into_bytes()
        }),
    ];
    let ply = (header, body, any::<prop::sample::Index>()).prop_map(|(header, body, cut)| {
        let mut bytes = header.into_bytes();
        bytes.extend(body);
        bytes.truncate(cut.index(2 * bytes.len() + 1).max(1));
        ("ply".to_owned(), bytes)
    });
    prop_oneof![obj, ply]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1024, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_meshes((format, bytes) in mesh_text()) {
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(directory.path().join("mesh"), bytes).expect("written");
        let value = format!("{{\"type\": \"{format}\", \"filename\": \"mesh\"}}");
        let text = crate::scene_with("mesh", &value);
        sound(parse_scene(&text, "scene.json", directory.path(), &[]).map(drop));
    }
}

#[test]
fn deep_nesting_does_not_exhaust_the_stack() {
    for (open, close) in [("[", "]"), ("{\"a\":", "}")] {
        let text = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        load(&text);
        load(&open.repeat(100_000));
        let change = Override::parse(&format!("fog={text}")).expect("valid, as a text");
        let scene = shipped_text(SHIPPED[0]);
        sound(parse_scene(&scene, "scene.json", Path::new("."), &[change]).map(drop));
    }
}
