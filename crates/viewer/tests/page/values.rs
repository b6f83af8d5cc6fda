//! What the page says is what the arrays hold, within the stated errors.

use serde_json::Value;
use tpb_film::Arrays;
use tpb_viewer::{
    Comparison, Factors, Method, Metrics, PixelErrors, SE_ERROR, VALUE_ERROR, reduce,
};

use crate::scene::{BIN, SHAPE, Scene, arrays, cell, steady};
use crate::{ask, numbers, press, with_page};

/// All values of a method as the page has them: (channel, bin, row, column).
fn cube_script(method: usize) -> String {
    format!(
        "(() => {{ const c = tpbViewer.viewer.cubes[{method}]; const all = []; \
         for (let k = 0; k < c.channels; k++) for (let i = 0; i < c.bins * c.pixels; i++) \
         all.push(c.value(Math.floor(i / c.pixels), i % c.pixels, k)); return all; }})()"
    )
}

#[track_caller]
fn assert_same_cube(found: &Value, arrays: &Arrays) {
    let found = numbers(found);
    let pixels = arrays.pixels();
    assert_eq!(found.len(), pixels * arrays.bins * arrays.channels);
    for (at, found) in found.into_iter().enumerate() {
        let (channel, rest) = (at / (pixels * arrays.bins), at % (pixels * arrays.bins));
        let (bin, pixel) = (rest / pixels, rest % pixels);
        let exact = cell(arrays, pixel % arrays.width, pixel / arrays.width, bin, channel);
        assert!((found - exact).abs() <= VALUE_ERROR * exact.abs(), "{at}: {found} for {exact}");
    }
}

#[test]
fn every_cell_of_every_method_is_there() {
    for channels in [1, 3] {
        let scene = Scene::new(channels);
        with_page(&scene.comparison(), |page| {
            for (method, arrays) in scene.all().into_iter().enumerate() {
                assert_same_cube(&ask(page, &cube_script(method)), arrays);
            }
            let steady = numbers(&ask(page, "Array.from(tpbViewer.viewer.cubes[1].steady[0])"));
            for (found, exact) in steady.iter().zip(scene.beams.steady.iter().step_by(channels)) {
                assert!((found / exact - 1.0).abs() < 4e-3, "{found} {exact}");
            }
        });
    }
}

#[test]
fn the_plot_of_a_pixel_holds_its_time_response_and_band() {
    let scene = Scene::new(1);
    with_page(&scene.comparison(), |page| {
        let place = ask(page, "tpbViewer.placeOf(5, 7)");
        let at = |key: &str| place[key].as_f64().unwrap();
        page.click(at("x"), at("y")).unwrap();
        assert_eq!(ask(page, "[tpbViewer.state.x, tpbViewer.state.y].join()"), "5,7");
        let plot = ask(page, "tpbViewer.chart.plot.data.map((column) => Array.from(column))");
        let columns: Vec<Vec<f64>> = plot.as_array().unwrap().iter().map(numbers).collect();
        assert_eq!(columns.len(), 1 + 3 * 3);
        for (edge, &time) in columns[0].iter().enumerate() {
            let exact = (2.0 + BIN * edge as f64) / 299_792_458.0 * 1e9;
            assert!((time - exact).abs() < 1e-9 * exact, "edge {edge}: {time} ns for {exact} ns");
        }
        for (method, arrays) in scene.all().into_iter().enumerate() {
            let [low, high, value] = [1, 2, 3].map(|c| &columns[3 * method + c]);
            for bin in 0..SHAPE.2 {
                let exact = cell(arrays, 5, 7, bin, 0);
                let (low, high, value) = (low[bin], high[bin], value[bin]);
                assert!((value - exact).abs() <= VALUE_ERROR * exact, "{method} {bin}");
                if arrays.variance.is_none() {
                    assert!(low.is_nan() && high.is_nan(), "no band without variance");
                    continue;
                }
                // Five batches; an unknown number.
                let relative = [2.776_445 * 0.2, 1.959_964 * 0.05][method];
                let half = relative * exact;
                let tolerance = (SE_ERROR + VALUE_ERROR) * half + 1e-12 * exact;
                assert!(
                    ((high - low) / 2.0 - half).abs() <= tolerance,
                    "{method} {bin}: {low} {high}"
                );
            }
        }
        // Regression: the label said ±1.96 whatever the number of batches.
        let note = ask(page, "document.getElementById('chart-note').textContent");
        for part in [
            "Student's t",
            "path tracing ±2.78 standard errors of 5 batches",
            "photon beams ±1.96 standard errors of an unknown number of batches",
        ] {
            assert!(note.as_str().unwrap().contains(part), "{part} is missing in {note}");
        }
    });
}

#[test]
fn one_batch_and_shared_random_numbers_have_no_bands_and_no_noise() {
    let scene = Scene::new(1);
    let mut comparison = scene.comparison();
    comparison.methods[0].batches = Some(1);
    comparison.methods[1].independent = false;
    with_page(&comparison, |page| {
        let band = "tpbViewer.chart.plot.data[1].every((value) => value === null)";
        assert_eq!(ask(page, band), true);
        let note = ask(page, "document.getElementById('chart-note').textContent");
        assert!(note.as_str().unwrap().contains("path tracing none, from 1 batch"), "{note}");
        ask(page, "tpbViewer.update({ view: 'error', metric: 'z', method: 1, bin: 15 })");
        let read =
            "String(tpbViewer.viewer.view.read(tpbViewer.viewer, tpbViewer.viewer.cube, 4, 3))";
        assert_eq!(ask(page, read), "NaN", "standard errors of the difference are not known");
        let rows = ask(
            page,
            "[...document.querySelectorAll('#numbers tbody tr')].map((row) => \
             [...row.children].map((cell) => cell.textContent))",
        );
        assert_eq!((&rows[2][0], &rows[2][3]), (&"photon beams".into(), &"–".into()), "{rows}");
        assert_ne!(rows[1][3], "–", "noise is told of the other");
        let notes = ask(page, "document.getElementById('numbers-note').textContent");
        assert!(notes.as_str().unwrap().contains("same random numbers"), "{notes}");
    });
}

#[test]
fn the_readout_shows_every_method_under_the_cursor() {
    let scene = Scene::new(3);
    with_page(&scene.comparison(), |page| {
        ask(page, "tpbViewer.update({ bin: 20 })");
        let place = ask(page, "tpbViewer.placeOf(9, 2)");
        page.move_to(place["x"].as_f64().unwrap(), place["y"].as_f64().unwrap()).unwrap();
        let rows = "[...document.querySelectorAll('#readout tbody tr')].map((row) => \
                    [...row.children].map((cell) => cell.textContent))";
        let rows = ask(page, rows);
        assert!(
            ask(page, "document.getElementById('where').textContent")
                .as_str()
                .unwrap()
                .starts_with("column 9, row 2")
        );
        for (method, arrays) in scene.all().into_iter().enumerate() {
            for channel in 0..3 {
                let text = rows[method][1 + channel].as_str().unwrap().replace('−', "-");
                let shown: f64 = text.parse().unwrap();
                let exact = cell(arrays, 9, 2, 20, channel);
                // Three digits beside the code's own error.
                assert!((shown - exact).abs() <= (VALUE_ERROR + 5e-3) * exact, "{text} {exact}");
            }
        }
        let interval = rows[0][4].as_str().unwrap();
        let half: f64 = interval.strip_prefix("± ").unwrap().replace('−', "-").parse().unwrap();
        // Luminance of channels 1, 0.7 and 0.4 times the first.
        let luminance = 0.2126 + 0.7 * 0.7152 + 0.4 * 0.0722;
        let exact = 2.776_445 * 0.2 * luminance * cell(&scene.path, 9, 2, 20, 0);
        assert!((half / exact - 1.0).abs() <= SE_ERROR + VALUE_ERROR + 0.05, "{half} {exact}");
        assert_eq!(rows[2][4], "", "no variance");
    });
}

#[test]
fn false_colours_show_the_errors_of_their_formulas() {
    let scene = Scene::new(1);
    let (x, y, bin) = (4, 3, 15);
    let (value, truth) = (cell(&scene.path, x, y, bin, 0), cell(&scene.reference, x, y, bin, 0));
    let lit: Vec<f64> =
        scene.reference.transient.iter().map(|&c| f64::from(c)).filter(|&c| c > 0.0).collect();
    let epsilon = 0.01 * lit.iter().sum::<f64>() / lit.len() as f64;
    let d = value - truth;
    let expected = [
        ("signed", d / (truth + epsilon)),
        ("relative", d.abs() / (truth + epsilon)),
        ("squared", d * d / (truth * truth + epsilon * epsilon)),
        ("smape", 2.0 * d.abs() / (value + truth + epsilon)),
        ("absolute", d.abs()),
        ("z", d / (0.2 * value)),
    ];
    with_page(&scene.comparison(), |page| {
        for (metric, exact) in expected {
            let set =
                format!("tpbViewer.update({{ view: 'error', metric: '{metric}', bin: {bin} }})");
            ask(page, &set);
            let read = format!(
                "tpbViewer.viewer.view.read(tpbViewer.viewer, tpbViewer.viewer.cubes[0], {x}, {y})"
            );
            let found = ask(page, &read).as_f64().unwrap();
            // Both values are off by 1 % at most; so is their difference, in units of the larger.
            let slack = 2.0 * VALUE_ERROR * value.max(truth);
            let relative = match metric {
                "absolute" => slack,
                "squared" => (2.0 * d.abs() * slack + slack * slack) / (truth * truth),
                "z" => slack / (0.2 * value) + exact.abs() * SE_ERROR,
                _ => 2.0 * slack / truth,
            };
            assert!((found - exact).abs() <= relative, "{metric}: {found} for {exact}");
        }
    });
}

#[test]
fn the_table_holds_the_numbers_of_the_full_arrays() {
    let scene = Scene::new(1);
    let mut comparison = scene.comparison();
    let mut judged = vec![true; scene.path.pixels()];
    judged[17] = false;
    comparison.judged = Some(judged.clone());
    comparison.judged_label = "pixels that see no lamp".to_owned();
    with_page(&comparison, |page| {
        let row = ask(
            page,
            "[...document.querySelectorAll('#numbers tbody tr')].map((row) => \
             [...row.children].map((cell) => cell.textContent))",
        );
        let groups =
            [(0, "Cells of pixels that see no lamp", Some(&judged[..])), (3, "All cells", None)];
        for (first, title, judged) in groups {
            let expected = Metrics::of_cube(&scene.path, &scene.reference, judged);
            assert_eq!(row[first][0], title);
            assert_eq!(row[first + 1][0], "path tracing");
            for (column, exact) in [(1, expected.rmse), (2, expected.nmse), (3, expected.noise)] {
                let text = row[first + 1][column].as_str().unwrap().replace('−', "-");
                let shown: f64 = text.parse().unwrap();
                assert!((shown / exact.unwrap() - 1.0).abs() < 6e-3, "{column}: {shown} {exact:?}");
            }
        }
    });
}

#[test]
fn reduced_cubes_are_exact_means_and_sums_and_say_so() {
    let scene = Scene::new(3);
    let mut comparison = scene.comparison();
    let whole = tpb_viewer::page(&comparison).unwrap().1.bytes;
    comparison.budget_bytes = whole - whole / 40;
    let report = with_page(&comparison, |page| {
        let factors = numbers(&ask(page, "tpbViewer.viewer.manifest.factors"));
        let factors = Factors { pixels: factors[0] as usize, bins: factors[1] as usize };
        assert_ne!(factors, Factors::NONE);
        assert_same_cube(
            &ask(page, &cube_script(1)),
            &reduce(&scene.beams, factors, PixelErrors::Together),
        );
        ask(page, "tpbViewer.update({ x: 1, y: 2 })");
        let last = |at: usize| if factors.pixels > 1 { format!("–{at}") } else { String::new() };
        let name = format!(
            "Pixel {}{}, {}{}",
            factors.pixels,
            last(2 * factors.pixels - 1),
            2 * factors.pixels,
            last(3 * factors.pixels - 1)
        );
        assert_eq!(ask(page, "document.getElementById('chart-title').textContent"), name);
        let note = ask(page, "document.getElementById('shown').textContent");
        let note = note.as_str().unwrap();
        let parts = ["14 × 10 pixels × 40 bins rendered", "to keep the page small", "count from 0"];
        assert!(parts.iter().all(|part| note.contains(part)), "{note}");
        // Regression: links and labels counted reduced bins, and from 1.
        ask(page, "location.hash = '#bin=21&pixel=9,7'");
        page.wait_for("tpbViewer.state.x !== 1").unwrap();
        let (f, b) = (factors.pixels, factors.bins);
        let state = "[tpbViewer.state.x, tpbViewer.state.y, tpbViewer.state.bin].join()";
        assert_eq!(ask(page, state), format!("{},{},{}", 9 / f, 7 / f, 21 / b));
        let first = 21 / b * b;
        let bins = match (first + b - 1).min(SHAPE.2 - 1) {
            last if last == first => format!("bin {first} of 0–39"),
            last => format!("bins {first}–{last} of 0–39"),
        };
        let shown = ask(page, "document.getElementById('time-text').textContent");
        assert!(shown.as_str().unwrap().ends_with(&bins), "{bins} is missing in {shown}");
    });
    assert!(report.bytes <= comparison.budget_bytes);
}

#[test]
fn odd_cells_times_without_a_unit_and_steady_films_are_shown() {
    let mut odd = arrays(1, 0.0, 5);
    odd.transient[300] = f32::NAN;
    odd.transient[301] = -1e-3;
    odd.opl_edges = (0..=odd.bins).map(|edge| edge as f64).collect();
    let (pixel, bin) = (300 / odd.bins, 300 % odd.bins);
    let mut comparison = Comparison::new("odd", vec![Method::new("odd", "odd", &odd)]);
    comparison.timed = false;
    with_page(&comparison, |page| {
        let read = |bin: usize| {
            format!("String(tpbViewer.viewer.cubes[0].value({bin}, {pixel}, 0).toPrecision(2))")
        };
        assert_eq!(ask(page, &read(bin)), "NaN");
        assert!(ask(page, &read(bin + 1)).as_str().unwrap().starts_with("-0.0010"));
        press(page, &["Home"]);
        let text = "document.getElementById('time-text').textContent";
        assert_eq!(ask(page, text), "bin 0 of 0–39");
        ask(page, "tpbViewer.update({ view: 'peak', bin: 20 })");
        assert_eq!(ask(page, text), "bin 20 of 0–39");
        // 1 % of 140 pixels see the front earlier than bin 4.
        let low = ask(page, "document.getElementById('scale-low').textContent");
        assert_eq!(low, "bin 4");
        ask(page, "tpbViewer.update({ view: 'frame' })");
        let views = ask(page, "tpbViewer.viewer.views.map((view) => view.name).join()");
        assert_eq!(
            views, "frame,steady,xt,yt,arrival,mean,peak,before,after",
            "nothing to err against"
        );
    });
    let steady = steady();
    with_page(&Comparison::new("steady", vec![Method::new("s", "s", &steady)]), |page| {
        let hidden =
            "[document.getElementById('transport').hidden, tpbViewer.viewer.view.name].join()";
        assert_eq!(ask(page, hidden), "true,steady");
        press(page, &[" ", "ArrowRight", "v", "l"]);
    });
}
