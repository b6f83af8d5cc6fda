//! Videos through the public door: written, decoded again, and refused.

mod errors;
mod ffmpeg;
mod files;

use std::ops::ControlFlow;
use std::path::Path;

use tpb_film::{Arrays, Quantity};
use tpb_video::{Format, VideoError, VideoOptions, VideoReport, write_video};

/// A cube of bins of 0.1 m from 1 m, from (x, y, bin, channel).
fn cube(
    [width, height, bins, channels]: [usize; 4],
    cell: impl Fn(usize, usize, usize, usize) -> f32,
) -> Arrays {
    let mut transient = Vec::with_capacity(width * height * bins * channels);
    for pixel in 0..width * height {
        for bin in 0..bins {
            transient.extend((0..channels).map(|c| cell(pixel % width, pixel / width, bin, c)));
        }
    }
    Arrays {
        width,
        height,
        bins,
        channels,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| 1.0 + 0.1 * edge as f64).collect(),
        transient,
        variance: None,
        before: vec![0.0; width * height * channels],
        after: vec![0.0; width * height * channels],
        steady: vec![1.0; width * height * channels],
    }
}

/// A coloured wave in coloured fog that grows darker: thousands of colours.
fn wave(channels: usize) -> Arrays {
    cube([48, 32, 24, channels], |x, y, t, c| {
        let from_front = (x as f32 - 2.0 * t as f32) / 3.0;
        let fog = (-0.05 * t as f32).exp() * (0.2 + y as f32 / 32.0) * [1.0, 0.6, 0.3][c];
        if y < 4 { 0.0 } else { fog + (-from_front * from_front).exp() * [0.3, 0.7, 1.0][c] }
    })
}

fn write(arrays: &Arrays, path: &Path, options: &VideoOptions) -> Result<VideoReport, VideoError> {
    let format = Format::of(path)?;
    write_video(arrays, path, format, options, &mut |_, _| ControlFlow::Continue(()))
}

/// Names in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
