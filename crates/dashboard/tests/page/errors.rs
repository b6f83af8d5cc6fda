//! Curves, their tips, and the factors between them, of errors that follow power laws exactly.

use tpb_browser::Page;

use crate::workshop::{HALVES, LAWS, PROCESSORS, Workshop};
use crate::{ask, press, text, with_page};

/// CPU seconds of the first and last checkpoint.
const ENDS: [f64; 2] = [0.1 * PROCESSORS, 3.2 * PROCESSORS];

fn law(method: usize, cpu: f64) -> f64 {
    let (_, exponent, size) = LAWS[method];
    size * cpu.powf(exponent)
}

#[track_caller]
fn number(page: &mut Page<'_>, script: &str) -> f64 {
    let value = ask(page, script);
    value.as_f64().unwrap_or_else(|| panic!("{script}: {value}"))
}

#[track_caller]
fn assert_near(found: f64, expected: f64, what: &str) {
    assert!((found / expected - 1.0).abs() < 1e-9, "{what}: {found}, not {expected}");
}

const PLOT: &str = "tpbDashboard.plots.get(document.getElementById('error-chart')).plot";

#[test]
fn curves_have_the_values_of_the_file_with_their_bands() {
    with_page(&Workshop::full(), |page| {
        press(page, &["2"]);
        assert_eq!(
            ask(page, &format!("[{PLOT}.scales.x.distr, {PLOT}.scales.y.distr].join()")),
            "3,3"
        );
        assert_eq!(ask(page, &format!("{PLOT}.data[0].length")), 6);
        for (method, &(name, ..)) in LAWS.iter().enumerate() {
            assert_eq!(ask(page, &format!("{PLOT}.series[{}].label", 3 * method + 3)), name);
            for k in [0, 5] {
                let cpu = number(page, &format!("{PLOT}.data[0][{k}]"));
                assert_near(cpu, ENDS[usize::from(k == 5)], "CPU seconds");
                let column = |part: usize| format!("{PLOT}.data[{}][{k}]", 3 * method + part);
                assert_near(number(page, &column(3)), law(method, cpu), "value");
                assert_near(
                    number(page, &column(1)),
                    law(method, cpu) * (1.0 - HALVES[method]),
                    "low",
                );
                assert_near(
                    number(page, &column(2)),
                    law(method, cpu) * (1.0 + HALVES[method]),
                    "high",
                );
            }
        }
        press(page, &["c"]);
        assert_near(number(page, &format!("{PLOT}.data[0][0]")), 0.1, "wall seconds");
        assert!(
            ask(page, &format!("{PLOT}.axes[0].label")).as_str().unwrap().contains("wall time")
        );
        // Points that are not positive are left out, not moved.
        ask(page, "tpbDashboard.update({ metric: 'squared_bias' })");
        assert_eq!(ask(page, &format!("{PLOT}.data[0].length")), 3);
        let label = ask(page, "document.getElementById('error-chart').getAttribute('aria-label')");
        assert!(label.as_str().unwrap().contains("bias² of box against wall time"), "{label}");
        assert_eq!(ask(page, "document.querySelectorAll('#points tbody tr').length"), 12);
    });
}

#[test]
fn the_tip_tells_the_point_under_the_cursor() {
    with_page(&Workshop::full(), |page| {
        press(page, &["2"]);
        // Over the fourth point of the beams, in the page's own pixels.
        let place = ask(
            page,
            &format!(
                "(() => {{ const u = {PLOT}; u.root.scrollIntoView(); const box = u.over.getBoundingClientRect(); \
                 return [box.left + u.valToPos(u.data[0][3], 'x'), box.top + u.valToPos(u.data[6][3], 'y')]; }})()"
            ),
        );
        let at = |i: usize| place[i].as_f64().unwrap();
        page.move_to(at(0) + 2.0, at(1) - 3.0).unwrap();
        page.wait_for("document.querySelector('#error-chart .tip')?.hidden === false").unwrap();
        let tip = text(page, "#error-chart .tip");
        let nmse = law(1, 0.8 * PROCESSORS);
        let expected = format!(
            "beams, 8 passes\nNMSE {nmse:.4} [{:.4}, {:.4}]\nCPU 1.28 s, wall 0.800 s",
            nmse * (1.0 - HALVES[1]),
            nmse * (1.0 + HALVES[1])
        );
        assert_eq!(tip, expected);
        // A click sets the time at which methods are compared.
        page.click(at(0), at(1)).unwrap();
        page.wait_for("tpbDashboard.state.atTime !== null").unwrap();
        let time = number(page, "tpbDashboard.state.atTime");
        assert!((time / 1.28 - 1.0).abs() < 0.02, "{time}");
        // The same by keys: along a curve, and to the other.
        ask(page, "document.getElementById('error-chart').focus()");
        press(page, &["ArrowRight", "ArrowRight", "ArrowDown"]);
        let said = text(page, "#live");
        assert!(said.starts_with("beams, 2 passes"), "{said}");
    });
}

#[test]
fn factors_are_those_of_the_power_laws() {
    with_page(&Workshop::full(), |page| {
        press(page, &["2"]);
        let curves = "tpbDashboard.data.error_time.scenes[0].curves.map((c) => \
                      tpbDashboard.curvePoints(c, 'cpu', 'nmse'))";
        let ask_factor = |page: &mut Page<'_>, call: &str| {
            ask(
                page,
                &format!("(() => {{ const [p, b] = {curves}; return tpbDashboard.{call}; }})()"),
            )
        };
        // At equal time, between checkpoints: both are straight lines.
        for time in [0.2, 1.0, 4.0] {
            let found = ask_factor(page, &format!("factorAtTime(p, b, {time})"));
            let factor = law(0, time) / law(1, time);
            assert_near(found["factor"].as_f64().unwrap(), factor, "factor at equal time");
            let (down, up) = (HALVES.map(|h| -(1.0 - h).ln()), HALVES.map(|h| (1.0 + h).ln()));
            assert_near(
                found["interval"][0].as_f64().unwrap(),
                factor * (-down[0].hypot(up[1])).exp(),
                "low",
            );
            assert_near(
                found["interval"][1].as_f64().unwrap(),
                factor * up[0].hypot(down[1]).exp(),
                "high",
            );
        }
        assert_eq!(ask_factor(page, "factorAtTime(p, b, 100)"), serde_json::Value::Null);
        // At equal error: only between the best of path and the worst of beams is there a factor.
        let (path_end, beams_start) = (law(0, ENDS[1]), law(1, ENDS[0]));
        assert!(path_end > beams_start, "the curves have no error in common");
        let found = ask_factor(page, &format!("factorAtError(p, b, {path_end})"));
        assert_near(found["least"].as_f64().unwrap(), ENDS[1] / ENDS[0], "a bound, not a guess");
        let found = ask_factor(page, &format!("factorAtError(b, p, {path_end})"));
        assert_near(found["most"].as_f64().unwrap(), ENDS[0] / ENDS[1], "the other way round");
        let found = ask_factor(page, "factorAtError(p, p, 0.4)");
        assert_near(found["factor"].as_f64().unwrap(), 1.0, "with itself");
        let (early, late) = (1.0 - HALVES[0], 1.0 + HALVES[0]);
        let half = (-early.ln()).hypot(late.ln());
        assert_near(
            found["interval"][1].as_f64().unwrap(),
            half.exp(),
            "slope −1: times err like errors",
        );
        // The table.
        let rows = ask(
            page,
            "[...document.querySelectorAll('#factors tbody tr')].map((r) => [...r.children].map((c) => c.innerText))",
        );
        let factor = law(0, ENDS[1]) / law(1, ENDS[1]);
        let shown = rows[1][1].as_str().unwrap();
        assert!(shown.starts_with(&format!("{factor:.1} [")), "{shown}, not {factor}");
        assert_eq!(rows[1][2], "≥ 32.0");
        assert_eq!(rows[1][3], "−0.80 [−0.85, −0.75]");
        assert_eq!(rows[0][1], "1");
        // The same in the table of all scenes, with the error itself.
        let all = ask(
            page,
            "[...document.querySelectorAll('#all-scenes tbody tr')].map((r) => [...r.children].map((c) => c.innerText).join('|'))",
        );
        assert_eq!(all.as_array().unwrap().len(), 4, "two scenes of two methods");
        let nmse = law(1, ENDS[1]);
        let expected = format!(
            "|beams|5.12 s|{nmse:.5} [{:.5}, {:.5}]|{shown}|≥ 32.0",
            nmse * (1.0 - HALVES[1]),
            nmse * (1.0 + HALVES[1])
        );
        assert_eq!(all[1], expected);
        press(page, &["b"]);
        assert_eq!(text(page, "#factors tbody tr:nth-child(2) td"), "1", "over beams now");
    });
}

#[test]
fn methods_hide_scenes_change_and_what_is_unreadable_is_named() {
    with_page(&Workshop::full(), |page| {
        press(page, &["2"]);
        let shown = format!(
            "[3, 6].map((i) => {PLOT}.data[i].filter((v) => v !== undefined && v !== null).length).join()"
        );
        assert_eq!(ask(page, &shown), "6,6");
        ask(page, "document.querySelectorAll('#methods button')[0].click()");
        assert_eq!(ask(page, &shown), "0,6");
        assert_eq!(
            ask(
                page,
                "document.querySelectorAll('#methods button')[0].getAttribute('aria-pressed')"
            ),
            "false"
        );
        assert_eq!(ask(page, "document.querySelectorAll('#factors tbody tr').length"), 1);
        press(page, &["s"]);
        assert_eq!(text(page, "#scenes [aria-pressed=true]"), "hall");
        assert_eq!(ask(page, &shown), "6,6", "a new scene shows all");
        let notes = text(page, "#errors-missing");
        assert!(notes.contains("torn.json: no error-time result"), "{notes}");
        let measured = text(page, "#measured");
        for part in ["8 of each method", "its machine", "own NMSE", "4033 of 4096", "\"rays\":9"] {
            assert!(measured.contains(part), "{part} is missing in {measured}");
        }
        assert!(text(page, "#measured-command").contains("cargo xtask error-time --scene hall"));
    });
}
