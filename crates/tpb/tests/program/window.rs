//! Renders that keep their window alone.

use std::path::Path;

use serde_json::Value;
use tpb_film::Arrays;

use super::{assert_done, assert_refused, program, render, scene, stdout, tpb};

/// The arrays and the report of a scene, 3 m of its time, with more arguments.
fn rendered(folder: &Path, name: &str, more: &[&str]) -> (Arrays, Value) {
    let mut command = program();
    let small = ["width=10", "height=8", "temporal_bins=30", "bin_width_opl=0.1"];
    command.current_dir(folder).arg("render").arg(scene(name)).args(["--passes", "1", "-o", "r"]);
    for film in small {
        command.arg("--set").arg(format!("sensor.film.{film}"));
    }
    assert_done(&command.args(more).output().expect("the program starts"));
    let report = std::fs::read_to_string(folder.join("r/report.json")).unwrap();
    let arrays = Arrays::read_npz(&folder.join("r/transient.npz")).unwrap();
    (arrays, serde_json::from_str(&report).unwrap())
}

fn number(report: &Value, path: &str) -> f64 {
    report.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path}"))
}

/// With one camera path per pixel (whose later random numbers nobody uses) and a random stream for each
/// photon, what is left out moves nothing else: bins are the same to the rounding of f32.
#[test]
fn the_bins_are_those_of_a_render_that_keeps_all() {
    let folder = tempfile::tempdir().unwrap();
    let path: &[&str] = &["--method", "path", "--samples-per-pass", "1"];
    let light: &[&str] = &["--method", "light", "--photons", "600"];
    let beams: &[&str] = &[
        "--method",
        "beams",
        "--photons",
        "600",
        "--beam-photons",
        "300",
        "--gather-samples",
        "1",
        "--surface-samples",
        "1",
        "--radius",
        "0.08",
        "--surface-radius",
        "0.1",
    ];
    let kernels: [&[&str]; 5] = [
        &["--kernel", "1d"],
        &["--kernel", "2d"],
        &["--kernel", "2d", "--temporal", "even"],
        &["--kernel", "3d"],
        &["--kernel", "1d", "--beam-length", "short"],
    ];
    let mut ways = vec![path.to_vec(), light.to_vec()];
    ways.extend(kernels.map(|kernel| [beams, kernel].concat()));
    for (name, starts) in [("cornell-blocks", ["2", "6"]), ("mirror-caustic", ["2", "4"])] {
        // Of the scene with a mirror, one kernel.
        let ways = if name == "mirror-caustic" { &ways[..3] } else { &ways[..] };
        for (start, way) in
            starts.into_iter().flat_map(|start| ways.iter().map(move |way| (start, way)))
        {
            let start = format!("sensor.film.start_opl={start}");
            let all = [&way[..], &["--set", &start]].concat();
            let (expected, before) = rendered(folder.path(), name, &all);
            let (found, report) =
                rendered(folder.path(), name, &[&all[..], &["--window-only"]].concat());
            let lit = expected.transient.iter().filter(|&&cell| cell > 0.0).count();
            assert!(lit > 20, "{name} {way:?}: {lit} cells");
            for (at, (x, y)) in expected.transient.iter().zip(&found.transient).enumerate() {
                assert!((x - y).abs() <= 1e-6 * x.abs(), "{name} {way:?} {start}: {at}: {x} {y}");
            }
            let inside: f64 = found.transient.iter().map(|&cell| f64::from(cell)).sum();
            assert!((found.steady.iter().sum::<f64>() / inside - 1.0).abs() < 1e-12);
            assert!(found.before.iter().chain(&found.after).all(|&cell| cell == 0.0));
            // The light that was not followed is booked.
            let cut = number(&report, "/run/ledger/mean_of_a_pass/cut_by_window");
            assert!(cut > 0.0 && number(&report, "/ledger_closure").abs() < 1e-9, "{report}");
            assert_eq!(number(&before, "/run/ledger/mean_of_a_pass/cut_by_window"), 0.0);
            let pairs = |report: &Value| number(report, "/run/counts/pairs_accepted");
            assert!(pairs(&report) <= pairs(&before));
            if way.contains(&"beams") && name == "cornell-blocks" {
                assert!(
                    pairs(&report) < 0.8 * pairs(&before),
                    "{} {}",
                    pairs(&report),
                    pairs(&before)
                );
            }
        }
    }
}

#[test]
fn the_output_says_what_it_lacks() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--method", "path", "--passes", "1", "--window-only"];
    let output = render(folder.path(), "r", &more);
    assert_done(&output);
    let said = "the image lacks light outside the window";
    assert!(stdout(&output).contains(said), "{}", stdout(&output));
    let result = folder.path().join("r");
    assert!(result.join("animation.png").exists());
    assert!(!result.join("steady.png").exists() && !result.join("steady.exr").exists());
    let info = tpb(folder.path(), ["info", "r"]);
    assert_done(&info);
    assert!(stdout(&info).contains(said), "{}", stdout(&info));
    // Pages know the window's light from the steady image.
    assert_done(&tpb(folder.path(), ["compare", "r", "r"]));
    let plan = |more: &[&str]| {
        let scene = scene("cornell-blocks");
        let arguments = [&["plan", scene.to_str().unwrap(), "--method", "beams"], more].concat();
        stdout(&tpb(folder.path(), arguments))
    };
    let outside = "beams outside the window";
    let left_out = |plan: &str| plan.split_once("leaves out:").unwrap().1.contains(outside);
    assert!(!plan(&[]).contains(outside));
    assert!(left_out(&plan(&["--window-only"])));
    let unwarped = plan(&["--window-only", "--unwarp"]);
    assert!(unwarped.contains(outside) && !left_out(&unwarped), "{unwarped}");
}

/// Times from each pixel's first surface: nothing is culled, the bins are the same to the bit.
#[test]
fn unwarped_renders_follow_all_light() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--method", "beams", "--photons", "300", "--unwarp"];
    let (expected, _) = rendered(folder.path(), "cornell-blocks", &more);
    let (found, report) =
        rendered(folder.path(), "cornell-blocks", &[&more[..], &["--window-only"]].concat());
    assert!(expected.transient == found.transient && expected.steady != found.steady);
    assert_eq!(number(&report, "/run/ledger/mean_of_a_pass/cut_by_window"), 0.0);
}

#[test]
fn a_window_that_is_not_there_or_not_enough_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let continuous = render(folder.path(), "r", &["--window-only", "--pulse", "continuous"]);
    assert_refused(&continuous, &["before the window"]);
    let steady = r#"sensor.film={"type": "hdrfilm", "width": 8, "height": 8}"#;
    let scene = scene("cornell-blocks");
    let arguments = ["render", scene.to_str().unwrap(), "--set", steady, "--window-only"];
    assert_refused(&tpb(folder.path(), arguments), &["no window"]);
}
