//! All experiments: one line adds one.

use crate::experiment::{Effort, Experiment, Sabotage, Twin};
use crate::experiments::energy::SumOfBins;
use crate::experiments::equal_time::EqualTimeRun;
use crate::experiments::fresnel::FresnelChoice;
use crate::experiments::kernels::KernelPairs;
use crate::experiments::samplers::Samplers;
use crate::experiments::single_scatter::{SingleScatter, Who};
use crate::experiments::sphere::SphereOrder;
use crate::experiments::tables::Tables;

/// The experiments of a run, in their order.
pub fn experiments(effort: Effort) -> Vec<Box<dyn Experiment>> {
    let mut list: Vec<Box<dyn Experiment>> = vec![Box::new(Tables)];
    list.extend(Samplers::ALL.map(|group| Box::new(group) as Box<dyn Experiment>));
    list.push(Box::new(KernelPairs::OneD));
    list.push(Box::new(KernelPairs::TwoD));
    list.push(Box::new(SumOfBins::Path));
    list.push(Box::new(SumOfBins::Beams));
    list.push(Box::new(FresnelChoice::Path));
    list.push(Box::new(FresnelChoice::Beams));
    for order in 1..=effort.pick(4, 8) {
        list.push(Box::new(SphereOrder::new(order)));
    }
    list.push(Box::new(SingleScatter::new(Who::Path, 0.0)));
    list.push(Box::new(SingleScatter::new(Who::Path, 0.6)));
    list.push(Box::new(SingleScatter::new(Who::Beams1d, 0.0)));
    list.push(Box::new(SingleScatter::new(Who::Beams1d, 0.6)));
    list.push(Box::new(SingleScatter::new(Who::Beams2d, 0.0)));
    list.extend(controls(effort));
    list.push(Box::new(EqualTimeRun {
        scene: "cornell-blocks",
        beams_win: true,
        path_complete: true,
    }));
    if effort == Effort::Full {
        let caustic =
            |scene, path_complete| EqualTimeRun { scene, beams_win: false, path_complete };
        list.push(Box::new(caustic("mirror-caustic", true)));
        list.push(Box::new(caustic("mirror-caustic-point", false)));
    }
    list
}

/// Sabotaged twins, which must be rejected.
fn controls(effort: Effort) -> Vec<Box<dyn Experiment>> {
    let single = |who, sabotage| Twin::new(sabotage, SingleScatter::new(who, 0.0).with(sabotage));
    let (sigma, late) = (Sabotage::SigmaS(1.01), Sabotage::TimeShift(0.5));
    let sphere = SphereOrder { order: 3, sabotage: Some(late) };
    let mut list: Vec<Box<dyn Experiment>> = vec![
        Box::new(single(Who::Path, sigma)),
        Box::new(Twin::new(late, sphere)),
        Box::new(single(Who::Beams1d, Sabotage::KernelNormalisation(1.02))),
    ];
    if effort == Effort::Full {
        list.push(Box::new(single(Who::Beams2d, Sabotage::KernelNormalisation(1.02))));
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_three_kinds_of_sabotage_are_tried() {
        for effort in [Effort::Quick, Effort::Full] {
            let names: Vec<String> = experiments(effort).iter().map(|e| e.name()).collect();
            let unique: BTreeSet<&String> = names.iter().collect();
            assert_eq!(unique.len(), names.len(), "{names:?}");
            for kind in ["sigma-s", "time-shift", "kernel-normalisation"] {
                assert!(names.iter().any(|name| name.starts_with(&format!("control/{kind}/"))));
            }
        }
    }
}
