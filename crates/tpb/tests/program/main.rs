//! The program as its users meet it: the built binary, run in a folder of its own.

mod compare;
mod errors;
mod files;
mod interrupt;
mod reference;
mod renders;
mod snapshots;
mod video;
mod window;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A small, quick film over all the time that light takes in the scenes that are rendered here.
const SMALL: [&str; 8] = [
    "--set",
    "sensor.film.width=12",
    "--set",
    "sensor.film.height=10",
    "--set",
    "sensor.film.temporal_bins=40",
    "--set",
    "sensor.film.bin_width_opl=0.35",
];

/// Beams that are quick on a small film.
const FEW: [&str; 4] = ["--method", "beams", "--photons", "500"];

/// The root of the project.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A scene that ships with the project.
fn scene(name: &str) -> PathBuf {
    root().join("validation/scenes").join(name).with_extension("json")
}

/// The program, not started yet.
fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tpb"));
    command.env_remove("COLUMNS").env("NO_COLOR", "1");
    command
}

/// Runs the program in a folder.
fn tpb<I: AsRef<OsStr>>(folder: &Path, arguments: impl IntoIterator<Item = I>) -> Output {
    program().current_dir(folder).args(arguments).output().expect("the program starts")
}

/// Renders a small film of the Cornell blocks into `output` within a folder.
fn render(folder: &Path, output: &str, more: &[&str]) -> Output {
    let mut command = program();
    command.current_dir(folder).arg("render").arg(scene("cornell-blocks")).args(SMALL);
    command.args(["-o", output]).args(more).output().expect("the program starts")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// That a run went well.
#[track_caller]
fn assert_done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(output), stderr(output));
}

/// That a run ended with exit code 2 and a message with these parts, and without a panic.
#[track_caller]
fn assert_refused(output: &Output, parts: &[&str]) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(!message.contains("panicked") && !message.contains('\x1b'), "{message}");
    for part in parts {
        assert!(message.contains(part), "'{part}' is missing in\n{message}");
    }
}
