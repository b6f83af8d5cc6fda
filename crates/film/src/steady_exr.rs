//! `steady.exr`: the steady image in linear f32, for viewers of high dynamic range.
//!
//! Three channels are R, G, B with Rec. 709 primaries; one channel is Y (luminance).

use std::io;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
    WritableImage,
};

use crate::{Arrays, FilmError, atomic_write};

impl Arrays {
    /// Writes the steady image \[W m^-2 sr^-1\] as OpenEXR, whole or not at all.
    ///
    /// # Errors
    /// [`FilmError::Io`].
    pub fn write_steady_exr(&self, path: &Path) -> Result<(), FilmError> {
        let names: &[&str] = if self.channels == 3 { &["R", "G", "B"] } else { &["Y"] };
        let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = names
            .iter()
            .enumerate()
            .map(|(channel, &name)| {
                let values = self.steady.iter().skip(channel).step_by(self.channels);
                AnyChannel::new(name, FlatSamples::F32(values.map(|&v| v as f32).collect()))
            })
            .collect();
        let layer = Layer::new(
            (self.width, self.height),
            LayerAttributes::named("steady"),
            Encoding::SMALL_LOSSLESS,
            AnyChannels::sort(channels),
        );
        let image = Image::from_layer(layer);
        atomic_write(path, |file| {
            image.write().to_buffered(file).map_err(|error| match error {
                exr::error::Error::Io(error) => error,
                other => io::Error::other(other.to_string()),
            })
        })
    }
}
