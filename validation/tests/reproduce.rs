//! The pages of a reproduction, from tiny renders to what their readers meet in a real browser.
//!
//! Needs Chromium; without one the test fails and says how to get it.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde_json::Value;
use tpb_browser::testing::{CONTRAST, with_file};
use tpb_browser::{Page, Viewport};
use tpb_film::Arrays;
use tpb_validation::reproduce::Options;
use tpb_validation::reproduce::session::{self, Figure};
use tpb_validation::suite::Circumstances;
use tpb_viewer::VALUE_ERROR;

/// Pixels on a side and bins of the trial.
const PIXELS: usize = 16;
const BINS: usize = 24;

/// Both figures on a tiny film.
fn reproduce(out: &Path) {
    let options = Options {
        time: Duration::from_millis(200),
        reference_time: Duration::from_secs(1),
        replicates: 4,
        old_references: false,
        pixels: Some(PIXELS),
        bins: Some(BINS),
        scenes: Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes"),
        out: out.to_owned(),
        circumstances: Circumstances {
            commit: "test".into(),
            machine: "a machine".into(),
            flags: "--trial".into(),
            seed: 3,
        },
        command: "cargo xtask reproduce all --time 0.04".into(),
    };
    let mut told = Vec::new();
    let tell = &mut |line: &str| told.push(line.to_owned());
    session::run(&Figure::ALL, &options, tell, &AtomicBool::new(false)).expect("figures");
    assert!(told[0].starts_with("plan: about "), "the budget comes first: {told:?}");
    assert!(!out.join("unfinished.json").exists());
}

/// The value of a script.
#[track_caller]
fn ask(page: &mut Page<'_>, script: &str) -> Value {
    page.evaluate(script).unwrap_or_else(|error| panic!("{script}: {error}"))
}

/// The same in a viewer, after everything is drawn.
#[track_caller]
fn ask_viewer(page: &mut Page<'_>, script: &str) -> Value {
    ask(page, &format!("tpbViewer.settled().then(() => ({script}))"))
}

#[test]
fn pages_are_sound_in_a_browser() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path();
    reproduce(out);
    for (file, charts, tables) in
        [("index.html", 0, 4), ("cornell-blocks/index.html", 4, 4), ("mirrors/index.html", 4, 6)]
    {
        with_file(&out.join(file), "document.images", |page| {
            document(page, out, file, charts, tables);
        });
    }
    for file in ["cornell-blocks/viewer.html", "mirrors/viewer.html", "mirrors/caustics.html"] {
        with_file(&out.join(file), "window.tpbViewer", |page| viewer(page, file));
    }
    let reference = out.join(format!("cornell-blocks/reference-{PIXELS}-{BINS}.npz"));
    let reference = Arrays::read_npz(&reference).expect("the reference");
    with_file(&out.join("cornell-blocks/viewer.html"), "window.tpbViewer", |page| {
        response(page, &reference);
    });
    curves(&out.join("cornell-blocks"));
    curves(&out.join("mirrors"));
}

/// Text, tables, pictures and charts: there, legible, and within the screen.
fn document(page: &mut Page<'_>, out: &Path, file: &str, charts: usize, tables: usize) {
    let pictures =
        "[...document.images].map((i) => [i.complete && i.naturalWidth > 0, i.alt.length > 10])";
    for picture in ask(page, pictures).as_array().expect("a list") {
        assert_eq!(*picture, serde_json::json!([true, true]), "{file}: decoded, and told in words");
    }
    let count = |selector: &str| format!("document.querySelectorAll('{selector}').length");
    assert_eq!(ask(page, &count("img.chart")), charts, "{file}");
    assert!(ask(page, &count("table")).as_u64() >= Some(tables as u64), "{file}");
    let links = ask(page, "[...document.links].map((link) => link.getAttribute('href'))");
    for link in links.as_array().expect("a list") {
        let target = out.join(file).with_file_name(link.as_str().expect("an address"));
        assert!(target.is_file(), "{file} links {link}");
    }
    for viewport in [Viewport::DESKTOP, Viewport::PHONE] {
        page.viewport(viewport).expect("a screen");
        let mut backgrounds = Vec::new();
        for theme in ["light", "dark"] {
            page.prefer("prefers-color-scheme", theme).expect("a theme");
            backgrounds.push(ask(page, "getComputedStyle(document.body).backgroundColor"));
            let widths = ask(page, "[document.documentElement.scrollWidth, innerWidth].join()");
            let width = viewport.width;
            assert_eq!(widths, format!("{width},{width}"), "{file}, {theme}: nothing sticks out");
            let texts = "['h1', 'h2', 'p', 'a', 'td', 'th', 'caption', 'figcaption', '.note', 'dt', \
                         'dd', 'code', 'li', 'summary']";
            let faint = format!(
                "{texts}.flatMap((s) => [...document.querySelectorAll(s)].slice(0, 3)) \
                 .filter((e) => {CONTRAST}(e) < 4.5).map((e) => e.outerHTML.slice(0, 80))"
            );
            assert_eq!(ask(page, &faint), serde_json::json!([]), "{file}, {theme}: legible");
        }
        assert_ne!(backgrounds[0], backgrounds[1], "{file}: two themes");
    }
}

/// The slider changes the frame; on a phone nothing sticks out, in both themes.
fn viewer(page: &mut Page<'_>, file: &str) {
    let picture = "tpbViewer.stage.canvas.toDataURL()";
    let slide = |bin: usize| {
        format!(
            "(() => {{ const time = document.getElementById('time'); time.value = '{bin}'; \
             time.dispatchEvent(new Event('input')); return tpbViewer.state.bin; }})()"
        )
    };
    // The film's window begins before the light and ends with it.
    let lit = ask_viewer(page, "tpbViewer.viewer.cubes[0].entry.frames.mean");
    let lit: Vec<f64> =
        lit.as_array().expect("means").iter().map(|v| v.as_f64().unwrap_or(0.0)).collect();
    let brightest = (0..lit.len()).max_by(|&a, &b| lit[a].total_cmp(&lit[b])).expect("bins");
    assert_eq!(ask_viewer(page, &slide(0)), 0, "{file}");
    let first = ask_viewer(page, picture);
    assert_eq!(ask_viewer(page, &slide(brightest)), brightest, "{file}");
    assert_ne!(ask_viewer(page, picture), first, "{file}: the slider changes the frame");
    ask_viewer(page, &slide(0));
    assert_eq!(ask_viewer(page, picture), first, "{file}: and back");
    page.viewport(Viewport::PHONE).expect("a phone");
    for theme in ["light", "dark"] {
        page.prefer("prefers-color-scheme", theme).expect("a theme");
        // The chart follows the screen a moment later.
        let fits = "innerWidth === 390 && document.documentElement.scrollWidth === 390";
        page.wait_for(fits).unwrap_or_else(|error| panic!("{file}, {theme}: {error}"));
    }
}

/// The plot of a pixel holds what the reference's file holds, and the error curves are there.
fn response(page: &mut Page<'_>, reference: &Arrays) {
    let (x, y) = (PIXELS / 2, PIXELS / 2 + 2);
    for channel in 0..3 {
        let set =
            format!("tpbViewer.update({{ x: {x}, y: {y}, channel: '{channel}', logAxis: false }})");
        ask_viewer(page, &set);
        let plot =
            ask_viewer(page, "tpbViewer.chart.plot.data.map((column) => Array.from(column))");
        // Edges; then low, high and value of path, beams and reference.
        assert_eq!(plot.as_array().expect("columns").len(), 1 + 3 * 3);
        for bin in 0..BINS {
            let exact = f64::from(reference.pixel(y * PIXELS + x)[3 * bin + channel]);
            let found = plot[9][bin].as_f64().unwrap_or(0.0);
            assert!((found - exact).abs() <= VALUE_ERROR * exact, "bin {bin}: {found} for {exact}");
            if exact > 0.0 {
                let [low, high] = [7, 8].map(|column| plot[column][bin].as_f64().expect("a band"));
                assert!(low <= found && found <= high, "bin {bin}: {low} {found} {high}");
            }
        }
    }
    for (index, method) in [(0, "path"), (1, "beams")] {
        let errors =
            ask_viewer(page, &format!("tpbViewer.viewer.cubes[{index}].entry.frames.nmse"));
        let lit = errors.as_array().expect("a list").iter().filter_map(Value::as_f64);
        assert!(lit.filter(|&nmse| nmse > 0.0).count() > BINS / 4, "{method}: {errors}");
    }
    let label = ask_viewer(page, "document.getElementById('numbers').textContent");
    assert!(label.as_str().is_some_and(|text| text.contains("photon beams")), "{label}");
}

/// The charts beside a page. So few passes resolve few errors, or none: that resolved ones are drawn
/// is tested with given numbers where charts are made.
fn curves(folder: &Path) {
    let read = |file: &str| std::fs::read_to_string(folder.join(file)).expect(file);
    assert!(read("signal-by-bin.svg").contains("<polyline"));
    for file in ["error-by-bin.svg", "error-by-time.svg", "factor-by-bin.svg"] {
        assert!(read(file).trim_end().ends_with("</svg>"), "{file} in {}", folder.display());
    }
}
