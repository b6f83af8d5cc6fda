//! Where the workspace is, and the one place from which tasks print.

use std::error::Error;
use std::path::PathBuf;

/// What a task returns: whether all is well, or why it could not tell.
pub(crate) type Outcome = Result<bool, Box<dyn Error>>;

/// The root folder of the workspace.
pub(crate) fn root() -> PathBuf {
    let xtask = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().map_or(xtask.clone(), PathBuf::from)
}

/// Prints a line for the person who runs the task.
#[expect(clippy::print_stdout, reason = "tasks talk to a person")]
pub(crate) fn say(line: &str) {
    println!("{line}");
}

/// Prints a problem.
#[expect(clippy::print_stderr, reason = "tasks talk to a person")]
pub(crate) fn complain(line: &str) {
    eprintln!("error: {line}");
}
