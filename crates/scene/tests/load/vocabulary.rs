//! What valid scenes mean.

use std::fs;

use glam::DVec3;
use tpb_optics::{Phase, Rgb};
use tpb_scene::description::{schema, schema_text};
use tpb_scene::load::load_scene;
use tpb_scene::{
    Bsdf, Emitter, EmitterKind, IntegratorSpec, MediumId, MethodName, PixelFormat, Primitive,
    Reflector, Scene, TimeSpec,
};

use crate::{SHIPPED, cornell_with, error_of, parse, scene_with, shipped_path};

pub(crate) fn scene(key: &str, value: &str) -> Scene {
    match parse(&scene_with(key, value)) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    }
}

fn shipped(name: &str) -> Scene {
    match load_scene(&shipped_path(name), &[]) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_shipped_scenes_load_as_they_are() {
    for name in SHIPPED {
        let scene = shipped(name);
        assert_eq!(scene.media.len(), 1, "{name}");
        assert_eq!(scene.media[0].name, "fog");
        assert_eq!(scene.emitters.len(), 1, "{name}");
    }
}

#[test]
fn the_cornell_box_is_what_its_file_says() {
    let scene = shipped("cornell-blocks");
    assert_eq!((scene.film.width, scene.film.height), (64, 64));
    assert_eq!(scene.film.pixel_format, PixelFormat::Luminance);
    let time = TimeSpec { start_opl: 0.0, bin_width_opl: 0.07, bins: 200 };
    assert_eq!(scene.film.time, Some(time));
    let method = Some(MethodName::Path);
    let integrator = IntegratorSpec { method, max_depth: Some(100), min_depth: 1, rr_depth: 8 };
    assert_eq!(scene.integrator, integrator);
    assert_eq!(scene.sensor.position, DVec3::new(0.0, 0.0, 3.9));
    assert!((scene.sensor.forward() + DVec3::Z).length() < 1e-15);

    let fog = scene.media[0].coefficients;
    assert_eq!(fog.sigma_t, Rgb::splat(0.5));
    assert_eq!(fog.sigma_s, Rgb::splat(0.4));
    // Six faces for each of the blocks, and one for each of the others.
    assert_eq!(scene.primitives.len(), 2 * 6 + 7);
    let front = scene.shapes.iter().find(|s| s.name == "front").expect("the front");
    assert_eq!(front.bsdf, Bsdf::Null);
    let boundary = front.boundary.expect("a boundary");
    assert_eq!((boundary.interior, boundary.exterior), (Some(MediumId(0)), None));
    let EmitterKind::Area { radiance, area, .. } = scene.emitters[0].kind else {
        panic!("an area light")
    };
    assert_eq!(radiance, Rgb::splat(10.0));
    assert!((area - 0.16).abs() < 1e-15);
    let Primitive::Planar(lamp) = &scene.primitives[scene.shapes[8].primitives.start as usize]
    else {
        panic!("a rectangle")
    };
    assert!((lamp.normal + DVec3::Y).length() < 1e-15, "the lamp shines down");
}

#[test]
fn the_background_fills_the_infinite_scene() {
    let scene = shipped("infinite-point");
    assert_eq!(scene.background.medium, Some(MediumId(0)));
    assert_eq!(scene.sensor.stated_medium, Some(MediumId(0)));
    assert_eq!(scene.sensor.region.medium, Some(MediumId(0)));
}

#[test]
fn defaults_are_mitsubas() {
    let scene = scene("s", r#"{"type": "sphere"}"#);
    assert_eq!(scene.integrator, IntegratorSpec::default());
    assert_eq!(scene.film.pixel_format, PixelFormat::Rgb);
    assert_eq!(scene.film.time, None);
    let front = Reflector::Diffuse(Rgb::splat(0.5));
    assert_eq!(scene.shapes[0].bsdf, Bsdf::Opaque { front, back: Reflector::Black });
    let glass = self::scene("s", r#"{"type": "sphere", "bsdf": {"type": "dielectric"}}"#);
    let Bsdf::Dielectric(glass) = glass.shapes[0].bsdf else { panic!("a dielectric") };
    assert_eq!((glass.interior_eta, glass.exterior_eta), (1.5046, 1.000_277));
    let film = r#"{"type": "perspective", "fov": 40, "film": {"type": "transient_hdr_film"}}"#;
    let text = format!(r#"{{"type": "scene", "camera": {film}}}"#);
    let Ok(loaded) = parse(&text) else { panic!("it loads") };
    assert_eq!((loaded.scene.film.width, loaded.scene.film.height), (768, 576));
    assert_eq!(loaded.scene.film.time, None);
}

#[test]
fn media_have_two_ways_to_be_written() {
    let medium = |text: &str| {
        let value =
            format!(r#"{{"type": "sphere", "bsdf": {{"type": "null"}}, "interior": {text}}}"#);
        scene("s", &value).media.remove(0)
    };
    let ours = medium(
        r#"{"type": "homogeneous", "sigma_s": {"type": "rgb", "value": [1, 2, 3]}, "sigma_a": 1,
            "scale": 2, "eta": 1.3, "phase": {"type": "hg", "g": -0.5}}"#,
    );
    assert_eq!(ours.coefficients.sigma_s, tpb_optics::Spectrum([2.0, 4.0, 6.0]));
    assert_eq!(ours.coefficients.sigma_t, tpb_optics::Spectrum([4.0, 6.0, 8.0]));
    assert_eq!((ours.phase, ours.eta), (Phase::with_mean_cosine(-0.5), Some(1.3)));
    assert_eq!(ours.name, "s.interior");
    let mitsubas = medium(r#"{"type": "homogeneous"}"#);
    assert_eq!(mitsubas.coefficients.sigma_s, Rgb::splat(0.75));
    assert_eq!(mitsubas.coefficients.sigma_t, Rgb::splat(1.0));
    assert_eq!((mitsubas.phase, mitsubas.eta), (Phase::Isotropic, None));
}

#[test]
fn references_may_come_first_and_share_a_medium() {
    let text = r#"{
      "type": "scene",
      "a": {"type": "sphere", "bsdf": {"type": "ref", "id": "both"}, "center": [3, 0, 0]},
      "b": {"type": "sphere", "bsdf": {"type": "null"}, "interior": {"type": "ref", "id": "fog"}},
      "c": {"type": "sphere", "bsdf": {"type": "null"}, "center": [-3, 0, 0],
            "interior": {"type": "ref", "id": "fog"}},
      "both": {"type": "twosided", "bsdf": {"type": "ref", "id": "grey"},
               "back": {"type": "conductor", "material": "none"}},
      "grey": {"type": "diffuse", "reflectance": 0.25},
      "fog": {"type": "homogeneous", "phase": {"type": "ref", "id": "ahead"}},
      "unused": {"type": "homogeneous"},
      "ahead": {"type": "hg", "g": 0.5},
      "sensor": {"type": "perspective", "fov": 40, "film": {"type": "hdrfilm"},
                 "to_world": [{"translate": [0, 0, 9]}]}
    }"#;
    let scene = match parse(text) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    };
    assert_eq!(scene.media.len(), 1);
    assert_eq!(scene.media[0].phase, Phase::with_mean_cosine(0.5));
    assert_eq!(scene.shapes[1].boundary, scene.shapes[2].boundary);
    let front = Reflector::Diffuse(Rgb::splat(0.25));
    let back = Reflector::Mirror(Rgb::ONE);
    assert_eq!(scene.shapes[0].bsdf, Bsdf::Opaque { front, back });
}

#[test]
fn normals_point_outwards_and_can_be_flipped_even_through_a_mirror() {
    for steps in ["[]", r#"[{"scale": [-1, 2, 3]}, {"rotate": {"axis": [1, 2, 3], "angle": 50}}]"#]
    {
        for flip in [false, true] {
            let value =
                format!(r#"{{"type": "cube", "to_world": {steps}, "flip_normals": {flip}}}"#);
            let scene = scene("s", &value);
            assert_eq!(scene.primitives.len(), 6);
            for primitive in &scene.primitives {
                let point = primitive.sample(0.5, 0.5);
                assert_eq!(point.normal.dot(point.position) < 0.0, flip);
            }
        }
    }
}

#[test]
fn lamps_are_placed_by_their_transforms() {
    let look = r#"[{"look_at": {"origin": [0, 2, 0], "target": [0, 0, 0], "up": [0, 0, 1]}}]"#;
    let scene =
        scene("s", &format!(r#"{{"type": "spot", "to_world": {look}, "intensity": [1, 2, 3]}}"#));
    let EmitterKind::Spot { position, axis, intensity, cos_cutoff, cos_beam } =
        scene.emitters[1].kind
    else {
        panic!("a spot")
    };
    assert_eq!(position, DVec3::new(0.0, 2.0, 0.0));
    assert!((axis + DVec3::Y).length() < 1e-15);
    assert_eq!(intensity, tpb_optics::Spectrum([1.0, 2.0, 3.0]));
    assert_eq!(cos_cutoff, 20.0_f64.to_radians().cos());
    assert_eq!(cos_beam, 15.0_f64.to_radians().cos());
    let sun = r#"{"type": "directional", "direction": [0, -2, 0], "irradiance": 3}"#;
    let Ok(loaded) = cornell_with(&[&format!("sun={sun}")]) else { panic!("it loads") };
    let EmitterKind::Directional { axis, irradiance, position, radius } =
        loaded.scene.emitters[0].kind
    else {
        panic!("parallel light")
    };
    let bounds = loaded.scene.bounds();
    assert_eq!((axis, irradiance), (-DVec3::Y, Rgb::splat(3.0)));
    assert!((radius / bounds.radius() - 1.001).abs() < 1e-12);
    assert!((position - bounds.centre() - radius * DVec3::Y).length() < 1e-12);
    let nothing = error_of(&scene_with("sun", sun)).to_string();
    assert!(nothing.contains("covers the shapes of the scene"), "{nothing}");
    let laser = self::scene("s", r#"{"type": "laser", "radius": 0.01, "power": 3}"#);
    let EmitterKind::Laser { axis, radius, power, .. } = laser.emitters[1].kind else {
        panic!("a laser")
    };
    assert_eq!((axis, radius, power), (DVec3::Z, 0.01, Rgb::splat(3.0)));
}

/// Regression: a laser whose light met a wall first stood in a vacuum of its own, amid the fog.
#[test]
fn a_laser_that_faces_a_wall_stands_in_the_fog_around_it() {
    for angle in [0, 90] {
        let beam = format!(
            r#"beam={{"type": "laser", "radius": 0.01,
                "to_world": [{{"rotate": {{"axis": [0, 1, 0], "angle": {angle}}}}}]}}"#
        );
        let Ok(loaded) = cornell_with(&[&beam]) else { panic!("it loads") };
        let laser = |e: &&Emitter| matches!(e.kind, EmitterKind::Laser { .. });
        let beam = loaded.scene.emitters.iter().find(laser).expect("the laser");
        assert!(beam.region.medium.is_some(), "turned by {angle} degrees");
    }
}

#[test]
fn overrides_change_what_is_loaded_and_what_is_reported() {
    let Ok(loaded) = cornell_with(&[
        "sensor.film.width=128",
        "fog.phase.g=0.5",
        "floor.to_world.0.matrix.1.3=-2",
    ]) else {
        panic!("it loads")
    };
    assert_eq!(loaded.scene.film.width, 128);
    assert_eq!(loaded.canonical["sensor"]["film"]["width"], 128);
    assert_eq!(loaded.scene.media[0].phase, Phase::with_mean_cosine(0.5));
    assert_eq!(loaded.canonical["floor"]["to_world"][0]["matrix"][1][3], -2);
    let Ok(loaded) = cornell_with(&[r#"integrator={"type": "photon_beams", "max_depth": -1}"#])
    else {
        panic!("it loads")
    };
    assert_eq!(loaded.scene.integrator.method, Some(MethodName::Beams));
    assert_eq!(loaded.scene.integrator.max_depth, None);
    for name in ["ptracer", "transient_ptracer"] {
        let Ok(loaded) = cornell_with(&[&format!(r#"integrator={{"type": "{name}"}}"#)]) else {
            panic!("it loads")
        };
        assert_eq!(loaded.scene.integrator.method, Some(MethodName::Light));
    }
}

#[test]
fn the_committed_schema_is_fresh() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scene.schema.json");
    let committed = fs::read_to_string(path).unwrap_or_default();
    assert!(committed == schema_text(), "run `cargo xtask schema --write` and commit the file");
}

/// A validator for the part of JSON schema that the generated file uses.
fn conforms(
    schema: &serde_json::Value,
    value: &serde_json::Value,
    root: &serde_json::Value,
) -> bool {
    let Some(rules) = schema.as_object() else { return schema.as_bool().unwrap_or(false) };
    rules.iter().all(|(rule, with)| match rule.as_str() {
        "$ref" => {
            let pointer =
                with.as_str().and_then(|s| s.strip_prefix('#')).expect("a local reference");
            conforms(root.pointer(pointer).expect("it is defined"), value, root)
        }
        "anyOf" => with.as_array().expect("a list").iter().any(|s| conforms(s, value, root)),
        "oneOf" => {
            let fits = |s: &&serde_json::Value| conforms(s, value, root);
            with.as_array().expect("a list").iter().filter(fits).count() == 1
        }
        "const" => with == value,
        "enum" => with.as_array().expect("a list").contains(value),
        "type" => match with.as_str().expect("one type") {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "integer" => value.is_u64() || value.is_i64(),
            "number" => value.is_number(),
            other => panic!("type {other}"),
        },
        "properties" => {
            with.as_object().expect("an object").iter().all(|(key, schema)| {
                value.get(key).is_none_or(|value| conforms(schema, value, root))
            })
        }
        "additionalProperties" => value.as_object().is_none_or(|object| {
            let known = rules.get("properties").and_then(|p| p.as_object());
            let unknown = |key: &String| known.is_none_or(|known| !known.contains_key(key));
            object.iter().filter(|(k, _)| unknown(k)).all(|(_, v)| conforms(with, v, root))
        }),
        "required" => with
            .as_array()
            .expect("a list")
            .iter()
            .all(|key| value.get(key.as_str().expect("a key")).is_some()),
        "items" => {
            value.as_array().is_none_or(|items| items.iter().all(|i| conforms(with, i, root)))
        }
        "minItems" => value.as_array().is_none_or(|v| v.len() as u64 >= with.as_u64().expect("n")),
        "maxItems" => value.as_array().is_none_or(|v| v.len() as u64 <= with.as_u64().expect("n")),
        "minProperties" => value.as_object().is_none_or(|v| !v.is_empty()),
        "maxProperties" => value.as_object().is_none_or(|v| v.len() <= 1),
        "minimum" => value.as_f64().is_none_or(|v| v >= with.as_f64().expect("a number")),
        "maximum" => value.as_f64().is_none_or(|v| v <= with.as_f64().expect("a number")),
        "exclusiveMinimum" => value.as_f64().is_none_or(|v| v > with.as_f64().expect("a number")),
        "exclusiveMaximum" => value.as_f64().is_none_or(|v| v < with.as_f64().expect("a number")),
        "$schema" | "title" | "description" | "default" | "format" | "$defs" => true,
        other => panic!("this test does not know the rule {other}"),
    })
}

#[test]
fn the_shipped_scenes_conform_to_the_schema_and_broken_ones_do_not() {
    let schema = schema();
    for name in SHIPPED {
        let text = fs::read_to_string(shipped_path(name)).expect("it is there");
        let value: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
        assert!(conforms(&schema, &value, &schema), "{name}");
        let mut broken = value.clone();
        broken["sensor"]["film"]["widht"] = 3.into();
        assert!(!conforms(&schema, &broken, &schema), "{name}");
        let mut broken = value;
        broken["fog"]["albedo"] = 1.5.into();
        assert!(!conforms(&schema, &broken, &schema), "{name}");
    }
}

#[test]
fn a_file_that_is_missing_or_no_text_is_an_error() {
    let directory = tempfile::tempdir().expect("a directory");
    let missing = directory.path().join("missing.json");
    let Err(error) = load_scene(&missing, &[]) else { panic!("there is no file") };
    assert!(error.to_string().contains("missing.json"), "{error}");
    assert!(load_scene(directory.path(), &[]).is_err());
    let bytes = directory.path().join("bytes.json");
    fs::write(&bytes, [b'{', 0xff]).expect("written");
    let Err(error) = load_scene(&bytes, &[]) else { panic!("this is no text") };
    assert!(error.message().contains("not UTF-8"), "{error}");
    assert!(!error_of("").to_string().is_empty());
}

#[test]
fn an_emitter_may_state_its_medium() {
    let scene = scene(
        "wet",
        r#"{"type": "point", "position": [0, 9, 0],
            "medium": {"type": "homogeneous", "sigma_t": 2.0, "eta": 1.3}}"#,
    );
    let region = scene.emitters.iter().find(|e| e.name == "wet").expect("it is there").region;
    let sigma_t = scene.medium(region.medium.expect("a medium")).coefficients.sigma_t;
    assert_eq!((sigma_t, region.eta), (Rgb::splat(2.0), 1.3));
}

/// Regression: the image was infinite, and came out as whatever was drawn.
#[test]
fn the_camera_may_stand_at_a_lamp_in_vacuum_but_not_in_fog() {
    let lamp = r#"{"type": "point", "position": [0, 0, 0]}"#;
    assert_eq!(scene("bulb", lamp).emitters.len(), 2);
    let fog = lamp.replace('}', r#", "medium": {"type": "homogeneous"}}"#);
    let message = error_of(&scene_with("bulb", &fog)).to_string();
    assert!(message.contains("emitter 'bulb'") && message.contains("move one"), "{message}");
}
