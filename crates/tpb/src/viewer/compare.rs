//! `tpb compare`: error numbers of results against one of them, and their page.

use std::process::ExitCode;

use tpb_film::Arrays;
use tpb_viewer::{Comparison, Loaded, Ruling, bring_together, load_mask};

use super::alike::{check, remark_shared};
use super::input::{Input, keys, name, read_all};
use super::numbers::{Judged, Verdicts};
use super::{CompareArgs, describe, open_page, write_page};
use crate::failure::Failure;
use crate::print;

/// Reads, judges, writes, prints.
pub(crate) fn run(args: &CompareArgs) -> Result<ExitCode, Failure> {
    let paths = [Some(&args.a), Some(&args.b), args.reference.as_ref()];
    let paths: Vec<_> = paths.into_iter().flatten().collect();
    let mut inputs = read_all(&paths, &args.labels, "labels are in the order A, B, reference")?;
    let mut loaded: Vec<&mut Loaded> = inputs.iter_mut().map(|input| &mut input.loaded).collect();
    let timed = bring_together(&mut loaded)?;
    check(&mut inputs)?;
    // Without a reference of its own, the first judges the second.
    let reference = if args.reference.is_some() { 2 } else { 0 };
    remark_shared(&mut inputs, reference);
    let truth = &inputs[reference].loaded.arrays;
    let mask = args.mask.as_deref().map(|file| load_mask(file, truth)).transpose()?;
    let verdicts = Verdicts {
        inputs: &inputs,
        reference,
        judged: judge(&inputs, reference, mask.as_deref()),
        mask: args.mask.as_deref().zip(mask.as_deref()),
        notes: notes(args, truth, mask.as_deref()),
    };
    let page = if args.no_page {
        None
    } else {
        let mut comparison = comparison(args, &inputs, reference);
        comparison.notes.clone_from(&verdicts.notes);
        comparison.judged_label = mask_label(args);
        comparison.judged.clone_from(&mask);
        comparison.timed = timed;
        comparison.budget_bytes = args.page.budget_bytes();
        let default = format!("compare-{}-{}", name(&args.a), name(&args.b));
        Some(write_page(&comparison, &default, &args.page)?)
    };
    if args.json {
        let path = page.as_ref().map(|(path, report)| (path.as_path(), report));
        print::out(&verdicts.as_json(path))?;
    } else {
        let page = page.as_ref().map(|(path, report)| describe(path, report));
        print::out(&verdicts.as_text(page.as_deref()))?;
    }
    if let Some((path, _)) = &page {
        open_page(path, &args.page)?;
    }
    let sound = inputs.iter().all(|input| input.loaded.is_sound());
    Ok(if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn judge(inputs: &[Input], reference: usize, mask: Option<&[bool]>) -> Vec<Judged> {
    let others = (0..inputs.len()).filter(|&index| index != reference);
    others.map(|index| Judged::new(index, &inputs[index], &inputs[reference], mask)).collect()
}

/// The mask's pixels in words.
fn mask_label(args: &CompareArgs) -> String {
    let file = args.mask.as_ref().map(|file| file.display().to_string());
    file.map_or_else(String::new, |file| format!("pixels in {file}"))
}

/// What else to know about the numbers.
fn notes(args: &CompareArgs, truth: &Arrays, mask: Option<&[bool]>) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(mask) = mask {
        let counted = mask.iter().filter(|counts| **counts).count();
        notes.push(format!("{}: {counted} of {}", mask_label(args), mask.len()));
    }
    if let Some(ruling) = Ruling::of(truth, mask) {
        let way_out = if mask.is_some() { "" } else { "; --mask counts others alone" };
        notes.push(format!("{ruling}{way_out}"));
    }
    notes
}

fn comparison<'a>(args: &CompareArgs, inputs: &'a [Input], reference: usize) -> Comparison<'a> {
    let keys = keys(inputs);
    let methods = inputs.iter().zip(&keys).enumerate();
    let methods = methods
        .map(|(index, (input, key))| {
            let mut method = input.method(key);
            method.is_reference = index == reference;
            method.independent = method.is_reference || input.independent_of(&inputs[reference]);
            method
        })
        .collect();
    let names = || format!("{} and {}", inputs[0].label, inputs[1].label);
    let scene = inputs.iter().find_map(Input::scene);
    Comparison::new(args.title.clone().or(scene).unwrap_or_else(names), methods)
}
