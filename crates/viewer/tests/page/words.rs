//! What the page says beside its numbers: units, times, bands, and what is left of long results.

use serde_json::Value;
use tpb_film::{Arrays, Quantity};
use tpb_viewer::{Comparison, Method};

use crate::scene::{BIN, Scene};
use crate::{ask, with_page};

fn text(id: &str) -> String {
    format!("document.getElementById('{id}').textContent")
}

#[track_caller]
fn assert_says(text: &Value, part: &str) {
    assert!(text.as_str().unwrap().contains(part), "{part} is missing in {text}");
}

/// Regression: a line for each method, word for word the same.
#[test]
fn bands_that_are_alike_are_told_once() {
    let scene = Scene::new(1);
    let methods = ["a", "b", "c", "d"].map(|key| {
        let mut method = Method::new(key, key, &scene.path);
        method.batches = Some(5);
        method
    });
    with_page(&Comparison::new("alike", methods.to_vec()), |page| {
        let note = ask(page, &text("chart-note"));
        assert_says(&note, "Student's t: ±2.78 standard errors of 5 batches");
        assert_eq!(note.as_str().unwrap().matches("batches").count(), 1, "{note}");
    });
    let mut comparison = Comparison::new("two kinds", methods.to_vec());
    comparison.methods[3].batches = Some(2);
    with_page(&comparison, |page| {
        let note = ask(page, &text("chart-note"));
        assert_says(
            &note,
            "a, b, c ±2.78 standard errors of 5 batches; d ±12.7 standard errors of 2",
        );
    });
}

/// Regression: cubes of any program were said to be W m⁻² sr⁻¹.
#[test]
fn units_are_told_where_they_are_known() {
    let scene = Scene::new(1);
    let all = "document.body.innerText + document.getElementById('stage').ariaLabel";
    let seen = |unknown: &[usize], page_says: &mut dyn FnMut(&str)| {
        let mut comparison = scene.comparison();
        for &method in unknown {
            comparison.methods[method].unit_known = false;
        }
        with_page(&comparison, |page| {
            for view in ["frame", "steady", "before", "error"] {
                ask(page, &format!("tpbViewer.update({{ view: '{view}', metric: 'absolute' }})"));
                page_says(ask(page, all).as_str().unwrap());
            }
        });
    };
    seen(&[], &mut |text| assert!(text.contains("W m⁻² sr⁻¹") && !text.contains("unit")));
    seen(&[0, 1, 2], &mut |text| {
        assert!(text.contains("unit unknown") && !text.contains("W m"), "{text}");
    });
    seen(&[1], &mut |text| {
        assert!(text.contains(", if that is the unit of photon beams"), "{text}");
    });
}

#[test]
fn images_beside_the_cube_are_not_per_bin() {
    let scene = Scene::new(1);
    with_page(&scene.comparison(), |page| {
        for (view, per_bin) in
            [("frame", true), ("steady", false), ("before", false), ("after", false)]
        {
            ask(page, &format!("tpbViewer.update({{ view: '{view}' }})"));
            let label = ask(page, &text("scale-label"));
            assert_says(&label, "W m⁻² sr⁻¹");
            assert_eq!(label.as_str().unwrap().contains("per bin"), per_bin, "{view}: {label}");
        }
    });
}

#[test]
fn frames_are_named_by_the_middle_of_their_bin_and_the_page_says_so() {
    let mut scene = Scene::new(1);
    let time = |opl: f64| format!("{:.2} ns", opl / 0.299_792_458);
    for (quantity, at, rule) in [
        (Quantity::BinEnergy, 7.5, "middle of its bin"),
        (Quantity::RadianceAtUpperEdges, 8.0, "upper edge of its bin"),
    ] {
        for arrays in [&mut scene.path, &mut scene.beams, &mut scene.reference] {
            arrays.quantity = quantity;
        }
        with_page(&scene.comparison(), |page| {
            ask(page, "tpbViewer.update({ bin: 7 })");
            assert_says(&ask(page, &text("time-text")), &time(2.0 + at * BIN));
            assert_says(&ask(page, &text("shown")), rule);
        });
    }
}

/// Regression: streaks of results with very many bins were canvases that no browser draws.
#[test]
fn a_pixel_with_very_many_bins_is_shown() {
    let bins = 100_000;
    let transient: Vec<f32> = (0..bins).map(|bin| (1 + bin % 7) as f32).collect();
    let arrays = Arrays {
        width: 1,
        height: 1,
        bins,
        channels: 1,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| 1.0 + edge as f64 / 3e4).collect(),
        steady: vec![transient.iter().map(|&cell| f64::from(cell)).sum()],
        transient,
        variance: None,
        before: vec![0.0],
        after: vec![0.0],
    };
    let reference = Method { is_reference: true, ..Method::new("r", "R", &arrays) };
    let comparison = Comparison::new("long", vec![Method::new("a", "A", &arrays), reference]);
    with_page(&comparison, |page| {
        assert_says(
            &ask(page, &text("shown")),
            "1 × 1 pixels × 14286 bins of 1 × 1 pixels × 100000",
        );
        assert_says(&ask(page, &text("shown")), "sums over 7 bins");
        assert_says(&ask(page, &text("shown")), "groups of 25 bins");
        for view in ["xt", "yt"] {
            ask(page, &format!("tpbViewer.update({{ view: '{view}' }})"));
            let lit = "(() => { const c = tpbViewer.stage.cells; const one = document.createElement('canvas'); \
                 const copy = one.getContext('2d'); copy.drawImage(c, 1 - c.width, 1 - c.height); \
                 return copy.getImageData(0, 0, 1, 1).data[0]; })()";
            assert!(ask(page, lit).as_f64().unwrap() > 100.0, "{view}");
        }
        // 25 bins hold no whole number of periods: 4 less or more.
        ask(page, "tpbViewer.update({ chartKind: 'mean' })");
        let data = "tpbViewer.chart.plot.data.map((column) => column.length).join()";
        assert_eq!(ask(page, data), "4001,4001,4001,4001,4001,4001,4001");
        let mean = ask(page, "tpbViewer.chart.plot.data[3][0]").as_f64().unwrap();
        let exact = f64::from(arrays.transient[..25].iter().sum::<f32>()) / 25.0;
        assert!((mean - exact).abs() < 1e-6, "{mean}");
        assert_says(&ask(page, &text("chart-note")), "25 bins together");
    });
}
