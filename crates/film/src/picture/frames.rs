//! Frames: the image at one time after the other.
//!
//! With more bins than frames wanted, each frame is the mean of as many consecutive bins as
//! needed, so that a frame always shows energy per bin. All frames share one exposure.

use std::path::Path;

use super::tone::Exposure;
use super::{Image, PictureOptions};
use crate::arrays::luminance;
use crate::{Arrays, FilmError, atomic_write};

/// Bins in groups, one per frame.
pub(super) struct Frames<'a> {
    arrays: &'a Arrays,
    per_frame: usize,
}

impl<'a> Frames<'a> {
    pub(super) fn new(arrays: &'a Arrays, max_frames: usize) -> Self {
        Self { arrays, per_frame: arrays.bins.div_ceil(max_frames.max(1)) }
    }

    pub(super) fn len(&self) -> usize {
        self.arrays.bins.div_ceil(self.per_frame)
    }

    /// The mean cell of a frame at a pixel, in `cell`.
    pub(super) fn cell(&self, pixel: usize, frame: usize, cell: &mut [f32]) {
        let channels = self.arrays.channels;
        let first = frame * self.per_frame;
        let bins = first..(first + self.per_frame).min(self.arrays.bins);
        let cells = &self.arrays.pixel(pixel)[bins.start * channels..bins.end * channels];
        for (channel, mean) in cell.iter_mut().enumerate() {
            let sum: f32 = cells.iter().skip(channel).step_by(channels).sum();
            *mean = sum / bins.len() as f32;
        }
    }

    pub(super) fn exposure(&self, options: &PictureOptions) -> Exposure {
        let pixels = 0..self.arrays.pixels();
        let luminances = pixels.flat_map(|pixel| {
            let mut cell = vec![0.0; self.arrays.channels];
            (0..self.len()).map(move |frame| {
                self.cell(pixel, frame, &mut cell);
                luminance(&cell)
            })
        });
        Exposure::new(luminances, options.white_percentile, options.exposure)
    }

    fn image(&self, frame: usize, exposure: Exposure) -> Image {
        let channels = self.arrays.picture_channels();
        let mut cell = vec![0.0; self.arrays.channels];
        let mut samples = Vec::with_capacity(self.arrays.pixels() * channels);
        for pixel in 0..self.arrays.pixels() {
            self.cell(pixel, frame, &mut cell);
            samples.extend(cell[..channels].iter().map(|&v| exposure.encode(f64::from(v))));
        }
        Image { width: self.arrays.width, height: self.arrays.height, channels, samples }
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
        self.need_bins()?;
        std::fs::create_dir_all(folder).map_err(|e| FilmError::io(folder, e))?;
        let frames = Frames::new(self, options.max_frames);
        let exposure = frames.exposure(options);
        for frame in 0..frames.len() {
            let path = folder.join(frame_name(frame * frames.per_frame));
            frames.image(frame, exposure).write(&path, &[])?;
        }
        for entry in std::fs::read_dir(folder).map_err(|e| FilmError::io(folder, e))? {
            let entry = entry.map_err(|e| FilmError::io(folder, e))?;
            let name = entry.file_name();
            let Some(name) = name.to_str().filter(|name| is_frame_name(name)) else { continue };
            let written = (0..frames.len()).any(|f| name == frame_name(f * frames.per_frame));
            if !written {
                std::fs::remove_file(entry.path()).map_err(|e| FilmError::io(&entry.path(), e))?;
            }
        }
        Ok(frames.len())
    }

    /// Writes all frames as one animated PNG, which plays for ever in any browser.
    ///
    /// # Errors
    /// [`FilmError::Io`]; [`FilmError::Unsuitable`] without a time axis.
    pub fn write_animation(&self, path: &Path, options: &PictureOptions) -> Result<(), FilmError> {
        self.need_bins()?;
        let frames = Frames::new(self, options.max_frames);
        let exposure = frames.exposure(options);
        atomic_write(path, |file| {
            let first = frames.image(0, exposure);
            let mut encoder = first.encoder(file)?;
            encoder.set_animated(frames.len() as u32, 0)?;
            encoder.set_frame_delay(1, options.frames_per_second.max(1))?;
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&first.samples)?;
            for frame in 1..frames.len() {
                writer.write_image_data(&frames.image(frame, exposure).samples)?;
            }
            writer.finish()?;
            Ok(())
        })
    }
}
