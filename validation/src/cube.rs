//! A time-resolved image as plain numbers: per pixel what came before the window, its bins, and
//! what came after.

use tpb_film::Arrays;

/// Values of one channel, or the mean over channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Cube {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Time bins of a pixel.
    pub bins: usize,
    /// (pixel, cell): cell 0 is before, `1..=bins` the bins, `bins + 1` after.
    pub values: Vec<f64>,
}

impl Cube {
    /// All zero.
    pub fn zero(width: usize, height: usize, bins: usize) -> Self {
        Self { width, height, bins, values: vec![0.0; width * height * (bins + 2)] }
    }

    /// The arrays of a render, channels averaged. A steady film gives pixels without bins whose
    /// only energy is in the cell before.
    pub fn of(arrays: &Arrays) -> Self {
        let &Arrays { width, height, bins, channels, .. } = arrays;
        let mut cube = Self::zero(width, height, bins);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / channels as f64;
        for pixel in 0..width * height {
            let image = pixel * channels..(pixel + 1) * channels;
            let cells = cube.pixel_mut(pixel);
            if bins == 0 {
                cells[0] = mean(&arrays.steady[image]);
                continue;
            }
            cells[0] = mean(&arrays.before[image.clone()]);
            cells[bins + 1] = mean(&arrays.after[image]);
            for (cell, bin) in cells[1..].iter_mut().zip(arrays.pixel(pixel).chunks(channels)) {
                *cell = bin.iter().map(|&v| f64::from(v)).sum::<f64>() / channels as f64;
            }
        }
        cube
    }

    /// The arrays of a render, its channels one below the other as images of their own: pixel p of
    /// channel c is pixel p + c · (width · height).
    pub fn stacked(arrays: &Arrays) -> Self {
        let &Arrays { width, height, bins, channels, .. } = arrays;
        let pixels = width * height;
        let mut cube = Self::zero(width, height * channels, bins);
        for (pixel, channel) in (0..pixels).flat_map(|p| (0..channels).map(move |c| (p, c))) {
            let at = pixel * channels + channel;
            let cells = cube.pixel_mut(pixel + channel * pixels);
            if bins == 0 {
                cells[0] = arrays.steady[at];
                continue;
            }
            (cells[0], cells[bins + 1]) = (arrays.before[at], arrays.after[at]);
            let line = arrays.pixel(pixel);
            for (bin, cell) in cells[1..=bins].iter_mut().enumerate() {
                *cell = f64::from(line[bin * channels + channel]);
            }
        }
        cube
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// All cells of a pixel.
    pub fn pixel(&self, pixel: usize) -> &[f64] {
        let cells = self.bins + 2;
        &self.values[pixel * cells..(pixel + 1) * cells]
    }

    /// All cells of a pixel, to be changed.
    pub fn pixel_mut(&mut self, pixel: usize) -> &mut [f64] {
        let cells = self.bins + 2;
        &mut self.values[pixel * cells..(pixel + 1) * cells]
    }

    /// The bins of a pixel.
    pub fn pixel_bins(&self, pixel: usize) -> &[f64] {
        &self.pixel(pixel)[1..=self.bins]
    }

    /// The sum over pixels of each bin.
    pub fn sum_of_pixels(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.bins];
        for pixel in 0..self.pixels() {
            for (sum, value) in sums.iter_mut().zip(self.pixel_bins(pixel)) {
                *sum += value;
            }
        }
        sums
    }

    /// Multiplies everything.
    pub fn scale(&mut self, factor: f64) {
        for value in &mut self.values {
            *value *= factor;
        }
    }
}

/// Grows a mask by one pixel in all eight directions.
pub fn dilate(mask: &[bool], width: usize, height: usize) -> Vec<bool> {
    let near = |centre: usize, size: usize| centre.saturating_sub(1)..(centre + 2).min(size);
    (0..width * height)
        .map(|pixel| {
            let (x, y) = (pixel % width, pixel / width);
            near(y, height).any(|y| near(x, width).any(|x| mask[y * width + x]))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dilation_reaches_the_eight_neighbours_and_stops_at_the_border() {
        let mut mask = vec![false; 12];
        mask[0] = true;
        let grown = dilate(&mask, 4, 3);
        let expected = [0, 1, 4, 5];
        assert!((0..12).all(|pixel| grown[pixel] == expected.contains(&pixel)));
    }

    #[test]
    fn cells_are_before_bins_after() {
        let mut cube = Cube::zero(2, 1, 3);
        cube.pixel_mut(1).copy_from_slice(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        cube.scale(2.0);
        assert_eq!(cube.pixel_bins(1), [4.0, 6.0, 8.0]);
        assert_eq!(cube.pixel(0), [0.0; 5]);
    }
}
