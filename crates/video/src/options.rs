//! What a video shows, and how.

use std::ffi::OsString;
use std::ops::Range;

use tpb_film::{Arrays, ArrivalTime, PictureOptions};

use crate::{Format, VideoError};

/// A GIF's delays are multiples of 1/100 s, and browsers slow down those below 2/100 s.
pub const MAX_FPS_GIF: u16 = 50;

/// Frames per second that players still show.
const MAX_FPS: u16 = 240;

/// Largest enlargement.
pub const MAX_SCALE: usize = 32;

/// What is display white, before the exposure's stops.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum White {
    /// One white for all frames: [`PictureOptions::white_percentile`] of the lit cells shown are
    /// darker. Brightnesses compare across time, nothing flickers.
    #[default]
    Shared,
    /// This energy of a bin, or radiance \[W m^-2 sr^-1\]. The same in two videos makes their
    /// brightnesses comparable.
    Given(f64),
    /// Each frame by itself, smoothed over its neighbours within a quarter of a second.
    /// Brightnesses of different frames then do not compare.
    Followed,
}

/// How a video is made.
#[derive(Clone, Debug, PartialEq)]
pub struct VideoOptions {
    /// Tone, exposure, percentiles, speed, largest number of frames.
    pub pictures: PictureOptions,
    /// The bins to show, counted from 0; all by default.
    pub bins: Option<Range<usize>>,
    /// What is display white.
    pub white: White,
    /// Pixels of the video per pixel of the image and side.
    pub scale: usize,
    /// Whether time and OPL are written into the frames.
    pub label: bool,
    /// Whether the arrays have a time axis; otherwise a label counts bins, from 0.
    pub timed: bool,
    /// Hue tells this time of arrival: what has arrived so far stays, light of the frame itself is
    /// white. Otherwise light has its own colours.
    pub colour_time: Option<ArrivalTime>,
    /// Whether colours that a GIF lacks are mixed of others (Floyd and Steinberg 1976).
    pub dither: bool,
    /// The program that makes MP4 and WebM.
    pub ffmpeg: OsString,
}

impl Default for VideoOptions {
    fn default() -> Self {
        Self {
            pictures: PictureOptions::default(),
            bins: None,
            white: White::Shared,
            scale: 1,
            label: false,
            timed: true,
            colour_time: None,
            dither: false,
            ffmpeg: OsString::from("ffmpeg"),
        }
    }
}

impl VideoOptions {
    /// Refuses what cannot be made.
    pub(crate) fn check(&self, arrays: &Arrays, format: Format) -> Result<(), VideoError> {
        let fps = self.pictures.frames_per_second;
        let fastest = if format == Format::Gif { MAX_FPS_GIF } else { MAX_FPS };
        if !(1..=fastest).contains(&fps) {
            let expected = format!("1 to {fastest} frames per second in {}", format.limit().0);
            return Err(VideoError::option("fps", &fps, expected));
        }
        if !(1..=MAX_SCALE).contains(&self.scale) {
            return Err(VideoError::option("scale", &self.scale, format!("1 to {MAX_SCALE}")));
        }
        if self.pictures.max_frames == 0 {
            return Err(VideoError::option("max-frames", &0, "at least 1"));
        }
        let stops = self.pictures.exposure_stops;
        if !(-100.0..=100.0).contains(&stops) {
            return Err(VideoError::option("exposure", &stops, "−100 to 100 stops"));
        }
        if let White::Given(white) = self.white
            && !(white > 0.0 && white.is_finite())
        {
            return Err(VideoError::option("white", &white, "a positive energy per bin"));
        }
        let bins = self.bins(arrays);
        if bins.is_empty() || bins.end > arrays.bins {
            let value = format!("{}..{}", bins.start, bins.end);
            let expected = format!("a range within 0..{}", arrays.bins);
            return Err(VideoError::option("bins", &value, expected));
        }
        if self.colour_time.is_some() {
            arrays.need_arrivals()?;
        }
        Ok(())
    }

    /// The bins to show.
    pub(crate) fn bins(&self, arrays: &Arrays) -> Range<usize> {
        self.bins.clone().unwrap_or(0..arrays.bins)
    }
}
