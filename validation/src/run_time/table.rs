//! Error against run time as text.

use super::{Checkpoint, Curve, ErrorAgainstTime};
use crate::statistics::split::Estimate;

impl ErrorAgainstTime {
    /// A table for people, one line each.
    pub fn table(&self) -> Vec<String> {
        let mut lines = vec![format!(
            "{}: {} runs of each method on {} threads; reference of {:.0} CPU s, own NMSE {:.1e}; {} of {} pixels judged",
            self.scene,
            self.replicates,
            self.threads,
            self.reference.cpu_seconds.unwrap_or(0.0),
            self.reference_nmse,
            self.pixels[0],
            self.pixels[1],
        )];
        lines.push(format!(
            "  {:<8} {:>6} {:>8} {:>8} {:>9} {:>29} {:>29} {:>31} {:>12}",
            "method",
            "passes",
            "wall s",
            "CPU s",
            "RMSE",
            "NMSE",
            "variance",
            "bias^2",
            "variance*s"
        ));
        for curve in &self.curves {
            lines.extend(curve.checkpoints.iter().map(|checkpoint| row(&curve.method, checkpoint)));
            lines.push(format!("  {:<8} {}", curve.method, slopes(curve)));
        }
        lines
    }
}

fn row(method: &str, point: &Checkpoint) -> String {
    format!(
        "  {method:<8} {:>6} {:>8.3} {:>8.3} {:>9.2e} {:>29} {:>29} {:>31} {:>12.3e}",
        point.passes,
        point.wall_seconds,
        point.cpu_seconds,
        point.rmse.value,
        interval(&point.nmse),
        interval(&point.variance),
        interval(&point.squared_bias),
        point.inverse_efficiency.value,
    )
}

fn slopes(curve: &Curve) -> String {
    let text = |slope: &Option<Estimate>| {
        slope.map_or("not resolved".to_owned(), |s| {
            format!("{:.2} [{:.2}, {:.2}]", s.value, s.interval[0], s.interval[1])
        })
    };
    format!(
        "slope of NMSE against CPU time {}, of its variance {}; preparation {:.3} s",
        text(&curve.slope),
        text(&curve.variance_slope),
        curve.setup_seconds
    )
}

fn interval(estimate: &Estimate) -> String {
    let Estimate { value, interval: [low, high], .. } = estimate;
    format!("{value:.2e} [{low:.1e}, {high:.1e}]")
}
