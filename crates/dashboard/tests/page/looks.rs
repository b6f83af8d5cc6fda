//! Dark and light, wide and narrow, in words for those who do not see it.

use tpb_browser::Viewport;
use tpb_browser::testing::CONTRAST;

use crate::workshop::Workshop;
use crate::{ask, press, with_page};

#[test]
fn both_themes_can_be_read() {
    with_page(&Workshop::full(), |page| {
        let mut backgrounds = Vec::new();
        for theme in ["light", "dark"] {
            page.prefer("prefers-color-scheme", theme).unwrap();
            backgrounds.push(ask(page, "getComputedStyle(document.body).backgroundColor"));
            ask(page, "tpbDashboard.update({ open: 'matrix/fog/beams-1d' })");
            let parts = [
                (
                    "1",
                    "#caption, #tab-overview .badge, .good, .bad, .odd, .verdict.none, .run, .group .note, #counts strong, #counts span, .name button, .controls span, .details li, .details dd, .details dt, #runs td, #found",
                ),
                (
                    "2",
                    "#error-note, #factors td, #factors-note, #methods button, #points td, #measured dd",
                ),
                ("3", "[data-bench] .latest span, [data-bench] .note"),
                ("4", "#shelves a, #shelves .note, .missing p, .missing code, #footer"),
            ];
            for (tab, elements) in parts {
                press(page, &[tab]);
                page.wait_for("document.getAnimations().length === 0").unwrap();
                let script = format!(
                    "[...document.querySelectorAll('{elements}')].filter((e) => e.offsetParent !== null && e.innerText) \
                     .map((e) => [{CONTRAST}(e), e.outerHTML.slice(0, 120)]).sort((a, b) => a[0] - b[0])[0]"
                );
                let least = ask(page, &script);
                assert!(least[0].as_f64().unwrap() >= 4.5, "{theme}: {least}");
            }
            press(page, &["1"]);
        }
        assert_ne!(backgrounds[0], backgrounds[1]);
        let colour = "tpbDashboard.plots.get(document.querySelector('[data-history=interval]')).plot.series[3].stroke()";
        let dark = ask(page, colour);
        press(page, &["t"]);
        assert_ne!(ask(page, colour), dark, "charts follow the theme");
    });
}

#[test]
fn the_page_fits_a_phone() {
    with_page(&Workshop::full(), |page| {
        page.viewport(Viewport::PHONE).unwrap();
        ask(page, "tpbDashboard.update({ open: 'matrix/fog/beams-1d' })");
        for tab in ["1", "2", "3", "4"] {
            press(page, &[tab]);
            let widths = ask(page, "[document.documentElement.scrollWidth, innerWidth].join()");
            assert_eq!(widths, "390,390", "tab {tab}: nothing sticks out");
            let small = "[...document.querySelectorAll('button, select, input[type=search]')].filter((e) => \
                         e.offsetParent !== null && e.getBoundingClientRect().height < 36) \
                         .map((e) => e.outerHTML.slice(0, 80))";
            assert_eq!(
                ask(page, small),
                serde_json::json!([]),
                "tab {tab}: large enough for fingers"
            );
        }
        press(page, &["2"]);
        let fits = "(() => { const u = tpbDashboard.plots.get(document.getElementById('error-chart')).plot; \
                    return u.width === document.getElementById('error-chart').clientWidth; })()";
        page.wait_for(fits).unwrap();
    });
}

#[test]
fn every_control_and_picture_has_a_name() {
    with_page(&Workshop::full(), |page| {
        ask(page, "tpbDashboard.update({ open: 'matrix/fog/beams-1d' })");
        for tab in ["1", "2", "3", "4"] {
            press(page, &[tab]);
            let unnamed = "[...document.querySelectorAll('button, select, input, a, [role=img], img')].filter((e) => \
                e.offsetParent !== null && !(e.textContent.trim() && e.getAttribute('role') !== 'img' || \
                e.getAttribute('aria-label') || e.alt || e.labels?.length)).map((e) => e.outerHTML.slice(0, 90))";
            assert_eq!(ask(page, unnamed), serde_json::json!([]), "tab {tab}");
            let doubled = "[...document.querySelectorAll('[id]')].map((e) => e.id).filter((id, i, all) => all.indexOf(id) !== i)";
            assert_eq!(ask(page, doubled), serde_json::json!([]), "tab {tab}: ids are single");
        }
    });
}
