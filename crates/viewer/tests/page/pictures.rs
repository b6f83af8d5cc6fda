//! Colours on the canvas are those of the values.

use tpb_film::{Tone, ToneMap};
use tpb_viewer::VALUE_ERROR;

use crate::scene::{BIN, SHAPE, Scene, cell};
use crate::{ask, numbers, press, with_page};

/// The colour at the middle of a cell on the stage.
fn colour_script(x: usize, y: usize) -> String {
    format!(
        "(() => {{ const s = tpbViewer.stage.canvas; const box = s.getBoundingClientRect(); \
         const p = tpbViewer.placeOf({x}, {y}); const k = s.width / box.width; \
         const c = document.createElement('canvas').getContext('2d'); \
         c.drawImage(s, (p.x - box.left) * k, (p.y - box.top) * k, 1, 1, 0, 0, 1, 1); \
         return Array.from(c.getImageData(0, 0, 1, 1).data); }})()"
    )
}

/// The curve of sRGB, in 8 bits.
fn srgb(linear: f64) -> f64 {
    let v = linear.clamp(0.0, 1.0);
    255.0 * if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn greys_follow_value_and_exposure_at_any_zoom() {
    let scene = Scene::new(1);
    let (x, y, bin) = (6, 4, 22);
    with_page(&scene.comparison(), |page| {
        // The crosshair elsewhere, out of the way of zooming around it.
        ask(page, &format!("tpbViewer.update({{ bin: {bin}, x: {}, y: {y} }})", x - 2));
        let white = ask(page, "tpbViewer.viewer.view.white(tpbViewer.viewer)").as_f64().unwrap();
        for exposure in [-2.0, 0.0, 1.5] {
            ask(page, &format!("tpbViewer.update({{ exposure: {exposure} }})"));
            for (method, arrays) in scene.all().into_iter().enumerate() {
                press(page, &[&(method + 1).to_string()]);
                let expected = srgb(cell(arrays, x, y, bin, 0) / white * f64::exp2(exposure));
                let found = ask(page, &colour_script(x, y))[0].as_f64().unwrap();
                // 1 % of a value is at most 1.2 of 255 steps.
                assert!((found - expected).abs() <= 2.3, "{method} {exposure}: {found} {expected}");
            }
        }
        let before = ask(page, &colour_script(x, y));
        press(page, &["+", "+"]);
        assert_eq!(ask(page, &colour_script(x, y)), before, "pixels stay sharp");
    });
}

#[test]
fn white_is_the_references_for_all_methods() {
    let scene = Scene::new(3);
    with_page(&scene.comparison(), |page| {
        let white = "tpbViewer.viewer.view.white(tpbViewer.viewer)";
        let first = ask(page, white);
        press(page, &["2"]);
        assert_eq!(ask(page, white), first);
        press(page, &["f", "Home", "PageDown"]);
        let early = ask(page, white).as_f64().unwrap();
        press(page, &["End"]);
        let late = ask(page, white).as_f64().unwrap();
        assert!(
            late < 0.5 * early && late > 0.0,
            "exposure follows the fading frame: {early} {late}"
        );
    });
}

#[test]
fn maps_tell_times_within_a_bin() {
    let mut scene = Scene::new(1);
    // A pixel that is dim, then lit, then brightest; one that stays dark.
    let cells = &mut scene.reference.transient[..2 * SHAPE.2];
    cells.fill(0.0);
    for (bin, value) in [(5, 0.05), (8, 0.2), (20, 1.0)] {
        cells[bin] = value;
    }
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ view: 'peak' })");
        for (x, y) in [(5, 3), (13, 9)] {
            let read = format!(
                "tpbViewer.viewer.view.read(tpbViewer.viewer, tpbViewer.viewer.cubes[2], {x}, {y})"
            );
            let found = ask(page, &read).as_f64().unwrap();
            let front = 3.0 + 0.9 * f64::from(x) + 1.1 * f64::from(y);
            let exact = 2.0 + 0.06 * (front.ceil() + 0.5);
            assert!((found - exact).abs() < 1e-9, "{x} {y}: {found} m for {exact} m");
        }
        let middle = |bin: f64| 2.0 + BIN * (bin + 0.5);
        let mean = (0.05 * middle(5.0) + 0.2 * middle(8.0) + middle(20.0)) / 1.25;
        // The mean is off by no more than the cells' own error times their mean distance from it.
        let spread =
            (0.05 * (mean - middle(5.0)) + 0.2 * (mean - middle(8.0)) + middle(20.0) - mean) / 1.25;
        let times = [
            ("arrival", middle(8.0), 1e-9),
            ("mean", mean, VALUE_ERROR * spread),
            ("peak", middle(20.0), 1e-9),
        ];
        for (view, exact, error) in times {
            ask(page, &format!("tpbViewer.update({{ view: '{view}' }})"));
            let read = |x| {
                let v = "tpbViewer.viewer";
                format!("String({v}.view.read({v}, {v}.cubes[2], {x}, 0))")
            };
            let found: f64 = ask(page, &read(0)).as_str().unwrap().parse().unwrap();
            assert!((found - exact).abs() <= 1.02 * error, "{view}: {found} m for {exact} m");
            assert_eq!(ask(page, &read(1)), "NaN", "{view}: what is dark has no time");
        }
        let low = ask(page, "document.getElementById('scale-low').textContent");
        assert!(low.as_str().unwrap().ends_with(" ns"), "{low}");
    });
}

/// Regression: the page's curves were not those of pictures and videos of the same names.
#[test]
fn tone_curves_are_those_of_our_pictures() {
    let scene = Scene::new(3);
    // A front, its tail, and colours that leave the display.
    let cells = [(6, 4, 22), (2, 1, 9), (0, 0, 38), (9, 7, 19)];
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ x: 13, y: 9 })");
        let white = ask(page, "tpbViewer.viewer.view.white(tpbViewer.viewer)").as_f64().unwrap();
        for (name, tone) in [("linear", Tone::Linear), ("log", Tone::Log), ("filmic", Tone::Filmic)]
        {
            ask(page, &format!("location.hash = '#curve={name}'"));
            page.wait_for(&format!("tpbViewer.state.curve === '{name}'")).unwrap();
            for stops in [-3.0, 0.0, 2.5] {
                ask(page, &format!("tpbViewer.update({{ exposure: {stops} }})"));
                let map = ToneMap::new(white, tone, stops);
                for (x, y, bin) in cells {
                    ask(page, &format!("tpbViewer.update({{ bin: {bin} }})"));
                    let rgb = [0, 1, 2].map(|c| cell(&scene.path, x, y, bin, c));
                    let expected = map.colour(rgb).map(|v| f64::from(tpb_film::srgb(v)));
                    let found = numbers(&ask(page, &colour_script(x, y)));
                    for (found, expected) in found.iter().zip(expected) {
                        // 1 % of a value is at most 2.4 steps of the steepest curve, and the page
                        // rounds linear values to 1/4095.
                        assert!(
                            (found - expected).abs() <= 4.0,
                            "{name} {stops} {x},{y},{bin}: {found} for {expected}"
                        );
                    }
                }
            }
        }
        // The bar ends where a curve is white.
        let mut ends = Vec::new();
        for name in ["linear", "log", "filmic"] {
            ask(page, &format!("tpbViewer.update({{ curve: '{name}', exposure: 0 }})"));
            let bar = ask(page, "document.getElementById('scale-high').textContent");
            let text = bar.as_str().unwrap().replace('−', "-");
            ends.push(text.parse::<f64>().unwrap() / white);
        }
        for (found, exact) in ends.iter().zip([1.0, 10.0, 7.24]) {
            assert!((found / exact - 1.0).abs() < 6e-3, "{ends:?}");
        }
    });
}

#[test]
fn notes_are_shown_with_or_without_a_reference() {
    let scene = Scene::new(1);
    let mut comparison = scene.comparison();
    comparison.notes.push("Bin 20: the front meets the <wall>.".to_owned());
    for methods in [3, 1] {
        comparison.methods.truncate(methods);
        with_page(&comparison, |page| {
            let shown = "document.getElementById('notes').innerText";
            assert_eq!(ask(page, shown), "Bin 20: the front meets the <wall>.");
        });
    }
}
