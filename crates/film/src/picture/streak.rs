//! x-t streak picture: one row of the image against time, as a streak camera records it.
//!
//! x runs to the right as in the image, time downwards from the first bin; one line per frame,
//! with the exposure of the frames.

use std::path::Path;

use super::frames::Frames;
use super::{Image, PictureOptions};
use crate::{Arrays, FilmError};

impl Arrays {
    /// Writes the streak picture of [`PictureOptions::streak_row`].
    ///
    /// # Errors
    /// [`FilmError::Io`]; [`FilmError::Unsuitable`] without a time axis or such a row.
    pub fn write_streak(&self, path: &Path, options: &PictureOptions) -> Result<(), FilmError> {
        let frames = Frames::new(self, 0..self.bins, options.max_frames)?;
        let row = options.streak_row.unwrap_or(self.height / 2);
        if row >= self.height {
            return Err(FilmError::Unsuitable("the streak's row is not within the image"));
        }
        let map = options.tone_map(frames.white(options.white_percentile));
        let channels = self.picture_channels();
        let mut cell = vec![0.0; self.channels];
        let mut samples = Vec::with_capacity(self.width * frames.count() * channels);
        for frame in 0..frames.count() {
            for x in 0..self.width {
                frames.cell(row * self.width + x, frame, &mut cell);
                map.encode(&cell[..channels], &mut samples);
            }
        }
        let image = Image { width: self.width, height: frames.count(), channels, samples };
        image.write(path, &[("Title", format!("row {row} against time, downwards"))])
    }
}
