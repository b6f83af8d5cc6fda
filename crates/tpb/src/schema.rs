//! `tpb schema`: the JSON schema of scene files.

use std::process::ExitCode;

use tpb_scene::description;

use crate::failure::Failure;
use crate::print;

/// Prints the schema.
pub(crate) fn run() -> Result<ExitCode, Failure> {
    print::out_and_done(&description::schema_text())
}
