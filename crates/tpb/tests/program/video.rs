//! Videos of results, and what is refused.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::{Command, Output};

use tpb_film::{Arrays, Quantity};

use crate::{FEW, assert_done, assert_refused, program, render, stderr, stdout, tpb};

/// A small render without the lamp itself, which would outshine all else in so few pixels.
const LIT: [&str; 6] = ["--method", "path", "--passes", "2", "--min-depth", "2"];

/// A grey cube of 8 x 4 pixels and 40 bins of 0.03 m (100 ps) from 3 m: a front with a tail.
fn cube() -> Arrays {
    let (width, height, bins) = (8, 4, 40);
    let cell = |pixel: usize, bin: usize| {
        let since = bin as f32 - 10.0 - (pixel % width) as f32;
        if (0.0..=9.0).contains(&since) { 1.0 + 9.0 * (-0.3 * since).exp() } else { 0.0 }
    };
    let transient: Vec<f32> =
        (0..width * height).flat_map(|p| (0..bins).map(move |bin| cell(p, bin))).collect();
    let steady = transient.chunks_exact(bins).map(|c| c.iter().map(|&v| f64::from(v)).sum());
    Arrays {
        width,
        height,
        bins,
        channels: 1,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| 3.0 + 0.03 * edge as f64).collect(),
        steady: steady.collect(),
        transient,
        variance: None,
        before: vec![0.0; width * height],
        after: vec![0.0; width * height],
    }
}

/// A folder with that cube in it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    cube().write_npz(&folder.path().join("cube.npz")).unwrap();
    folder
}

fn video(folder: &Path, arguments: &[&str]) -> Output {
    tpb(folder, [&["video", "cube.npz"], arguments].concat())
}

/// The frames of an APNG.
fn frames(path: &Path) -> Vec<Vec<u8>> {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let count = reader.info().animation_control().map_or(1, |a| a.num_frames);
    let mut frame = || {
        let mut samples = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut samples).unwrap();
        samples
    };
    (0..count).map(|_| frame()).collect()
}

#[test]
fn a_render_becomes_a_video_of_any_format_that_is_built_in() {
    let folder = tempfile::tempdir().unwrap();
    assert_done(&render(folder.path(), "result", &LIT));
    let output = tpb(folder.path(), ["video", "result", "--scale", "8", "--label", "--fps", "25"]);
    assert_done(&output);
    let text = stdout(&output);
    for part in ["result.apng: 96 x 80, 40 frames at 25", "= 1.6 s", "0..40, 1 a frame", "--white"]
    {
        assert!(text.contains(part), "'{part}' is missing in\n{text}");
    }
    assert_eq!(frames(&folder.path().join("result.apng")).len(), 40);
    for file in ["waves.gif", "still.png"] {
        let arguments = ["video", "result", "-o", file, "--colour-time=peak", "--tone", "log"];
        assert_done(&tpb(folder.path(), arguments));
        assert!(folder.path().join(file).exists());
    }
    // What it prints as white exposes it the same way.
    let white = text.split("--white ").nth(1).unwrap().trim();
    let again = ["video", "result", "-o", "again.apng", "--white", white];
    assert_done(&tpb(folder.path(), again));
    assert_done(&tpb(folder.path(), ["video", "result", "-o", "first.apng"]));
    let read = |name| frames(&folder.path().join(name));
    let near = read("again.apng").concat().into_iter().zip(read("first.apng").concat());
    assert!(near.into_iter().all(|(a, b)| a.abs_diff(b) <= 1));
    // The result's own animation is the same video.
    let first = read("first.apng");
    assert!(first == read("result/animation.png"));
    assert!(first.iter().filter(|frame| frame.iter().any(|&s| s > 0)).count() > 20, "lit");
}

#[test]
fn ranges_of_time_and_opl_choose_the_bins_that_they_overlap() {
    let folder = folder();
    let made = |name: &str, flag: &str, range: &str| {
        let output = video(folder.path(), &["-o", name, flag, range]);
        assert_done(&output);
        (stdout(&output), fs::read(folder.path().join(name)).unwrap())
    };
    let (text, bins) = made("bins.apng", "--bins", "5..25");
    assert!(text.contains("5..25") && text.contains("3.1500 m to 3.7500 m"), "{text}");
    // 3.15 m is 10.507 ns, 3.75 m 12.509 ns.
    for (flag, range) in [
        ("--opl-range", "3.16..3.74m"),
        ("--time-range", "10.52ns..12.49ns"),
        ("--time-range", "10520 ps .. 0.01249us"),
    ] {
        assert!(made("range.apng", flag, range).1 == bins, "{flag} {range}");
    }
    assert!(made("open.apng", "--opl-range", "..4").0.contains("0..34"));
    assert!(made("open.apng", "--bins", "30..").0.contains("30..40"));
}

#[test]
fn bad_arguments_name_the_flag_what_was_expected_and_a_way_out() {
    let folder = folder();
    let cases: [(&[&str], &[&str]); 24] = [
        (&["-o", "a.avi"], &["-o a.avi", ".webm", "help"]),
        (&["-o", "a"], &[".apng", "help"]),
        (&["-o", "nowhere/a.gif"], &["nowhere"]),
        (&["-o", "a.gif", "--fps", "60"], &["--fps 60", "1 to 50", "GIF", ".apng"]),
        (&["--fps", "0"], &["--fps 0", "1 to 240"]),
        (&["--fps", "-1"], &["--fps"]),
        (&["--scale", "0"], &["--scale 0", "1 to 32"]),
        (&["--label"], &["--label", "needs", "--scale 2"]),
        (&["--max-frames", "0"], &["--max-frames 0", "at least 1"]),
        (&["--tone", "reinhard"], &["--tone", "filmic"]),
        (&["--exposure", "bright"], &["--exposure", "stops"]),
        (&["--exposure", "1e9"], &["--exposure", "-100 to 100"]),
        (&["--white", "0"], &["--white", "positive"]),
        (&["--white", "1", "--follow"], &["--white", "--follow"]),
        (&["--colour-time=first"], &["mean", "peak"]),
        (&["--colour-time", "--pulse", "continuous"], &["no time of arrival"]),
        (&["--bins", "5..41"], &["--bins 5..41", "0..40"]),
        (&["--bins", "7..5"], &["--bins", "10..60"]),
        (&["--time-range", "1..2"], &["--time-range", "unit", "2ns..8ns"]),
        (&["--time-range", "1ns..2ns"], &["--time-range", "10.0069 ns to 14.0097 ns", "help"]),
        (&["--opl-range", "5.."], &["--opl-range", "3.0000 m to 4.2000 m"]),
        (&["--opl-range", "3..4", "--bins", "1..2"], &["--opl-range", "--bins"]),
        (&["--pulse", "gaussian"], &["--pulse", "gaussian:TIME"]),
        (&["--unwarp"], &["--unwarp", "cannot be unwarped afterwards", "no report"]),
    ];
    for (arguments, parts) in cases {
        assert_refused(&video(folder.path(), arguments), parts);
    }
    assert_refused(&tpb(folder.path(), ["video", "nowhere"]), &["nowhere"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing was written");
}

/// sRGB samples as light.
fn light(frames: &[Vec<u8>]) -> f64 {
    let linear = |&sample: &u8| {
        let encoded = f64::from(sample) / 255.0;
        if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    };
    frames.iter().flatten().map(linear).sum()
}

#[test]
fn pulses_keep_the_energy_and_continuous_light_adds_up() {
    let folder = folder();
    let shown = |pulse: &str, white: &str| {
        let arguments = ["-o", "a.apng", "--pulse", pulse, "--white", white];
        let output = video(folder.path(), &arguments);
        assert_done(&output);
        assert!(!stdout(&output).contains("WARNING"), "nothing arrives outside the window");
        frames(&folder.path().join("a.apng"))
    };
    let delta = shown("delta", "12");
    for pulse in ["gaussian:250ps", "box:400ps"] {
        let frames = shown(pulse, "12");
        let ratio = light(&frames) / light(&delta);
        // Rounding of samples to 8 bits; the front is early enough for the window.
        assert!((ratio - 1.0).abs() < 0.01, "{pulse}: {ratio}");
        let brightest = |frames: &[Vec<u8>]| frames.iter().flatten().copied().max();
        assert!(brightest(&frames) < brightest(&delta), "{pulse} spreads");
    }
    // Switched on, the last frame shows all that arrived within the window.
    let total: f64 = cube().steady.iter().sum();
    let last = shown("continuous", "60").pop().unwrap();
    let found = 60.0 * light(&[last]);
    assert!((found / total - 1.0).abs() < 0.01, "{found} of {total}");
}

/// Regression: uneven bins were spread by the kernel of their mean width.
#[test]
fn a_pulse_needs_bins_of_one_width() {
    let folder = tempfile::tempdir().unwrap();
    let mut arrays = cube();
    arrays.opl_edges[20] += 0.01;
    arrays.write_npz(&folder.path().join("cube.npz")).unwrap();
    for pulse in ["gaussian:200ps", "box:200ps"] {
        assert_refused(&video(folder.path(), &["--pulse", pulse]), &["--pulse", "one width"]);
    }
    assert_done(&video(folder.path(), &["--pulse", "continuous"]));
}

#[test]
fn a_pulse_that_lacks_light_from_outside_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut arrays = cube();
    arrays.after[3] = 1.0;
    arrays.write_npz(&folder.path().join("cube.npz")).unwrap();
    let output = video(folder.path(), &["--pulse", "gaussian:200ps"]);
    assert_done(&output);
    let text = stdout(&output);
    assert!(text.contains("last 9 bins lack") && !text.contains("first"), "{text}");
}

#[test]
fn what_the_film_has_to_do_is_not_done_afterwards() {
    let folder = tempfile::tempdir().unwrap();
    let options = [&FEW[..], &["--passes", "1", "--seed", "5"]].concat();
    assert_done(&render(folder.path(), "plain", &options));
    let output = tpb(folder.path(), ["video", "plain", "--unwarp"]);
    let command = ["tpb render", "--seed 5", "cornell-blocks", "--unwarp"];
    assert_refused(&output, &[&["cannot be unwarped afterwards"][..], &command].concat());

    let more = ["--unwarp", "--pulse", "gaussian:500ps"];
    assert_done(&render(folder.path(), "other", &[&options[..], &more].concat()));
    assert_done(&tpb(folder.path(), ["video", "other", "--unwarp"]));
    let output = tpb(folder.path(), ["video", "other", "--pulse", "box:1ns"]);
    assert_refused(&output, &["--pulse", "already has the pulse gaussian", "--pulse delta"]);

    let steady = ["--set", "sensor.film.temporal_bins=0"];
    assert_done(&render(folder.path(), "steady", &[&options[..], &steady].concat()));
    assert_refused(&tpb(folder.path(), ["video", "steady"]), &["no time axis", "temporal_bins"]);
}

/// A cube of (1, 2, 3) as another program may write it.
fn npy() -> Vec<u8> {
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 3), }";
    let header = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(header.bytes());
    bytes.extend([0.0, 1.0, 2.0, 3.0, -4.0, 5.0_f32].iter().flat_map(|v| v.to_le_bytes()));
    bytes
}

#[test]
fn cubes_of_other_programs_have_bins_instead_of_times() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.npy"), npy()).unwrap();
    let made = |more: &[&str]| tpb(folder.path(), [&["video", "cube.npy"], more].concat());
    let output = made(&["--scale", "32", "--label"]);
    assert_eq!(output.status.code(), Some(1), "a cell is negative: {}", stderr(&output));
    assert!(stdout(&output).contains("1 of 6 cells are negative"), "{}", stdout(&output));
    assert_eq!(frames(&folder.path().join("cube.apng")).len(), 3);
    assert_refused(&made(&["--time-range", "0ns..1ns"]), &["--time-range", "--bins"]);
    assert_refused(&made(&["--pulse", "box:1ns"]), &["--pulse", "no time axis"]);
}

#[test]
fn renders_are_exposed_as_asked() {
    let folder = tempfile::tempdir().unwrap();
    assert_done(&render(folder.path(), "plain", &LIT));
    let more = ["--tone", "filmic", "--exposure", "-1.5"];
    assert_done(&render(folder.path(), "filmic", &[&LIT[..], &more].concat()));
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for picture in ["steady.png", "streak.png", "arrival_time.png", "animation.png"] {
        assert!(read(&format!("plain/{picture}")) != read(&format!("filmic/{picture}")));
    }
    assert!(read("plain/transient.npz") == read("filmic/transient.npz"));
    let report = String::from_utf8(read("filmic/report.json")).unwrap();
    assert!(report.contains("\"tone\": \"filmic\"") && report.contains("\"exposure_stops\": -1.5"));
    assert_done(&tpb(folder.path(), ["info", "filmic"]));
    let refused = render(folder.path(), "none", &["--no-pictures", "--tone", "log"]);
    assert_refused(&refused, &["--no-pictures", "--tone"]);
}

/// Puts a script named ffmpeg into a folder of its own.
#[cfg(unix)]
fn fake_ffmpeg(folder: &Path, script: &str) -> std::path::PathBuf {
    let bin = folder.join("bin");
    fs::create_dir_all(&bin).unwrap();
    let text = folder.join("script");
    fs::write(&text, format!("#!/bin/sh\nfor last; do :; done\n{script}\n")).unwrap();
    let mut install = Command::new("install");
    assert!(
        install.args(["-m", "755"]).arg(text).arg(bin.join("ffmpeg")).status().unwrap().success()
    );
    bin
}

#[cfg(unix)]
#[test]
fn mp4_is_made_by_the_ffmpeg_on_the_path() {
    let folder = folder();
    let bin = fake_ffmpeg(folder.path(), "cat > \"$0.frames\"; echo video > \"$last\"");
    let path = std::env::join_paths([bin.as_path(), "/usr/bin".as_ref(), "/bin".as_ref()]).unwrap();
    let made = |name: &str, path: &std::ffi::OsStr, ffmpeg: Option<&str>| {
        let mut command = program();
        command.current_dir(folder.path()).args(["video", "cube.npz", "-o", name]);
        command.env("PATH", path).env_remove("FFMPEG");
        command.envs(ffmpeg.map(|ffmpeg| ("FFMPEG", ffmpeg))).output().unwrap()
    };
    assert_done(&made("a.mp4", &path, None));
    assert_eq!(fs::read(folder.path().join("a.mp4")).unwrap(), b"video\n");
    assert_eq!(fs::metadata(bin.join("ffmpeg.frames")).unwrap().len(), 40 * 8 * 4);
    let hint = ["cannot start", "ffmpeg has to be installed", "install ffmpeg", "FFMPEG", ".apng"];
    let without = made("b.mp4", "/nowhere".as_ref(), None);
    assert_refused(&without, &[&hint[..1], &hint[2..]].concat());
    let named = made("b.webm", &path, Some("/nowhere/ffmpeg"));
    assert_refused(&named, &["/nowhere/ffmpeg", "FFMPEG"]);
    fake_ffmpeg(folder.path(), "cat > /dev/null; echo \"Unknown encoder 'libx264'\" >&2; exit 8");
    let failing = made("b.mp4", &path, None);
    assert_refused(&failing, &["exit code 8", "Unknown encoder 'libx264'", ".webm"]);
    assert!(!folder.path().join("b.mp4").exists());
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing_behind() {
    let folder = folder();
    // 50 ms for each frame of 32 KiB.
    let script = "touch \"$0.started\"; \
                  for i in $(seq 500); do head -c 32768 > /dev/null; sleep 0.05; done";
    let bin = fake_ffmpeg(folder.path(), script);
    let mut command = program();
    command.current_dir(folder.path()).args(["video", "cube.npz", "-o", "a.mp4", "--scale", "32"]);
    command.env("FFMPEG", bin.join("ffmpeg"));
    command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped());
    let child = command.spawn().unwrap();
    // The program listens before it starts ffmpeg.
    while !bin.join("ffmpeg.started").exists() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(stderr(&output).contains("nothing was written"), "{}", stderr(&output));
    let left: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left.len(), 3, "the cube, the script, bin: {left:?}");
}
