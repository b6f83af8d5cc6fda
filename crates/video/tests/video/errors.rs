//! What cannot be made, and files that cannot be written.

use std::ops::ControlFlow;
use std::path::Path;

use tpb_film::{ArrivalTime, FilmError};
use tpb_video::{Format, VideoError, VideoOptions, White, write_video};

use crate::{cube, names, wave, write};

/// What is wrong with some options.
type Change<'a> = &'a dyn Fn(&mut VideoOptions);

#[test]
fn impossible_options_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let arrays = wave(3);
    let refused = |name: &str, change: &dyn Fn(&mut VideoOptions)| {
        let mut options = VideoOptions::default();
        change(&mut options);
        write(&arrays, &path(name), &options).unwrap_err().to_string()
    };
    let cases: [(&str, Change<'_>, &str); 12] = [
        ("a.gif", &|o| o.pictures.frames_per_second = 51, "fps 51"),
        ("a.gif", &|o| o.pictures.frames_per_second = 0, "1 to 50"),
        ("a.apng", &|o| o.pictures.frames_per_second = 241, "1 to 240"),
        ("a.apng", &|o| o.scale = 0, "scale 0"),
        ("a.apng", &|o| o.scale = 33, "1 to 32"),
        ("a.apng", &|o| o.pictures.max_frames = 0, "max-frames 0"),
        ("a.apng", &|o| o.pictures.exposure_stops = f64::NAN, "exposure NaN"),
        ("a.apng", &|o| o.white = White::Given(0.0), "white 0"),
        ("a.apng", &|o| o.bins = Some(3..3), "bins 3..3"),
        ("a.apng", &|o| o.bins = Some(3..25), "within 0..24"),
        ("a.avi", &|_| (), ".webm"),
        ("apng", &|_| (), ".webm"),
    ];
    for (name, change, part) in cases {
        let message = refused(name, change);
        assert!(message.contains(part), "{part} is missing in {message}");
    }
    let wide = cube([2100, 1, 1, 1], |_, _, _, _| 1.0);
    let options = VideoOptions { scale: 32, ..VideoOptions::default() };
    let message = write(&wide, &path("a.gif"), &options).unwrap_err().to_string();
    assert!(message.contains("67200") && message.contains("65535"), "{message}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn films_without_time_and_without_arrivals_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.apng");
    let mut steady = cube([2, 2, 0, 1], |_, _, _, _| 0.0);
    steady.opl_edges.clear();
    let refused = |arrays, options| write(arrays, &path, &options).unwrap_err();
    let error = refused(&steady, VideoOptions::default());
    assert!(matches!(error, VideoError::Film(FilmError::Unsuitable(_))), "{error}");
    let mut continuous = wave(1);
    continuous.quantity = tpb_film::Quantity::RadianceAtUpperEdges;
    let options = VideoOptions { colour_time: Some(ArrivalTime::Mean), ..VideoOptions::default() };
    assert!(refused(&continuous, options).to_string().contains("continuous"));
}

#[test]
fn a_video_appears_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.apng", "a.gif", "a.png"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "old").unwrap();
        let steps = if name == "a.png" { 1 } else { 5 };
        let mut told = Vec::new();
        let format = Format::of(&path).unwrap();
        let options = VideoOptions::default();
        let stopped = write_video(&wave(3), &path, format, &options, &mut |done, total| {
            told.push((done, total));
            if done + 1 == steps { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(matches!(stopped, Err(VideoError::Interrupted)), "{stopped:?}");
        let total = match name {
            "a.apng" => 24,
            "a.gif" => 48,
            _ => 1,
        };
        let expected: Vec<_> = (0..steps).map(|done| (done, total)).collect();
        assert_eq!(told, expected, "{name}");
        assert_eq!(std::fs::read(&path).unwrap(), b"old", "{name}");
    }
    assert_eq!(names(folder.path()), ["a.apng", "a.gif", "a.png"]);
    let nowhere = folder.path().join("nowhere").join("a.gif");
    let message = write(&wave(1), &nowhere, &VideoOptions::default()).unwrap_err().to_string();
    assert!(message.contains("nowhere"), "{message}");
    let message =
        write_video(&wave(1), folder.path(), Format::Gif, &VideoOptions::default(), &mut |_, _| {
            ControlFlow::Continue(())
        });
    assert!(message.unwrap_err().to_string().contains("directory"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    for format in [Format::Apng, Format::Gif, Format::Png] {
        let written = write_video(
            &wave(3),
            Path::new("/dev/full"),
            format,
            &VideoOptions::default(),
            &mut |_, _| ControlFlow::Continue(()),
        );
        let message = written.unwrap_err().to_string();
        assert!(message.contains("/dev/full") && message.contains("No space"), "{message}");
    }
}
