//! APNG, PNG and GIF, decoded again.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use gif::{ColorOutput, DecodeOptions, Repeat};
use tpb_film::{ArrivalTime, PictureOptions};
use tpb_video::{VideoOptions, White};

use crate::{cube, wave, write};

/// Decoded frames of three samples a pixel, and their delays \[s\].
struct Video {
    size: (usize, usize),
    frames: Vec<Vec<u8>>,
    delays: Vec<f64>,
    for_ever: bool,
}

fn decode_png(path: &Path) -> Video {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let animation = reader.info().animation_control().copied();
    let size = (reader.info().width as usize, reader.info().height as usize);
    let grey = reader.info().color_type == png::ColorType::Grayscale;
    let (mut frames, mut delays) = (Vec::new(), Vec::new());
    for _ in 0..animation.map_or(1, |animation| animation.num_frames) {
        let mut samples = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut samples).unwrap();
        frames.push(if grey { samples.iter().flat_map(|&s| [s; 3]).collect() } else { samples });
        let control = reader.info().frame_control();
        delays.extend(control.map(|c| f64::from(c.delay_num) / f64::from(c.delay_den)));
    }
    Video { size, frames, delays, for_ever: animation.is_some_and(|a| a.num_plays == 0) }
}

/// Frames laid over each other, as players do.
fn decode_gif(path: &Path) -> Video {
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(path).unwrap()).unwrap();
    let size = (usize::from(decoder.width()), usize::from(decoder.height()));
    let mut canvas = vec![0; 3 * size.0 * size.1];
    let (mut frames, mut delays) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        for (at, pixel) in frame.buffer.chunks_exact(4).enumerate() {
            let x = usize::from(frame.left) + at % usize::from(frame.width);
            let y = usize::from(frame.top) + at / usize::from(frame.width);
            let first = 3 * (y * size.0 + x);
            if pixel[3] > 0 {
                canvas[first..first + 3].copy_from_slice(&pixel[..3]);
            }
        }
        frames.push(canvas.clone());
        delays.push(f64::from(frame.delay) / 100.0);
    }
    Video { size, frames, delays, for_ever: decoder.repeat() == Repeat::Infinite }
}

#[test]
fn an_apng_holds_the_frames_of_the_result_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("video.apng");
    for channels in [1, 3] {
        let arrays = wave(channels);
        let mut options = VideoOptions::default();
        options.pictures.frames_per_second = 30;
        let report = write(&arrays, &path, &options).unwrap();
        assert_eq!((report.size, report.frames, report.bins.clone()), ((48, 32), 24, 0..24));
        assert_eq!(report.bytes, path.metadata().unwrap().len());
        let video = decode_png(&path);
        assert!(video.size == (48, 32) && video.for_ever);
        assert!(video.delays.len() == 24 && video.delays.iter().all(|&d| d == 1.0 / 30.0));
        let stills = folder.path().join("frames");
        arrays.write_frames(&stills, &PictureOptions::default()).unwrap();
        for (bin, frame) in video.frames.iter().enumerate() {
            let still = decode_png(&stills.join(format!("frame-{bin:06}.png")));
            assert!(*frame == still.frames[0], "bin {bin}");
        }
    }
}

#[test]
fn a_png_is_one_picture_of_the_range() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let arrays = cube([3, 1, 9, 1], |x, _, t, _| if t == 2 * x { 4.0 } else { 0.0 });
    let options = VideoOptions { bins: Some(0..3), ..VideoOptions::default() };
    let report = write(&arrays, &path, &options).unwrap();
    assert_eq!((report.frames, report.bins_per_frame), (1, 3));
    let picture = decode_png(&path);
    assert!(picture.delays.is_empty(), "no animation");
    let lit: Vec<bool> = picture.frames[0].chunks_exact(3).map(|p| p[0] > 200).collect();
    assert_eq!(lit, [true, true, false], "the third arrives later");
}

/// Regression: the light itself lay over the hues in white.
#[test]
fn a_png_of_arrival_times_is_that_of_the_result_folder() {
    let folder = tempfile::tempdir().unwrap();
    let (path, still) = (folder.path().join("a.png"), folder.path().join("b.png"));
    for kind in [ArrivalTime::Mean, ArrivalTime::Peak] {
        let mut arrays = wave(3);
        let cells = arrays.transient.chunks_exact(3 * arrays.bins);
        let sum = |cells: &[f32], channel: usize| -> f64 {
            cells.iter().skip(channel).step_by(3).map(|&cell| f64::from(cell)).sum()
        };
        arrays.steady = cells.flat_map(|cells| [0, 1, 2].map(|c| sum(cells, c))).collect();
        let options = VideoOptions { colour_time: Some(kind), ..VideoOptions::default() };
        write(&arrays, &path, &options).unwrap();
        let pictures = PictureOptions { arrival: kind, ..PictureOptions::default() };
        arrays.write_arrival_time(&still, &pictures).unwrap();
        let (found, expected) = (decode_png(&path), decode_png(&still));
        assert_eq!(found.size, expected.size);
        // Sums in another order may round differently.
        assert!(difference(&found.frames[0], &expected.frames[0]).1 <= 1, "{kind:?}");
    }
}

/// Mean and largest difference of samples.
fn difference(a: &[u8], b: &[u8]) -> (f64, u8) {
    let differences = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
    let sum: f64 = differences.clone().map(f64::from).sum();
    (sum / a.len() as f64, differences.max().unwrap_or(0))
}

#[test]
fn a_gif_has_the_frames_and_nearly_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    let (gif, apng) = (folder.path().join("video.gif"), folder.path().join("video.apng"));
    for (colour_time, dither) in [(None, false), (Some(ArrivalTime::Mean), false), (None, true)] {
        let mut options =
            VideoOptions { colour_time, dither, label: true, scale: 2, ..VideoOptions::default() };
        options.pictures.frames_per_second = 24;
        let arrays = wave(3);
        let report = write(&arrays, &gif, &options).unwrap();
        write(&arrays, &apng, &options).unwrap();
        let (video, exact) = (decode_gif(&gif), decode_png(&apng));
        assert!(video.size == report.size && video.size == exact.size && video.for_ever);
        assert_eq!(video.frames.len(), 24);
        assert!((video.delays.iter().sum::<f64>() - 1.0).abs() < 1e-9, "24 frames in a second");
        for (frame, (found, expected)) in video.frames.iter().zip(&exact.frames).enumerate() {
            let (mean, worst) = difference(found, expected);
            assert!(mean < 4.0, "frame {frame}: {mean} {colour_time:?}, dither {dither}");
            if !dither {
                assert!(worst < 48, "frame {frame}: {worst} {colour_time:?}");
                let black =
                    |(found, expected): (&[u8], &[u8])| expected != [0; 3] || found == [0; 3];
                assert!(found.chunks(3).zip(expected.chunks(3)).all(black), "black stays black");
            }
        }
    }
}

#[test]
fn dithering_keeps_means_where_the_palette_is_short() {
    let folder = tempfile::tempdir().unwrap();
    let (gif, apng) = (folder.path().join("video.gif"), folder.path().join("video.apng"));
    // A plane of 4096 colours that moves.
    let arrays =
        cube([64, 64, 16, 3], |x, y, t, c| [((x + t) % 64) as f32 / 64.0, y as f32 / 64.0, 0.3][c]);
    let mean = |frame: &[u8], channel: usize| -> f64 {
        let values = frame.iter().skip(channel).step_by(3).map(|&s| f64::from(s));
        values.sum::<f64>() / (64.0 * 64.0)
    };
    let options =
        VideoOptions { dither: true, white: White::Given(1.0), ..VideoOptions::default() };
    write(&arrays, &gif, &options).unwrap();
    write(&arrays, &apng, &options).unwrap();
    let (dithered, exact) = (decode_gif(&gif), decode_png(&apng));
    for (found, expected) in dithered.frames.iter().zip(&exact.frames) {
        for channel in 0..3 {
            let error = mean(found, channel) - mean(expected, channel);
            assert!(error.abs() < 2.0, "channel {channel}: {error}");
        }
    }
}

#[test]
fn greys_are_exact_and_what_stands_still_costs_next_to_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (gif, apng) = (folder.path().join("video.gif"), folder.path().join("video.apng"));
    write(&wave(1), &gif, &VideoOptions::default()).unwrap();
    write(&wave(1), &apng, &VideoOptions::default()).unwrap();
    assert!(decode_gif(&gif).frames == decode_png(&apng).frames);

    let still = cube([50, 40, 30, 3], |x, y, _, c| (x + 50 * y + c) as f32);
    write(&still, &gif, &VideoOptions::default()).unwrap();
    let (all, video) = (gif.metadata().unwrap().len(), decode_gif(&gif));
    assert_eq!(video.frames.len(), 30);
    assert!(video.frames.iter().all(|frame| *frame == video.frames[0]));
    let first = VideoOptions { bins: Some(0..1), ..VideoOptions::default() };
    write(&still, &gif, &first).unwrap();
    let one = gif.metadata().unwrap().len();
    assert!(all < one + 29 * 32, "{all} bytes, {one} of them the first frame");
}

#[test]
fn black_videos_and_single_bins_are_videos_too() {
    let folder = tempfile::tempdir().unwrap();
    for channels in [1, 3] {
        let black = cube([4, 3, 1, channels], |_, _, _, _| 0.0);
        let (gif, apng) = (folder.path().join("video.gif"), folder.path().join("video.apng"));
        write(&black, &gif, &VideoOptions::default()).unwrap();
        write(&black, &apng, &VideoOptions::default()).unwrap();
        for video in [decode_gif(&gif), decode_png(&apng)] {
            assert!(video.frames.len() == 1 && video.frames[0].iter().all(|&s| s == 0));
        }
    }
}

#[test]
fn thousands_of_frames_are_averaged_only_if_asked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("video.gif");
    let arrays = cube([4, 4, 5000, 1], |x, _, t, _| ((x + t) % 7) as f32);
    let mut options = VideoOptions::default();
    assert_eq!(write(&arrays, &path, &options).unwrap().frames, 295, "17 bins a frame");
    options.pictures.max_frames = 100_000;
    assert_eq!(write(&arrays, &path, &options).unwrap().frames, 5000);
    assert_eq!(decode_gif(&path).frames.len(), 5000);
}
