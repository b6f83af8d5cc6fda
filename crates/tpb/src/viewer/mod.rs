//! `tpb view` and `tpb compare`: results as a page that opens from a file, and their error numbers.

mod alike;
mod args;
mod command;
mod compare;
mod input;
mod numbers;
mod view;

use std::path::{Path, PathBuf};

use tpb_viewer::{Comparison, PageReport, ViewerError, write_comparison};

pub(crate) use args::{CompareArgs, ViewArgs};
pub(crate) use command::{command, pulse as pulse_name};
pub(crate) use compare::run as compare;
pub(crate) use input::{Input, name};
pub(crate) use view::run as view;

use crate::failure::Failure;
use args::PageArgs;

impl From<ViewerError> for Failure {
    fn from(error: ViewerError) -> Self {
        let message = error.to_string();
        match error {
            ViewerError::Mismatch(_) => {
                Self::with_help(message, "render them with the same film, pulse and window")
            }
            ViewerError::Budget { .. } => Self::with_help(message, "--budget sets it, in MB"),
            _ => Self::input(message),
        }
    }
}

/// Writes the page and, if asked for, opens it. Returns where it is and what became of it.
fn write_page(
    comparison: &Comparison<'_>,
    default: &str,
    args: &PageArgs,
) -> Result<(PathBuf, PageReport), Failure> {
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{default}.html")));
    let report = write_comparison(&path, comparison)?;
    Ok((path, report))
}

/// Opens a page that is written, if asked for.
fn open_page(path: &Path, args: &PageArgs) -> Result<(), Failure> {
    if !args.open {
        return Ok(());
    }
    open::that_detached(path).map_err(|error| {
        let message = format!("the page is written, but no browser could be started: {error}");
        Failure::with_help(message, format!("open {} by hand", path.display()))
    })
}

/// What is shown of what was rendered.
fn describe(path: &Path, report: &PageReport) -> String {
    let size = report.bytes as f64 / 1e6;
    let shape = |[rows, columns, bins]: [usize; 3]| format!("({rows}, {columns}, {bins})");
    let shown = if report.shown == report.rendered {
        "all cells".to_owned()
    } else {
        let (pixels, bins) = (report.factors.pixels, report.factors.bins);
        format!(
            "{} of {} (rows, columns, bins): means over {pixels} x {pixels} pixels, sums over \
             {bins} bins",
            shape(report.shown),
            shape(report.rendered)
        )
    };
    format!("{}: {size:.1} MB, {shown}", path.display())
}
