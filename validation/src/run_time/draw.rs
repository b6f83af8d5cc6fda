//! Error against run time as charts.

use tpb_plot::{Axis, Chart, Mark, PlotError, Series};

use super::{Checkpoint, Curve, ErrorAgainstTime};
use crate::statistics::split::Estimate;

/// Which seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Of the wall.
    Wall,
    /// Of all processors together.
    Cpu,
}

/// Pixels of a chart.
const SIZE: (u32, u32) = (760, 480);

impl ErrorAgainstTime {
    /// NMSE of all methods with its interval, and its squared bias where that is resolved.
    ///
    /// # Errors
    /// If no error is positive.
    pub fn error_chart(&self, clock: Clock) -> Result<String, PlotError> {
        self.chart("NMSE", clock, |curve| {
            let error = series(&curve.method, Mark::LineAndPoints, curve, clock, |c| c.nmse);
            let name = format!("{}: bias\u{b2}", curve.method);
            let resolved = |point: &&Checkpoint| point.squared_bias.interval[0] > 0.0;
            let points = curve.checkpoints.iter().filter(resolved);
            let points: Vec<(f64, f64)> =
                points.map(|c| (seconds(c, clock), c.squared_bias.value)).collect();
            let bias = (!points.is_empty()).then(|| Series::new(name, Mark::Dashes, points));
            [Some(error), bias].into_iter().flatten().collect()
        })
    }

    /// Variance times CPU seconds of all methods.
    ///
    /// # Errors
    /// If no variance is positive.
    pub fn efficiency_chart(&self) -> Result<String, PlotError> {
        self.chart("variance \u{d7} CPU time [s]", Clock::Cpu, |curve| {
            let of = |c: &Checkpoint| c.inverse_efficiency;
            vec![series(&curve.method, Mark::LineAndPoints, curve, Clock::Cpu, of)]
        })
    }

    fn chart(
        &self,
        what: &str,
        clock: Clock,
        of: impl Fn(&Curve) -> Vec<Series>,
    ) -> Result<String, PlotError> {
        let time =
            if clock == Clock::Wall { "wall time [s]" } else { "CPU time of all threads [s]" };
        Chart {
            title: format!("{} ({} runs each, 95 % intervals)", self.scene, self.replicates),
            x: Axis::logarithmic(time),
            y: Axis::logarithmic(what),
            series: self.curves.iter().flat_map(of).collect(),
        }
        .svg(SIZE)
    }
}

fn series(
    name: &str,
    mark: Mark,
    curve: &Curve,
    clock: Clock,
    of: impl Fn(&Checkpoint) -> Estimate,
) -> Series {
    let estimates = || curve.checkpoints.iter().map(|c| (seconds(c, clock), of(c)));
    let points = estimates().map(|(time, estimate)| (time, estimate.value)).collect();
    let band = estimates().map(|(_, estimate)| (estimate.interval[0], estimate.interval[1]));
    Series::new(name, mark, points).with_band(band.collect())
}

fn seconds(checkpoint: &Checkpoint, clock: Clock) -> f64 {
    if clock == Clock::Wall { checkpoint.wall_seconds } else { checkpoint.cpu_seconds }
}
