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
        assert_eq!(text(page, "#found-bench"), "1 of 4 benchmarks");
    });
}

#[test]
fn runs_show_instructions_and_rates_with_their_changes() {
    with_page(&Workshop::full(), |page| {
        press(page, &["3"]);
        let beams = "[data-case='box, beams']";
        let latest = text(page, &format!("{beams} .latest"));
        assert_eq!(latest, "303 M instructions · 8.00 M pairs per CPU s");
        // Newest first; against the run before on the same machine.
        let row = "#bench-runs [data-case-row='box, beams']";
        let words = text(page, row).split_whitespace().collect::<Vec<_>>().join(" ");
        for part in ["cccccccc", "303 M ×1.0100 AVX2", "8.00 M pairs ×0.80", "2.50 ×1.25 AVX-512"]
        {
            assert!(words.contains(part), "{part} in {words}");
        }
        assert_eq!(ask(page, &format!("document.querySelectorAll(`{row}`).length")), 3);
        assert_eq!(ask(page, &format!("document.querySelectorAll(`{row} .bad`).length")), 3);
        let plot = format!("tpbDashboard.plots.get(document.querySelector(`{beams} .plot`)).plot");
        let data = ask(
            page,
            &format!(
                "{plot}.data.filter((c, i) => i > 0 && i % 3 === 0).map((c) => c.join(' ')).join()"
            ),
        );
        assert_eq!(data, "300000000  303000000, 900000000 ");
        // Never counted: CPU time instead.
        let path = text(page, "[data-case='box, path'] .latest");
        assert!(path.starts_with("2.50 CPU s"), "{path}");
        let costs = text(page, "#costs tbody tr");
        let words = costs.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.ends_with("1.0300 ≤ 1.02 missed"), "{words}");
        assert!(text(page, "#costs-note").contains("commit aaaaaaaa"));
        page.evaluate("document.getElementById('find-bench').value = 'path'").unwrap();
        ask(page, "document.getElementById('find-bench').dispatchEvent(new Event('input'))");
        assert_eq!(ask(page, "document.querySelectorAll('[data-case]').length"), 1);
    });
}
