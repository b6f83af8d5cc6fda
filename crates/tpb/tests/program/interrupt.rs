//! Ctrl-c ends the pass and writes what is there; the second aborts.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::Value;

use crate::{SMALL, program, scene};

/// Waits in seconds before the signal; longer ones for machines that are busy.
const WAITS: [f64; 4] = [0.5, 2.0, 8.0, 30.0];

fn start(folder: &Path, more: &[&str]) -> Child {
    let mut command = program();
    command.current_dir(folder).arg("render").arg(scene("cornell-blocks")).args(SMALL);
    command.args(["-o", "result", "--method", "path", "--time", "1h"]).args(more);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts")
}

fn interrupt(child: &Child) {
    let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(status.unwrap().success());
}

#[test]
fn an_interrupt_writes_what_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let code = WAITS.iter().find_map(|&wait| {
        let mut child = start(folder.path(), &[]);
        sleep(Duration::from_secs_f64(wait));
        interrupt(&child);
        // No code: the signal came before the program listened.
        child.wait().unwrap().code()
    });
    assert_eq!(code, Some(0));
    let report = std::fs::read_to_string(folder.path().join("result/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["run"]["interrupted"], true);
    assert!(report["run"]["passes"].as_u64().unwrap() >= 1);
    assert!(folder.path().join("result/transient.npz").exists());
}

#[test]
fn a_preview_is_there_while_the_render_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let preview = folder.path().join("result/preview.png");
    let mut child = start(folder.path(), &[]);
    let seen = (0..600).any(|_| {
        sleep(Duration::from_millis(100));
        preview.exists()
    });
    // Written under another name first: never half of it.
    let png = std::fs::read(&preview).unwrap_or_default();
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(seen && png.starts_with(b"\x89PNG") && png.ends_with(b"IEND\xae\x42\x60\x82"));
    assert!(!preview.exists() && folder.path().join("result/steady.png").exists());
}

#[test]
fn a_second_interrupt_aborts_within_the_pass() {
    let folder = tempfile::tempdir().unwrap();
    let code = WAITS.iter().find_map(|&wait| {
        let mut child = start(folder.path(), &["--samples-per-pass", "100000000"]);
        sleep(Duration::from_secs_f64(wait));
        interrupt(&child);
        sleep(Duration::from_millis(200));
        if child.try_wait().unwrap().is_none() {
            interrupt(&child);
        }
        child.wait().unwrap().code()
    });
    assert_eq!(code, Some(130));
    assert!(!folder.path().join("result/transient.npz").exists());
}
