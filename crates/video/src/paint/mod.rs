//! Frames as 8-bit samples, one at a time.
//!
//! * [`arrived`]: what has arrived so far, its hue the time of arrival, with its scale;
//! * [`label`]: time and OPL in a corner.
//!
//! A frame is painted at the image's own resolution, enlarged by whole pixels, and padded with
//! black at the right and below where the format wants even sides.

mod arrived;
mod label;

use rayon::prelude::*;
use tpb_film::{Arrays, Frames, Quantity, srgb};
use tpb_optics::Spectrum;

use self::arrived::Arrived;
use self::label::Label;
use crate::exposure::Exposure;
use crate::{Format, VideoError, VideoOptions};

/// Paints frames in their order.
pub(crate) struct Painter<'a> {
    arrays: &'a Arrays,
    options: &'a VideoOptions,
    frames: Frames<'a>,
    exposure: Exposure,
    arrived: Option<Arrived<'a>>,
    label: Option<Label>,
    still: bool,
    channels: usize,
    /// At the image's resolution: its rows, and a scale's.
    small: Vec<u8>,
    width: usize,
    height: usize,
    padding: (usize, usize),
    samples: Vec<u8>,
}

impl<'a> Painter<'a> {
    /// # Errors
    /// [`VideoError::TooLarge`], [`VideoError::Label`]; [`VideoError::Film`] without bins.
    pub(crate) fn new(
        arrays: &'a Arrays,
        options: &'a VideoOptions,
        format: Format,
    ) -> Result<Self, VideoError> {
        let bins = options.bins(arrays);
        let frames = Frames::new(arrays, bins.clone(), options.pictures.max_frames)?;
        let arrived = options.colour_time;
        let arrived = arrived.map(|kind| Arrived::new(arrays, bins, kind, &options.pictures));
        let channels = if arrived.is_some() { 3 } else { arrays.picture_channels() };
        let scale_rows = arrived.as_ref().map_or(0, Arrived::scale_rows);
        let even = |side: usize| if format.even_sides() { side.next_multiple_of(2) } else { side };
        let image = (arrays.width * options.scale, arrays.height * options.scale);
        let width = even(image.0);
        let height = even(image.1 + scale_rows * options.scale);
        let (name, limit) = format.limit();
        if width.max(height) > limit {
            return Err(VideoError::TooLarge { width, height, format: name, limit });
        }
        let exposure = Exposure::new(&frames, options);
        let label = options.label.then(|| {
            let times: Vec<f64> = (0..frames.count()).map(|f| time(arrays, &frames, f)).collect();
            Label::new(&times, options.timed, exposure.stops(0).is_some(), image)
        });
        Ok(Self {
            arrays,
            options,
            exposure,
            arrived,
            label: label.transpose()?,
            still: format == Format::Png,
            channels,
            small: vec![0; arrays.width * (arrays.height + scale_rows) * channels],
            width,
            height,
            padding: (width - image.0, height - image.1 - scale_rows * options.scale),
            samples: vec![0; width * height * channels],
            frames,
        })
    }

    /// How many frames there are.
    pub(crate) fn count(&self) -> usize {
        self.frames.count()
    }

    /// The frames themselves.
    pub(crate) fn frames(&self) -> &Frames<'a> {
        &self.frames
    }

    /// Display white of the whole video.
    pub(crate) fn white(&self) -> f64 {
        self.exposure.white
    }

    /// Width and height in pixels.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Columns and rows of the size that are black, so that sides are even.
    pub(crate) fn padding(&self) -> (usize, usize) {
        self.padding
    }

    /// Samples of a pixel: 3, or 1 for greys.
    pub(crate) fn channels(&self) -> usize {
        self.channels
    }

    /// The samples of a frame, row by row. Frames come in their order, perhaps again from the first.
    pub(crate) fn paint(&mut self, frame: usize) -> &[u8] {
        let map = self.options.pictures.tone_map(self.exposure.of(frame));
        let (arrays, frames, channels) = (self.arrays, &self.frames, self.channels);
        let time = time(arrays, frames, frame);
        if let Some(arrived) = &mut self.arrived {
            if frame == 0 {
                arrived.restart();
            }
            arrived.advance(frames.bins(frame));
        }
        let arrived = self.arrived.as_ref();
        // A still has no light of its own time beside all the light.
        let still = self.still;
        let (image, scale) = self.small.split_at_mut(arrays.pixels() * channels);
        image.par_chunks_exact_mut(arrays.width * channels).enumerate().for_each(|(y, row)| {
            let mut cell = vec![0.0; arrays.channels];
            for (x, samples) in row.chunks_exact_mut(channels).enumerate() {
                let pixel = y * arrays.width + x;
                frames.cell(pixel, frame, &mut cell);
                match (samples, arrived, &*cell) {
                    ([r, g, b], Some(arrived), cell) => {
                        let light = match *cell {
                            [r, g, b] => Spectrum([r, g, b]).luminance(),
                            _ => cell[0],
                        };
                        let light = if still { 0.0 } else { map.grey(light) };
                        [*r, *g, *b] = arrived.colour(pixel, light).map(srgb);
                    }
                    ([r, g, b], None, &[red, green, blue]) => {
                        [*r, *g, *b] = map.colour([red, green, blue]).map(srgb);
                    }
                    (samples, _, cell) => samples[0] = srgb(map.grey(cell[0])),
                }
            }
        });
        if let Some(arrived) = arrived {
            arrived.paint_scale((!still).then_some(time), scale);
        }
        self.enlarge();
        if let Some(label) = &self.label {
            let size = (self.width, self.height, channels);
            label.draw(frame, self.exposure.stops(frame), &mut self.samples, size);
        }
        &self.samples
    }

    /// Each small pixel becomes a square; padding stays black.
    fn enlarge(&mut self) {
        let (scale, channels) = (self.options.scale, self.channels);
        let small_row = self.arrays.width * channels;
        let row = self.width * channels;
        let rows = self.small.chunks_exact(small_row);
        for (small, block) in rows.zip(self.samples.chunks_mut(row * scale)) {
            let (first, others) = block.split_at_mut(row);
            let squares = first.chunks_exact_mut(channels * scale);
            for (pixel, square) in small.chunks_exact(channels).zip(squares) {
                square.chunks_exact_mut(channels).for_each(|to| to.copy_from_slice(pixel));
            }
            others.chunks_exact_mut(row).for_each(|other| other.copy_from_slice(first));
        }
    }
}

/// OPL that a frame shows \[m\]: the middle of its bins; for continuous emission, whose cells are
/// values at upper edges, the mean of those.
fn time(arrays: &Arrays, frames: &Frames<'_>, frame: usize) -> f64 {
    let (bins, edges) = (frames.bins(frame), &arrays.opl_edges);
    match arrays.quantity {
        Quantity::BinEnergy => 0.5 * (edges[bins.start] + edges[bins.end]),
        Quantity::RadianceAtUpperEdges => 0.5 * (edges[bins.start + 1] + edges[bins.end]),
    }
}

#[cfg(test)]
mod tests;
