//! All experiments: one line adds one.
//!
//! Each module of [`crate::experiments`] lists its own; the twins follow their experiment.

use std::sync::Arc;

use crate::experiment::{Effort, Experiment, Kind};
use crate::experiments::{
    blur, calibration, echoes, energy, equal_time, even_spread, fresnel, furnace, glass,
    infinite_medium, kernels, lens, mirrors, progressive, refraction, samplers, slab, sphere, spot,
    standard_error, tables,
};
use crate::matrix;
use crate::sabotage::Twin;
use crate::suite::SUITE_LEVEL;

/// A list of experiments.
pub type Experiments = Vec<Arc<dyn Experiment>>;

/// The experiments of a run in their order, each with its twins.
pub fn experiments(effort: Effort) -> Experiments {
    let mut list = Experiments::new();
    for experiment in sound(effort) {
        let twin = |sabotage| Arc::new(Twin::new(sabotage, experiment.clone())) as _;
        let twins: Experiments = experiment.twins(effort).into_iter().map(twin).collect();
        list.push(experiment);
        list.extend(twins);
    }
    list
}

/// The share of the suite's false-alarm probability that each experiment has, whichever are run.
pub fn level(effort: Effort) -> f64 {
    let by_chance = |e: &&Arc<dyn Experiment>| e.kind() != Kind::Exact;
    SUITE_LEVEL / sound(effort).iter().filter(by_chance).count() as f64
}

fn sound(effort: Effort) -> Experiments {
    [
        calibration::all(),
        tables::all(),
        samplers::all(effort),
        kernels::all(),
        energy::all(),
        standard_error::all(),
        fresnel::all(),
        echoes::all(effort),
        refraction::all(effort),
        mirrors::all(effort),
        infinite_medium::all(effort),
        lens::all(effort),
        glass::all(effort),
        slab::all(effort),
        sphere::all(effort),
        spot::all(effort),
        furnace::all(effort),
        matrix::all(effort),
        even_spread::all(),
        blur::all(effort),
        progressive::all(effort),
        equal_time::all(effort),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::sabotage::Sabotage;

    #[test]
    fn names_are_unique() {
        for effort in [Effort::Quick, Effort::Full] {
            let names: Vec<String> = experiments(effort).iter().map(|e| e.name()).collect();
            let unique: BTreeSet<&String> = names.iter().collect();
            assert_eq!(unique.len(), names.len(), "{names:?}");
        }
    }

    #[test]
    fn every_experiment_that_rests_on_chance_has_a_twin() {
        for experiment in sound(Effort::Full) {
            let twins = experiment.twins(Effort::Full).len();
            match experiment.kind() {
                Kind::Statistical => assert!(twins > 0, "{} has no twin", experiment.name()),
                Kind::SelfControlled | Kind::Exact => {}
                Kind::Twin => panic!("{} is a twin of nothing", experiment.name()),
            }
        }
    }

    #[test]
    fn every_kind_of_sabotage_is_tried() {
        let names: Vec<String> = experiments(Effort::Full).iter().map(|e| e.name()).collect();
        for label in Sabotage::LABELS {
            let tried = names.iter().any(|name| name.starts_with(&format!("control/{label}/")));
            assert!(tried, "{label}");
        }
        let quick = experiments(Effort::Quick);
        assert!(quick.iter().any(|e| e.kind() == Kind::Twin));
    }

    #[test]
    fn shares_add_up_to_the_level_of_the_suite() {
        for effort in [Effort::Quick, Effort::Full] {
            let by_chance = sound(effort).iter().filter(|e| e.kind() != Kind::Exact).count();
            let sum = by_chance as f64 * level(effort);
            assert!((sum / SUITE_LEVEL - 1.0).abs() < 1e-12);
        }
    }
}
