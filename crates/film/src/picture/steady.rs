//! The steady image as a picture, exposed by its own percentile.

use std::path::Path;

use super::tone::Exposure;
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
        let exposure = Exposure::new(luminances, options.steady_white_percentile, options.exposure);
        let pixels = self.steady.chunks_exact(self.channels).flat_map(|pixel| &pixel[..channels]);
        let samples = pixels.map(|&steady| exposure.encode(steady)).collect();
        Image { width: self.width, height: self.height, channels, samples }.write(path, &[])
    }
}
