//! From a chart to SVG.

use plotters::coord::cartesian::Cartesian2d;
use plotters::prelude::*;

use crate::coordinate::Coordinate;
use crate::{Chart, Mark, PlotError, Series, range};

/// Colours that people with any kind of colour vision tell apart (Okabe and Ito 2008), without
/// yellow, which white paper swallows.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    BLACK,
];
const FONT: &str = "sans-serif";
/// How a chart looks where its reader's system is dark: for each colour that is drawn, the other.
/// Readers without style sheets see the light one.
const DARK: [(&str, &str); 8] = [
    ("#FFFFFF", "#1a1e22"),
    ("#000000", "#e8ebee"),
    ("#DEDEDE", "#343c44"),
    ("#C8C8C8", "#4a545e"),
    ("#0072B2", "#6cb0ff"),
    ("#D55E00", "#f59a52"),
    ("#009E73", "#5fc98a"),
    ("#CC79A7", "#dd8ce4"),
];
/// Opacity of bands.
const SHADE: f64 = 0.2;

type Frame<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Coordinate, Coordinate>>;
type Drawn<'b> = Result<(), DrawingAreaErrorKind<<SVGBackend<'b> as DrawingBackend>::ErrorType>>;

/// The chart as SVG text.
pub(crate) fn svg(chart: &Chart, size: (u32, u32)) -> Result<String, PlotError> {
    let x = Coordinate { scale: chart.x.scale, ends: range::horizontal(chart)? };
    let y = Coordinate { scale: chart.y.scale, ends: range::vertical(chart)? };
    let mut text = String::new();
    draw(chart, (x, y), SVGBackend::with_string(&mut text, size))
        .map_err(|error| PlotError::Drawing(error.to_string()))?;
    Ok(with_dark(&text))
}

/// A text in place of a chart.
pub(crate) fn message(text: &str, (width, height): (u32, u32)) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    with_dark(&format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\" stroke=\"none\"/>\n\
         <text x=\"20\" y=\"40\" font-family=\"{FONT}\" fill=\"#000000\">{text}</text>\n</svg>\n"
    ))
}

/// With the style sheet of [`DARK`]: rules outweigh the attributes that `plotters` writes.
fn with_dark(svg: &str) -> String {
    let rule = |(light, dark): (&str, &str)| {
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    let rules = DARK.map(rule).concat();
    let style = format!("\n<style>@media (prefers-color-scheme:dark){{{rules}}}</style>");
    let (start, rest) = svg.split_at(svg.find('>').map_or(0, |end| end + 1));
    [start, &style, rest].concat()
}

fn draw<'b>(chart: &Chart, (x, y): (Coordinate, Coordinate), page: SVGBackend<'b>) -> Drawn<'b> {
    let root = page.into_drawing_area();
    root.fill(&WHITE)?;
    let mut builder = ChartBuilder::on(&root);
    builder.margin(14).x_label_area_size(44).y_label_area_size(76);
    if !chart.title.is_empty() {
        builder.caption(&chart.title, (FONT, 17));
    }
    let mut frame = builder.build_cartesian_2d(x, y)?;
    frame
        .configure_mesh()
        .x_desc(&chart.x.label)
        .y_desc(&chart.y.label)
        .label_style((FONT, 13))
        .axis_desc_style((FONT, 14))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(222, 222, 222))
        .draw()?;
    for (index, series) in chart.series.iter().enumerate() {
        draw_series(&mut frame, chart, series, COLOURS[index % COLOURS.len()])?;
    }
    if chart.series.iter().any(|series| !series.name.is_empty()) {
        frame
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .label_font((FONT, 13))
            .draw()?;
    }
    root.present()
}

fn draw_series<'a, 'b: 'a>(
    frame: &mut Frame<'a, 'b>,
    chart: &Chart,
    series: &Series,
    colour: RGBColor,
) -> Drawn<'b> {
    let line = colour.stroke_width(2);
    for run in runs(chart, series) {
        let points: Vec<(f64, f64)> = run.iter().map(|place| place.point).collect();
        draw_intervals(frame, series.mark, &run, colour)?;
        match series.mark {
            Mark::Line | Mark::LineAndPoints => {
                frame.draw_series(LineSeries::new(points.iter().copied(), line))?;
            }
            Mark::Dashes => {
                frame.draw_series(DashedLineSeries::new(points.iter().copied(), 7, 5, line))?;
            }
            Mark::Points => {}
        }
        if matches!(series.mark, Mark::Points | Mark::LineAndPoints) {
            let dot = |&point: &(f64, f64)| Circle::new(point, 3, colour.filled());
            frame.draw_series(points.iter().map(dot))?;
        }
    }
    if !series.name.is_empty() {
        // An empty series, for its entry in the legend.
        let entry =
            frame.draw_series(LineSeries::new(std::iter::empty(), line))?.label(&series.name);
        // As the series itself is drawn.
        let dash = move |from: i32, to: i32| PathElement::new([(from, 0), (to, 0)], line);
        let dot = move || Circle::new((9, 0), 3, colour.filled());
        match series.mark {
            Mark::Line => entry.legend(move |at| EmptyElement::at(at) + dash(0, 18)),
            Mark::Dashes => {
                entry.legend(move |at| EmptyElement::at(at) + dash(0, 7) + dash(12, 19))
            }
            Mark::Points => entry.legend(move |at| EmptyElement::at(at) + dot()),
            Mark::LineAndPoints => {
                entry.legend(move |at| EmptyElement::at(at) + dash(0, 18) + dot())
            }
        };
    }
    Ok(())
}

/// Shades a line's band, or draws points' intervals as bars.
fn draw_intervals<'b>(
    frame: &mut Frame<'_, 'b>,
    mark: Mark,
    run: &[Place],
    colour: RGBColor,
) -> Drawn<'b> {
    let intervals = || run.iter().filter_map(|place| Some((place.point.0, place.interval?)));
    if mark == Mark::Points {
        let bar =
            |(x, (low, high))| PathElement::new([(x, low), (x, high)], colour.stroke_width(1));
        frame.draw_series(intervals().map(bar))?;
        return Ok(());
    }
    let above = intervals().map(|(x, (_, high))| (x, high));
    let below = intervals().map(|(x, (low, _))| (x, low));
    let outline: Vec<(f64, f64)> = above.chain(below.rev()).collect();
    if !outline.is_empty() {
        frame.draw_series([Polygon::new(outline, colour.mix(SHADE).filled())])?;
    }
    Ok(())
}

/// A point that can be shown, with its interval as far as that can be shown.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    point: (f64, f64),
    interval: Option<(f64, f64)>,
}

/// The parts of a series between points that cannot be shown.
fn runs(chart: &Chart, series: &Series) -> Vec<Vec<Place>> {
    let place = |index: usize| {
        let point = series.points[index];
        let shown = chart.x.shows(point.0) && chart.y.shows(point.1);
        let within = |value: f64| if chart.y.shows(value) { value } else { point.1 };
        let interval = series.band.get(index).map(|&(low, high)| (within(low), within(high)));
        shown.then_some(Place { point, interval })
    };
    let places: Vec<Option<Place>> = (0..series.points.len()).map(place).collect();
    places
        .split(Option::is_none)
        .map(|run| run.iter().copied().flatten().collect::<Vec<_>>())
        .filter(|run| !run.is_empty())
        .collect()
}
