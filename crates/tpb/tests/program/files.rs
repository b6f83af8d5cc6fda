//! Files appear whole or not at all, and nothing else comes to harm.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use crate::{assert_done, assert_refused, program, render, stderr, stdout, tpb};

const QUICK: [&str; 4] = ["--method", "path", "--passes", "1"];

/// The names in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
    let mut names: Vec<String> =
        entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_result_is_complete_and_replaced_by_the_next() {
    let folder = tempfile::tempdir().unwrap();
    assert_done(&render(folder.path(), "result", &QUICK));
    let result = folder.path().join("result");
    let complete = [
        "animation.png",
        "arrival_time.png",
        "frames",
        "report.json",
        "steady.exr",
        "steady.png",
        "streak.png",
        "transient.npz",
    ];
    assert_eq!(names(&result), complete);
    fs::write(result.join("notes.txt"), "mine").unwrap();
    assert_done(&render(folder.path(), "result", &[&QUICK[..], &["--no-pictures"]].concat()));
    assert_eq!(names(&result), ["notes.txt", "report.json", "steady.exr", "transient.npz"]);
}

#[test]
fn a_folder_of_someone_else_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("photos")).unwrap();
    fs::write(folder.path().join("photos/report.json"), "{}").unwrap();
    fs::write(folder.path().join("photos/cat.png"), "cat").unwrap();
    let output = render(folder.path(), "photos", &QUICK);
    assert_refused(&output, &["photos", "other files", "-o"]);
    assert_eq!(names(&folder.path().join("photos")), ["cat.png", "report.json"]);
    assert_refused(&render(folder.path(), "photos/cat.png", &QUICK), &["is a file"]);
    assert_refused(&render(folder.path(), "photos/cat.png/below", &QUICK), &["cannot make"]);
}

#[test]
fn what_can_be_written_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let result = folder.path().join("result");
    fs::create_dir(&result).unwrap();
    fs::write(result.join("frames"), "in the way").unwrap();
    fs::create_dir(result.join("steady.exr")).unwrap();
    let output = render(folder.path(), "result", &QUICK);
    assert_refused(&output, &["cannot write", "frames", "steady.exr"]);
    assert_eq!(fs::read(result.join("frames")).unwrap(), b"in the way");
    assert!(result.join("transient.npz").exists() && result.join("report.json").exists());
    assert!(stdout(&output).contains("transient.npz"), "{}", stdout(&output));
    assert!(!names(&result).iter().any(|name| name.starts_with('.')), "{:?}", names(&result));
    assert_done(&tpb(folder.path(), ["info", "result"]));
}

#[test]
fn a_broken_result_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    assert_done(&render(folder.path(), "result", &QUICK));
    let arrays = folder.path().join("result/transient.npz");
    let bytes = fs::read(&arrays).unwrap();
    fs::write(&arrays, &bytes[..bytes.len() / 2]).unwrap();
    assert_refused(&tpb(folder.path(), ["info", "result"]), &["transient.npz"]);
    assert_refused(&tpb(folder.path(), ["info", "nowhere"]), &["nowhere"]);
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let mut child = program().arg("schema").stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_a_failure() {
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = program().arg("schema").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
}
