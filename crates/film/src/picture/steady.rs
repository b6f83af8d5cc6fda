//! The steady image as a picture, exposed by its own percentile.

use std::path::Path;

use super::tone::white_level;
use super::{Image, PictureOptions};
use crate::{Arrays, FilmError};

impl Arrays {
    /// Writes the steady image as a PNG.
    ///
    /// # Errors
    /// [`FilmError::Io`].
    pub fn write_steady_png(&self, path: &Path, options: &PictureOptions) -> Result<(), FilmError> {
        let channels = self.picture_channels();
        let luminances = (0..self.pixels()).map(|pixel| self.steady_luminance(pixel));
        let map = options.tone_map(white_level(luminances, options.steady_white_percentile));
        let mut samples = Vec::with_capacity(self.pixels() * channels);
        for pixel in self.steady.chunks_exact(self.channels) {
            map.encode(&pixel[..channels], &mut samples);
        }
        Image { width: self.width, height: self.height, channels, samples }.write(path, &[])
    }
}
