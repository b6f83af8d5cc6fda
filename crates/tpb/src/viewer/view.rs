//! `tpb view`: results as a page, side by side and unjudged.

use std::process::ExitCode;

use tpb_viewer::{Comparison, bring_together};

use super::alike::check;
use super::input::{Input, keys, name, read_all};
use super::{ViewArgs, describe, open_page, write_page};
use crate::failure::Failure;
use crate::print;
use crate::summary::Lines;

/// What the page says of several results.
const UNJUDGED: &str = "No result here is a reference: none of them judges the others.";

/// Reads, writes, opens.
pub(crate) fn run(args: &ViewArgs) -> Result<ExitCode, Failure> {
    let paths: Vec<_> = args.results.iter().collect();
    let mut inputs = read_all(&paths, &args.labels, "labels are in the order of the results")?;
    let timed =
        bring_together(&mut inputs.iter_mut().map(|input| &mut input.loaded).collect::<Vec<_>>())?;
    check(&mut inputs)?;
    let labels: Vec<&str> = inputs.iter().map(|input| input.label.as_str()).collect();
    let scene = inputs.iter().find_map(Input::scene);
    let title = args.title.clone().or(scene).unwrap_or_else(|| labels.join(", "));
    let single = ["result".to_owned()];
    let keys = if inputs.len() == 1 { single.to_vec() } else { keys(&inputs) };
    let methods = inputs.iter().zip(&keys).map(|(input, key)| input.method(key)).collect();
    let mut comparison = Comparison::new(title, methods);
    comparison.timed = timed;
    comparison.budget_bytes = args.page.budget_bytes();
    comparison.notes.extend((inputs.len() > 1).then(|| UNJUDGED.to_owned()));
    comparison.notes.extend_from_slice(&args.notes);
    let default: Vec<String> = paths.iter().map(|path| name(path)).collect();
    let (path, report) = write_page(&comparison, &default.join("-"), &args.page)?;
    let mut lines = Lines::default();
    lines.add("page", &describe(&path, &report));
    for remark in inputs.iter().flat_map(|input| &input.loaded.remarks) {
        lines.add("WARNING", remark);
    }
    print::out(&lines.text())?;
    open_page(&path, &args.page)?;
    let sound = inputs.iter().all(|input| input.loaded.is_sound());
    Ok(if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
