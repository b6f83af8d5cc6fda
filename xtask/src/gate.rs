//! `cargo xtask test`: what must pass before anything lands; CI calls the same command.
//!
//! One profile (release) serves tests, docs and programs, so that a clean checkout compiles its
//! dependencies once.

use std::time::Instant;

use xshell::{Shell, cmd};

use crate::workspace::{Outcome, complain, root, say};

/// Runs all steps, also after one has failed, and names those that failed.
pub(crate) fn run() -> Outcome {
    let sh = Shell::new()?;
    sh.change_dir(root());
    // Snapshots are compared, never rewritten; warnings in docs are errors.
    sh.set_var("INSTA_UPDATE", "no");
    sh.set_var("RUSTDOCFLAGS", "-D warnings");
    let steps = [
        ("format", cmd!(sh, "cargo fmt --all --check")),
        (
            "clippy",
            cmd!(sh, "cargo clippy --workspace --all-targets --release --quiet -- -D warnings"),
        ),
        ("docs", cmd!(sh, "cargo doc --workspace --no-deps --release --quiet")),
        ("tests", cmd!(sh, "cargo test --workspace --release")),
    ];
    let mut failed = Vec::new();
    for (name, command) in steps {
        say(&format!("== {name}: {command}"));
        let start = Instant::now();
        if let Err(error) = command.quiet().run() {
            complain(&error.to_string());
            failed.push(name);
        }
        say(&format!("== {name}: {:.0} s", start.elapsed().as_secs_f64()));
    }
    if !crate::tidy::run()? {
        failed.push("tidy");
    }
    if failed.is_empty() {
        say("test: all steps passed");
    } else {
        complain(&format!("failed: {}", failed.join(", ")));
    }
    Ok(failed.is_empty())
}
