//! Everything can be done from the keyboard.

use std::collections::BTreeSet;

use tpb_browser::{Modifiers, Page};

use crate::scene::{SHAPE, Scene};
use crate::{ask, press, with_page};

#[track_caller]
fn assert_state(page: &mut Page<'_>, expression: &str, expected: impl Into<serde_json::Value>) {
    assert_eq!(
        ask(page, &format!("tpbViewer.state.{expression}")),
        expected.into(),
        "{expression}"
    );
}

#[test]
fn number_keys_flip_methods_in_place() {
    let scene = Scene::new(1);
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ bin: 18, x: 6, y: 4 })");
        press(page, &["+"]);
        let place = "JSON.stringify([tpbViewer.placeOf(6, 4), tpbViewer.state.zooms])";
        let before = ask(page, place);
        let picture = "tpbViewer.stage.canvas.toDataURL()";
        let mut seen = BTreeSet::new();
        for (key, label) in [("1", "path tracing"), ("2", "photon beams"), ("3", "reference")] {
            press(page, &[key]);
            let pressed = "document.querySelector('#methods [aria-pressed=true]').textContent";
            assert_eq!(ask(page, pressed), format!("{label}{key}"));
            assert_eq!(ask(page, place), before, "same zoom and pan");
            seen.insert(ask(page, picture).as_str().unwrap().to_owned());
        }
        assert_eq!(seen.len(), 3, "three methods, three pictures");
        press(page, &["2", "9"]);
        assert_state(page, "method", 1);
        press(page, &["r"]);
        assert_state(page, "method", 2);
        press(page, &["r"]);
        assert_state(page, "method", 1);
    });
}

#[test]
fn time_moves_by_keys_and_slider_and_the_frame_with_it() {
    let scene = Scene::new(3);
    let last = SHAPE.2 - 1;
    with_page(&scene.comparison(), |page| {
        press(page, &["Home"]);
        assert_state(page, "bin", 0);
        let picture = "tpbViewer.stage.canvas.toDataURL()";
        let dark = ask(page, picture);
        press(page, &["PageDown", "ArrowRight", "."]);
        assert_state(page, "bin", 12);
        assert_ne!(ask(page, picture), dark);
        press(page, &["ArrowLeft", ",", "PageUp"]);
        assert_state(page, "bin", 0);
        assert_eq!(ask(page, picture), dark, "the same frame is the same picture");
        press(page, &["End", "ArrowRight"]);
        assert_state(page, "bin", last);
        // The slider itself, by its own keys.
        ask(page, "document.getElementById('time').focus()");
        press(page, &["ArrowLeft", "ArrowLeft"]);
        assert_state(page, "bin", last - 2);
        let said = ask(page, "document.getElementById('time').getAttribute('aria-valuetext')");
        assert!(said.as_str().unwrap().starts_with("bin 37 of 0–39, "), "{said}");
        let line = "document.getElementById('time').value";
        assert_eq!(ask(page, line), (last - 2).to_string());
        // Playing goes on by itself, and stops.
        press(page, &["Home", "]", " "]);
        page.wait_for("tpbViewer.state.bin >= 3").unwrap();
        assert_eq!(ask(page, "document.getElementById('play').textContent"), "Pause");
        press(page, &[" "]);
        assert_state(page, "playing", false);
        assert_state(page, "speed", 30);
    });
}

#[test]
fn every_other_key_does_what_the_help_says() {
    let scene = Scene::new(1);
    let shift = Modifiers { shift: true, ..Modifiers::default() };
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ x: 5, y: 5, bin: 10 })");
        for key in ["ArrowRight", "ArrowDown", "ArrowDown"] {
            page.press_with(key, shift).unwrap();
        }
        assert_eq!(ask(page, "[tpbViewer.state.x, tpbViewer.state.y].join()"), "6,7");
        assert_eq!(ask(page, "document.getElementById('chart-title').textContent"), "Pixel 6, 7");
        press(page, &["e", "e", "f", "c", "l", "z", "m"]);
        assert_state(page, "exposure", 1);
        assert_state(page, "follow", true);
        assert_state(page, "curve", "log");
        assert_state(page, "logAxis", true);
        assert_state(page, "chartZoom", true);
        assert_state(page, "metric", "relative");
        assert_eq!(ask(page, "tpbViewer.chart.plot.scales.y.distr"), 3);
        page.press_with("E", shift).unwrap();
        assert_state(page, "exposure", 0.5);
        press(page, &["x"]);
        assert_state(page, "exposure", 0);
        press(page, &["+", "+", "-"]);
        assert_state(page, "zooms.image.scale", 2);
        press(page, &["0"]);
        assert_state(page, "zooms.image.scale", 1);
        let count = ask(page, "tpbViewer.viewer.views.length").as_u64().unwrap();
        let mut views = BTreeSet::new();
        for _ in 0..count {
            press(page, &["v"]);
            views.insert(ask(page, "tpbViewer.state.view").as_str().unwrap().to_owned());
        }
        assert_eq!(views.len() as u64, count, "v shows every view in turn");
        assert_eq!(count, 11);
        page.press_with("V", shift).unwrap();
        assert_state(page, "view", "after");
        press(page, &["?"]);
        assert_eq!(ask(page, "document.getElementById('help').open"), true);
        assert!(ask(page, "document.querySelectorAll('#help dt').length").as_u64() > Some(20));
        press(page, &["Escape"]);
        assert_eq!(ask(page, "document.getElementById('help').open"), false);
        let theme = "getComputedStyle(document.body).backgroundColor";
        let before = ask(page, theme);
        press(page, &["t"]);
        assert_ne!(ask(page, theme), before);
    });
}

#[test]
fn streaks_move_through_pixels_and_time() {
    let scene = Scene::new(1);
    let shift = Modifiers { shift: true, ..Modifiers::default() };
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ view: 'xt', x: 3, y: 4, bin: 9 })");
        page.press_with("ArrowDown", shift).unwrap();
        page.press_with("ArrowRight", shift).unwrap();
        assert_eq!(
            ask(page, "[tpbViewer.state.x, tpbViewer.state.y, tpbViewer.state.bin].join()"),
            "4,4,10"
        );
        let place = ask(page, "tpbViewer.placeOf(11, 30)");
        page.click(place["x"].as_f64().unwrap(), place["y"].as_f64().unwrap()).unwrap();
        assert_eq!(
            ask(page, "[tpbViewer.state.x, tpbViewer.state.y, tpbViewer.state.bin].join()"),
            "11,4,30"
        );
        ask(page, "tpbViewer.update({ view: 'yt' })");
        page.press_with("ArrowUp", shift).unwrap();
        assert_eq!(
            ask(page, "[tpbViewer.state.x, tpbViewer.state.y, tpbViewer.state.bin].join()"),
            "11,3,30"
        );
    });
}

#[test]
fn the_tab_key_reaches_every_control_and_shows_where_it_is() {
    let scene = Scene::new(3);
    with_page(&scene.comparison(), |page| {
        let wanted = ask(
            page,
            "[...document.querySelectorAll('button, select, input, a, [tabindex]')]\
             .filter((e) => !e.disabled && e.offsetParent !== null && !e.closest('dialog')).length",
        );
        let mut reached = 0;
        let mut seen = BTreeSet::new();
        for _ in 0..wanted.as_u64().unwrap() {
            press(page, &["Tab"]);
            let focus = "(() => { const e = document.activeElement; e.mark ??= Math.random(); \
                         const s = getComputedStyle(e); \
                         return [e.mark, s.outlineStyle, parseFloat(s.outlineWidth), e.outerHTML.slice(0, 90)]; })()";
            let focus = ask(page, focus);
            if seen.insert(focus[0].to_string()) {
                reached += 1;
            }
            let visible = focus[1] == "solid" && focus[2].as_f64() >= Some(2.0);
            assert!(visible, "the focus is not seen on {}", focus[3]);
        }
        assert_eq!(reached, wanted.as_u64().unwrap());
    });
}
