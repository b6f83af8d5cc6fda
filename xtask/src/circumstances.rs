//! Where and how a task runs: what reports and histories say of it.

use tpb_validation::suite::Circumstances;
use xshell::{Shell, cmd};

use crate::workspace::root;

/// What reports say of this run. `threads` as asked for, `None` for all.
pub(crate) fn of(threads: Option<usize>, seed: u64) -> Circumstances {
    let flags = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    Circumstances { commit: commit(), machine: machine(threads), flags, seed }
}

/// Processor, threads, system.
pub(crate) fn machine(threads: Option<usize>) -> String {
    let threads = threads
        .or_else(|| std::thread::available_parallelism().ok().map(usize::from))
        .map_or("all threads".to_owned(), |count| format!("{count} threads"));
    let processor = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let processor = processor.unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    format!("{processor}, {threads}, {}", std::env::consts::OS)
}

/// The commit of the sources, with a mark if they differ from it.
pub(crate) fn commit() -> String {
    git(&["describe", "--always", "--dirty", "--abbrev=12"]).unwrap_or_else(|| "unknown".into())
}

/// The last commit of this branch before a time \[s since 1970\].
pub(crate) fn commit_before(time: u64) -> Option<String> {
    let before = format!("--before={time}");
    let found = git(&["log", "-1", "--format=%h", "--abbrev=12", &before])?;
    (!found.is_empty()).then_some(found)
}

/// What git says.
fn git(arguments: &[&str]) -> Option<String> {
    let sh = Shell::new().ok()?;
    sh.change_dir(root());
    cmd!(sh, "git {arguments...}").quiet().ignore_stderr().read().ok()
}
