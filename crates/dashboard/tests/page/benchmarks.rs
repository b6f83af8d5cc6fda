//! Benchmarks over commits.

use crate::workshop::Workshop;
use crate::{ask, press, text, with_page};

#[test]
fn benchmarks_show_their_latest_value_change_and_history() {
    with_page(&Workshop::full(), |page| {
        press(page, &["3"]);
        let gather = "[data-bench='gather/tiles']";
        let latest = text(page, &format!("{gather} .latest"));
        // 4.4 ms for 1e5 elements; against 4.0 ms: 10 % up, ±√2 % in quadrature.
        let expected = "44.0 ns per element [43.6, 44.4] · 22.7 M elements/s\n+10.00 % [+8.4";
        assert!(latest.starts_with(expected), "{latest}");
        assert!(latest.ends_with("against bbbbbbbb"), "{latest}");
        assert_eq!(ask(page, &format!("document.querySelector(`{gather} .bad`) !== null")), true);
        assert!(text(page, "[data-bench='paths/room'] .latest").starts_with("2.50 s [2.4"));
        let plot = format!("tpbDashboard.plots.get(document.querySelector(`{gather} .plot`)).plot");
        let data = ask(
            page,
            &format!(
                "{plot}.data.slice(1).map((c) => c.map((v) => v.toFixed(3)).join(' ')).join()"
            ),
        );
        assert_eq!(data, "49.500 39.600 43.560,50.500 40.400 44.440,50.000 40.000 44.000");
        ask(page, &format!("{plot}.setCursor({{ left: {plot}.valToPos(0, 'x'), top: 10 }})"));
        let tip = text(page, &format!("{gather} .tip"));
        assert!(
            tip.contains("50.0 ns per element [49.5, 50.5]") && tip.contains("commit aaaaaaaaaaaa"),
            "{tip}"
        );
        assert!(
            text(page, gather)
                .contains("commit cccccccc (told from the time), slope with its 95 % interval")
        );
        press(page, &["/"]);
        page.evaluate("document.getElementById('find-bench').value = 'room'").unwrap();
        ask(page, "document.getElementById('find-bench').dispatchEvent(new Event('input'))");
        assert_eq!(ask(page, "document.querySelectorAll('[data-bench]').length"), 1);
        assert_eq!(text(page, "#found-bench"), "1 of 2 benchmarks");
    });
}
