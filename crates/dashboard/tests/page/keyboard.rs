//! Everything can be done from the keyboard.

use std::collections::BTreeSet;

use crate::workshop::Workshop;
use crate::{ask, press, text, with_page};

#[test]
fn keys_do_what_the_help_says() {
    with_page(&Workshop::full(), |page| {
        for (key, tab) in [("2", "errors"), ("3", "benchmarks"), ("4", "pages"), ("1", "overview")]
        {
            press(page, &[key]);
            let shown = "[...document.querySelectorAll('[role=tabpanel]')].filter((p) => p.offsetParent !== null).map((p) => p.id).join()";
            assert_eq!(ask(page, shown), tab);
            assert_eq!(
                ask(page, "document.querySelector('[aria-selected=true]').id"),
                format!("tab-{tab}")
            );
            assert_eq!(ask(page, "location.hash"), format!("#tab={tab}"));
        }
        press(page, &["j", "j"]);
        let focused = "document.activeElement.dataset.experiment";
        assert_eq!(ask(page, focused), "matrix/fog/path");
        press(page, &["Enter"]);
        assert_eq!(ask(page, "tpbDashboard.state.open"), "matrix/fog/path");
        assert_eq!(ask(page, focused), "matrix/fog/path", "the focus stays");
        press(page, &["j", "k", "k"]);
        assert_eq!(ask(page, focused), "samplers/phase");
        // A search takes letters for itself.
        press(page, &["/", "j", "2", "t"]);
        assert_eq!(ask(page, "document.getElementById('find').value"), "j2t");
        assert_eq!(ask(page, "tpbDashboard.state.find"), "j2t");
        press(page, &["Escape"]);
        assert_eq!(ask(page, "[tpbDashboard.state.find, tpbDashboard.state.open].join()"), ",");
        let mut verdicts = BTreeSet::new();
        for _ in 0..6 {
            press(page, &["f"]);
            verdicts.insert(ask(page, "tpbDashboard.state.verdict").as_str().unwrap().to_owned());
        }
        assert_eq!(verdicts.len(), 6, "f goes through all verdicts");
        press(page, &["2", "m", "c", "s", "b"]);
        assert_eq!(
            ask(
                page,
                "(({ metric, clock, scene, base }) => [metric, clock, scene, base].join())(tpbDashboard.state)"
            ),
            "rmse,wall,hall,beams"
        );
        press(page, &["?"]);
        assert_eq!(ask(page, "document.getElementById('help').open"), true);
        assert!(ask(page, "document.querySelectorAll('#help dt').length").as_u64() > Some(9));
        press(page, &["Escape"]);
        assert_eq!(ask(page, "document.getElementById('help').open"), false);
        let theme = "getComputedStyle(document.body).backgroundColor";
        let before = ask(page, theme);
        press(page, &["t"]);
        assert_ne!(ask(page, theme), before);
        // Arrow keys on the tabs.
        ask(page, "document.getElementById('tab-errors').focus()");
        press(page, &["ArrowRight"]);
        assert_eq!(ask(page, "document.activeElement.id"), "tab-benchmarks");
        press(page, &["ArrowLeft", "ArrowLeft", "ArrowLeft"]);
        assert_eq!(ask(page, "document.activeElement.id"), "tab-pages");
    });
}

#[test]
fn the_tab_key_reaches_every_control_and_shows_where_it_is() {
    with_page(&Workshop::full(), |page| {
        for tab in ["1", "2"] {
            press(page, &[tab]);
            ask(page, "document.activeElement.blur()");
            let wanted = ask(
                page,
                "[...document.querySelectorAll('button, select, input, a, [tabindex]')].filter((e) => \
                 !e.disabled && e.tabIndex >= 0 && e.offsetParent !== null && !e.closest('dialog')).length",
            );
            let mut seen = BTreeSet::new();
            for _ in 0..wanted.as_u64().unwrap() + 2 {
                press(page, &["Tab"]);
                let focus = "(() => { const e = document.activeElement; e.mark ??= Math.random(); \
                             const s = getComputedStyle(e); \
                             return [e.mark, s.outlineStyle, parseFloat(s.outlineWidth), e.outerHTML.slice(0, 90), e === document.body]; })()";
                let focus = ask(page, focus);
                if focus[4] == true {
                    continue;
                }
                let visible = focus[1] == "solid" && focus[2].as_f64() >= Some(2.0);
                assert!(visible, "the focus is not seen on {}", focus[3]);
                seen.insert(focus[0].to_string());
            }
            assert_eq!(seen.len() as u64, wanted.as_u64().unwrap(), "tab {tab}");
        }
    });
}

#[test]
fn links_say_what_is_shown_first() {
    with_page(&Workshop::full(), |page| {
        let go = |hash: &str| format!("location.hash = '{hash}'");
        page.evaluate(&go("tab=errors&scene=hall&clock=wall&metric=variance&base=beams")).unwrap();
        page.wait_for("tpbDashboard.state.scene === 'hall'").unwrap();
        assert_eq!(
            ask(
                page,
                "(({ tab, clock, metric, base }) => [tab, clock, metric, base].join())(tpbDashboard.state)"
            ),
            "errors,wall,variance,beams"
        );
        page.evaluate(&go("tab=overview&verdict=failed&open=matrix/fog/beams-1d&theme=dark"))
            .unwrap();
        page.wait_for("tpbDashboard.state.verdict === 'failed'").unwrap();
        assert!(text(page, ".details").contains("bin 12"));
        // What is not known is left alone.
        page.evaluate(&go("tab=none&clock=sun&verdict=odd")).unwrap();
        assert_eq!(
            ask(page, "[tpbDashboard.state.tab, tpbDashboard.state.verdict].join()"),
            "overview,failed"
        );
    });
}
