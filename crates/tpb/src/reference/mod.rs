//! `tpb reference`: analytic solutions, as numbers and curves.
//!
//! A request ([`request`]) is checked against what the solution takes before anything is computed;
//! then each point of the sweep is evaluated ([`curve`]) and written ([`output`]). Points without
//! a value, such as those on a wavefront, are left empty and counted.

mod curve;
mod list;
mod output;
mod request;

use std::path::Path;
use std::process::ExitCode;

use tpb_film::atomic_write;
use tpb_reference::registry::{self, Solution};

use crate::cli::{ReferenceArgs, ReferenceFormat};
use crate::failure::Failure;
use crate::print;
use curve::Curve;
use request::Request;

/// Lists or evaluates.
pub(crate) fn run(args: &ReferenceArgs) -> Result<ExitCode, Failure> {
    let chosen = args.name.as_deref().map(find).transpose()?;
    let format = format(args);
    if args.list {
        let text = match format {
            ReferenceFormat::Json => list::as_json(chosen),
            ReferenceFormat::Csv => list::as_text(chosen),
            ReferenceFormat::Svg => return Err(Failure::input("a list cannot be drawn")),
        };
        deliver(args.output.as_deref(), &text)?;
        return Ok(ExitCode::SUCCESS);
    }
    let Some(solution) = chosen else {
        return Err(Failure::with_help("no solution is named", LIST_HELP));
    };
    let request = Request::new(solution, args)?;
    let curve = Curve::evaluate(&request)?;
    if let Some(note) = curve.note() {
        print::err(&note);
    }
    if let Some(path) = &args.plot {
        write(path, &output::svg(&request, &curve, args)?)?;
    }
    let text = match format {
        ReferenceFormat::Csv => output::csv(&request, &curve),
        ReferenceFormat::Json => output::json(&request, &curve),
        ReferenceFormat::Svg => output::svg(&request, &curve, args)?,
    };
    deliver(args.output.as_deref(), &text)?;
    Ok(ExitCode::SUCCESS)
}

const LIST_HELP: &str = "tpb reference --list names all solutions";

fn find(name: &str) -> Result<&'static Solution, Failure> {
    registry::find(name).ok_or_else(|| {
        let names = registry::solutions().map(|solution| solution.name);
        let help = request::nearest(name, names).map_or_else(
            || LIST_HELP.to_owned(),
            |near| format!("did you mean {near}? {LIST_HELP}"),
        );
        Failure::with_help(format!("there is no solution '{name}'"), help)
    })
}

/// What is asked for, else what the name of the file says.
fn format(args: &ReferenceArgs) -> ReferenceFormat {
    let extension = args.output.as_deref().and_then(Path::extension);
    let of_file = match extension.and_then(|extension| extension.to_str()) {
        Some("json") => ReferenceFormat::Json,
        Some("svg") => ReferenceFormat::Svg,
        _ => ReferenceFormat::Csv,
    };
    args.format.unwrap_or(of_file)
}

fn deliver(path: Option<&Path>, text: &str) -> Result<(), Failure> {
    match path {
        None => print::out(&format!("{}\n", text.trim_end())),
        Some(path) => write(path, &format!("{}\n", text.trim_end())),
    }
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    use std::io::Write;
    atomic_write(path, |file| file.write_all(text.as_bytes()))
        .map_err(|error| Failure::input(error.to_string()))
}
