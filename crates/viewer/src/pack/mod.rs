//! Arrays as streams that a browser inflates.
//!
//! A cube is stored channel by channel as codes ([`code`]) in the order (bin, row, column). Codes
//! are replaced by symbols that tell them from their prediction ([`predict`]), in whole numbers, so
//! that nothing is lost beyond the code; low bytes, then high bytes, are deflated without a wrapper
//! (RFC 1951): `DecompressionStream("deflate-raw")`.

pub(crate) mod code;
mod predict;

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rayon::prelude::*;
use tpb_film::Arrays;

pub use code::{SE_ERROR, VALUE_ERROR};
pub(crate) use predict::Prediction;

/// Deflate's effort, 0 to 9.
const EFFORT: u32 = 6;

/// A channel, deflated.
#[derive(Clone, Debug)]
pub(crate) struct Stream {
    pub(crate) bytes: Vec<u8>,
    pub(crate) prediction: Prediction,
}

/// A result, packed. Streams are one for each channel.
#[derive(Clone, Debug)]
pub(crate) struct PackedMethod {
    pub(crate) cube: Vec<Stream>,
    /// Standard errors, 8 bits each; empty if there is no variance.
    pub(crate) errors: Vec<Stream>,
    pub(crate) before: Vec<Stream>,
    pub(crate) after: Vec<Stream>,
    pub(crate) steady: Vec<Stream>,
}

impl PackedMethod {
    /// Packs a result.
    ///
    /// # Errors
    /// None that is known: deflating into memory.
    pub(crate) fn new(arrays: &Arrays) -> io::Result<Self> {
        let image = |values: &[f64]| -> io::Result<Vec<Stream>> {
            let codes: Vec<u16> = values.iter().map(|&v| code::image(v)).collect();
            Planes::new(arrays, 1, &codes).pack()
        };
        Ok(Self {
            cube: Planes::of_cube(arrays).pack()?,
            errors: Planes::of_errors(arrays).map_or(Ok(Vec::new()), |planes| planes.pack())?,
            before: image(&arrays.before)?,
            after: image(&arrays.after)?,
            steady: image(&arrays.steady)?,
        })
    }

    /// All streams.
    pub(crate) fn streams(&self) -> impl Iterator<Item = &Stream> {
        [&self.cube, &self.errors, &self.before, &self.after, &self.steady].into_iter().flatten()
    }
}

/// Codes in planes: (channel, bin, row, column).
struct Planes {
    shape: predict::Shape,
    channels: Vec<Vec<u16>>,
}

impl Planes {
    /// From codes in the order of the arrays: (row, column, bin, channel).
    fn new(arrays: &Arrays, bins: usize, codes: &[u16]) -> Self {
        let (pixels, channels) = (arrays.pixels(), arrays.channels);
        let of_channel = |channel: usize| {
            if codes.is_empty() {
                return Vec::new();
            }
            let mut plane = vec![0; codes.len() / channels];
            for (pixel, cells) in codes.chunks_exact(bins * channels).enumerate() {
                for (bin, cell) in cells.chunks_exact(channels).enumerate() {
                    plane[bin * pixels + pixel] = cell[channel];
                }
            }
            plane
        };
        let channels = (0..channels).into_par_iter().map(of_channel).collect();
        let shape = predict::Shape { width: arrays.width, pixels, narrow: false };
        Self { shape, channels }
    }

    fn of_cube(arrays: &Arrays) -> Self {
        let cells = arrays.transient.par_iter();
        let codes: Vec<u16> = cells.map(|&value| code::value(value)).collect();
        Self::new(arrays, arrays.bins, &codes)
    }

    fn of_errors(arrays: &Arrays) -> Option<Self> {
        let variance = arrays.variance.as_ref().filter(|_| arrays.bins > 0)?;
        let pairs = arrays.transient.par_iter().zip(variance);
        let codes: Vec<u16> =
            pairs.map(|(&value, &variance)| u16::from(code::error(value, variance))).collect();
        let mut planes = Self::new(arrays, arrays.bins, &codes);
        planes.shape.narrow = true;
        Some(planes)
    }

    /// Deflates each channel with the prediction that suits it best.
    fn pack(&self) -> io::Result<Vec<Stream>> {
        if self.channels.iter().all(Vec::is_empty) {
            return Ok(Vec::new());
        }
        let channels: Vec<usize> = (0..self.channels.len()).collect();
        channels.par_iter().map(|&channel| self.stream(channel)).collect()
    }

    fn stream(&self, channel: usize) -> io::Result<Stream> {
        let codes = &self.channels[channel];
        // Channels 0 and 2 may be told from channel 1: green.
        let guide = (channel != 1).then(|| self.channels.get(1)).flatten().map(Vec::as_slice);
        let prediction = predict::best(codes, guide, self.shape);
        let symbols = prediction.symbols(codes, guide, self.shape);
        let bytes = deflate(&symbols, self.shape.narrow)?;
        Ok(Stream { bytes, prediction })
    }
}

/// Low bytes, then (unless all are narrow) high bytes, deflated.
fn deflate(symbols: &[u16], narrow: bool) -> io::Result<Vec<u8>> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::new(EFFORT));
    let low: Vec<u8> = symbols.iter().map(|&symbol| symbol as u8).collect();
    encoder.write_all(&low)?;
    if !narrow {
        let high: Vec<u8> = symbols.iter().map(|&symbol| (symbol >> 8) as u8).collect();
        encoder.write_all(&high)?;
    }
    encoder.finish()
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use flate2::read::DeflateDecoder;

    use super::*;
    use crate::testing::{cube, with_error};

    /// The codes of a stream, as the page unpacks them.
    fn unpack(stream: &Stream, guide: Option<&[u16]>, shape: predict::Shape) -> Vec<u16> {
        let mut bytes = Vec::new();
        DeflateDecoder::new(&stream.bytes[..]).read_to_end(&mut bytes).unwrap();
        let symbols = if shape.narrow {
            bytes.iter().map(|&low| u16::from(low)).collect()
        } else {
            let (low, high) = bytes.split_at(bytes.len() / 2);
            low.iter().zip(high).map(|(&l, &h)| u16::from_le_bytes([l, h])).collect()
        };
        stream.prediction.restore(symbols, guide, shape)
    }

    #[test]
    fn every_cell_comes_back_within_the_stated_error() {
        let mut arrays = with_error(cube(9, 7, 30, 3), 0.03);
        arrays.transient[5] = -0.25;
        arrays.transient[6] = f32::NAN;
        arrays.transient[7] = f32::MAX;
        arrays.transient[8] = f32::from_bits(1);
        let packed = PackedMethod::new(&arrays).unwrap();
        let shape = predict::Shape { width: 9, pixels: 63, narrow: false };
        let narrow = predict::Shape { narrow: true, ..shape };
        let green = unpack(&packed.cube[1], None, shape);
        let green_error = unpack(&packed.errors[1], None, narrow);
        for channel in 0..3 {
            let guide = (channel != 1).then_some(green.as_slice());
            let codes = unpack(&packed.cube[channel], guide, shape);
            let guide = (channel != 1).then_some(green_error.as_slice());
            let errors = unpack(&packed.errors[channel], guide, narrow);
            for (at, (&found, &error)) in codes.iter().zip(&errors).enumerate() {
                let cell = (at % 63 * 30 + at / 63) * 3 + channel;
                let value = arrays.transient[cell];
                let found = code::decode(found);
                if value.is_finite() {
                    assert!(
                        (found - f64::from(value)).abs() <= VALUE_ERROR * f64::from(value).abs()
                    );
                } else {
                    assert!(found.is_nan());
                    continue;
                }
                let exact = f64::from(arrays.variance.as_ref().unwrap()[cell]).sqrt();
                let error = code::decode_error(error as u8) * f64::from(value).abs();
                if ![5, 7, 8].contains(&cell) {
                    assert!((error - exact).abs() <= SE_ERROR * exact + 1e-30, "{cell}");
                }
            }
        }
    }

    #[test]
    fn images_are_finer() {
        let arrays = cube(6, 5, 4, 1);
        let packed = PackedMethod::new(&arrays).unwrap();
        let shape = predict::Shape { width: 6, pixels: 30, narrow: false };
        let steady = unpack(&packed.steady[0], None, shape);
        for (code, exact) in steady.into_iter().zip(&arrays.steady) {
            assert!((code::decode_image(code) / exact - 1.0).abs() < 3.6e-3);
        }
        assert_eq!(packed.errors.len(), 0);
    }

    #[test]
    fn smooth_cubes_become_small() {
        let mut arrays = cube(32, 32, 50, 1);
        let smooth = |at: usize| (at as f32 * 1e-4).exp();
        arrays.transient.iter_mut().enumerate().for_each(|(at, cell)| *cell = smooth(at));
        let packed = PackedMethod::new(&arrays).unwrap();
        let bytes = packed.cube[0].bytes.len();
        assert!(bytes * 8 < arrays.transient.len(), "{bytes} bytes");
    }
}
