//! Floor 0: line charts as SVG text, by `plotters`: what the project's programs draw.
//!
//! A [`Chart`] is plain data: two [`Axis`], any number of [`Series`]. [`Chart::svg`] draws it; the
//! text depends on nothing but the data, so that it can be compared and kept. A chart holds numbers
//! without units: labels say them.
//!
//! Values that cannot be shown — NaN, infinities, and what is not positive on a logarithmic axis —
//! leave a gap in their line. An axis without a range covers the finite values of all series.
//!
//! Charts are light, and dark where the reader's system is: a style sheet inside the SVG tells the other
//! colours, also where a page shows it as an image.
//!
//! Not handled: bars, maps of colours, dates, more than one chart on a page.

mod coordinate;
mod draw;
mod range;

/// A chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Title above it; none if empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the first at the bottom.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What it shows, with the unit.
    pub label: String,
    /// How values are placed.
    pub scale: Scale,
    /// Its ends; by default those of the data.
    pub range: Option<(f64, f64)>,
}

/// How values are placed along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm; only positive values are shown.
    Logarithmic,
}

/// A curve or a set of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend; none if empty.
    pub name: String,
    /// Points (x, y), in the order in which a line joins them.
    pub points: Vec<(f64, f64)>,
    /// Lower and upper end of each point's interval; empty, or as many as points.
    pub band: Vec<(f64, f64)>,
    /// How it is drawn.
    pub mark: Mark,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// A line; its band is shaded.
    #[default]
    Line,
    /// A broken line, for predictions.
    Dashes,
    /// Points; their intervals are bars.
    Points,
    /// A line with points.
    LineAndPoints,
}

/// Why a chart cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// No value of any series can be shown on an axis.
    #[error("the {axis} axis has no value that it can show")]
    Empty {
        /// Which axis.
        axis: &'static str,
    },
    /// An axis was given ends that make no range.
    #[error("the {axis} axis cannot run from {start} to {end}")]
    Range {
        /// Which axis.
        axis: &'static str,
        /// Its first end.
        start: f64,
        /// Its other end.
        end: f64,
    },
    /// A series has a band of another length than its points.
    #[error("series '{series}' has {points} points and {band} intervals")]
    Band {
        /// Its name.
        series: String,
        /// How many points.
        points: usize,
        /// How many intervals.
        band: usize,
    },
    /// The drawing library failed.
    #[error("cannot draw: {0}")]
    Drawing(String),
}

impl Axis {
    /// A linear axis over the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis over the data.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Logarithmic, range: None }
    }

    /// Whether a value has a place on it.
    fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }
}

impl Series {
    /// A series without intervals.
    pub fn new(name: impl Into<String>, mark: Mark, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, band: Vec::new(), mark }
    }

    /// With an interval for each point.
    #[must_use]
    pub fn with_band(mut self, band: Vec<(f64, f64)>) -> Self {
        self.band = band;
        self
    }
}

impl Chart {
    /// Draws it, `size` pixels wide and high.
    ///
    /// # Errors
    /// [`PlotError`] if there is nothing to show, a given range is not one, or a band has another
    /// length than its series.
    pub fn svg(&self, size: (u32, u32)) -> Result<String, PlotError> {
        for series in &self.series {
            let (points, band) = (series.points.len(), series.band.len());
            if band != 0 && band != points {
                return Err(PlotError::Band { series: series.name.clone(), points, band });
            }
        }
        draw::svg(self, size)
    }
}

/// A text where a chart would be, of the same looks: for data without anything to show.
pub fn message(text: &str, size: (u32, u32)) -> String {
    draw::message(text, size)
}

#[cfg(test)]
mod tests;
