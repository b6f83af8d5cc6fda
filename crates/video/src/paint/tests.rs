//! Frames as samples.

use std::fs::File;
use std::io::BufReader;

use tpb_film::ArrivalTime;

use super::*;
use crate::White;

const WIDTH: usize = 5;
const HEIGHT: usize = 3;

/// A cube of bins of 0.1 m from 1 m, from (x, y, bin, channel).
fn cube(bins: usize, channels: usize, cell: impl Fn(usize, usize, usize, usize) -> f32) -> Arrays {
    let mut transient = Vec::new();
    let mut steady = vec![0.0; WIDTH * HEIGHT * channels];
    for pixel in 0..WIDTH * HEIGHT {
        for bin in 0..bins {
            for channel in 0..channels {
                let value = cell(pixel % WIDTH, pixel / WIDTH, bin, channel);
                steady[pixel * channels + channel] += f64::from(value);
                transient.push(value);
            }
        }
    }
    let outside = vec![0.0; steady.len()];
    Arrays {
        width: WIDTH,
        height: HEIGHT,
        bins,
        channels,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| 1.0 + 0.1 * edge as f64).collect(),
        transient,
        variance: None,
        before: outside.clone(),
        after: outside,
        steady,
    }
}

/// Light that is at column t in bin t.
fn front(bins: usize) -> Arrays {
    cube(bins, 3, |x, _, t, c| if x == t { [2.0, 1.0, 0.5][c] } else { 0.0 })
}

fn frames(arrays: &Arrays, options: &VideoOptions, format: Format) -> Vec<Vec<u8>> {
    let mut painter = Painter::new(arrays, options, format).unwrap();
    (0..painter.count()).map(|frame| painter.paint(frame).to_vec()).collect()
}

#[test]
fn pixels_become_squares_and_odd_sides_are_padded_with_black() {
    let arrays = front(WIDTH);
    let options = VideoOptions { scale: 3, ..VideoOptions::default() };
    let painter = Painter::new(&arrays, &options, Format::Mp4).unwrap();
    assert_eq!((painter.size(), painter.padding(), painter.channels()), ((16, 10), (1, 1), 3));
    let small = frames(&arrays, &VideoOptions::default(), Format::Apng);
    let large = frames(&arrays, &options, Format::Mp4);
    assert_eq!((small.len(), large.len()), (WIDTH, WIDTH));
    for (frame, (small, large)) in small.iter().zip(&large).enumerate() {
        for (at, pixel) in large.chunks_exact(3).enumerate() {
            let (x, y) = (at % 16 / 3, at / 16 / 3);
            let inside = at % 16 < 3 * WIDTH && at / 16 < 3 * HEIGHT;
            let first = 3 * (y * WIDTH + x);
            let expected = if inside { &small[first..first + 3] } else { &[0; 3][..] };
            assert_eq!(pixel, expected, "frame {frame}, {at}");
        }
        for (x, pixel) in small.chunks_exact(3).take(WIDTH).enumerate() {
            assert_eq!(pixel[0] > 0, x == frame, "the front is where it should be");
        }
    }
}

#[test]
fn steady_light_does_not_flicker_and_greys_stay_grey() {
    let arrays = cube(20, 1, |x, y, _, _| (1 + x + WIDTH * y) as f32);
    let painted = frames(&arrays, &VideoOptions::default(), Format::Gif);
    assert!(painted.iter().all(|frame| *frame == painted[0]));
    assert_eq!(painted[0].len(), WIDTH * HEIGHT, "one channel");
    assert!(painted[0].windows(2).all(|pair| pair[0] < pair[1]), "{:?}", painted[0]);
}

#[test]
fn exposure_follows_only_if_asked() {
    // Two decades darker over 40 frames, and a dark end.
    let decay = |t: usize| if t < 40 { 10_f32.powf(-(t as f32) / 20.0) } else { 0.0 };
    let arrays = cube(60, 1, |x, _, t, _| decay(t) * (1 + x) as f32);
    let brightest = |options: &VideoOptions| -> Vec<u8> {
        let frames = frames(&arrays, options, Format::Apng);
        frames.iter().map(|frame| frame.iter().copied().max().unwrap_or(0)).collect()
    };
    let fixed = brightest(&VideoOptions::default());
    assert!(fixed[..40].windows(2).all(|pair| pair[0] >= pair[1]) && fixed[39] < 40, "{fixed:?}");
    let followed = brightest(&VideoOptions { white: White::Followed, ..VideoOptions::default() });
    assert!(followed[..34].iter().all(|&b| b >= 250), "{followed:?}");
    assert!(followed[40..].iter().all(|&b| b == 0), "dark frames stay dark");
    let options = VideoOptions { white: White::Followed, ..VideoOptions::default() };
    let painter = Painter::new(&arrays, &options, Format::Apng).unwrap();
    let stops = |frame| painter.exposure.stops(frame).unwrap();
    // 20 frames are a decade: 3.32 stops, to the 1/128 of both percentiles.
    assert!((stops(30) - stops(10) - 10_f64.log2()).abs() < 0.05);
}

#[test]
fn a_given_white_is_white() {
    let arrays = cube(3, 1, |_, _, t, _| [0.5, 1.0, 4.0][t]);
    let options = VideoOptions { white: White::Given(1.0), ..VideoOptions::default() };
    let painted = frames(&arrays, &options, Format::Apng);
    assert_eq!([painted[0][0], painted[1][0], painted[2][0]], [188, 255, 255]);
    let mut darker = options.clone();
    darker.pictures.exposure_stops = -2.0;
    assert_eq!(frames(&arrays, &darker, Format::Apng)[2][0], 255);
    assert_eq!(frames(&arrays, &darker, Format::Apng)[1][0], 137, "a quarter");
}

#[test]
fn bins_are_chosen_and_averaged() {
    let arrays = cube(10, 1, |_, _, t, _| t as f32);
    let mut options =
        VideoOptions { bins: Some(2..9), white: White::Given(9.0), ..VideoOptions::default() };
    options.pictures.max_frames = 3;
    let painter = Painter::new(&arrays, &options, Format::Apng).unwrap();
    assert_eq!((painter.count(), painter.frames().per_frame()), (3, 3));
    assert_eq!(painter.frames().bins(2), 8..9);
    let painted = frames(&arrays, &options, Format::Apng);
    // Means of 2 3 4, 5 6 7, 8.
    assert_eq!([0, 1, 2].map(|f| painted[f][0]), [1.0 / 3.0, 2.0 / 3.0, 8.0 / 9.0].map(srgb));
}

/// The samples of a PNG file.
fn png_samples(path: &std::path::Path) -> Vec<u8> {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut samples).unwrap();
    samples
}

#[test]
fn once_all_has_arrived_the_picture_of_arrival_times_remains() {
    let folder = tempfile::tempdir().unwrap();
    let still = folder.path().join("still.png");
    // Two pulses at each pixel, the later one weaker; nothing in the last bin.
    let arrays = cube(12, 3, |x, y, t, c| {
        let colour = [1.0, 0.7, 0.2][c];
        if t == x + y {
            3.0 * colour
        } else if t == x + y + 4 {
            colour
        } else {
            0.0
        }
    });
    for kind in [ArrivalTime::Mean, ArrivalTime::Peak] {
        let mut options = VideoOptions { colour_time: Some(kind), ..VideoOptions::default() };
        options.pictures.arrival = kind;
        arrays.write_arrival_time(&still, &options.pictures).unwrap();
        let expected = png_samples(&still);
        // Twice: the second round starts afresh.
        let mut painter = Painter::new(&arrays, &options, Format::Gif).unwrap();
        for _ in 0..2 {
            let painted: Vec<Vec<u8>> = (0..12).map(|f| painter.paint(f).to_vec()).collect();
            let image = 3 * WIDTH * HEIGHT;
            assert_eq!(painted[11][..image], expected[..image], "{kind:?}");
            assert_eq!(painted[11].len(), expected.len(), "with its scale");
            assert_ne!(painted[6][..image], expected[..image]);
            assert!(painted[0][3] == 0, "black before the light comes");
            // The mark on the scale moves from the early end to the late one.
            let mark = |frame: usize| {
                let row = &painted[frame][image + 3 * WIDTH..image + 6 * WIDTH];
                row.chunks_exact(3).position(|pixel| pixel == [255; 3])
            };
            assert_eq!((mark(0), mark(11)), (Some(0), Some(WIDTH - 1)));
        }
    }
}

#[test]
fn labels_tell_frames_apart_and_leave_the_picture_alone() {
    let mut options = VideoOptions { label: true, scale: 12, ..VideoOptions::default() };
    let arrays = cube(8, 1, |_, _, _, _| 1.0);
    let painted = frames(&arrays, &options, Format::Apng);
    let width = 12 * WIDTH;
    for pair in painted.windows(2) {
        assert_ne!(pair[0], pair[1]);
        assert!(pair[0][width * 20..] == pair[1][width * 20..], "below the label");
    }
    options.timed = false;
    assert_ne!(frames(&arrays, &options, Format::Apng)[0], painted[0]);
    options.scale = 1;
    assert!(matches!(Painter::new(&arrays, &options, Format::Apng), Err(VideoError::Label { .. })));
}

#[test]
fn continuous_emission_is_shown_at_upper_edges_and_has_no_arrival() {
    let mut arrays = cube(4, 1, |_, _, t, _| t as f32);
    arrays.quantity = Quantity::RadianceAtUpperEdges;
    let frames = Frames::new(&arrays, 0..4, 2).unwrap();
    assert!((time(&arrays, &frames, 0) - 1.15).abs() < 1e-12, "the mean of 1.1 and 1.2");
    let options = VideoOptions { colour_time: Some(ArrivalTime::Mean), ..VideoOptions::default() };
    assert!(matches!(options.check(&arrays, Format::Apng), Err(VideoError::Film(_))));
}
