//! Standard output and standard error: the only place that writes to them.

use std::io::{self, Write};
use std::process::ExitCode;

use crate::failure::Failure;

/// Writes to standard output. A reader that has closed the pipe has seen enough.
///
/// # Errors
/// [`Failure::Input`] if the output cannot be written, such as to a full disk.
pub(crate) fn out(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::input(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// The same with a line end, as the whole output of a subcommand.
pub(crate) fn out_and_done(text: &str) -> Result<ExitCode, Failure> {
    out(&format!("{}\n", text.trim_end()))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes a line to standard error; if even that fails, there is nobody to tell.
pub(crate) fn err(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
