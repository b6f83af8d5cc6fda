use super::*;

fn decay(mark: Mark) -> Series {
    let points = (0..=20).map(|i| (f64::from(i), (-0.5 * f64::from(i)).exp()));
    Series::new("decay", mark, points.collect())
}

fn chart(series: Vec<Series>) -> Chart {
    Chart { title: "t".into(), x: Axis::linear("time [s]"), y: Axis::linear("value"), series }
}

#[test]
fn a_chart_holds_its_labels_and_all_marks() {
    for mark in [Mark::Line, Mark::Dashes, Mark::Points, Mark::LineAndPoints] {
        for y in [Axis::linear("value [W]"), Axis::logarithmic("value [W]")] {
            let series = decay(mark);
            let band = series.points.iter().map(|&(_, y)| (0.5 * y, 2.0 * y)).collect();
            let text = Chart { y, ..chart(vec![series.with_band(band)]) }.svg((640, 400)).unwrap();
            assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
            for label in ["time [s]", "value [W]", "decay"] {
                assert!(text.contains(label), "{label} in {text}");
            }
        }
    }
}

#[test]
fn what_cannot_be_shown_leaves_a_gap() {
    let mut series = decay(Mark::Line);
    let lines = |series: &Series| chart(vec![series.clone()]).svg((640, 400)).unwrap();
    let count = |text: &str| text.matches("<polyline").count();
    let whole = count(&lines(&series));
    series.points[10].1 = f64::NAN;
    assert_eq!(count(&lines(&series)), whole + 1);
    series.points[10].1 = 0.0;
    let y = Axis::logarithmic("value");
    let text = Chart { y, ..chart(vec![series]) }.svg((640, 400)).unwrap();
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

#[test]
fn charts_without_a_range_are_errors() {
    let empty = Chart::default().svg((640, 400)).unwrap_err();
    assert_eq!(empty, PlotError::Empty { axis: "horizontal" });
    let negative = Series::new("", Mark::Line, vec![(1.0, -1.0)]);
    let y = Axis::logarithmic("value");
    let dark = Chart { y, ..chart(vec![negative]) }.svg((640, 400)).unwrap_err();
    assert_eq!(dark.to_string(), "the vertical axis has no value that it can show");
    let x = Axis { range: Some((2.0, 1.0)), ..Axis::linear("x") };
    let turned = Chart { x, ..chart(vec![decay(Mark::Line)]) }.svg((640, 400)).unwrap_err();
    assert_eq!(turned.to_string(), "the horizontal axis cannot run from 2 to 1");
    let band = chart(vec![decay(Mark::Line).with_band(vec![(0.0, 1.0)])]).svg((640, 400));
    assert_eq!(band.unwrap_err().to_string(), "series 'decay' has 21 points and 1 intervals");
}

#[test]
fn a_single_point_and_huge_values_are_drawn() {
    for value in [0.0, 1.0, -3e-300, 1e308] {
        let point = Series::new("", Mark::Points, vec![(value, value)]);
        assert!(chart(vec![point]).svg((640, 400)).unwrap().contains("<circle"));
    }
    let wide = Series::new("", Mark::Line, vec![(-1e308, -1e308), (1e308, 1e308)]);
    assert!(chart(vec![wide]).svg((640, 400)).is_ok());
}

/// Regression: a broken line had an unbroken one in the legend, and points had none of their looks.
#[test]
fn the_legend_shows_what_is_drawn() {
    let drawn = |mark, name: &str| {
        let series = Series { name: name.into(), ..decay(mark) };
        let text = chart(vec![series]).svg((640, 400)).unwrap();
        ["<polyline", "<circle"].map(|part| text.matches(part).count())
    };
    for (mark, lines, dots) in [
        (Mark::Line, 1, 0),
        (Mark::Dashes, 2, 0),
        (Mark::Points, 0, 1),
        (Mark::LineAndPoints, 1, 1),
    ] {
        let (with, without) = (drawn(mark, "decay"), drawn(mark, ""));
        assert_eq!([with[0] - without[0], with[1] - without[1]], [lines, dots], "{mark:?}");
    }
}

/// Regression: charts stayed white on dark pages.
#[test]
fn every_colour_of_a_chart_has_a_dark_one() {
    // The sixth and seventh colours are bright enough on both.
    let kept = ["#56B4E9", "#E69F00"];
    let series = (0..7).map(|_| decay(Mark::LineAndPoints)).collect();
    for text in [chart(series).svg((640, 400)).unwrap(), message("a < b & c", (640, 400))] {
        let (style, rest) = text.split_once("</style>").unwrap();
        assert!(text.starts_with("<svg ") && style.contains("prefers-color-scheme:dark"));
        for name in ["fill", "stroke"] {
            for part in rest.split(&format!(" {name}=\"")).skip(1) {
                let colour = part.split('"').next().unwrap();
                let told = style.contains(&format!("[{name}=\"{colour}\"]"));
                assert!(told || kept.contains(&colour) || colour == "none", "{name} {colour}");
            }
        }
    }
    assert!(message("a < b & c", (640, 400)).contains("a &lt; b &amp; c"));
}
