//! Pictures as plain pixels: composed, enlarged, written as PNG.

use std::io::Cursor;
use std::path::Path;

use tpb_film::{Arrays, atomic_write, linear_of_srgb, srgb};

use crate::error::{Result, ValidationError};

/// Pictures of a document are at most this wide, and so many in a row.
const SMALL: usize = 128;
const SMALL_COLUMNS: usize = 4;

/// An RGB picture of 8 bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// One colour.
    pub fn filled(width: usize, height: usize, colour: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![colour; width * height] }
    }

    /// A colour for each pixel, which are numbered row by row.
    pub fn by_pixel(width: usize, height: usize, colour: impl Fn(usize) -> [u8; 3]) -> Self {
        Self { width, height, pixels: (0..width * height).map(colour).collect() }
    }

    /// One bin of a cube, `white` being display white.
    pub fn frame(arrays: &Arrays, bin: usize, white: f64) -> Self {
        let channels = arrays.channels;
        Self::by_pixel(arrays.width, arrays.height, |pixel| {
            let cell = &arrays.pixel(pixel)[bin * channels..(bin + 1) * channels];
            shown(cell.iter().map(|&v| f64::from(v)), white)
        })
    }

    /// The steady image.
    pub fn steady(arrays: &Arrays, white: f64) -> Self {
        let channels = arrays.channels;
        Self::by_pixel(arrays.width, arrays.height, |pixel| {
            shown(arrays.steady[pixel * channels..(pixel + 1) * channels].iter().copied(), white)
        })
    }

    /// The mean light of squares of `side` by `side`: samples are decoded, averaged, and encoded, so
    /// that noise does not change brightness. Squares at right and lower ends may be smaller. What was
    /// cut off at white stays cut off.
    #[must_use]
    pub fn reduced(&self, side: usize) -> Self {
        if side == 1 {
            return self.clone();
        }
        let linear: Vec<f64> = (0..=255).map(|s| linear_of_srgb(f64::from(s) / 255.0)).collect();
        let (width, height) = (self.width.div_ceil(side), self.height.div_ceil(side));
        Self::by_pixel(width, height, |pixel| {
            let (x0, y0) = (pixel % width * side, pixel / width * side);
            let (mut sums, mut count) = ([0.0; 3], 0.0);
            for y in y0..(y0 + side).min(self.height) {
                let row = y * self.width;
                for colour in &self.pixels[row + x0..row + (x0 + side).min(self.width)] {
                    let light = colour.map(|sample| linear[usize::from(sample)]);
                    sums.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
                    count += 1.0;
                }
            }
            sums.map(|sum| srgb(sum / count))
        })
    }

    /// Pictures of one size in a grid, row by row, `gap` pixels of a colour apart.
    pub fn grid(rows: &[Vec<Self>], gap: usize, colour: [u8; 3]) -> Self {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let (w, h) = rows.iter().flatten().next().map_or((0, 0), |p| (p.width, p.height));
        let size = |count: usize, side: usize| count * side + count.saturating_sub(1) * gap;
        let mut whole = Self::filled(size(columns, w), size(rows.len(), h), colour);
        for (row, pictures) in rows.iter().enumerate() {
            for (column, picture) in pictures.iter().enumerate() {
                whole.put(picture, column * (w + gap), row * (h + gap));
            }
        }
        whole
    }

    /// Rows of pictures for a document: some of the columns, in a smaller size.
    pub fn small_grid(rows: &[Vec<Self>], gap: usize, colour: [u8; 3]) -> Self {
        let step = rows.iter().map(Vec::len).max().unwrap_or(0).div_ceil(SMALL_COLUMNS).max(1);
        let small = |row: &Vec<Self>| -> Vec<Self> {
            row.iter().step_by(step).map(|p| p.reduced(p.width.div_ceil(SMALL).max(1))).collect()
        };
        Self::grid(&rows.iter().map(small).collect::<Vec<_>>(), gap, colour)
    }

    /// Puts another picture onto this one; what is outside is left out.
    pub fn put(&mut self, other: &Self, x: usize, y: usize) {
        let width = other.width.min(self.width.saturating_sub(x));
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let to = (y + row) * self.width + x;
            let from = row * other.width;
            self.pixels[to..to + width].copy_from_slice(&other.pixels[from..from + width]);
        }
    }

    /// As the bytes of a PNG file.
    ///
    /// # Errors
    /// If it has no pixels.
    pub fn png(&self) -> Result<Vec<u8>> {
        let failed = |error: String| ValidationError::unusable("picture", error);
        let side = |n: usize| u32::try_from(n).map_err(|e| failed(e.to_string()));
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = png::Encoder::new(&mut bytes, side(self.width)?, side(self.height)?);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder
            .write_header()
            .and_then(|mut writer| {
                writer.write_image_data(self.pixels.as_flattened())?;
                writer.finish()
            })
            .map_err(|error| failed(error.to_string()))?;
        Ok(bytes.into_inner())
    }

    /// Writes it as a PNG file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<()> {
        let bytes = self.png()?;
        Ok(atomic_write(path, |file| std::io::Write::write_all(file, &bytes))?)
    }
}

/// One or three channels as a colour.
fn shown(mut channels: impl Iterator<Item = f64>, white: f64) -> [u8; 3] {
    let red = srgb(channels.next().unwrap_or(0.0) / white);
    let (green, blue) = match (channels.next(), channels.next()) {
        (Some(green), Some(blue)) => (srgb(green / white), srgb(blue / white)),
        _ => (red, red),
    };
    [red, green, blue]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_their_gaps_and_pictures_in_place() {
        let tile = |c: u8| Picture::filled(3, 2, [c; 3]);
        let whole = Picture::grid(&[vec![tile(1), tile(2)], vec![tile(3)]], 1, [9; 3]);
        assert_eq!((whole.width, whole.height), (7, 5));
        let row = |y: usize| -> Vec<u8> { (0..7).map(|x| whole.pixels[y * 7 + x][0]).collect() };
        assert_eq!(row(0), [1, 1, 1, 9, 2, 2, 2]);
        assert_eq!(row(2), [9; 7]);
        assert_eq!(row(4), [3, 3, 3, 9, 9, 9, 9]);
    }

    #[test]
    fn reducing_takes_means_of_light_also_at_the_ends() {
        let red = [0, 100, 50, 255, 255, 255];
        let picture = Picture::by_pixel(3, 2, |pixel| [red[pixel], 7, 255]);
        // sRGB's linear values of 100 and 50 are 0.1274 and 0.0319: the means are
        // (0 + 0.1274 + 1 + 1)/4 = 0.5319 and (0.0319 + 1)/2 = 0.5160, encoded 193 and 190.
        assert_eq!(picture.reduced(2).pixels, [[193, 7, 255], [190, 7, 255]]);
        assert_eq!(picture.reduced(1), picture);
    }

    /// Two frames of the same light, one quiet, one noisy, are equally bright when they are small.
    #[test]
    fn noise_does_not_darken_a_smaller_picture() {
        let frame = |light: &dyn Fn(usize) -> f64| {
            Picture::by_pixel(64, 64, |pixel| [srgb(light(pixel)); 3]).reduced(64).pixels[0][0]
        };
        let (quiet, noisy) = (frame(&|_| 0.25), frame(&|pixel| f64::from(pixel % 4 == 0)));
        assert_eq!((quiet, noisy), (137, 137), "the mean of encoded values would be 64");
    }

    #[test]
    fn a_png_has_the_pixels() {
        let picture = Picture::by_pixel(4, 3, |pixel| [pixel as u8, 2, 3]);
        let decoder = png::Decoder::new(Cursor::new(picture.png().unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; 36];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, picture.pixels.as_flattened());
        assert!(Picture::filled(0, 0, [0; 3]).png().is_err());
    }
}
