//! `tpb view`: one result as a page.

use std::process::ExitCode;

use tpb_viewer::{Comparison, bring_together};

use super::input::{Input, name};
use super::{ViewArgs, describe, open_page, write_page};
use crate::failure::Failure;
use crate::print;
use crate::summary::Lines;

/// Reads, writes, opens.
pub(crate) fn run(args: &ViewArgs) -> Result<ExitCode, Failure> {
    let mut input = Input::read(&args.result, None)?;
    let timed = bring_together(&mut [&mut input.loaded])?;
    let title = args.title.clone().or_else(|| input.scene()).unwrap_or_else(|| input.label.clone());
    let mut comparison = Comparison::new(title, vec![input.method("result")]);
    comparison.timed = timed;
    comparison.budget_bytes = args.page.budget_bytes();
    let (path, report) = write_page(&comparison, &name(&args.result), &args.page)?;
    let mut lines = Lines::default();
    lines.add("page", &describe(&path, &report));
    for remark in &input.loaded.remarks {
        lines.add("WARNING", remark);
    }
    print::out(&lines.text())?;
    open_page(&path, &args.page)?;
    let sound = input.loaded.is_sound();
    Ok(if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
