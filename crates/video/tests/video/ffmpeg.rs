//! MP4 and WebM: what ffmpeg is given, what becomes of its failures, and the real one's output.
#![cfg(unix)]

use std::ffi::OsString;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;

use tpb_film::Arrays;
use tpb_video::{Format, VideoError, VideoOptions, White, write_video};

use crate::{cube, names, wave, write};

/// A script in the place of ffmpeg; its output's name is the last argument. Another process makes it
/// executable: while this one has it open for writing, a child forked meanwhile keeps it busy.
fn fake(folder: &Path, script: &str) -> VideoOptions {
    let (text, program) = (folder.join("script"), folder.join("ffmpeg"));
    fs::write(&text, format!("#!/bin/sh\nfor last; do :; done\n{script}\n")).unwrap();
    let installed = Command::new("install").args(["-m", "755"]).arg(text).arg(&program).status();
    assert!(installed.unwrap().success());
    VideoOptions { ffmpeg: program.into_os_string(), ..VideoOptions::default() }
}

/// Its failure, with the old file in place and nothing beside it.
fn failure(arrays: &Arrays, script: &str) -> String {
    let (programs, folder) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = folder.path().join("video.mp4");
    fs::write(&path, "old").unwrap();
    let message = write(arrays, &path, &fake(programs.path(), script)).unwrap_err().to_string();
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["video.mp4"]);
    message
}

#[test]
fn ffmpeg_is_given_raw_frames_of_even_size() {
    for (channels, name, wanted) in [
        (3, "video.mp4", ["rgb24", "libx264", "mp4"]),
        (1, "video.webm", ["gray", "libvpx-vp9", "webm"]),
    ] {
        let (programs, folder) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let path = folder.path().join(name);
        let script = "printf '%s\\n' \"$@\" > \"$0.arguments\"; cat > \"$0.frames\"; \
                      echo done > \"$last\"";
        let mut options = fake(programs.path(), script);
        options.pictures.frames_per_second = 25;
        let arrays = cube([5, 3, 7, channels], |x, y, t, _| (x + y + t) as f32);
        let report = write(&arrays, &path, &options).unwrap();
        assert_eq!((report.size, report.padding, report.frames), ((6, 4), (1, 1), 7));
        let frames = fs::read(programs.path().join("ffmpeg.frames")).unwrap();
        assert_eq!(frames.len(), 7 * 6 * 4 * channels);
        let arguments = fs::read_to_string(programs.path().join("ffmpeg.arguments")).unwrap();
        let arguments: Vec<&str> = arguments.lines().collect();
        let after = |name: &str| {
            let at = arguments.iter().position(|argument| *argument == name);
            at.map(|at| arguments[at + 1]).unwrap_or_default()
        };
        assert_eq!([after("-pixel_format"), after("-c:v")], wanted[..2]);
        assert_eq!(
            (after("-video_size"), after("-framerate"), after("-i")),
            ("6x4", "25", "pipe:0")
        );
        assert_eq!(arguments[arguments.len() - 2], wanted[2], "the format does not rest on a name");
        assert_eq!(fs::read(&path).unwrap(), b"done\n");
        assert_eq!(names(folder.path()), [name]);
    }
}

#[test]
fn a_failing_ffmpeg_has_the_last_word() {
    let said = "i=0; while [ $i -lt 50 ]; do echo \"line $i\" >&2; i=$((i+1)); done";
    let message = failure(&wave(1), &format!("cat > /dev/null; {said}; exit 3"));
    for part in ["exit code 3", "line 42", "line 49"] {
        assert!(message.contains(part), "{part} is missing in {message}");
    }
    assert!(!message.contains("line 41"), "only the last: {message}");
    // Larger than any pipe's buffer, and not read.
    let large = cube([256, 256, 20, 1], |_, _, _, _| 1.0);
    let message = failure(&large, "echo 'Unknown encoder' >&2; exit 1");
    assert!(message.contains("exit code 1") && message.contains("Unknown encoder"), "{message}");
    assert!(failure(&large, "echo x > \"$last\"").contains("before it had all frames"));
    assert!(failure(&wave(1), "cat > /dev/null").contains("wrote nothing"));
    assert!(failure(&wave(1), "cat > /dev/null; kill -9 $$").contains("signal"));
    // More than a pipe's buffer of complaints must not stop the frames.
    let flood = "yes complaint | head -c 1000000 >&2; cat > /dev/null; exit 1";
    assert!(failure(&large, flood).contains("complaint"));
}

#[test]
fn without_ffmpeg_the_program_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let ffmpeg = OsString::from("no-such-ffmpeg");
    let options = VideoOptions { ffmpeg, ..VideoOptions::default() };
    let error = write(&wave(1), &folder.path().join("a.mp4"), &options).unwrap_err();
    assert!(matches!(error, VideoError::NoFfmpeg { .. }));
    assert!(error.to_string().contains("no-such-ffmpeg"), "{error}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_stop_ends_ffmpeg_too() {
    let (programs, folder) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    // Would wait for an hour.
    let options = fake(programs.path(), "echo x > \"$last\"; exec sleep 3600");
    let path = folder.path().join("video.mp4");
    let stopped = write_video(&wave(1), &path, Format::Mp4, &options, &mut |done, _| {
        if done == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(stopped, Err(VideoError::Interrupted)), "{stopped:?}");
    assert!(names(folder.path()).is_empty());
}

/// The frames of a video as raw RGB, by the real ffmpeg.
fn decode(path: &Path) -> Vec<u8> {
    let decoded = Command::new("ffmpeg")
        .args(["-hide_banner", "-loglevel", "error", "-i"])
        .arg(path)
        .args(["-vf", "scale=in_color_matrix=bt709:in_range=tv:out_range=full"])
        .args(["-f", "rawvideo", "-pix_fmt", "rgb24", "pipe:1"])
        .output()
        .unwrap();
    assert!(decoded.status.success(), "{}", String::from_utf8_lossy(&decoded.stderr));
    decoded.stdout
}

/// Where ffmpeg is installed: it makes videos of the right size, length and colours.
#[test]
fn the_real_ffmpeg_makes_videos_of_these_colours() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // Four plain quarters that change their colours; large enough for halved chroma.
    let colours = [[1.0, 0.1, 0.1], [0.1, 0.8, 0.2], [0.2, 0.3, 1.0], [0.5, 0.5, 0.5]];
    let arrays = cube([31, 31, 10, 3], |x, y, t, c| colours[(x / 16 + 2 * (y / 16) + t) % 4][c]);
    for name in ["video.mp4", "video.webm"] {
        let path = folder.path().join(name);
        let options =
            VideoOptions { white: White::Given(1.0), scale: 3, ..VideoOptions::default() };
        let report = write(&arrays, &path, &options).unwrap();
        assert_eq!(report.size, (94, 94), "{name}");
        let frames = decode(&path);
        assert_eq!(frames.len(), 10 * 94 * 94 * 3, "{name}: ten frames");
        for (t, frame) in frames.chunks_exact(94 * 94 * 3).enumerate() {
            for (quarter, (x, y)) in
                [(24, 24), (72, 24), (24, 72), (72, 72)].into_iter().enumerate()
            {
                let found = &frame[3 * (94 * y + x)..][..3];
                let colour = colours[(quarter + t) % 4];
                let expected = colour.map(|c: f32| tpb_film::srgb(f64::from(c)));
                let near = found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 10);
                assert!(near, "{name}, frame {t}, quarter {quarter}: {found:?} for {expected:?}");
            }
        }
    }
}
