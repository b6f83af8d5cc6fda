//! Frames: the image at one time after the other.
//!
//! With more bins than frames wanted, each frame is the mean of as many consecutive bins as
//! needed, so that a frame always shows energy per bin. All frames share one exposure.

use std::ops::Range;
use std::path::Path;

use tpb_optics::Spectrum;

use super::tone::{ToneMap, white_level};
use super::{Image, PictureOptions};
use crate::{Arrays, FilmError};

/// Bins in groups, one per frame.
#[derive(Clone, Debug)]
pub struct Frames<'a> {
    arrays: &'a Arrays,
    bins: Range<usize>,
    per_frame: usize,
}

impl<'a> Frames<'a> {
    /// As many frames of these bins as there are bins, or at most `max_frames`.
    ///
    /// # Errors
    /// [`FilmError::Unsuitable`] without a time axis, or if the bins are none of the arrays'.
    pub fn new(
        arrays: &'a Arrays,
        bins: Range<usize>,
        max_frames: usize,
    ) -> Result<Self, FilmError> {
        arrays.need_bins()?;
        if bins.is_empty() || bins.end > arrays.bins {
            return Err(FilmError::Unsuitable("these frames are not within the time axis"));
        }
        let per_frame = bins.len().div_ceil(max_frames.max(1));
        Ok(Self { arrays, bins, per_frame })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.bins.len().div_ceil(self.per_frame)
    }

    /// Bins of a frame; the last may have fewer.
    pub fn per_frame(&self) -> usize {
        self.per_frame
    }

    /// The bins of frame `frame`.
    pub fn bins(&self, frame: usize) -> Range<usize> {
        let first = self.bins.start + frame * self.per_frame;
        first..(first + self.per_frame).min(self.bins.end)
    }

    /// The mean cell of a frame at a pixel, in `cell`, which has as many channels as the arrays.
    pub fn cell(&self, pixel: usize, frame: usize, cell: &mut [f64]) {
        let channels = self.arrays.channels;
        let bins = self.bins(frame);
        let cells = &self.arrays.pixel(pixel)[bins.start * channels..bins.end * channels];
        for (channel, mean) in cell.iter_mut().enumerate() {
            let sum: f32 = cells.iter().skip(channel).step_by(channels).sum();
            *mean = f64::from(sum / bins.len() as f32);
        }
    }

    /// The luminances of one frame.
    pub fn luminances(&self, frame: usize) -> impl Iterator<Item = f64> {
        let mut cell = vec![0.0; self.arrays.channels];
        (0..self.arrays.pixels()).map(move |pixel| {
            self.cell(pixel, frame, &mut cell);
            luminance(&cell)
        })
    }

    /// Display white for all frames: the part `percentile` of lit cells is darker.
    pub fn white(&self, percentile: f64) -> f64 {
        let pixels = 0..self.arrays.pixels();
        let luminances = pixels.flat_map(|pixel| {
            let mut cell = vec![0.0; self.arrays.channels];
            (0..self.count()).map(move |frame| {
                self.cell(pixel, frame, &mut cell);
                luminance(&cell)
            })
        });
        white_level(luminances, percentile)
    }

    fn image(&self, frame: usize, map: ToneMap) -> Image {
        let channels = self.arrays.picture_channels();
        let mut cell = vec![0.0; self.arrays.channels];
        let mut samples = Vec::with_capacity(self.arrays.pixels() * channels);
        for pixel in 0..self.arrays.pixels() {
            self.cell(pixel, frame, &mut cell);
            map.encode(&cell[..channels], &mut samples);
        }
        Image { width: self.arrays.width, height: self.arrays.height, channels, samples }
    }
}

/// Luminance of a cell with one or three channels.
fn luminance(cell: &[f64]) -> f64 {
    match *cell {
        [r, g, b] => Spectrum([r, g, b]).luminance(),
        _ => cell[0],
    }
}

/// Name of the frame that starts with a bin.
fn frame_name(bin: usize) -> String {
    format!("frame-{bin:06}.png")
}

/// Whether a file name is one that [`frame_name`] makes.
fn is_frame_name(name: &str) -> bool {
    let digits = name.strip_prefix("frame-").and_then(|rest| rest.strip_suffix(".png"));
    digits.is_some_and(|d| d.len() >= 6 && d.bytes().all(|b| b.is_ascii_digit()))
}

impl Arrays {
    /// Writes the frames into a folder, made if need be, as `frame-NNNNNN.png`, where N is the
    /// first bin of the frame. Frames of an earlier result in that folder that this one lacks are
    /// removed. Returns how many frames there are.
    ///
    /// # Errors
    /// [`FilmError::Io`]; [`FilmError::Unsuitable`] without a time axis.
    pub fn write_frames(
        &self,
        folder: &Path,
        options: &PictureOptions,
    ) -> Result<usize, FilmError> {
        let frames = Frames::new(self, 0..self.bins, options.max_frames)?;
        std::fs::create_dir_all(folder).map_err(|e| FilmError::io(folder, e))?;
        let map = options.tone_map(frames.white(options.white_percentile));
        for frame in 0..frames.count() {
            let path = folder.join(frame_name(frame * frames.per_frame));
            frames.image(frame, map).write(&path, &[])?;
        }
        for entry in std::fs::read_dir(folder).map_err(|e| FilmError::io(folder, e))? {
            let entry = entry.map_err(|e| FilmError::io(folder, e))?;
            let name = entry.file_name();
            let Some(name) = name.to_str().filter(|name| is_frame_name(name)) else { continue };
            let written = (0..frames.count()).any(|f| name == frame_name(f * frames.per_frame));
            if !written {
                std::fs::remove_file(entry.path()).map_err(|e| FilmError::io(&entry.path(), e))?;
            }
        }
        Ok(frames.count())
    }
}
