//! Dark and light, wide and narrow, in words for those who do not see it.

use tpb_browser::testing::CONTRAST;
use tpb_browser::{Page, Viewport};

use crate::scene::Scene;
use crate::{ask, press, with_page};

#[test]
fn both_themes_can_be_read_and_follow_the_system() {
    let scene = Scene::new(1);
    with_page(&scene.comparison(), |page| {
        let background = "getComputedStyle(document.body).backgroundColor";
        let mut seen = Vec::new();
        for theme in ["light", "dark"] {
            page.prefer("prefers-color-scheme", theme).unwrap();
            seen.push(ask(page, background));
            for element in [
                "h1",
                "#where",
                "#methods button",
                "#methods [aria-pressed=true]",
                "#views button",
                ".note",
                "#numbers td",
                "#numbers thead th",
                "dd",
                "dt",
                "#badge",
            ] {
                let script = format!("{CONTRAST}(document.querySelector('{element}'))");
                // Colours change within a moment.
                page.wait_for("document.getAnimations().length === 0").unwrap();
                let contrast = ask(page, &script).as_f64().unwrap();
                assert!(contrast >= 4.5, "{element} in {theme}: {contrast}");
            }
        }
        assert_ne!(seen[0], seen[1]);
        press(page, &["t"]);
        assert_eq!(ask(page, background), seen[0], "the button beats the system");
    });
}

#[test]
fn the_page_fits_a_phone_and_answers_to_fingers() {
    let scene = Scene::new(3);
    with_page(&scene.comparison(), |page| {
        page.viewport(Viewport::PHONE).unwrap();
        for theme in ["light", "dark"] {
            page.prefer("prefers-color-scheme", theme).unwrap();
            for view in ["frame", "error", "xt", "mean"] {
                ask(page, &format!("tpbViewer.update({{ view: '{view}' }})"));
                let widths = ask(page, "[document.documentElement.scrollWidth, innerWidth].join()");
                assert_eq!(widths, "390,390", "{view} in {theme}: nothing sticks out");
            }
        }
        let small = "[...document.querySelectorAll('button, select')].filter((e) => \
                     e.offsetParent !== null && e.getBoundingClientRect().height < 36).length";
        assert_eq!(ask(page, small), 0, "large enough for fingers");
        ask(page, "tpbViewer.update({ view: 'frame' })");
        let place = ask(page, "tpbViewer.placeOf(12, 8)");
        page.tap(place["x"].as_f64().unwrap(), place["y"].as_f64().unwrap()).unwrap();
        page.wait_for("tpbViewer.state.x === 12 && tpbViewer.state.y === 8").unwrap();
    });
}

#[test]
fn words_tell_what_is_seen() {
    let scene = Scene::new(1);
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ bin: 20, x: 2, y: 3, exposure: -1.5 })");
        press(page, &["2"]);
        let label = "document.getElementById('stage').getAttribute('aria-label')";
        let words = ask(page, label);
        // The centre of bin 20, counted from 0: (2 + 20.5 * 0.06) m.
        for part in
            ["bin 20 of 0–39", "10.77", "photon beams", "−1.5 stops", "brightest cell", "column"]
        {
            assert!(words.as_str().unwrap().contains(part), "{part} is missing in {words}");
        }
        let said = ask(page, "document.getElementById('live').textContent");
        assert_eq!(said, words, "keys are answered aloud");
        let chart = ask(page, "document.getElementById('chart').getAttribute('aria-label')");
        for part in ["column 2, row 3", "linear axis", "path tracing: largest"] {
            assert!(chart.as_str().unwrap().contains(part), "{part} is missing in {chart}");
        }
        let text = ask(page, "document.getElementById('time-text').textContent");
        assert_eq!(text, "10.77 ns · bin 20 of 0–39");
        let unnamed = "[...document.querySelectorAll('button, select, input, canvas')].filter((e) => \
            !e.closest('#chart') && \
            !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length)).length";
        assert_eq!(ask(page, unnamed), 0, "every control has a name");
    });
}

#[test]
fn quiet_for_those_who_want_no_motion() {
    let scene = Scene::new(1);
    with_page(&scene.comparison(), |page: &mut Page<'_>| {
        page.prefer("prefers-reduced-motion", "reduce").unwrap();
        let moving = "[...document.querySelectorAll('*')].filter((e) => { \
            const s = getComputedStyle(e); \
            return parseFloat(s.transitionDuration) > 0 || parseFloat(s.animationDuration) > 0; }).length";
        assert_eq!(ask(page, moving), 0);
        assert_eq!(ask(page, "tpbViewer.state.playing"), false, "nothing plays unasked");
    });
}
