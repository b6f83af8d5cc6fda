//! The wording of errors, as snapshots: one for every kind of bad input.

use std::fmt::Write;

use tpb_scene::load::Override;

use crate::{SHIPPED, cornell_with, error_of, scene_with, shipped_text};

/// A snapshot without the code that made it.
macro_rules! assert_shown {
    ($text:expr) => {
        insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!($text) })
    };
}

/// The Cornell box after a change of its text.
fn cornell(old: &str, new: &str) -> String {
    let text = shipped_text(SHIPPED[0]);
    assert!(text.contains(old), "the scene does not hold {old}");
    text.replacen(old, new, 1)
}

/// All errors of a list of texts under their headings.
fn report<T: AsRef<str>>(cases: &[(&str, T)]) -> String {
    let mut report = String::new();
    for (heading, text) in cases {
        let error = error_of(text.as_ref());
        writeln!(report, "# {heading}\n{error}\n").expect("a text takes everything");
    }
    report
}

#[test]
fn syntax() {
    assert_shown!(report(&[
        ("empty file", String::new()),
        ("truncated file", "{\"type\": \"scene\",\n  \"fog\": {".to_owned()),
        ("missing comma", cornell("\"temporal_bins\": 200,", "\"temporal_bins\": 200")),
        ("trailing comma", "{\"type\": \"scene\",}".to_owned()),
        ("number out of range", cornell("\"sigma_t\": 0.5", "\"sigma_t\": 1e999")),
        ("NaN", cornell("\"sigma_t\": 0.5", "\"sigma_t\": NaN")),
        ("duplicate key", cornell("\"albedo\": 0.8", "\"sigma_t\": 0.8")),
        ("XML", "<scene version=\"3.0.0\"></scene>".to_owned()),
        ("list", "[]".to_owned()),
        ("no type", "{}".to_owned()),
        ("not a scene", "{\"type\": \"sphere\"}".to_owned()),
    ]));
}

#[test]
fn words() {
    assert_shown!(report(&[
        ("misspelt key", cornell("\"phase\"", "\"phse\"")),
        ("misspelt key at the end of a path", cornell("\"bin_width_opl\"", "\"bin_width\"")),
        ("unknown key", cornell("\"albedo\": 0.8,", "\"albedo\": 0.8, \"colour\": 1,")),
        ("parameter of Mitsuba", cornell("\"fov\": 38.0,", "\"fov\": 38.0, \"near_clip\": 1,")),
        ("nested plugin under another key", cornell("\"emitter\": {", "\"my_lamp\": {")),
        ("misspelt type", cornell("\"type\": \"homogeneous\"", "\"type\": \"homogenous\"")),
        ("missing type", cornell("\"type\": \"homogeneous\",", "")),
        ("missing type inside", cornell("{\"type\": \"hg\", \"g\": 0.0}", "{\"g\": 0.0}")),
        ("plugin of Mitsuba", cornell("{\"type\": \"null\"}", "{\"type\": \"roughplastic\"}")),
        ("texture", cornell("\"reflectance\": 0.75", "\"reflectance\": {\"type\": \"d65\"}")),
        ("filter", cornell("{\"type\": \"box\"}", "{\"type\": \"gaussian\"}")),
        ("metal", scene_with("s", "{\"type\": \"conductor\", \"material\": \"Cu\"}")),
        ("default metal", scene_with("s", "{\"type\": \"conductor\"}")),
        ("misplaced film", scene_with("s", "{\"type\": \"hdrfilm\"}")),
        (
            "misplaced emitter",
            cornell("{\"type\": \"area\", \"radiance\": 10.0}", "{\"type\": \"point\"}")
        ),
        (
            "glass that is not known",
            scene_with("s", "{\"type\": \"dielectric\", \"int_ior\": \"watr\"}")
        ),
    ]));
}

#[test]
fn values() {
    assert_shown!(report(&[
        ("text for a number", cornell("\"sigma_t\": 0.5", "\"sigma_t\": \"thick\"")),
        ("null", cornell("\"sigma_t\": 0.5", "\"sigma_t\": null")),
        ("negative coefficient", cornell("\"sigma_t\": 0.5", "\"sigma_t\": -0.5")),
        ("negative channel", cornell("\"sigma_t\": 0.5", "\"sigma_t\": [1, -2, 3]")),
        ("two channels", cornell("\"sigma_t\": 0.5", "\"sigma_t\": [1, 2]")),
        ("albedo above 1", cornell("\"albedo\": 0.8", "\"albedo\": 1.25")),
        ("g of 1", cornell("\"g\": 0.0", "\"g\": 1")),
        (
            "both ways to write a medium",
            cornell("\"albedo\": 0.8", "\"sigma_s\": 0.4, \"sigma_a\": 0.1")
        ),
        ("half of a way", cornell("\"sigma_t\": 0.5,", "\"sigma_s\": 0.5,")),
        ("reflectance above 1", cornell("\"reflectance\": 0.75", "\"reflectance\": 75")),
        ("zero-size film", cornell("\"width\": 64", "\"width\": 0")),
        ("fraction of a pixel", cornell("\"width\": 64", "\"width\": 64.5")),
        ("enormous film", cornell("\"temporal_bins\": 200", "\"temporal_bins\": 4000000000")),
        ("bin width 0", cornell("\"bin_width_opl\": 0.07", "\"bin_width_opl\": 0")),
        ("bins that vanish", cornell("\"start_opl\": 0.0", "\"start_opl\": 1e30")),
        (
            "depths that exclude each other",
            cornell("\"max_depth\": 100", "\"max_depth\": 2, \"min_depth\": 3")
        ),
        ("depth -2", cornell("\"max_depth\": 100", "\"max_depth\": -2")),
        ("zero radius", scene_with("s", "{\"type\": \"sphere\", \"radius\": 0}")),
        ("cylinder without length", scene_with("s", "{\"type\": \"cylinder\", \"p1\": [0, 0, 0]}")),
        ("spot with a wide beam", scene_with("s", "{\"type\": \"spot\", \"beam_width\": 30}")),
        ("mesh that is missing", scene_with("s", "{\"type\": \"ply\", \"filename\": \"cow.ply\"}")),
        (
            "shining null",
            scene_with(
                "s",
                "{\"type\": \"disk\", \"bsdf\": {\"type\": \"null\"}, \"emitter\": {\"type\": \"area\"}}"
            )
        ),
    ]));
}

#[test]
fn transforms() {
    let sphere =
        |steps: &str| scene_with("s", &format!("{{\"type\": \"sphere\", \"to_world\": {steps}}}"));
    assert_shown!(report(&[
        ("not a list", sphere("{\"scale\": 2}")),
        ("two in one step", sphere("[{\"scale\": 2, \"translate\": [0, 0, 1]}]")),
        ("misspelt step", sphere("[{\"lookat\": {}}]")),
        ("two coordinates", sphere("[{\"translate\": [0, 0]}]")),
        ("scale 0", sphere("[{\"scale\": [1, 1, 0]}]")),
        ("no axis", sphere("[{\"rotate\": {\"axis\": [0, 0, 0], \"angle\": 3}}]")),
        (
            "degenerate view",
            sphere(
                "[{\"look_at\": {\"origin\": [0, 0, 0], \"target\": [0, 1, 0], \"up\": [0, 1, 0]}}]"
            )
        ),
        (
            "projective matrix",
            sphere("[{\"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 0]]}]")
        ),
        ("stretched sphere", sphere("[{\"scale\": [1, 2, 1]}]")),
        ("scaled camera", cornell("\"look_at\": {", "\"scale\": 2}, {\"look_at\": {")),
    ]));
}

#[test]
fn references_and_media() {
    assert_shown!(report(&[
        ("missing reference", cornell("\"id\": \"white\"", "\"id\": \"whit\"")),
        ("reference to the wrong kind", cornell("\"id\": \"white\"", "\"id\": \"fog\"")),
        (
            "reference without id",
            cornell("{\"type\": \"ref\", \"id\": \"white\"}", "{\"type\": \"ref\"}")
        ),
        (
            "id in place of a reference",
            cornell("{\"type\": \"ref\", \"id\": \"white\"}", "\"white\"")
        ),
        (
            "circle",
            scene_with(
                "a",
                "{\"type\": \"twosided\", \"bsdf\": {\"type\": \"ref\", \"id\": \"a\"}}"
            )
        ),
        (
            "twosided glass",
            scene_with("a", "{\"type\": \"twosided\", \"bsdf\": {\"type\": \"dielectric\"}}")
        ),
        ("no sensor", "{\"type\": \"scene\"}".to_owned()),
        (
            "two sensors",
            scene_with(
                "eye",
                "{\"type\": \"perspective\", \"fov\": 1, \"film\": {\"type\": \"hdrfilm\"}}"
            )
        ),
        ("no film", cornell("\"film\": {", "\"flm\": {")),
        ("no field of view", cornell("\"fov\": 38.0,", "")),
        (
            "boundaries that contradict each other",
            shipped_text("mirror-caustic").replace(
                "\"exterior\": {\"type\": \"ref\", \"id\": \"fog\"}",
                "\"exterior\": {\"type\": \"homogeneous\"}"
            )
        ),
        (
            "indices that contradict each other",
            shipped_text("mirror-caustic")
                .replace("\"sigma_t\": 0.5,", "\"sigma_t\": 0.5, \"eta\": 1.3,")
        ),
    ]));
}

#[test]
fn overrides() {
    let mut report = String::new();
    for change in ["sensor.film.width", "=3", "a..b=3"] {
        let error = Override::parse(change).expect_err("it is no override");
        writeln!(report, "# {change}\n{error}\n").expect("a text takes everything");
    }
    for change in [
        "sensor.film.widht=128",
        "sensor.film.width=many",
        "senor.film.width=128",
        "floor.to_world.1.scale=3",
        "fog.albedo.max=3",
        "fog.albedo=2",
        "light={\"type\": \"spott\"}",
    ] {
        let Err(error) = cornell_with(&[change]) else { panic!("{change} loads") };
        let shown = error.to_string();
        let name = error.file().to_owned();
        writeln!(report, "# {change}\n{}\n", shown.replace(&name, "scene.json"))
            .expect("a text takes everything");
    }
    assert_shown!(report);
}

#[test]
fn a_scene_on_one_line_is_shown_in_part() {
    let value: serde_json::Value =
        serde_json::from_str(&cornell("\"reflectance\": 0.45", "\"reflectance\": 4.5"))
            .expect("valid JSON");
    assert_shown!(error_of(&value.to_string()));
}
