//! Pages and error numbers, of results of ours and cubes of other programs.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::{FEW, assert_done, assert_refused, program, render, stderr, stdout, tpb};

const PATH: [&str; 5] = ["--method", "path", "--passes", "2", "--no-pictures"];

/// A `.npy` file of 32-bit floats.
fn write_npy(path: &Path, shape: &str, values: &[f32]) {
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    while (header.len() + 11) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    fs::write(path, bytes).unwrap();
}

/// The manifest of a page.
fn manifest(page: &Path) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let (_, rest) = text.split_once("id=\"manifest\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn numbers_are_those_of_their_formulas() {
    let folder = tempfile::tempdir().unwrap();
    let cube =
        |name: &str, values: &[f32]| write_npy(&folder.path().join(name), "(1, 2, 3)", values);
    cube("truth.npy", &[0.0, 1.0, 2.0, 4.0, 1.0, 0.0]);
    cube("a.npy", &[0.0, 1.5, 2.0, 4.0, 1.0, 0.0]);
    cube("b.npy", &[0.0, 1.0, 2.0, 3.0, 1.0, 0.25]);
    let arguments = ["compare", "a.npy", "b.npy", "--reference", "truth.npy"];
    let output = tpb(folder.path(), arguments);
    assert_done(&output);
    let text = stdout(&output);
    // The size of the page changes with its scripts.
    let (numbers, page) = text.split_once("page ").unwrap();
    insta::assert_snapshot!("compare", numbers.trim_end());
    assert!(page.trim().starts_with("compare-a-b.html: 0."), "{page}");
    let output = tpb(folder.path(), [&arguments[..], &["--json", "--no-page"]].concat());
    assert_done(&output);
    let report: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(report["shape"], serde_json::json!([1, 2, 3, 1]));
    assert_eq!(report["results"][0]["label"], "a");
    assert_eq!(report["results"][0]["cube"]["nmse"], 0.25 / 22.0);
    assert_eq!(report["results"][1]["cube"]["bias"], -0.75 / 8.0);
    assert_eq!(report["results"][1]["steady"]["rmse"], (0.5625_f64 / 2.0).sqrt());
    assert!(report["page"].is_null());
    // Without a reference, the first judges the second.
    let output = tpb(folder.path(), ["compare", "a.npy", "b.npy", "--json", "--no-page"]);
    let report: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(report["reference"]["label"], "a");
    assert_eq!(report["results"].as_array().unwrap().len(), 1);
}

#[test]
fn a_page_holds_its_results_and_the_commands_that_repeat_them() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--seed", "5", "--variance", "--max-depth", "9"];
    assert_done(&render(folder.path(), "path", &[&PATH[..], &more].concat()));
    let few = ["--passes", "2", "--no-pictures", "--kernel", "2d", "--set", "fog.albedo=0.5"];
    assert_done(&render(folder.path(), "beams", &[&FEW[..], &few].concat()));
    let labels = ["--label", "paths", "--label", "light beams"];
    let arguments = [&["compare", "path", "beams", "-o", "page.html"][..], &labels].concat();
    let output = tpb(folder.path(), arguments);
    assert_done(&output);
    let manifest = manifest(&folder.path().join("page.html"));
    assert_eq!(manifest["title"], "cornell-blocks");
    assert_eq!(manifest["shape"]["bins"], 40);
    let methods = manifest["methods"].as_array().unwrap();
    assert_eq!((&methods[0]["key"], &methods[1]["key"]), (&"paths".into(), &"light-beams".into()));
    assert_eq!(methods[0]["reference"], true);
    assert!(methods[0]["errors"].as_array().is_some_and(|errors| !errors.is_empty()));
    for (name, method) in ["path", "beams"].iter().zip(methods) {
        let command = method["command"].as_str().unwrap();
        let words = command.strip_prefix("tpb ").unwrap().split(' ');
        let again = [&words.collect::<Vec<_>>()[..], &["-o", "again", "--no-pictures"]].concat();
        assert_done(&tpb(folder.path(), again));
        let bytes =
            |result: &str| fs::read(folder.path().join(result).join("transient.npz")).unwrap();
        assert!(bytes(name) == bytes("again"), "{command} makes the same arrays");
    }
    assert_done(&tpb(folder.path(), ["view", "beams"]));
    assert!(folder.path().join("beams.html").exists());
}

#[test]
fn results_are_viewed_side_by_side_without_a_judge() {
    let folder = tempfile::tempdir().unwrap();
    assert_done(&render(folder.path(), "path", &PATH));
    assert_done(&render(
        folder.path(),
        "beams",
        &[&FEW[..], &["--passes", "1", "--no-pictures"]].concat(),
    ));
    let labels =
        ["--label", "paths", "--label", "light beams", "--note", "a remark", "-o", "v.html"];
    assert_done(&tpb(folder.path(), [&["view", "path", "beams"][..], &labels].concat()));
    let manifest = manifest(&folder.path().join("v.html"));
    let methods = manifest["methods"].as_array().unwrap();
    let of = |key: &str| methods.iter().map(|m| m[key].clone()).collect::<Vec<_>>();
    assert_eq!(of("key"), ["paths", "light-beams"]);
    assert_eq!(of("label"), ["paths", "light beams"]);
    assert_eq!(of("reference"), [false, false]);
    let notes = manifest["notes"].to_string();
    assert!(
        notes.contains("No result here is a reference") && notes.contains("a remark"),
        "{notes}"
    );
    // Without names of their own they are told apart by their paths, and the page is named after them.
    assert_done(&tpb(folder.path(), ["view", "path", "path/transient.npz"]));
    assert!(folder.path().join("path-path.html").exists());
    let refused = tpb(folder.path(), ["view", "path", "--label", "a", "--label", "b"]);
    assert_refused(&refused, &["2 labels for 1 results"]);
}

#[test]
fn cubes_of_others_meet_results_of_ours() {
    let folder = tempfile::tempdir().unwrap();
    assert_done(&render(folder.path(), "path", &PATH));
    let mut cells = vec![1e-4; 10 * 12 * 40];
    let other = folder.path().join("other.npy");
    write_npy(&other, "(10, 12, 40, 1)", &cells);
    let output = tpb(folder.path(), ["compare", "path", "other.npy"]);
    assert_done(&output);
    assert!(stdout(&output).contains("no time axis: that of path/transient.npz is used"));
    let page = manifest(&folder.path().join("compare-path-other.html"));
    assert_eq!(page["timed"], true);

    cells[7] = f32::NAN;
    cells[8] = -1.0;
    write_npy(&other, "(10, 12, 40)", &cells);
    let output = tpb(folder.path(), ["compare", "path", "other.npy", "--no-page"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let text = stdout(&output);
    for part in ["1 of 4800 cells are not finite: left out", "1 of 4800 cells are negative: kept"] {
        assert!(text.contains(part), "'{part}' is missing in\n{text}");
    }

    write_npy(&other, "(12, 10, 40)", &cells);
    let output = tpb(folder.path(), ["compare", "path", "other.npy"]);
    let parts = ["path/transient.npz has (10, 12, 40, 1)", "other.npy has (12, 10, 40, 1)"];
    assert_refused(&output, &parts);
}

/// The numbers of a comparison without a page.
fn numbers(folder: &Path, arguments: &[&str]) -> Value {
    let output = tpb(folder, [&["compare", "--json", "--no-page"], arguments].concat());
    assert_done(&output);
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// Regression: a long reference of the same seed contains the passes of what it judges, and nothing
/// was said.
#[test]
fn results_that_share_random_numbers_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, passes: &str, seed: &str| {
        let options = ["--method", "path", "--passes", passes, "--seed", seed];
        let more = ["--no-pictures", "--variance", "--set", "sensor.film.bin_width_opl=0.35"];
        assert_done(&render(folder.path(), name, &[&options[..], &more].concat()));
    };
    made("short", "2", "0");
    made("long", "3", "0");
    made("other", "3", "1");
    let shared = numbers(folder.path(), &["long", "short"]);
    let result = &shared["results"][0];
    assert!(result["remarks"][0].as_str().unwrap().contains("same random passes"), "{shared:#}");
    assert!(result["cube"]["noise"].is_null() && result["cube"]["bias_half"].is_null());
    assert!(result["cube"]["nmse"].is_number());
    let apart = numbers(folder.path(), &["other", "short"]);
    let result = &apart["results"][0];
    assert!(result["cube"]["noise"].is_number() && result["remarks"] == serde_json::json!([]));
    // The page says it, too, and knows the passes: quantiles for 2 and 1 degrees of freedom.
    assert_done(&tpb(folder.path(), ["compare", "long", "short"]));
    let page = manifest(&folder.path().join("compare-long-short.html"));
    let [long, short] = &page["methods"].as_array().unwrap()[..] else { panic!("two methods") };
    assert_eq!((&long["independent"], &short["independent"]), (&true.into(), &false.into()));
    assert_eq!((&long["batches"], &short["batches"]), (&3.into(), &2.into()));
    for (method, exact) in [(long, 4.302_653), (short, 12.706_205)] {
        assert!((method["interval"].as_f64().unwrap() - exact).abs() < 1e-5, "{method:#}");
    }
}

/// Regression: unwarped times were compared with others, pulses with other pulses.
#[test]
fn other_zeros_of_time_and_other_pulses_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, more: &[&str]| {
        assert_done(&render(folder.path(), name, &[&PATH[..], more].concat()));
    };
    made("plain", &[]);
    made("unwarped", &["--unwarp", "--seed", "1"]);
    made("wide", &["--pulse", "gaussian:500ps", "--seed", "1"]);
    for results in [["plain", "unwarped"], ["unwarped", "plain"]] {
        let output = tpb(folder.path(), [&["compare"][..], &results].concat());
        let parts =
            ["unwarped was rendered with --unwarp, plain without", "tpb render", "--seed 0 "];
        assert_refused(&output, &parts);
    }
    let output = tpb(folder.path(), ["compare", "plain", "wide"]);
    assert_refused(&output, &["plain has the pulse delta, wide has gaussian", "--pulse"]);
    write_npy(&folder.path().join("other.npy"), "(10, 12, 40)", &vec![1e-4; 4800]);
    let found = numbers(folder.path(), &["unwarped", "other.npy"]);
    let remarks = found["results"][0]["remarks"].to_string();
    assert!(remarks.contains("no report tells"), "{remarks}");
    // How it was rendered is on the page.
    assert_done(&tpb(folder.path(), ["view", "unwarped"]));
    let page = manifest(&folder.path().join("unwarped.html"));
    let method = &page["methods"][0];
    assert!(method["provenance"].to_string().contains("without the leg from the eye"));
    assert!(method["command"].as_str().unwrap().contains(" --unwarp"));
}

/// Regression: a few pixels that see a lamp ruled all numbers, unsaid.
#[test]
fn pixels_that_rule_are_named_and_others_judged_alone() {
    let folder = tempfile::tempdir().unwrap();
    let cube = |name: &str, lamp: f32, rest: f32| {
        let cell = |at: usize| if at / 2 == 21 { lamp } else { rest };
        let cells: Vec<f32> = (0..800).map(cell).collect();
        write_npy(&folder.path().join(name), "(20, 20, 2)", &cells);
    };
    cube("truth.npy", 1000.0, 1.0);
    cube("a.npy", 1000.0, 1.5);
    let mask: Vec<f32> = (0..400).map(|pixel| f32::from(u8::from(pixel != 21))).collect();
    write_npy(&folder.path().join("mask.npy"), "(20, 20)", &mask);
    let found = numbers(folder.path(), &["truth.npy", "a.npy"]);
    let notes = found["notes"].to_string();
    for part in ["4 of 400 pixels", "hold 100.0 %", "--mask"] {
        assert!(notes.contains(part), "{part} is missing in {notes}");
    }
    assert!(found["results"][0]["cube"]["nmse"].as_f64() < Some(1e-3));
    assert!(found["mask"].is_null() && found["results"][0].get("masked_cube").is_none());

    let masked = ["compare", "truth.npy", "a.npy", "--mask", "mask.npy"];
    let found = numbers(folder.path(), &masked[1..]);
    let nmse = found["results"][0]["masked_cube"]["nmse"].as_f64().unwrap();
    assert!((nmse - 0.25).abs() < 1e-12, "{nmse}");
    assert_eq!(found["results"][0]["masked_steady"]["bias"], 0.5);
    assert_eq!(found["mask"]["pixels"], 399);
    let output = tpb(folder.path(), masked);
    assert_done(&output);
    let text = stdout(&output);
    for part in ["cells in mask", "steady in mask", "pixels in mask.npy: 399 of 400"] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    assert!(!text.contains("Σr²"), "no few of them rule:\n{text}");
    let page = manifest(&folder.path().join("compare-truth-a.html"));
    assert_eq!(page["judged_label"], "pixels in mask.npy");
    assert_eq!(page["methods"][1]["numbers"]["judged_cube"]["nmse"], nmse);
    let refused = |mask: &str| tpb(folder.path(), ["compare", "a.npy", "a.npy", "--mask", mask]);
    assert_refused(&refused("a.npy"), &["a.npy", "(rows, columns)"]);
    assert_refused(&refused("nowhere.npy"), &["nowhere.npy"]);
}

/// Regression: the steady image of all time was compared with another program's sum of bins.
#[test]
fn steady_images_are_of_the_window_if_the_other_knows_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let half = ["--set", "sensor.film.bin_width_opl=0.2"];
    assert_done(&render(folder.path(), "path", &[&PATH[..], &half].concat()));
    let arrays = tpb_film::Arrays::read_npz(&folder.path().join("path/transient.npz")).unwrap();
    let outside: f64 = arrays.before.iter().chain(&arrays.after).sum();
    let all: f64 = arrays.steady.iter().sum();
    assert!((1e-3..0.999).contains(&(outside / all)), "light within the window and outside");
    write_npy(&folder.path().join("same.npy"), "(10, 12, 40)", &arrays.transient);
    let found = numbers(folder.path(), &["path", "same.npy"]);
    assert_eq!(found["results"][0]["steady"]["rmse"], 0.0, "{found:#}");
    let remarks = found["reference"]["remarks"].to_string();
    assert!(remarks.contains("arrives outside the window"), "{remarks}");
    // Alone, the page says what its steady image is.
    assert_done(&tpb(folder.path(), ["view", "same.npy"]));
    let page = manifest(&folder.path().join("same.html"));
    let provenance = page["methods"][0]["provenance"].to_string();
    assert!(provenance.contains("light of the window alone"), "{provenance}");
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |arguments: &[&str]| tpb(folder.path(), arguments);
    write_npy(&folder.path().join("a.npy"), "(1, 1, 2)", &[1.0, 2.0]);
    fs::write(folder.path().join("text.npz"), "no archive").unwrap();
    assert_refused(&at(&["view", "nowhere"]), &["nowhere"]);
    assert_refused(&at(&["view", "text.npz"]), &["text.npz", "neither a result"]);
    assert_refused(&at(&["compare", "a.npy", "nowhere.npz"]), &["nowhere.npz"]);
    assert_refused(&at(&["compare", "a.npy"]), &["<B>"]);
    let three = ["--label", "1", "--label", "2", "--label", "3"];
    let labels = [&["compare", "a.npy", "a.npy"][..], &three].concat();
    assert_refused(&at(&labels), &["3 labels for 2 results"]);
    assert_refused(&at(&["view", "a.npy", "--budget", "0"]), &["MB"]);
    assert_refused(&at(&["view", "a.npy", "--budget", "-1"]), &["MB"]);
    assert_refused(&at(&["view", "a.npy", "-o", "no/such/page.html"]), &["no/such/page.html"]);
    assert_refused(&at(&["compare", "a.npy", "a.npy", "--no-page", "--open"]), &["--no-page"]);
    assert!(!folder.path().join("a.html").exists());
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_browser_the_page_is_still_written() {
    let folder = tempfile::tempdir().unwrap();
    write_npy(&folder.path().join("a.npy"), "(1, 1, 2)", &[1.0, 2.0]);
    let mut command = program();
    command.current_dir(folder.path()).env("PATH", folder.path());
    let output = command.args(["view", "a.npy", "--open"]).output().unwrap();
    assert_refused(&output, &["page is written", "no browser", "a.html by hand"]);
    assert!(folder.path().join("a.html").exists());
}
