//! Pictures of the arrays, for people: frames, time of arrival, streak, steady image.
//!
//! * [`tone`]: exposure, curves, sRGB.
//! * [`frames`]: one PNG per frame.
//! * [`arrival_time`]: hue tells when light arrives, brightness how much.
//! * [`steady`]: the steady image.
//! * [`streak`]: one row of the image against time.

mod arrival_time;
mod frames;
mod steady;
mod streak;
mod tone;

use std::io::{self, BufWriter};
use std::path::Path;

use serde::{Deserialize, Serialize};
use tpb_optics::Spectrum;

pub use arrival_time::{ArrivalColours, ArrivalTime, arrival_scale};
pub use frames::Frames;
pub use tone::{Tone, ToneMap, linear_of_srgb, srgb, white_level};

use crate::{Arrays, FilmError, atomic_write};

/// How pictures are made. Unknown members of a stored one are ignored, so that reports of other
/// versions can be read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PictureOptions {
    /// The part of lit cells of the cube that is darker than display white, in frames and streak.
    pub white_percentile: f64,
    /// The same for pixels of the steady image, where lamps seen directly take a larger part.
    pub steady_white_percentile: f64,
    /// Exposure on top of that \[stops\]: 1 doubles.
    pub exposure_stops: f64,
    /// The curve from radiance to display values.
    pub tone: Tone,
    /// Bins are averaged in groups so that there are at most this many frames.
    pub max_frames: usize,
    /// Speed of the animation.
    pub frames_per_second: u16,
    /// The image row of the streak picture; the middle one by default.
    pub streak_row: Option<usize>,
    /// Which time the hue shows.
    pub arrival: ArrivalTime,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            white_percentile: 0.99,
            steady_white_percentile: 0.95,
            exposure_stops: 0.0,
            tone: Tone::Linear,
            max_frames: 300,
            frames_per_second: 20,
            streak_row: None,
            arrival: ArrivalTime::Mean,
        }
    }
}

impl PictureOptions {
    /// The tone mapping for a display white.
    pub fn tone_map(&self, white: f64) -> ToneMap {
        ToneMap::new(white, self.tone, self.exposure_stops)
    }
}

/// An 8-bit image with one or three channels, sRGB-encoded.
struct Image {
    width: usize,
    height: usize,
    channels: usize,
    samples: Vec<u8>,
}

impl Image {
    fn color(&self) -> png::ColorType {
        if self.channels == 3 { png::ColorType::Rgb } else { png::ColorType::Grayscale }
    }

    fn write(&self, path: &Path, texts: &[(&str, String)]) -> Result<(), FilmError> {
        atomic_write(path, |file: &mut BufWriter<_>| {
            let side = |n: usize| u32::try_from(n).map_err(io::Error::other);
            let mut encoder = png::Encoder::new(file, side(self.width)?, side(self.height)?);
            encoder.set_color(self.color());
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
            for (keyword, text) in texts {
                encoder.add_text_chunk((*keyword).to_owned(), text.clone())?;
            }
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&self.samples)?;
            writer.finish()?;
            Ok(())
        })
    }
}

impl Arrays {
    /// Channels of a picture: three for colour, one for grey.
    pub fn picture_channels(&self) -> usize {
        if self.channels == 3 { 3 } else { 1 }
    }

    /// Luminance of a pixel of the steady image.
    fn steady_luminance(&self, pixel: usize) -> f64 {
        match self.steady[pixel * self.channels..(pixel + 1) * self.channels] {
            [r, g, b] => Spectrum([r, g, b]).luminance(),
            ref cell => cell[0],
        }
    }

    /// That there are bins to show.
    fn need_bins(&self) -> Result<(), FilmError> {
        if self.bins > 0 {
            return Ok(());
        }
        Err(FilmError::Unsuitable("pictures of time need a time axis; this film is steady"))
    }
}
