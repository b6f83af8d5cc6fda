//! The analytic solutions against every row of every shipped table.
//!
//! The tables were computed elsewhere in higher precision; a solution that misses its table cannot
//! judge anything. No chance is involved.

use std::sync::Arc;

use tpb_reference::tables::{TableReport, Verdict, evaluate_directory};

use crate::error::Result;
use crate::experiment::{Context, Experiment, Kind, Outcome};
use crate::registry::Experiments;

/// All tables.
pub struct Tables;

/// The one experiment.
pub fn all() -> Experiments {
    vec![Arc::new(Tables)]
}

impl Experiment for Tables {
    fn name(&self) -> String {
        "tables".into()
    }

    fn description(&self) -> String {
        "analytic solutions against every row of every table".into()
    }

    fn kind(&self) -> Kind {
        Kind::Exact
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let reports = evaluate_directory(&context.data.join("tables"))?;
        let of = |verdict: Verdict| reports.iter().filter(move |r| r.verdict() == verdict);
        let (passed, unknown) = (of(Verdict::Passed).count(), of(Verdict::Unknown).count());
        let rows: usize = of(Verdict::Passed).map(|report| report.rows).sum();
        let mut notes =
            vec![format!("{passed} tables of {rows} rows; {unknown} without a solution")];
        notes.extend(of(Verdict::Failed).map(|report| format!("{} is missed", report.name)));
        let all_met = passed > 0 && of(Verdict::Failed).count() == 0;
        let worst = of(Verdict::Passed).filter_map(worst_error).fold(0.0, f64::max);
        Ok(Outcome::exact(all_met, notes).with_interval([-worst, worst]))
    }
}

fn worst_error(report: &TableReport) -> Option<f64> {
    Some(report.comparison.as_ref()?.worst.as_ref()?.relative_error)
}
