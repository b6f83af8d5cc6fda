//! Instructions of a pass, counted by Valgrind's Callgrind.
//!
//! What starting, loading, preparing and writing take is the same for n and for 2n passes: the
//! instructions of 2n less those of n are those of the passes alone. They repeat to about 1e-5 on one
//! thread. Valgrind does not know AVX-512: programs that choose their instructions when they run use
//! AVX2 under it, and say so.

use std::error::Error;
use std::fs;
use std::path::Path;

use xshell::{Shell, cmd};

use super::programs::{Command, Said};

/// Callgrind, where it is there.
pub(crate) struct Callgrind {
    /// Its name and version.
    pub(crate) name: String,
}

/// What a count found.
pub(crate) struct Count {
    /// Instructions of one pass.
    pub(crate) instructions: f64,
    /// What the run of n passes said of itself.
    pub(crate) said: Said,
}

impl Callgrind {
    /// `None` where there is no Valgrind.
    pub(crate) fn find(sh: &Shell) -> Option<Self> {
        let version = cmd!(sh, "valgrind --version").quiet().ignore_stderr().read().ok()?;
        Some(Self { name: format!("callgrind of {version}") })
    }

    /// Counts the instructions of a pass; `command` makes the command for so many passes.
    #[expect(clippy::unused_self, reason = "who counts has found Callgrind")]
    pub(crate) fn count(
        &self,
        sh: &Shell,
        file: &Path,
        passes: u64,
        command: impl Fn(u64) -> Command,
    ) -> Result<Count, Box<dyn Error>> {
        let (few, said) = total(sh, file, &command(passes))?;
        let (many, _) = total(sh, file, &command(2 * passes))?;
        let instructions = many.checked_sub(few).ok_or("more passes took fewer instructions")?;
        Ok(Count { instructions: instructions as f64 / passes as f64, said })
    }
}

/// All instructions of a command.
fn total(sh: &Shell, file: &Path, command: &Command) -> Result<(u64, Said), Box<dyn Error>> {
    let under = [
        "valgrind".to_owned(),
        "--tool=callgrind".to_owned(),
        format!("--callgrind-out-file={}", file.display()),
    ];
    let said = command.run(sh, &under)?;
    let found = totals(&fs::read_to_string(file)?);
    fs::remove_file(file)?;
    Ok((found.ok_or_else(|| format!("{} has no total", file.display()))?, said))
}

/// The sum over all functions in a file of Callgrind.
fn totals(text: &str) -> Option<u64> {
    let line = text.lines().rev().find_map(|line| line.strip_prefix("totals:"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_found_in_a_file() {
        let text =
            "version: 1\nevents: Ir\nsummary: 12\n\nfn=(1) main\n10 5\n\ntotals: 299180668\n";
        assert_eq!(totals(text), Some(299_180_668));
        assert_eq!(totals("events: Ir Dr\ntotals: 7 3\n"), Some(7));
        for torn in ["", "fn=(1) main\n10 5", "totals:", "totals: x"] {
            assert_eq!(totals(torn), None, "{torn}");
        }
    }
}
