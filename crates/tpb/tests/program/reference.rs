//! `tpb reference`: numbers and curves of analytic solutions.

use std::fs;
use std::process::Output;

use serde_json::Value;

use crate::{assert_done, assert_refused, root, stderr, stdout, tpb};

const ONCE: [&str; 10] = [
    "--set",
    "energy=1",
    "--set",
    "sigma_s=1",
    "--set",
    "sigma_t=1",
    "--set",
    "speed=1",
    "--set",
    "r=2",
];

fn reference(arguments: &[&str]) -> Output {
    tpb(&root(), [&["reference"], arguments].concat())
}

fn once(arguments: &[&str]) -> Output {
    reference(&[&["once_scattered_fluence"], &ONCE[..], arguments].concat())
}

/// The lines of a CSV that are no comments, cell by cell.
fn cells(output: &Output) -> Vec<Vec<String>> {
    let text = stdout(output);
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn a_value_is_that_of_its_closed_form() {
    let output = reference(&[
        "ballistic_point_fluence",
        "--set",
        "energy=3",
        "--set",
        "sigma_t=0.5",
        "--set",
        "r=2",
    ]);
    assert_done(&output);
    let value: f64 = cells(&output)[1][0].parse().unwrap();
    let expected = 3.0 * (-1.0_f64).exp() / (16.0 * std::f64::consts::PI);
    assert!((value / expected - 1.0).abs() < 1e-12);
}

#[test]
fn a_front_leaves_a_cell_empty_and_a_note() {
    let output = once(&["--over", "time=0..4:5"]);
    assert_done(&output);
    let cells = cells(&output);
    assert_eq!(cells[0], ["time", "value [W/m^2]"]);
    assert_eq!((cells[1][1].as_str(), cells[3][1].as_str()), ("0.0", ""));
    assert!(cells[4][1].parse::<f64>().unwrap() > 0.0);
    let note = stderr(&output);
    assert!(note.contains("1 of 5 values are missing") && note.contains("wavefront"), "{note}");

    let output = once(&["--over", "time=0..4:5", "--format", "json"]);
    assert_done(&output);
    let curve: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(curve["over"][0]["values"][2], 2.0);
    assert!(curve["quantities"][0]["values"][2].is_null());
    assert_eq!(curve["exact"], true);
}

#[test]
fn without_any_value_it_fails() {
    assert_refused(&once(&["--set", "time=2"]), &["time = 2", "wavefront", "--list"]);
    assert_refused(&once(&["--over", "time=2..2:3"]), &["wavefront"]);
}

#[test]
fn all_quantities_are_columns_and_one_can_be_chosen() {
    let lens = ["ball_lens", "--set", "eta=1.5", "--over", "impact=0..0.5:3"];
    let output = reference(&lens);
    assert_done(&output);
    assert_eq!(cells(&output)[0], ["impact", "time [s]", "y_out [m]"]);
    let output = reference(&[&lens[..], &["--quantity", "y_out", "--set", "radius=2"]].concat());
    assert_done(&output);
    assert_eq!(cells(&output)[0], ["impact", "y_out [m]"]);
    let wrong = reference(&[&lens[..], &["--quantity", "height"]].concat());
    assert_refused(&wrong, &["no quantity 'height'", "time, y_out"]);
}

#[test]
fn bins_vary_both_edges_and_words_are_inputs() {
    let sphere = ["sphere_centre_radiance_bins", "--set", "albedo=0.7", "--set", "order=all"];
    let output = reference(&[&sphere[..], &["--over", "bins=0..12:6"]].concat());
    assert_done(&output);
    let cells = cells(&output);
    assert_eq!(cells[0], ["t0", "t1", "value [J/(m^2 sr)]"]);
    assert_eq!((cells[2][0].as_str(), cells[2][1].as_str()), ("2.0", "4.0"));
    let wrong = reference(&[
        "sphere_centre_radiance_bins",
        "--set",
        "albedo=1",
        "--set",
        "order=x",
        "--over",
        "bins=0..1:2",
    ]);
    assert_refused(&wrong, &["whole number or \"all\""]);
}

#[test]
fn vectors_are_inputs() {
    let output = reference(&[
        "beam_ray_1d",
        "--set",
        "sigma_s=1",
        "--set",
        "sigma_t=1",
        "--set",
        "g=0",
        "--set",
        "radius=0.5",
        "--set",
        "beam_origin=[0,0,0]",
        "--set",
        "beam_direction=[0,0,1]",
        "--set",
        "beam_length=4",
        "--set",
        "ray_origin=[-1,0.1,1]",
        "--set",
        "ray_direction=[1,0,0]",
        "--over",
        "ray_length=0..4:5",
    ]);
    assert_done(&output);
    assert_eq!(cells(&output)[1][1], "0.0");
    assert!(cells(&output)[4][1].parse::<f64>().unwrap() > 0.0);
}

#[test]
fn approximations_are_labelled_everywhere() {
    let infinite = [
        "diffusion_infinite",
        "--set",
        "r=5",
        "--set",
        "mu_a=0.02",
        "--set",
        "mu_s_prime=2",
        "--set",
        "speed=1",
        "--over",
        "time=1..100:40",
        "--log-x",
        "--log-y",
    ];
    let with = |more: &[&str]| {
        let output = reference(&[&infinite[..], more].concat());
        assert_done(&output);
        stdout(&output)
    };
    assert!(with(&[]).contains("# APPROXIMATE: "));
    let json: Value = serde_json::from_str(&with(&["--format", "json"])).unwrap();
    assert!(json["exact"] == false && json["validity"].is_string());
    let svg = with(&["--format", "svg"]);
    assert!(svg.contains("<svg") && svg.contains("(approximate)"));
    let list = reference(&["--list", "diffusion_infinite"]);
    assert!(stdout(&list).contains("APPROXIMATE: "));
}

#[test]
fn files_are_of_the_format_of_their_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let sweep = ["--over", "time=2.1..9:50"];
    let to = |more: &[&str]| once(&[&sweep[..], more].concat());
    assert_done(&to(&["-o", &path("a.csv"), "--plot", &path("plot.svg")]));
    assert_done(&to(&["-o", &path("a.json")]));
    assert_done(&to(&["-o", &path("a.svg"), "--log-y"]));
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("a.csv").lines().count(), 53);
    assert!(serde_json::from_str::<Value>(&read("a.json")).is_ok());
    for name in ["plot.svg", "a.svg"] {
        assert!(read(name).contains("once_scattered_fluence"), "{name}");
    }
    assert_refused(&to(&["-o", &path("nowhere/a.csv")]), &["nowhere"]);
}

#[test]
fn wrong_inputs_get_the_right_ones() {
    let cases: [(&[&str], &[&str]); 13] = [
        (&["once_scatered_fluence"], &["did you mean once_scattered_fluence"]),
        (&["banana"], &["--list"]),
        (&["ballistic_point_fluence"], &["energy, sigma_t, r", "--set r="]),
        (&["ballistic_point_fluence", "--set", "energi=1"], &["did you mean energy"]),
        (&["ballistic_point_fluence", "--set", "R=1"], &["inputs are energy, sigma_t, r"]),
        (&["ballistic_point_fluence", "--set", "r"], &["KEY=VALUE"]),
        (&["ballistic_point_fluence", "--set", "r=1m"], &["not JSON"]),
        (&["ballistic_point_fluence", "--set", "r=1", "--set", "r=2"], &["twice"]),
        (
            &["ballistic_point_fluence", "--set", "r=1", "--over", "r=1..2"],
            &["both set and varied"],
        ),
        (&["ballistic_point_fluence", "--over", "r=1..2:0"], &["from 1 to"]),
        (&["ballistic_point_fluence", "--over", "r=0..2", "--log-x"], &["positive"]),
        (
            &[
                "ballistic_point_fluence",
                "--format",
                "svg",
                "--set",
                "energy=1",
                "--set",
                "sigma_t=0",
                "--set",
                "r=1",
            ],
            &["--over"],
        ),
        (&[], &["<NAME>"]),
    ];
    for (arguments, parts) in cases {
        assert_refused(&reference(arguments), parts);
    }
}

#[test]
fn the_list_names_every_solution_with_its_inputs() {
    let output = reference(&["--list"]);
    assert_done(&output);
    let text = stdout(&output);
    let output = reference(&["--list", "--format", "json"]);
    assert_done(&output);
    let list: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let list = list.as_array().unwrap();
    assert!(list.len() >= 20);
    for solution in list {
        let name = solution["name"].as_str().unwrap();
        assert!(text.contains(&format!("{name}\n")), "{name}");
        for quantity in solution["quantities"].as_array().unwrap() {
            assert!(!quantity["keys"].as_array().unwrap().is_empty(), "{name}");
            assert!(!quantity["unit"].as_str().unwrap().is_empty(), "{name}");
        }
    }
}
