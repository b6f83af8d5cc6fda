//! `cargo xtask doctor`: which tools are there, and how to get those that are not.
//!
//! | tool | needed for |
//! | --- | --- |
//! | rustfmt, clippy | `cargo xtask test` |
//! | Chromium | tests of pages |
//! | git | commits in reports and histories; without it they are "unknown" |
//! | Valgrind | instructions in `cargo xtask bench` |
//! | FFmpeg | videos as MP4 and WebM; APNG and GIF need nothing |
//!
//! Rust itself runs this task, so it is there; `rust-version` of `Cargo.toml` guards its age.

use xshell::{Shell, cmd};

use crate::workspace::{Outcome, say};

/// A tool that was looked for.
struct Tool {
    name: &'static str,
    /// What it says of itself, or where it is; `None` if it is not there.
    found: Option<String>,
    /// What does not work without it.
    purpose: &'static str,
    install: &'static str,
    /// Whether tests need it.
    needed: bool,
}

/// Looks for all; true if everything that tests need is there.
pub(crate) fn run() -> Outcome {
    let sh = Shell::new()?;
    let version = |program: &str, arguments: &[&str]| {
        let said = cmd!(sh, "{program} {arguments...}").quiet().ignore_stderr().read().ok()?;
        said.lines().next().map(str::to_owned)
    };
    let tools = [
        Tool {
            name: "rustc",
            found: version("rustc", &["--version"]),
            purpose: "everything",
            install: "https://rustup.rs",
            needed: true,
        },
        Tool {
            name: "rustfmt",
            found: version("cargo", &["fmt", "--version"]),
            purpose: "cargo xtask test",
            install: "rustup component add rustfmt",
            needed: true,
        },
        Tool {
            name: "clippy",
            found: version("cargo", &["clippy", "--version"]),
            purpose: "cargo xtask test",
            install: "rustup component add clippy",
            needed: true,
        },
        Tool {
            name: "chromium",
            found: tpb_browser::find_program()
                .ok()
                .and_then(|program| version(&program.to_string_lossy(), &["--version"])),
            purpose: "tests of pages, in cargo xtask test",
            install: "apt-get install chromium (Debian, Ubuntu); brew install chromium (macOS); or \
                      name a Chrome in the environment variable CHROMIUM",
            needed: true,
        },
        Tool {
            name: "git",
            found: version("git", &["--version"]),
            purpose: "commits in reports and histories",
            install: "apt-get install git; brew install git",
            needed: false,
        },
        Tool {
            name: "valgrind",
            found: version("valgrind", &["--version"]),
            purpose: "instructions in cargo xtask bench",
            install: "apt-get install valgrind",
            needed: false,
        },
        Tool {
            name: "ffmpeg",
            found: version("ffmpeg", &["-version"]),
            purpose: "videos as MP4 and WebM (APNG and GIF are built in)",
            install: "apt-get install ffmpeg; brew install ffmpeg",
            needed: false,
        },
    ];
    for tool in &tools {
        say(&line(tool));
    }
    let missing: Vec<&str> =
        tools.iter().filter(|t| t.needed && t.found.is_none()).map(|t| t.name).collect();
    say(&match missing.as_slice() {
        [] => "doctor: all that tests need is there".to_owned(),
        some => format!("doctor: missing {}", some.join(", ")),
    });
    Ok(missing.is_empty())
}

fn line(tool: &Tool) -> String {
    let Tool { name, purpose, install, .. } = tool;
    if let Some(found) = &tool.found {
        return format!("  there     {name:<9} {found}");
    }
    let state = if tool.needed { "MISSING " } else { "optional" };
    format!("  {state}  {name:<9} for {purpose}\n            {:<9} install: {install}", "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_comes_with_the_command_that_gets_it() {
        let tool = |found: Option<&str>, needed| Tool {
            name: "tool",
            found: found.map(str::to_owned),
            purpose: "tests",
            install: "get tool",
            needed,
        };
        assert_eq!(line(&tool(Some("tool 1.2"), true)), "  there     tool      tool 1.2");
        assert!(line(&tool(None, true)).starts_with("  MISSING   tool      for tests\n"));
        assert!(line(&tool(None, false)).starts_with("  optional  tool      for tests\n"));
        assert!(line(&tool(None, false)).ends_with("install: get tool"));
    }
}
