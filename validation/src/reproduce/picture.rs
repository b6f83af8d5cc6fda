//! Pictures as plain pixels: composed, enlarged, written as PNG.

use std::io::Cursor;
use std::path::Path;

use tpb_film::{Arrays, atomic_write};

use super::colour::srgb;
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

    /// The mean of squares of `side` by `side`, in display values; less at right and lower ends.
    #[must_use]
    pub fn reduced(&self, side: usize) -> Self {
        let (width, height) = (self.width.div_ceil(side), self.height.div_ceil(side));
        Self::by_pixel(width, height, |pixel| {
            let (x0, y0) = (pixel % width * side, pixel / width * side);
            let (mut sums, mut count) = ([0_u32; 3], 0);
            for y in y0..(y0 + side).min(self.height) {
                for colour in
                    &self.pixels[y * self.width + x0..y * self.width + (x0 + side).min(self.width)]
                {
                    sums.iter_mut().zip(colour).for_each(|(sum, &c)| *sum += u32::from(c));
                    count += 1;
                }
            }
            sums.map(|sum| ((sum + count / 2) / count) as u8)
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
    fn reducing_takes_means_also_at_the_ends() {
        let picture = Picture::by_pixel(3, 2, |pixel| [pixel as u8 * 10, 7, pixel as u8]);
        // Red: (0 + 10 + 30 + 40)/4 and (20 + 50)/2; blue is rounded: (2 + 5)/2.
        assert_eq!(picture.reduced(2).pixels, [[20, 7, 2], [35, 7, 4]]);
        assert_eq!(picture.reduced(1), picture);
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
