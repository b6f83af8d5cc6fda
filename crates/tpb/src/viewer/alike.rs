//! What the reports of results say about comparing them.

use super::command::{command, pulse};
use super::input::Input;
use crate::failure::Failure;

/// Refuses results whose cells mean different things: other pulses, other zeros of time. What no
/// report tells is remarked upon where it may matter.
pub(super) fn check(inputs: &mut [Input]) -> Result<(), Failure> {
    let reported = || inputs.iter().filter_map(|input| Some((input, input.report.as_ref()?)));
    let Some((first, report)) = reported().next() else { return Ok(()) };
    for (other, its) in reported().skip(1) {
        let options = [&report.options, &its.options];
        if options[0].unwarp != options[1].unwarp {
            let (with, without) =
                if report.options.unwarp { (first, other) } else { (other, first) };
            let again = without.report.as_ref().map_or_else(String::new, command);
            return Err(Failure::with_help(
                format!(
                    "{} was rendered with --unwarp, {} without: their times start at different \
                     places",
                    with.label, without.label
                ),
                format!("render both alike: {again} --unwarp"),
            ));
        }
        if options[0].pulse != options[1].pulse {
            return Err(Failure::with_help(
                format!(
                    "{} has the pulse {}, {} has {}",
                    first.label,
                    pulse(options[0].pulse),
                    other.label,
                    pulse(options[1].pulse)
                ),
                "render both with the same --pulse",
            ));
        }
    }
    if report.options.unwarp {
        let remark = format!(
            "no report tells whether its times leave out the leg from the eye to the first surface, \
             as those of {} do (--unwarp)",
            first.label
        );
        for input in inputs.iter_mut().filter(|input| input.report.is_none()) {
            input.loaded.remarks.push(remark.clone());
        }
    }
    Ok(())
}

/// Remarks upon results that share random numbers with the reference: passes depend on method, seed
/// and index alone, so that what was rendered twice errs alike.
pub(super) fn remark_shared(inputs: &mut [Input], reference: usize) {
    for index in (0..inputs.len()).filter(|&index| index != reference) {
        if inputs[index].independent_of(&inputs[reference]) {
            continue;
        }
        let remark = format!(
            "method and seed are those of the reference, {}: both consist of the same random passes, \
             errors are too small and noise cannot be told from bias; render one with another --seed",
            inputs[reference].label
        );
        inputs[index].loaded.remarks.push(remark);
    }
}
