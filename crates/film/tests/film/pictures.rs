//! Pictures: decoded again, they show what the cube says.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use tpb_film::{
    Arrays, Arrival, ArrivalTime, FilmError, FilmOptions, Layout, PictureOptions, Tone,
    TransientFilm,
};
use tpb_optics::Spectrum;

use super::{AXIS, rendered};

const WIDTH: usize = 40;
const HEIGHT: usize = 6;

/// A front that reaches column x at OPL 1.5 + 0.1 x, the same in all rows.
fn front() -> Arrays {
    let layout = Layout::new(WIDTH, HEIGHT, AXIS).unwrap();
    let mut film = TransientFilm::<3>::new(layout, FilmOptions::default()).unwrap();
    film.add_pass(|tile| {
        for pixel in tile.pixels() {
            let opl = 1.5 + 0.1 * (pixel % WIDTH) as f64;
            tile.deposit(pixel, 0.0, &Arrival::Instant(opl), Spectrum([2.0, 1.0, 0.5]));
        }
    });
    film.develop()
}

struct Picture {
    width: usize,
    height: usize,
    samples: Vec<u8>,
}

fn decode(path: &Path) -> Picture {
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut samples).unwrap();
    Picture { width, height, samples }
}

#[test]
fn frames_show_the_front_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let options = PictureOptions::default();
    let front = front();
    assert_eq!(front.write_frames(folder.path(), &options).unwrap(), 30);
    for bin in 0..30 {
        let frame = decode(&folder.path().join(format!("frame-{bin:06}.png")));
        assert_eq!((frame.width, frame.height), (WIDTH, HEIGHT));
        for x in 0..WIDTH {
            let inside =
                (front.opl_edges[bin]..front.opl_edges[bin + 1]).contains(&(1.5 + 0.1 * x as f64));
            assert_eq!(frame.samples[3 * x] > 100, inside, "bin {bin}, column {x}");
        }
    }
}

#[test]
fn exposure_and_tone_reach_every_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    // Rows of 1/64, 1/16, 1/4 and 1; all are lit, so that white is 1.
    let layout = Layout::new(1, 4, AXIS).unwrap();
    let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).unwrap();
    film.add_pass(|tile| {
        for pixel in tile.pixels() {
            let energy = Spectrum::splat([1.0 / 64.0, 1.0 / 16.0, 0.25, 1.0][pixel]);
            tile.deposit(pixel, 0.0, &Arrival::Instant(1.5), energy);
        }
    });
    let arrays = film.develop();
    let all = PictureOptions {
        white_percentile: 1.0,
        steady_white_percentile: 1.0,
        streak_row: Some(1),
        ..PictureOptions::default()
    };
    // sRGB of x = 1/64, 1/16, 1/4, 1; of 4 x; ln(1 + 1000 x)/ln(10001).
    let cases = [
        (PictureOptions { ..all }, [34, 71, 137, 255]),
        (PictureOptions { exposure_stops: 2.0, ..all }, [71, 137, 255, 255]),
        (PictureOptions { tone: Tone::Log, ..all }, [78, 115, 153, 191]),
    ];
    for (options, expected) in cases {
        // White is the upper end of its bucket, 1/128 above 1.
        let near = |found: &[u8], expected: &[u8]| {
            found.len() == expected.len()
                && found.iter().zip(expected).all(|(a, b)| a.abs_diff(*b) <= 1)
        };
        arrays.write_steady_png(&path, &options).unwrap();
        let steady = decode(&path).samples;
        assert!(near(&steady, &expected), "{steady:?} for {expected:?}");
        arrays.write_frames(folder.path(), &options).unwrap();
        let frame = decode(&folder.path().join("frame-000002.png")).samples;
        assert!(near(&frame, &expected), "{frame:?} for {expected:?}");
        arrays.write_streak(&path, &options).unwrap();
        assert!(near(&decode(&path).samples[2..3], &expected[1..2]));
        // One pixel's hue, times the brightness.
        arrays.write_arrival_time(&path, &options).unwrap();
        let arrival = decode(&path).samples;
        let ratios: Vec<f64> = (0..4).map(|y| f64::from(arrival[3 * y + 1])).collect();
        assert!(ratios.windows(2).all(|pair| pair[0] <= pair[1]), "{ratios:?}");
        assert_eq!(ratios[3] - ratios[2] > 1.0, expected[2] != expected[3], "{ratios:?}");
    }
}

#[test]
fn many_bins_are_averaged_into_few_frames_and_old_frames_removed() {
    let folder = tempfile::tempdir().unwrap();
    let front = front();
    let options = PictureOptions::default();
    front.write_frames(folder.path(), &options).unwrap();
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    let few = PictureOptions { max_frames: 8, ..options };
    assert_eq!(front.write_frames(folder.path(), &few).unwrap(), 8);
    let mut names: Vec<String> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names.len(), 9, "{names:?}");
    assert_eq!(names[1], "frame-000004.png");
    assert_eq!(names[8], "notes.txt", "only frames are removed");
}

#[test]
fn the_steady_picture_keeps_colours_and_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("steady.png");
    let layout = Layout::new(2, 2, None).unwrap();
    let mut film = TransientFilm::<3>::new(layout, FilmOptions::default()).unwrap();
    film.add_pass(|tile| {
        for pixel in tile.pixels() {
            let energy = Spectrum::splat(0.25 * pixel as f64) * Spectrum([1.0, 0.5, 0.25]);
            tile.deposit(pixel, 0.0, &Arrival::Instant(0.0), energy);
        }
    });
    film.develop().write_steady_png(&path, &PictureOptions::default()).unwrap();
    let picture = decode(&path);
    assert_eq!((picture.width, picture.height), (2, 2));
    let pixels: Vec<&[u8]> = picture.samples.chunks_exact(3).collect();
    assert_eq!(pixels[0], [0, 0, 0]);
    assert!(pixels.windows(2).all(|p| p[0][1] < p[1][1]), "top left to bottom right: {pixels:?}");
    assert!(pixels[3][0] > pixels[3][1] && pixels[3][1] > pixels[3][2], "{pixels:?}");
}

#[test]
fn the_streak_is_a_slanted_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("streak.png");
    front().write_streak(&path, &PictureOptions::default()).unwrap();
    let streak = decode(&path);
    assert_eq!((streak.width, streak.height), (WIDTH, 30));
    for x in 0..WIDTH {
        let lit = |bin: &usize| streak.samples[3 * (bin * WIDTH + x)] > 100;
        let bins: Vec<usize> = (0..30).filter(lit).collect();
        let opl = 1.5 + 0.1 * x as f64;
        let edges = AXIS.unwrap().edges();
        assert!(bins.len() == 1 && edges[bins[0]] <= opl && opl < edges[bins[0] + 1], "{bins:?}");
    }
    let outside = PictureOptions { streak_row: Some(HEIGHT), ..PictureOptions::default() };
    assert!(matches!(front().write_streak(&path, &outside), Err(FilmError::Unsuitable(_))));
}

#[test]
fn early_pixels_are_blue_and_late_ones_red() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arrival.png");
    for arrival in [ArrivalTime::Mean, ArrivalTime::Peak] {
        let options = PictureOptions { arrival, ..PictureOptions::default() };
        let colours = front().write_arrival_time(&path, &options).unwrap();
        assert!((colours.early_opl - 1.5).abs() < 0.2 && (colours.late_opl - 5.4).abs() < 0.2);
        let picture = decode(&path);
        assert!(picture.width == WIDTH && picture.height > HEIGHT, "a scale below");
        let pixel = |x: usize| &picture.samples[3 * x..3 * x + 3];
        let (early, middle, late) = (pixel(0), pixel(WIDTH / 2), pixel(WIDTH - 1));
        assert!(early[2] > early[0] && late[0] > late[2], "{early:?} {late:?}");
        assert!(middle[1] > middle[0] && middle[1] > middle[2], "{middle:?}");
        let scale = picture.samples.len() - 3 * WIDTH;
        assert!(picture.samples[scale + 2] > picture.samples[scale], "the scale starts blue");
    }
}

#[test]
fn a_lamp_takes_neither_the_exposure_nor_the_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arrival.png");
    let layout = Layout::new(WIDTH, HEIGHT, AXIS).unwrap();
    let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).unwrap();
    film.add_pass(|tile| {
        for pixel in tile.pixels() {
            let opl = 3.0 + 0.05 * (pixel % WIDTH) as f64;
            tile.deposit(pixel, 0.0, &Arrival::Instant(opl), Spectrum::ONE);
            if pixel < 4 {
                tile.deposit(pixel, 0.0, &Arrival::Instant(1.1), Spectrum([1e5]));
            }
        }
    });
    let arrays = film.develop();
    let colours = arrays.write_arrival_time(&path, &PictureOptions::default()).unwrap();
    assert!(colours.late_opl > 4.8, "{colours:?}");
    let picture = decode(&path);
    let late = &picture.samples[3 * (2 * WIDTH - 1)..][..3];
    assert!(late[0] > 150 && late[0] > late[2], "{late:?}");
    arrays.write_steady_png(&path, &PictureOptions::default()).unwrap();
    assert!(decode(&path).samples[2 * WIDTH] > 200);
}

#[test]
fn grey_cubes_and_black_ones_have_pictures_too_and_steady_ones_say_why_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let options = PictureOptions::default();
    let layout = Layout::new(5, 4, AXIS).unwrap();
    for passes in [0, 1] {
        let arrays = rendered::<1>(layout, FilmOptions::default(), passes).develop();
        arrays.write_streak(&path, &options).unwrap();
        let brightest = decode(&path).samples.iter().copied().max();
        assert_eq!(brightest, Some(if passes == 0 { 0 } else { 255 }));
        arrays.write_arrival_time(&path, &options).unwrap();
    }
    let steady = Layout::new(5, 4, None).unwrap();
    let arrays = rendered::<1>(steady, FilmOptions::default(), 1).develop();
    for result in [
        arrays.write_streak(&path, &options),
        arrays.write_frames(folder.path(), &options).map(|_| ()),
        arrays.write_arrival_time(&path, &options).map(|_| ()),
    ] {
        assert!(matches!(result, Err(FilmError::Unsuitable(_))));
    }
}
