use std::path::PathBuf;

use serde_json::json;
use tpb_scene::load::{Override, load_scene, parse_scene};

use super::*;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn of_file(path: &Path, changes: &[&str]) -> Outcome<Translation> {
    let changes: Vec<Override> = changes.iter().map(|c| Override::parse(c).unwrap()).collect();
    translate(&load_scene(path, &changes).unwrap(), path.parent().unwrap())
}

fn blocks(changes: &[&str]) -> Outcome<Translation> {
    of_file(&folder("scenes/cornell-blocks.json"), changes)
}

/// A scene with a camera, a lamp, and one more object.
fn with(key: &str, value: &str) -> Outcome<Translation> {
    let text = format!(
        r#"{{"type": "scene",
             "integrator": {{"type": "path", "max_depth": 4}},
             "sensor": {{"type": "perspective", "fov": 40, "film": {{"type": "transient_hdr_film",
               "width": 4, "height": 3, "temporal_bins": 5, "start_opl": 1, "bin_width_opl": 0.5}}}},
             "light": {{"type": "point", "to_world": [{{"translate": [0, 0, 3]}}]}},
             "{key}": {value}}}"#
    );
    translate(&parse_scene(&text, "scene.json", Path::new("/m"), &[]).unwrap(), Path::new("/m"))
}

#[test]
fn cornell_blocks_in_mitsubas_words() {
    insta::assert_json_snapshot!(blocks(&[]).unwrap().dictionary);
}

/// Every scene that ships is translated, or refused with a reason that names what is in the way.
#[test]
fn every_scene_is_translated_or_refused_with_a_reason() {
    let mut found = Vec::new();
    for name in ["scenes", "../scenes"] {
        let files = std::fs::read_dir(folder(name)).unwrap();
        let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        files.sort();
        for path in files {
            let outcome = of_file(&path, &[]).map_or_else(
                |refusal| refusal.to_string(),
                |translation| translation.variant.to_owned(),
            );
            found.push(format!("{name}/{}: {outcome}", path.file_name().unwrap().display()));
        }
    }
    insta::assert_snapshot!(found.join("\n"));
}

#[test]
fn steps_are_composed_and_the_first_acts_first() {
    let translated = with(
        "board",
        r#"{"type": "rectangle", "to_world": [{"scale": 2}, {"translate": [1, 0, -5]}],
            "bsdf": {"type": "diffuse", "reflectance": {"type": "checkerboard",
              "to_uv": [{"scale": 4}]}}}"#,
    );
    let dictionary = translated.unwrap().dictionary;
    let board = &dictionary["board"];
    assert_eq!(
        board["to_world"],
        json!([
            [2.0, 0.0, 0.0, 1.0],
            [0.0, 2.0, 0.0, 0.0],
            [0.0, 0.0, 2.0, -5.0],
            [0.0, 0.0, 0.0, 1.0]
        ])
    );
    assert_eq!(board["bsdf"]["reflectance"]["to_uv"][0], json!([4.0, 0.0, 0.0, 0.0]));
    assert_eq!(dictionary["light"]["position"], json!([0.0, 0.0, 3.0]));
    assert_eq!(dictionary["light"].get("to_world"), None);
    let film = &dictionary["sensor"]["film"];
    assert_eq!(film["start_opl"], json!(1.0 - NEAR_CLIP));
    assert_eq!(dictionary["sensor"]["near_clip"], json!(NEAR_CLIP));
}

/// Mitsuba takes a whole number for neither an index nor a name.
#[test]
fn indices_are_never_whole_numbers() {
    let glass = r#"{"type": "dielectric", "int_ior": "bk7", "ext_ior": 1}"#;
    let glass = with("glass", glass).unwrap().dictionary["glass"].clone();
    assert_eq!(glass["int_ior"], json!("bk7"));
    assert_eq!(glass["ext_ior"].to_string(), "1.0");
}

#[test]
fn coefficients_become_extinction_albedo_and_scale() {
    let fog = |text: &str| with("fog", text).unwrap().dictionary["fog"].clone();
    let grey = fog(r#"{"type": "homogeneous", "sigma_s": 3, "sigma_a": 1, "scale": 2}"#);
    assert_eq!(grey["sigma_t"], json!(1.0));
    assert_eq!(grey["albedo"], json!(0.75));
    assert_eq!(grey["scale"], json!(8.0));
    assert_eq!(grey.get("sigma_s"), None);
    let coloured = fog(r#"{"type": "homogeneous", "sigma_s": [4, 1, 0], "sigma_a": [0, 1, 0]}"#);
    assert_eq!(coloured["sigma_t"], json!({ "type": "rgb", "value": [1.0, 0.5, 0.0] }));
    assert_eq!(coloured["albedo"], json!({ "type": "rgb", "value": [1.0, 0.5, 0.0] }));
    assert_eq!(coloured["scale"], json!(4.0));
    // Mitsuba's defaults.
    let plain = fog(r#"{"type": "homogeneous"}"#);
    assert_eq!((&plain["sigma_t"], &plain["albedo"]), (&json!(1.0), &json!(0.75)));
    assert_eq!(plain["scale"], json!(1.0));
}

#[test]
fn files_are_found_from_anywhere_and_fronts_come_first() {
    let path = folder("../scenes/chapel.json");
    let loaded = load_scene(&path, &[]).unwrap();
    let directory = Path::new("/scenes");
    let translator = Translator { scene: &loaded.scene, directory };
    let mesh = json!({ "type": "ply", "filename": "meshes/a.ply" });
    let translated = translator.plugin(&mesh, "mesh").unwrap();
    assert_eq!(translated["filename"], json!("/scenes/meshes/a.ply"));
    let sides = json!({
        "type": "twosided",
        "back": { "type": "diffuse", "reflectance": 0.1 },
        "bsdf": { "type": "diffuse", "reflectance": [0.2, 0.2, 0.3] },
    });
    let translated = translator.plugin(&sides, "sides").unwrap();
    let keys: Vec<&String> = translated.as_object().unwrap().keys().collect();
    assert_eq!(keys, ["side_1_front", "side_2_back", "type"]);
    let front = &translated["side_1_front"]["reflectance"];
    assert_eq!(*front, json!({ "type": "rgb", "value": [0.2, 0.2, 0.3] }));
}

#[test]
fn what_the_peer_does_not_have_is_refused_by_its_place() {
    for (outcome, path, reason) in [
        (with("beam", r#"{"type": "laser", "radius": 0.1}"#), "$.beam", "extension `laser`"),
        (of_file(&folder("../scenes/chapel.json"), &[]), "$.sun", "arrives everywhere at one time"),
        (with("fog", r#"{"type": "homogeneous", "eta": 1.3}"#), "$.fog.eta", "index 1"),
        (with("background", r#"{"type": "homogeneous"}"#), "$.background", "extension"),
        (blocks(&["integrator.min_depth=2"]), "$.integrator.min_depth", "shorter paths"),
        (blocks(&["sensor.film.temporal_bins=0"]), "$.sensor.film", "without time bins"),
        (
            blocks(&["fog.albedo=[0.8, 0.7, 0.6]"]),
            "$.sensor.film.pixel_format",
            "one channel of a coloured scene",
        ),
    ] {
        let refusal = outcome.unwrap_err();
        assert_eq!(refusal.path, path, "{refusal}");
        assert!(refusal.reason.contains(reason), "{refusal}");
    }
}

/// What the loader takes has a rule, or a refusal by name; nothing is left to chance.
#[test]
fn every_plugin_of_the_vocabulary_is_known() {
    use tpb_scene::description::Kind;
    let by_hand = ["homogeneous", "point", "twosided", "laser", "directional"];
    for kind in
        [Kind::Shape, Kind::Emitter, Kind::ShapeEmitter, Kind::Bsdf, Kind::Medium, Kind::Phase]
    {
        for name in kind.type_names() {
            assert!(by_hand.contains(name) || rules(name).is_some(), "{kind:?} {name}");
        }
    }
}
