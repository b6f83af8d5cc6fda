//! What is written beside the arrays: enough to make them again, and to judge them.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use tpb_film::{Arrays, Ledger, Pulse, PulseReport, Quantity};
use tpb_lanes::Instructions;
use tpb_scene::{IntegratorSpec, Plan};

use crate::{RenderOptions, RunSummary};

/// An imbalance of the ledger beyond this is worth a warning.
const LEDGER_TOLERANCE: f64 = 1e-9;

/// `report.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// The program and its version.
    pub program: String,
    /// The widest vector instructions that the machine had: photon beams use them. Bits do not
    /// depend on them.
    #[serde(default)]
    pub vectors: String,
    /// What was rendered.
    pub scene: SceneRecord,
    /// How.
    pub method: MethodRecord,
    /// With which options, defaults filled in.
    pub options: RenderOptions,
    /// Into which arrays.
    pub film: FilmRecord,
    /// What the run did.
    pub run: RunSummary,
    /// Work per second.
    pub rates: Rates,
    /// Relative imbalance of the ledger of the run; `None` where it is empty.
    pub ledger_closure: Option<f64>,
    /// Contributions that were not finite and were kept out; 0 in a sound render.
    pub non_finite: u64,
    /// What the cells of the arrays, 32-bit floats, could not hold; `None` if they held everything.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub out_of_range: Option<String>,
    /// What the pulse did to the arrays.
    pub pulse: PulseReport,
    /// The most memory that the process held \[bytes\]; `None` where the system does not tell.
    pub peak_memory_bytes: Option<u64>,
    /// What the reader should know before using the result.
    pub warnings: Vec<String>,
    /// What the run needed and what it left out.
    pub plan: Value,
}

/// What was rendered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneRecord {
    /// The file, as it was named on the command line.
    pub file: String,
    /// Its content with all overrides and defaults applied.
    pub canonical: Value,
}

/// How it was rendered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodRecord {
    /// The method's name.
    pub name: String,
    /// Its effective options.
    pub options: Value,
    /// Deepest paths counted; `None` is unlimited.
    pub max_depth: Option<u32>,
    /// Shallowest paths counted.
    pub min_depth: u32,
    /// Depth from which Russian roulette may end a path.
    pub rr_depth: u32,
}

impl MethodRecord {
    /// A method with the depths of `integrator`.
    pub fn new(name: &str, options: Value, integrator: &IntegratorSpec) -> Self {
        let IntegratorSpec { max_depth, min_depth, rr_depth, .. } = *integrator;
        Self { name: name.to_owned(), options, max_depth, min_depth, rr_depth }
    }
}

/// Shape and contents of the arrays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilmRecord {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bins; 0 for a steady film.
    pub bins: usize,
    /// Channels.
    pub channels: usize,
    /// First and last edge of the bins \[m\].
    pub opl_window: Option<(f64, f64)>,
    /// What the cells hold.
    pub quantity: Quantity,
}

impl FilmRecord {
    /// Of these arrays.
    pub fn new(arrays: &Arrays) -> Self {
        let Arrays { width, height, bins, channels, quantity, ref opl_edges, .. } = *arrays;
        let opl_window = opl_edges.first().copied().zip(opl_edges.last().copied());
        Self { width, height, bins, channels, opl_window, quantity }
    }
}

/// Work per second of passes (setup excluded); what a method does not do stays 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rates {
    /// Camera paths or rays started.
    pub camera_paths_per_second: f64,
    /// Photons emitted.
    pub photon_paths_per_second: f64,
    /// Photons' vertices whose connection to the eye was tried.
    #[serde(default)]
    pub connections_per_second: f64,
    /// Ray-beam pairs tested.
    pub pairs_tested_per_second: f64,
    /// Ray-beam pairs that contributed.
    pub pairs_accepted_per_second: f64,
}

impl Rates {
    /// Of a run.
    pub fn new(run: &RunSummary) -> Self {
        let counts = &run.counts;
        Self {
            camera_paths_per_second: run.per_second(counts.camera_paths),
            photon_paths_per_second: run.per_second(counts.photon_paths),
            connections_per_second: run.per_second(counts.connections),
            pairs_tested_per_second: run.per_second(counts.pairs_tested),
            pairs_accepted_per_second: run.per_second(counts.pairs_accepted),
        }
    }
}

/// What a report is made of beside the options.
pub struct Outcome<'a> {
    /// What was rendered.
    pub scene: SceneRecord,
    /// How.
    pub method: MethodRecord,
    /// What the scene needs, of this method.
    pub plan: &'a Plan,
    /// What the run did.
    pub run: RunSummary,
    /// What the film kept out.
    pub non_finite: u64,
    /// What came out.
    pub arrays: &'a Arrays,
    /// What the pulse did.
    pub pulse: PulseReport,
}

impl Report {
    /// The report of a render. `program` is its name and version.
    pub fn new(program: &str, options: RenderOptions, outcome: Outcome<'_>) -> Self {
        let Outcome { scene, method, plan, run, non_finite, arrays, pulse } = outcome;
        let ledger_closure = closure(&run.ledger.mean_of_a_pass);
        let mut report = Self {
            program: program.to_owned(),
            vectors: Instructions::widest().name().to_owned(),
            scene,
            method,
            options,
            film: FilmRecord::new(arrays),
            rates: Rates::new(&run),
            ledger_closure,
            run,
            non_finite,
            out_of_range: arrays.out_of_range(options.pulse == Pulse::Delta),
            pulse,
            peak_memory_bytes: crate::peak_memory(),
            warnings: Vec::new(),
            plan: serde_json::to_value(plan).unwrap_or_default(),
        };
        report.warnings = lost_light(plan);
        report.warnings.extend(report.find_warnings());
        report
    }

    /// Whether nothing was kept out, the ledger closes, and the arrays hold what the film holds.
    pub fn is_sound(&self) -> bool {
        self.non_finite == 0
            && self.ledger_closure.is_none_or(|c| c.abs() <= LEDGER_TOLERANCE)
            && self.out_of_range.is_none()
    }

    fn find_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.non_finite > 0 {
            let count = self.non_finite;
            warnings.push(format!(
                "{count} contributions were not finite and were kept out: the result lacks them"
            ));
        }
        if let Some(closure) = self.ledger_closure.filter(|c| c.abs() > LEDGER_TOLERANCE) {
            warnings.push(format!(
                "the ledger of {} does not close: off by {closure:.1e}",
                self.run.ledger.carrier
            ));
        }
        warnings.extend(self.out_of_range.clone());
        if self.options.variance && self.options.pulse != Pulse::Delta {
            warnings.push("no variance: it is known for the delta pulse only".to_owned());
        } else if self.options.variance && self.run.passes < 2 {
            warnings.push("no variance: it needs at least two passes".to_owned());
        }
        if self.run.interrupted {
            warnings.push("interrupted before the budget was used up".to_owned());
        }
        warnings
    }
}

/// What of the light the method leaves out.
fn lost_light(plan: &Plan) -> Vec<String> {
    let lost = plan.left_out.iter().filter(|item| item.loses_light);
    lost.map(|item| format!("the image lacks {}: {}", item.part, item.reason)).collect()
}

/// How far the ledger is from closing, if there is any light in it.
fn closure(ledger: &Ledger) -> Option<f64> {
    (*ledger != Ledger::default()).then(|| ledger.closure())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Counts, LedgerRecord};

    fn report(ledger: Ledger, non_finite: u64, options: RenderOptions) -> Report {
        let run = RunSummary {
            passes: 1,
            wall_seconds: 3.0,
            setup_seconds: 1.0,
            counts: Counts { camera_paths: 100, ..Counts::default() },
            ledger: LedgerRecord { carrier: "light [W]".to_owned(), mean_of_a_pass: ledger },
            interrupted: true,
            ..RunSummary::default()
        };
        Report {
            program: "test".to_owned(),
            vectors: "scalar".to_owned(),
            scene: SceneRecord::default(),
            method: MethodRecord::default(),
            options,
            film: FilmRecord {
                width: 1,
                height: 1,
                bins: 0,
                channels: 1,
                opl_window: None,
                quantity: Quantity::BinEnergy,
            },
            rates: Rates::new(&run),
            run,
            ledger_closure: closure(&ledger),
            non_finite,
            out_of_range: None,
            pulse: PulseReport {
                guard_bins_start: 0,
                guard_bins_end: 0,
                relative_error_bound: 0.0,
            },
            peak_memory_bytes: crate::peak_memory(),
            warnings: Vec::new(),
            plan: Value::Null,
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let leaking = Ledger { emitted: 1.0, escaped: 0.9, ..Ledger::default() };
        let options = RenderOptions { variance: true, ..RenderOptions::default() };
        let warnings = report(leaking, 3, options).find_warnings().join("\n");
        for part in ["3 contributions", "does not close", "two passes", "interrupted"] {
            assert!(warnings.contains(part), "{part} is missing in\n{warnings}");
        }
        let sound = report(Ledger::default(), 0, RenderOptions::default());
        assert!(sound.is_sound() && sound.ledger_closure.is_none());
        assert!(!report(leaking, 0, options).is_sound());
        let dark = Report { out_of_range: Some("too dark".to_owned()), ..sound.clone() };
        assert!(!dark.is_sound() && dark.find_warnings().contains(&"too dark".to_owned()));
        assert_eq!(sound.find_warnings().len(), 1, "only the interruption");
        assert_eq!(sound.rates.camera_paths_per_second, 50.0, "setup does not count");
    }

    #[test]
    fn it_survives_json() {
        let report = report(Ledger::default(), 0, RenderOptions::default());
        let text = serde_json::to_string_pretty(&report).unwrap();
        assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), report);
    }
}
