//! `cargo xtask tidy`: rules of the house that the compiler does not know.
//!
//! * Floors: a crate uses only crates of floors below its own; the reference uses none of ours.
//! * Files stay short: one subject each.
//! * One version of glam, so that vector types unify.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use xshell::{Shell, cmd};

use crate::workspace::{Outcome, complain, root, say};

/// The floor of each package; a dependency must lie strictly below. `tpb-reference` stands apart:
/// it uses nothing of ours, and only floor 4 and above may use it.
const FLOORS: &[(&str, u32)] = &[
    ("tpb-optics", 0),
    ("tpb-accel", 0),
    ("tpb-lanes", 0),
    ("tpb-plot", 0),
    ("tpb-statistics", 0),
    ("tpb-browser", 0),
    ("tpb-page", 0),
    ("tpb-scene", 1),
    ("tpb-film", 1),
    ("tpb-render", 2),
    ("tpb-transport", 2),
    ("tpb-viewer", 2),
    ("tpb-dashboard", 2),
    ("tpb-video", 2),
    ("tpb-path", 3),
    ("tpb-beams", 3),
    ("tpb-light", 3),
    ("tpb-reference", 3),
    ("tpb-validation", 4),
    ("tpb-benches", 4),
    ("tpb", 5),
    ("xtask", 5),
];

/// Longest source file, in lines.
const MAX_LINES: usize = 600;

/// Checks all rules and prints what breaks them.
pub(crate) fn run() -> Outcome {
    let sh = Shell::new()?;
    sh.change_dir(root());
    let metadata = cmd!(sh, "cargo metadata --format-version 1 --locked").quiet().read()?;
    let metadata: Value = serde_json::from_str(&metadata)?;
    let mut problems = floors(&metadata);
    problems.extend(glam(&sh)?);
    problems.extend(long_files(&sh)?);
    for problem in &problems {
        complain(problem);
    }
    if problems.is_empty() {
        say("tidy: floors, file lengths and glam are in order");
    }
    Ok(problems.is_empty())
}

fn floors(metadata: &Value) -> Vec<String> {
    let floors: BTreeMap<_, _> = FLOORS.iter().copied().collect();
    let mut problems = Vec::new();
    for package in metadata["packages"].as_array().into_iter().flatten() {
        if !package["source"].is_null() {
            continue;
        }
        let name = package["name"].as_str().unwrap_or_default();
        let Some(&floor) = floors.get(name) else {
            problems.push(format!("{name} has no floor: add it to xtask/src/tidy.rs"));
            continue;
        };
        for dependency in package["dependencies"].as_array().into_iter().flatten() {
            let used = dependency["name"].as_str().unwrap_or_default();
            let Some(&below) = floors.get(used) else { continue };
            let dev = dependency["kind"] == "dev";
            if name == "tpb-reference" || (used == "tpb-reference" && floor < 4) {
                problems.push(format!("{name} uses {used}: the reference stands apart"));
            } else if below > floor || (below == floor && floor > 0 && !dev) {
                problems.push(format!("{name} (floor {floor}) uses {used} (floor {below})"));
            }
        }
    }
    problems
}

fn glam(sh: &Shell) -> Result<Option<String>, Box<dyn std::error::Error>> {
    let tree = cmd!(sh, "cargo tree --workspace --edges normal --prefix none").quiet().read()?;
    let mut versions: Vec<_> =
        tree.lines().filter_map(|l| l.strip_prefix("glam ")).map(|l| l.split(' ').next()).collect();
    versions.sort_unstable();
    versions.dedup();
    Ok((versions.len() != 1).then(|| format!("glam is built in {} versions", versions.len())))
}

fn long_files(sh: &Shell) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let files = cmd!(sh, "git ls-files *.rs").quiet().read()?;
    let mut problems = Vec::new();
    for file in files.lines() {
        let Ok(text) = fs::read_to_string(root().join(Path::new(file))) else { continue };
        let lines = text.lines().count();
        if lines > MAX_LINES {
            problems.push(format!("{file}: {lines} lines; split it (at most {MAX_LINES})"));
        }
    }
    Ok(problems)
}
