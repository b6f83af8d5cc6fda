//! Time-resolved images as half floats, for the many renders that are kept until they are judged.
//!
//! Each frame has a scale of its own: its brightest cell is 2¹⁵ of it. What is at least 2⁻²⁹ of the
//! brightest cell keeps 11 bits, a relative rounding of at most 4.9e-4; its square, 2.4e-7, is far
//! below the squared errors that are measured. Cells below 2⁻⁴⁰ of the brightest become 0.

use half::f16;
use tpb_film::Arrays;

/// What the brightest cell of a frame becomes.
const LARGEST: f32 = 32_768.0;

/// The bins of all pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfCube {
    /// Pixels.
    pub pixels: usize,
    /// Time bins.
    pub bins: usize,
    /// Channels.
    pub channels: usize,
    /// Of each frame, to be multiplied with.
    pub scale: Vec<f32>,
    /// (pixel, bin, channel), over the scale.
    pub values: Vec<f16>,
}

impl HalfCube {
    /// The bins of a render, all channels.
    pub fn of(arrays: &Arrays) -> Self {
        let Arrays { bins, channels, .. } = *arrays;
        Self::new((arrays.pixels(), bins, channels), &arrays.transient)
    }

    /// The mean over the channels of a render's bins.
    pub fn mean_of(arrays: &Arrays) -> Self {
        let Arrays { bins, channels, .. } = *arrays;
        if channels == 1 {
            return Self::of(arrays);
        }
        let mean = |cell: &[f32]| cell.iter().sum::<f32>() / channels as f32;
        let means: Vec<f32> = arrays.transient.chunks_exact(channels).map(mean).collect();
        Self::new((arrays.pixels(), bins, 1), &means)
    }

    fn new((pixels, bins, channels): (usize, usize, usize), cells: &[f32]) -> Self {
        let mut brightest = vec![0.0_f32; bins];
        for (cell, value) in cells.iter().enumerate() {
            let frame = &mut brightest[cell / channels % bins];
            *frame = frame.max(value.abs());
        }
        let scale: Vec<f32> = brightest
            .into_iter()
            .map(|largest| if largest > 0.0 { largest / LARGEST } else { 1.0 })
            .collect();
        let values = cells
            .iter()
            .enumerate()
            .map(|(cell, value)| f16::from_f32(value / scale[cell / channels % bins]))
            .collect();
        Self { pixels, bins, channels, scale, values }
    }

    /// The bins of a pixel, averaged over channels.
    pub fn means(&self, pixel: usize, bins: &mut [f64]) {
        let size = self.bins * self.channels;
        let cells = self.values[pixel * size..(pixel + 1) * size].chunks_exact(self.channels);
        for ((mean, cell), scale) in bins.iter_mut().zip(cells).zip(&self.scale) {
            let sum: f64 = cell.iter().map(|value| value.to_f64()).sum();
            *mean = sum * f64::from(*scale) / self.channels as f64;
        }
    }

    /// All cells as they were, to rounding.
    pub fn cells(&self) -> Vec<f32> {
        let frame = |cell: usize| cell / self.channels % self.bins;
        let values = self.values.iter().enumerate();
        values.map(|(cell, value)| value.to_f32() * self.scale[frame(cell)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::testing::arrays;

    #[test]
    fn bright_and_dark_frames_keep_their_digits() {
        let mut arrays = arrays(3, 2, 4, 3);
        for (cell, value) in arrays.transient.iter_mut().enumerate() {
            let bin = cell / 3 % 4;
            *value *= [1.0, 1e-9, 1e-18, 1e-27][bin];
        }
        let cube = HalfCube::of(&arrays);
        for (kept, exact) in cube.cells().iter().zip(&arrays.transient) {
            assert!((kept - exact).abs() <= 4.9e-4 * exact, "{kept} {exact}");
        }
        let (mut a, mut b) = (vec![0.0; 4], vec![0.0; 4]);
        cube.means(5, &mut a);
        HalfCube::mean_of(&arrays).means(5, &mut b);
        for (a, b) in a.iter().zip(&b) {
            assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        }
    }

    #[test]
    fn a_black_frame_stays_black() {
        let mut arrays = arrays(2, 2, 3, 1);
        arrays.transient.fill(0.0);
        assert!(HalfCube::of(&arrays).cells().iter().all(|&v| v == 0.0));
    }
}
