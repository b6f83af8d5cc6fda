//! The table of experiments says what the histories say.

use tpb_browser::testing::with_file;
use tpb_dashboard::write;

use crate::workshop::Workshop;
use crate::{ask, text, with_page};

/// Names of the experiments that are shown, in their order.
const SHOWN: &str =
    "[...document.querySelectorAll('[data-row]')].map((row) => row.dataset.row).join()";

#[test]
fn the_table_shows_verdicts_and_numbers() {
    let report = with_page(&Workshop::full(), |page| {
        assert_eq!(
            ask(page, SHOWN),
            "samplers/phase,matrix/fog/path,matrix/fog/beams-1d,matrix/room/path,glass/clock"
        );
        let columns = |name: &str| {
            format!(
                "[...document.querySelectorAll('[data-row=\"{name}\"] > *')].map((c) => c.innerText.trim())"
            )
        };
        let expected = [
            (
                "matrix/fog/path",
                "✓ passed|matrix/fog/path|−0.20 % … +0.30 %|0.500|2.5 s|late: rejected, loss: not run||cccccccc",
            ),
            (
                "matrix/fog/beams-1d",
                "✗ failed|matrix/fog/beams-1d|+1.20 % … +3.40 %|1.0e−9|2.5 s|kernel: NOT REJECTED||bbbbbbbb-dirty",
            ),
            (
                "samplers/phase",
                "✗ control failed|samplers/phase||0.600|2.5 s|warp: NOT REJECTED||bbbbbbbb-dirty",
            ),
            ("matrix/room/path", "· not run|matrix/room/path|||full suite|||"),
            ("glass/clock", "! broken|glass/clock|no result|–|< 0.1 s|||aaaaaaaa"),
        ];
        for (name, row) in expected {
            assert_eq!(ask(page, &format!("{}.join('|')", columns(name))), row, "{name}");
        }
        let strip = "document.querySelector('[data-row=\"matrix/fog/path\"] .history svg').getAttribute('aria-label')";
        assert_eq!(ask(page, strip), "passed 3 of the last 3 runs");
        let counts = ask(
            page,
            "[...document.querySelectorAll('#counts button')].map((b) => b.innerText.replace('\\n', ' ')).join()",
        );
        assert_eq!(counts, "1 passed,2 failed,1 broken,1 not run,1 retired");
        assert!(text(page, "#counts-note").starts_with("1 of 3 negative controls were rejected"));
        let latest = text(page, "#latest-run");
        for part in [
            "cccccccccccc",
            "a machine, 2 threads",
            "validate --quick",
            "1 passed, 0 failed",
            "1.0e−7",
        ] {
            assert!(latest.contains(part), "{part} is missing in {latest}");
        }
        assert_eq!(ask(page, "document.querySelectorAll('#runs tbody tr').length"), 3);
        assert!(text(page, "#remarks").contains("1 lines could not be read"));
        assert_eq!(text(page, "#tab-overview .badge"), "3");
    });
    assert_eq!(report.experiments, [4, 4, 2], "with controls, and what is retired");
    assert_eq!((report.scenes, report.benchmarks, report.linked), (2, 4, 2));
    assert_eq!(report.remarks.len(), 2);
}

#[test]
fn a_failed_experiment_says_what_was_noted_and_how_to_repeat_it() {
    with_page(&Workshop::full(), |page| {
        ask(page, "document.querySelector('[data-experiment=\"matrix/fog/beams-1d\"]').click()");
        let details = text(page, ".details");
        for part in [
            "compares matrix/fog/beams-1d </script> with theory",
            "most significant: bin 12 (z = 9.1)",
            "cargo xtask validate --seed 1 --filter 'matrix/fog/beams-1d'",
            "bbbbbbbbbbbb-dirty",
            "3 contrasts, 64 batches",
            "not rejected",
            "left/wrong.svg, left/gone.png",
            "method   NMSE\nbeams  1.3e-2 < 2",
        ] {
            assert!(details.contains(part), "{part} is missing in {details}");
        }
        let picture = "(() => { const i = document.querySelector('.details img'); return [i.alt, i.naturalWidth]; })()";
        page.wait_for("document.querySelector('.details img').complete").unwrap();
        assert_eq!(ask(page, picture), serde_json::json!(["wrong.svg of matrix/fog/beams-1d", 40]));
        // What broke says why, as text; what was never run has the command.
        ask(page, "document.querySelector('[data-experiment=\"glass/clock\"]').click()");
        assert!(text(page, ".details").contains("the scene <b>cannot</b> be read"));
        ask(page, "document.querySelector('[data-experiment=\"matrix/room/path\"]').click()");
        let details = text(page, ".details");
        assert!(details.contains("There is no result yet."));
        assert!(details.contains("cargo xtask validate --full --filter 'matrix/room/path'"));
    });
}

#[test]
fn the_history_of_an_experiment_is_drawn() {
    with_page(&Workshop::full(), |page| {
        ask(page, "tpbDashboard.update({ open: 'matrix/fog/path' })");
        let plot = "tpbDashboard.plots.get(document.querySelector('[data-history=interval]')).plot";
        let data = ask(page, &format!("{plot}.data.slice(1)"));
        let expected = serde_json::json!([
            [-0.004, -0.003, -0.002],
            [0.001, 0.002, 0.003],
            [-0.0015, -0.0005, 0.0005]
        ]);
        for (found, expected) in data.as_array().unwrap().iter().zip(expected.as_array().unwrap()) {
            for (a, b) in found.as_array().unwrap().iter().zip(expected.as_array().unwrap()) {
                assert!((a.as_f64().unwrap() - b.as_f64().unwrap()).abs() < 1e-12, "{data}");
            }
        }
        let painted = format!(
            "(() => {{ const c = {plot}.ctx.canvas; \
             const d = {plot}.ctx.getImageData(0, 0, c.width, c.height).data; \
             let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0; return n; }})()"
        );
        assert!(ask(page, &painted).as_u64().unwrap() > 1000, "something is on the canvas");
        ask(page, &format!("{plot}.setCursor({{ left: {plot}.valToPos(1, 'x'), top: 20 }})"));
        let tip = text(page, "[data-history=interval] .tip");
        for part in ["−0.30 % … +0.20 %", "commit bbbbbbbbbbbb-dirty", "seed 1"] {
            assert!(tip.contains(part), "{part} is missing in {tip}");
        }
        let label = "document.querySelector('[data-history=interval]').getAttribute('aria-label')";
        let label = ask(page, label);
        assert!(
            label
                .as_str()
                .unwrap()
                .contains("over 3 runs; latest: relative error −0.20 % … +0.30 %"),
            "{label}"
        );
    });
}

#[test]
fn experiments_are_found_by_text_pattern_and_verdict() {
    with_page(&Workshop::full(), |page| {
        let find = |text: &str| {
            format!(
                "(() => {{ const f = document.getElementById('find'); f.value = {text:?}; \
                 f.dispatchEvent(new Event('input')); }})()"
            )
        };
        for (words, expected) in [
            ("path", "matrix/fog/path,matrix/room/path"),
            ("FOG path", "matrix/fog/path"),
            ("*/fog/*", "matrix/fog/path,matrix/fog/beams-1d"),
            ("matrix/*/path", "matrix/fog/path,matrix/room/path"),
            ("z = 9.1", "matrix/fog/beams-1d"),
            ("nothing like it", ""),
            ("(", "matrix/fog/beams-1d"),
            ("", "samplers/phase,matrix/fog/path,matrix/fog/beams-1d,matrix/room/path,glass/clock"),
        ] {
            ask(page, &find(words));
            assert_eq!(ask(page, SHOWN), expected, "{words}");
        }
        for (verdict, expected) in [
            ("failed", "samplers/phase,matrix/fog/beams-1d"),
            ("broken", "glass/clock"),
            ("missing", "matrix/room/path"),
            ("passed", "matrix/fog/path"),
            ("retired", "old/experiment"),
        ] {
            let choose = format!(
                "(() => {{ const v = document.getElementById('verdict'); v.value = '{verdict}'; \
                 v.dispatchEvent(new Event('change')); }})()"
            );
            ask(page, &choose);
            assert_eq!(ask(page, SHOWN), expected, "{verdict}");
        }
        assert_eq!(text(page, "#found"), "1 of 5 experiments");
        ask(page, "tpbDashboard.update({ verdict: 'passed' })");
        ask(page, &find("fog"));
        assert_eq!(ask(page, SHOWN), "matrix/fog/path", "both at once");
        ask(page, &find(""));
        // Sorted by what is worst, and back.
        ask(page, "tpbDashboard.update({ verdict: 'all' })");
        ask(
            page,
            "[...document.querySelectorAll('thead button')].find((b) => b.innerText === 'relative error').click()",
        );
        let sorted = ask(page, SHOWN);
        assert!(
            sorted.as_str().unwrap().starts_with("matrix/fog/beams-1d,matrix/fog/path,"),
            "{sorted}"
        );
        assert_eq!(ask(page, "document.querySelectorAll('[aria-sort]').length"), 1);
    });
}

#[test]
fn what_is_missing_comes_with_the_command_that_makes_it() {
    let report = with_page(&Workshop::empty(), |page| {
        assert!(text(page, ".summary").contains("cargo xtask validate --quick"));
        assert_eq!(ask(page, "document.querySelectorAll('[data-row]').length"), 5);
        for (tab, command) in [
            ("errors", "cargo xtask error-time"),
            ("benchmarks", "cargo xtask bench"),
            ("pages", "cargo xtask gallery"),
        ] {
            ask(page, &format!("document.getElementById('tab-{tab}').click()"));
            assert!(text(page, &format!("#{tab}")).contains(command), "{tab}");
        }
    });
    assert_eq!(report.experiments, [0, 0, 9]);
}

#[test]
fn pages_that_are_there_are_copied_and_linked() {
    let workshop = Workshop::full();
    with_page(&workshop, |page| {
        ask(page, "document.getElementById('tab-pages').click()");
        let links = ask(
            page,
            "[...document.querySelectorAll('#shelves a')].map((a) => [a.innerText, a.getAttribute('href')])",
        );
        let expected = serde_json::json!([
            ["All & more", "pages/reproduce/index.html"],
            ["The box", "pages/reproduce/box/index.html"]
        ]);
        assert_eq!(links, expected);
        let target = ask(
            page,
            "decodeURIComponent(new URL(document.querySelectorAll('#shelves a')[1].href).pathname)",
        );
        let target = std::path::PathBuf::from(target.as_str().unwrap());
        assert_eq!(
            target,
            workshop
                .root()
                .canonicalize()
                .unwrap()
                .join("dashboard/pages/reproduce/box/index.html")
        );
    });
}

/// Regression: pages were links out of the folder, dead wherever else it was taken.
#[test]
fn the_folder_can_be_taken_elsewhere() {
    let workshop = Workshop::full();
    let report = write(&workshop.sources()).unwrap();
    assert!(report.copied > 0 && report.linked == 2);
    let elsewhere = tempfile::tempdir().unwrap();
    let moved = elsewhere.path().join("sent, by post");
    std::fs::rename(workshop.root().join("dashboard"), &moved).unwrap();
    drop(workshop);
    with_file(&moved.join("index.html"), "window.tpbDashboard", |page| {
        ask(page, "document.getElementById('tab-pages').click()");
        let links = "[...document.querySelectorAll('#shelves a')].map((a) => new URL(a.href).pathname)\
                     .map(decodeURIComponent)";
        let links = ask(page, links);
        let links = links.as_array().unwrap();
        assert_eq!(links.len(), 2);
        for link in links {
            let file = std::path::Path::new(link.as_str().unwrap());
            assert!(file.starts_with(moved.canonicalize().unwrap()) && file.is_file(), "{file:?}");
        }
    });
}
