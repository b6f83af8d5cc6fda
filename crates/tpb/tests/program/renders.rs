//! Renders and what `tpb info` says of them.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::{FEW, SMALL, assert_done, render, scene, stdout, tpb};

const PATH: [&str; 2] = ["--method", "path"];

#[test]
fn seed_and_passes_decide_every_byte_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    for (method, options) in [("path", &PATH[..]), ("beams", &FEW)] {
        let arrays = |seed: &str, threads: &str| {
            let name = format!("{method}-{seed}-{threads}");
            let more = ["--passes", "3", "--seed", seed, "--threads", threads, "--variance"];
            let output = render(folder.path(), &name, &[options, &more].concat());
            assert_done(&output);
            fs::read(folder.path().join(name).join("transient.npz")).unwrap()
        };
        let one = arrays("5", "1");
        // File times have a resolution of 2 s; none must get into the file.
        sleep(Duration::from_millis(2100));
        assert!(one == arrays("5", "2"), "{method}: 1 and 2 threads");
        assert!(one == arrays("5", "7"), "{method}: 1 and 7 threads");
        assert!(one != arrays("6", "1"), "{method}: the seed matters");
    }
}

#[test]
fn every_kind_of_film_and_pulse_is_sound() {
    let folder = tempfile::tempdir().unwrap();
    let colour = r#"white.reflectance={"type": "rgb", "value": [0.8, 0.7, 0.2]}"#;
    let cases: [(&str, &[&str]); 8] = [
        ("plain", &[]),
        ("grey-as-rgb", &["--set", "sensor.film.pixel_format=rgb"]),
        ("colour-as-luminance", &["--set", colour]),
        ("colour", &["--set", colour, "--set", "sensor.film.pixel_format=rgb"]),
        ("gaussian", &["--pulse", "gaussian:3ns"]),
        ("box", &["--pulse", "box:4ns", "--variance"]),
        ("continuous", &["--pulse", "continuous"]),
        ("window", &["--unwarp", "--set", "sensor.film.start_opl=1.5"]),
    ];
    for (name, more) in cases {
        for (method, options) in [("path", &PATH[..]), ("beams", &FEW)] {
            let result = format!("{name}-{method}");
            let output =
                render(folder.path(), &result, &[options, more, &["--passes", "2"]].concat());
            assert_done(&output);
            let info = tpb(folder.path(), ["info", &result]);
            assert_done(&info);
            let text = stdout(&info);
            assert!(text.contains("bins = steady    holds"), "{result}\n{text}");
            assert!(text.contains("(10, 12, 40, "), "{result}\n{text}");
            // Without the camera's leg, the lamp itself is seen at 0.
            let least = if name == "window" { 0.0 } else { 98.0 };
            assert!(percent_in_window(&text) > least, "{result}\n{text}");
        }
    }
}

/// The part of the energy that `tpb info` finds within the window.
fn percent_in_window(info: &str) -> f64 {
    let (_, rest) = info.split_once("before the window, ").expect("energies");
    rest.split_once(" % in it").expect("a percentage").0.parse().expect("a number")
}

#[test]
fn a_steady_film_has_no_pictures_of_time() {
    let folder = tempfile::tempdir().unwrap();
    let steady = r#"sensor.film={"type": "hdrfilm", "width": 8, "height": 8}"#;
    let scene = scene("cornell-blocks");
    let arguments =
        ["render", scene.to_str().unwrap(), "--set", steady, "--passes", "1", "-o", "s"];
    assert_done(&tpb(folder.path(), arguments));
    let result = folder.path().join("s");
    assert!(result.join("steady.png").exists() && !result.join("frames").exists());
    let info = tpb(folder.path(), ["info", "s"]);
    assert_done(&info);
    assert!(stdout(&info).contains("no time axis"), "{}", stdout(&info));
}

#[test]
fn the_folder_is_named_after_scene_and_method() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("infinite-point");
    let small = "sensor.film.width=4";
    let arguments = ["render", scene.to_str().unwrap(), "--set", small, "--time", "1ms"];
    let output = tpb(folder.path(), arguments);
    assert_done(&output);
    assert!(stdout(&output).contains("passes           1, seed 0"), "{}", stdout(&output));
    assert!(folder.path().join("infinite-point-path/report.json").exists());
}

#[test]
fn light_that_a_method_leaves_out_is_a_warning_and_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("mirror-caustic-point");
    let start = ["render", scene.to_str().unwrap(), "--passes", "1", "-o", "r", "--method"];
    for (method, expected) in [(&PATH[1..], 1), (&FEW[1..], 0)] {
        let output = tpb(folder.path(), [&start[..], method, &SMALL].concat());
        assert_done(&output);
        assert!(percent_in_window(&stdout(&tpb(folder.path(), ["info", "r"]))) > 98.0);
        let said = stdout(&output).contains("WARNING          the image lacks caustics");
        assert_eq!(said, expected == 1, "{}", stdout(&output));
        let report = fs::read_to_string(folder.path().join("r/report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let warnings = report["warnings"].as_array().unwrap();
        assert_eq!(warnings.len(), expected, "{warnings:?}");
        let left_out = report["plan"]["left_out"].as_array().unwrap();
        let lost = left_out.iter().filter(|item| item["loses_light"] == true);
        assert_eq!(lost.count(), expected);
    }
}
