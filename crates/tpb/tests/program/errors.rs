//! Bad input: exit code 2, a message that helps, never a panic.

use std::fs;

use crate::{FEW, assert_done, assert_refused, render, scene, tpb};

#[test]
fn a_bad_scene_shows_the_place() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(scene("cornell-blocks")).unwrap();
    let bad = text.replace("\"albedo\": 0.8", "\"albedo\": 1.8");
    fs::write(folder.path().join("bad.json"), bad).unwrap();
    let output = tpb(folder.path(), ["render", "bad.json"]);
    assert_refused(&output, &["bad.json:31", "$.fog.albedo", "1.8"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "no result folder");

    // A scene in one long line is clipped.
    let line = text.replace('\n', " ").replace("\"albedo\": 0.8", "\"albedo\": -1");
    fs::write(folder.path().join("line.json"), line).unwrap();
    let output = tpb(folder.path(), ["plan", "line.json"]);
    assert_refused(&output, &["line.json:1:", "$.fog.albedo"]);
    assert!(output.stderr.len() < 1000);

    assert_refused(&tpb(folder.path(), ["plan", "nowhere.json"]), &["nowhere.json"]);
    assert_refused(&tpb(folder.path(), ["plan", "."]), &["not a file"]);
}

#[test]
fn a_misspelt_override_gets_the_nearest_name() {
    let folder = tempfile::tempdir().unwrap();
    let set = |text| render(folder.path(), "result", &["--set", text]);
    assert_refused(&set("sensor.film.widht=8"), &["widht", "`width`"]);
    assert_refused(&set("sensr.film.width=8"), &["sensr", "sensor"]);
    assert_refused(&set("width"), &["="]);
    assert_refused(&set("fog.sigma_t=1e999"), &["out of range", "--set"]);
    assert_refused(&set("sensor.film.width=0"), &["--set sensor.film.width=0"]);
}

#[test]
fn impossible_options_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &[&str]); 22] = [
        (&["--time", "20"], &["unit"]),
        (&["--time=-1s"], &["positive"]),
        (&["--time", "-1s"], &["positive"]),
        (&["--passes", "-1"], &["invalid value '-1'"]),
        (&["--threads", "-1"], &["from 1"]),
        (&["--pulse", "-1"], &["gaussian:TIME"]),
        (&["--time", "1s", "--passes", "3"], &["cannot be used with"]),
        (&["--passes", "0"], &["--passes"]),
        (&["--threads", "0"], &["from 1"]),
        (&["--method", "beems"], &["beams"]),
        (&["--pulse", "gaussian"], &["gaussian:TIME"]),
        (&["--pulse", "gaussian:1s"], &["longer than"]),
        (&["--max-depth", "1", "--min-depth", "2"], &["none counts"]),
        (&["--method", "path", "--radius", "0.1"], &["options of beams"]),
        (&["--method", "beams", "--samples-per-pass", "3"], &["options of path"]),
        (&["--method", "light", "--radius", "0.1"], &["options of beams"]),
        (&["--method", "path", "--photons", "9"], &["options of beams"]),
        (&["--method", "beams", "--radius", "0"], &["radius"]),
        (&["--method", "beams", "--radius", "-1"], &["'radius' of the beams must be"]),
        (
            &["--method", "beams", "--surface-radius", "-1e-3"],
            &["'surface_radius' of the beams must be"],
        ),
        (
            &["--method", "beams", "--radius-exponent", "-0.1"],
            &["'radius_exponent' of the beams must be"],
        ),
        (&["--method", "beams", "--photons", "0"], &["--photons"]),
    ];
    for (options, parts) in cases {
        assert_refused(&render(folder.path(), "result", options), parts);
    }
}

#[test]
fn what_does_not_fit_is_refused_before_it_is_tried() {
    let folder = tempfile::tempdir().unwrap();
    let sizes = ["1000000", "1000000000000", "18446744073709551615", "1e300", "-1"];
    for name in ["width", "height", "temporal_bins"] {
        for size in sizes {
            let set = format!("sensor.film.{name}={size}");
            let both = ["--set", &set, "--set", "sensor.film.start_opl=1"];
            let more =
                ["--set", "sensor.film.bin_width_opl=0.5", "--set", "sensor.film.width=90000"];
            let options = if name == "width" { both.to_vec() } else { [both, more].concat() };
            let bins = ["--set", "sensor.film.temporal_bins=100000"];
            let options =
                if name == "temporal_bins" { options } else { [&options[..], &bins].concat() };
            let output = render(folder.path(), "result", &[&FEW[..], &options].concat());
            assert_refused(&output, &[]);
        }
    }
}

#[test]
fn light_that_may_never_end_needs_a_limit_of_depth() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("mirror-caustic");
    let scene = scene.to_str().unwrap();
    let all = ["--set", "fog.albedo=1", "--max-depth", "-1"];
    for command in ["render", "plan"] {
        for method in ["path", "beams"] {
            let output =
                tpb(folder.path(), [&[command, scene, "--method", method], &all[..]].concat());
            let reasons = ["medium 'fog'", "shape 'mirror_shape'", "--max-depth N", "ledger"];
            assert_refused(&output, &reasons);
        }
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "no result folder");
    let mirror = "mirror.specular_reflectance=0.9";
    assert_done(&tpb(folder.path(), ["plan", scene, "--max-depth", "-1", "--set", mirror]));
    assert_done(&tpb(folder.path(), ["plan", scene, "--max-depth", "50"]));
}
