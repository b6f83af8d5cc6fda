//! What valid materials, textures and meshes mean.

use std::fs;

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_optics::microfacet::Metal;
use tpb_scene::load::{Override, load_scene};
use tpb_scene::{Bsdf, IntegratorSpec, Primitive, Reflector};

use crate::vocabulary::scene;
use crate::{error_of, scene_with};

#[test]
fn rough_surfaces_are_what_their_words_say() {
    let bsdf = |text: &str| {
        let value = format!(r#"{{"type": "sphere", "bsdf": {text}}}"#);
        scene("s", &value).shapes[0].bsdf
    };
    let metal = bsdf(
        r#"{"type": "roughconductor", "distribution": "ggx", "alpha_u": 0.3, "alpha_v": 0.3,
            "eta": [0.2, 0.9, 1.1], "k": 3, "specular_reflectance": 0.5}"#,
    );
    let Bsdf::Opaque { front: Reflector::Rough(metal), back: Reflector::Black } = metal else {
        panic!("a rough metal")
    };
    assert_eq!((metal.surface.ggx.alpha(), metal.reflectance), (0.3, Rgb::splat(0.5)));
    let Metal::Index { eta, k } = metal.surface.metal else { panic!("an index") };
    assert_eq!((eta, k), (tpb_optics::Spectrum([0.2, 0.9, 1.1]), Rgb::splat(3.0)));
    let perfect = r#"{"type": "roughconductor", "distribution": "ggx", "material": "none"}"#;
    let Bsdf::Opaque { front: Reflector::Rough(metal), .. } = bsdf(perfect) else {
        panic!("a rough metal")
    };
    assert_eq!((metal.surface.ggx.alpha(), metal.surface.metal), (0.1, Metal::Perfect));
    let both = format!(r#"{{"type": "twosided", "bsdf": {perfect}}}"#);
    let Bsdf::Opaque { back: Reflector::Rough(_), .. } = bsdf(&both) else { panic!("both sides") };
    let glass = bsdf(
        r#"{"type": "roughdielectric", "distribution": "ggx", "alpha": 0.2, "int_ior": 1.5,
            "ext_ior": "water"}"#,
    );
    let Bsdf::RoughDielectric(glass, ggx) = glass else { panic!("rough glass") };
    assert_eq!((glass.interior_eta, glass.exterior_eta, ggx.alpha()), (1.5, 1.333, 0.2));
    for (text, part) in [
        (r#""roughconductor", "material": "none""#, "`distribution` is missing"),
        (r#""roughconductor", "distribution": "beckmann""#, "`beckmann` is not supported"),
        (r#""roughconductor", "distribution": "ggx""#, "what is this metal made of?"),
        (r#""roughconductor", "distribution": "ggx", "eta": 1"#, "what is this metal made of?"),
        (r#""roughdielectric", "distribution": "ggx", "alpha": 0"#, "a roughness from 1e-4 to 1"),
        (
            r#""roughdielectric", "distribution": "ggx", "alpha_u": 0.1, "alpha_v": 0.2"#,
            "`alpha_u` and `alpha_v` differ",
        ),
        (r#""roughdielectric", "distribution": "ggx", "alpha_u": 0.1"#, "the roughness is"),
        (
            r#""roughdielectric", "distribution": "ggx", "int_ior": 1.5, "ext_ior": 1.5"#,
            "two refractive indices that differ",
        ),
        (r#""conductor", "material": "none", "alpha": 0.1"#, "have a roughness"),
    ] {
        let error = error_of(&scene_with("s", &format!(r#"{{"type": {text}}}"#))).to_string();
        assert!(error.contains(part), "{text}: {error}");
    }
}

/// Mitsuba's texture coordinates, at points of moved shapes.
#[test]
fn textures_lie_on_shapes_as_mitsubas_do() {
    let uv = |shape: &str, point: [f64; 3]| {
        let value = format!(
            r#"{{{shape}, "bsdf": {{"type": "diffuse", "reflectance": {{"type": "checkerboard"}}}},
                "to_world": [{{"scale": 2}}, {{"rotate": {{"axis": [0, 0, 1], "angle": 90}}}},
                             {{"translate": [5, 0, 0]}}]}}"#
        );
        let scene = scene("s", &value);
        let [x, y, z] = point;
        let world = DVec3::new(5.0 - 2.0 * y, 2.0 * x, 2.0 * z);
        let found = scene.textures[0].coordinates.uv(&scene.primitives[0], world);
        [found.x, found.y]
    };
    let turn = |x: f64, y: f64| (y.atan2(x) / std::f64::consts::TAU).rem_euclid(1.0);
    let polar = 0.5_f64.acos() / std::f64::consts::PI;
    let side = 0.75_f64.sqrt();
    for (shape, point, expected) in [
        (r#""type": "rectangle""#, [0.5, -0.5, 0.0], [0.75, 0.25]),
        (r#""type": "disk""#, [0.0, -0.5, 0.0], [0.5, 0.75]),
        (r#""type": "sphere""#, [side, 0.0, 0.5], [0.0, polar]),
        (r#""type": "sphere", "center": [0, 1, 0], "radius": 2"#, [0.0, -1.0, 0.0], [0.75, 0.5]),
        (
            r#""type": "cylinder", "p1": [0, 0, 2], "radius": 0.5"#,
            [0.3, 0.4, 0.5],
            [turn(0.3, 0.4), 0.25],
        ),
        (r#""type": "cube""#, [0.2, -1.0, 0.6], [0.8, 0.6]),
        (r#""type": "cube""#, [0.2, 1.0, 0.6], [0.4, 0.2]),
        (r#""type": "cube""#, [1.0, 0.2, 0.6], [0.6, 0.2]),
        (r#""type": "cube""#, [-1.0, 0.2, 0.6], [0.6, 0.8]),
        (r#""type": "cube""#, [0.2, 0.4, 1.0], [0.7, 0.6]),
        (r#""type": "cube""#, [0.2, 0.4, -1.0], [0.3, 0.6]),
    ] {
        let found = uv(shape, point);
        let near = (0..2).all(|i| (found[i] - expected[i]).abs() < 1e-12);
        assert!(near, "{shape} {point:?}: {found:?}, not {expected:?}");
    }
}

#[test]
fn a_checkerboard_has_its_colours_and_its_scale() {
    let scene = scene(
        "s",
        r#"{"type": "rectangle", "to_world": [{"translate": [0, 0, 7]}],
            "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse",
            "reflectance": {"type": "checkerboard", "color1": [0.1, 0.5, 0.9],
                            "to_uv": [{"scale": [3, 2, 1]}]}}}}"#,
    );
    let [texture] = &scene.textures[..] else { panic!("both sides share one") };
    let at = |u: f64, v: f64| {
        let position = DVec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 7.0);
        texture.at(&scene.primitives[0], position)
    };
    assert_eq!(at(0.1, 0.1), Rgb::splat(0.4));
    assert_eq!(at(0.2, 0.1), tpb_optics::Spectrum([0.1, 0.5, 0.9]));
    assert_eq!(at(0.2, 0.3), Rgb::splat(0.4));
    assert_eq!(texture.most(), tpb_optics::Spectrum([0.4, 0.5, 0.9]));
    let plan = tpb_scene::Plan::new(&scene, &IntegratorSpec::default());
    assert_eq!(plan.transport, tpb_scene::Transport::Rgb);
    for (texture, part) in [
        (r#"{"type": "checkerboard", "colour": 1}"#, "colour"),
        (r#"{"type": "checkerboard", "color0": 2}"#, "a number from 0 to 1"),
        (r#"{"type": "bitmap"}"#, "`filename` is missing"),
        (r#"{"type": "bitmap", "filename": "a.png"}"#, "images are looked for"),
        (r#"{"type": "wood"}"#, "`wood` is not"),
        (r#"{"type": "rgb", "value": 0.5, "to_uv": []}"#, "to_uv"),
        (r#"{"type": "rgb"}"#, "value"),
    ] {
        let value = format!(r#"{{"type": "diffuse", "reflectance": {texture}}}"#);
        let error = error_of(&scene_with("s", &value)).to_string();
        assert!(error.contains(part), "{texture}: {error}");
    }
}

#[test]
fn meshes_are_smooth_and_textured_as_their_files_say() {
    let directory = tempfile::tempdir().expect("a directory");
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0.6 0 0.8\nvt 0 0.25\nvt 1 0.25\nvt 0 1\n";
    fs::write(directory.path().join("a.obj"), format!("{mesh}f 1/1/1 2/2/1 3/3/1\n")).expect("ok");
    fs::write(directory.path().join("b.obj"), format!("{mesh}f 1 2 3\n")).expect("ok");
    let path = directory.path().join("scene.json");
    let value = r#"{"type": "obj", "filename": "a.obj", "to_world": [{"translate": [0, 0, 7]}],
        "bsdf": {"type": "diffuse", "reflectance": {"type": "checkerboard"}}}"#;
    fs::write(&path, scene_with("mesh", value)).expect("written");
    let load = |change: &str| load_scene(&path, &[Override::parse(change).expect("valid")]);
    let Ok(loaded) = load("mesh.flip_normals=false") else { panic!("it loads") };
    let Primitive::Planar(triangle) = &loaded.scene.primitives[0] else { panic!("a triangle") };
    let middle = DVec3::new(0.25, 0.5, 7.0);
    let uv = triangle.vertex_uv(middle).expect("it has some");
    // v is counted from the other end: 0.75, 0.75, 0.
    assert!((uv - glam::DVec2::new(0.25, 0.375)).length() < 1e-12, "{uv}");
    let normal = loaded.scene.primitives[0].shading_normal(middle).expect("it is smooth");
    assert!((normal - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-12);
    let Ok(flat) = load("mesh.face_normals=true") else { panic!("it loads") };
    assert!(flat.scene.primitives[0].shading_normal(middle).is_none());
    let Ok(flipped) = load("mesh.flip_normals=true") else { panic!("it loads") };
    let primitive = &flipped.scene.primitives[0];
    let normal = primitive.shading_normal(middle).expect("it is smooth");
    assert!(primitive.normal(middle).z < 0.0 && (normal.z + 0.8).abs() < 1e-12);
    let Err(error) = load("mesh.filename=b.obj") else { panic!("it has no coordinates") };
    assert!(error.to_string().contains("no texture coordinates"), "{error}");
}

#[test]
fn meshes_stand_beside_the_scene_and_a_broken_one_names_its_face() {
    let directory = tempfile::tempdir().expect("a directory");
    let mesh = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    fs::write(directory.path().join("good.obj"), mesh).expect("written");
    fs::write(directory.path().join("bad.obj"), mesh.replace("3 4", "3 9")).expect("written");
    let path = directory.path().join("scene.json");
    let value = r#"{"type": "obj", "filename": "good.obj", "to_world": [{"scale": 2}, {"translate": [0, 0, 7]}]}"#;
    fs::write(&path, scene_with("mesh", value)).expect("written");
    match load_scene(&path, &[]) {
        Ok(loaded) => {
            assert_eq!(loaded.scene.primitives.len(), 2);
            assert!((loaded.scene.primitives[0].area() - 2.0).abs() < 1e-15);
        }
        Err(error) => panic!("{error}"),
    }
    let change = Override::parse("mesh.filename=bad.obj").expect("valid");
    let Err(error) = load_scene(&path, &[change]) else { panic!("the mesh is broken") };
    assert!(error.message().contains("face 1 (line 5): there is no vertex 8"), "{error}");
    assert!(error.note().is_some_and(|note| note.contains("mesh.filename=bad.obj")));
}
