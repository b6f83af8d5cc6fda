//! The errors of one method's replicates, split into variance and squared bias: over all cells, over
//! windows of time, bin by bin, kind by kind, and pixel by pixel.
//!
//! One sweep over the cells makes the Gram matrices of the residuals
//! ([`crate::statistics::split`]) of every bin; those of windows and of the whole are sums of them.

use std::ops::Range;

use rayon::prelude::*;

use super::halves::HalfCube;
use super::truth::{Kind, Truth};
use crate::error::{Result, ValidationError};
use crate::statistics::Gram;

/// Parts of the pixels that are swept in parallel; added up in their order, whatever the threads.
const CHUNKS: usize = 64;

/// Inner products of residuals over the cells of one method's replicates.
pub struct Products {
    /// Of judged pixels, for each bin.
    pub frames: Vec<Gram>,
    /// Of all other pixels, over all bins.
    pub others: Gram,
    /// Of judged pixels, for each kind of cells and each bin.
    pub kinds: Vec<Vec<Gram>>,
    /// Variance over replicates of each pixel, summed over bins.
    pub variance: Vec<f64>,
    /// Residual of each pixel's energy within the window, for each replicate.
    pub window_residuals: Vec<Vec<f64>>,
}

/// Sums over a chunk of pixels.
struct Sums {
    frames: Vec<f64>,
    others: Vec<f64>,
    /// (kind, bin).
    kinds: Vec<f64>,
    variance: Vec<f64>,
    window: Vec<f64>,
}

impl Products {
    /// Of cubes of the truth's shape.
    ///
    /// # Errors
    /// If one has another.
    pub fn of(cubes: &[HalfCube], truth: &Truth) -> Result<Self> {
        let shape = (truth.pixels(), truth.bins);
        if cubes.iter().any(|cube| (cube.pixels, cube.bins) != shape) {
            return Err(ValidationError::unusable(
                "a replicate",
                "has another shape than the reference",
            ));
        }
        let n = cubes.len();
        let chunk = truth.pixels().div_ceil(CHUNKS).max(1);
        let starts: Vec<usize> = (0..truth.pixels()).step_by(chunk).collect();
        let parts: Vec<Sums> = starts
            .par_iter()
            .map(|&start| Sums::of(cubes, truth, start..(start + chunk).min(truth.pixels())))
            .collect();
        let square = n * n;
        let mut frames = vec![0.0; truth.bins * square];
        let mut kinds = vec![0.0; Kind::ALL.len() * truth.bins * square];
        let mut others = vec![0.0; square];
        let mut variance = Vec::with_capacity(truth.pixels());
        let mut window_residuals = vec![Vec::with_capacity(truth.pixels()); n];
        let add = |to: &mut [f64], from: &[f64]| to.iter_mut().zip(from).for_each(|(a, b)| *a += b);
        for part in parts {
            add(&mut frames, &part.frames);
            add(&mut others, &part.others);
            add(&mut kinds, &part.kinds);
            variance.extend(part.variance);
            for pixel in part.window.chunks_exact(n) {
                window_residuals.iter_mut().zip(pixel).for_each(|(all, &one)| all.push(one));
            }
        }
        let grams = |products: &[f64]| -> Vec<Gram> {
            products.chunks_exact(square).map(|p| Gram::from_products(n, p.to_vec())).collect()
        };
        Ok(Self {
            frames: grams(&frames),
            others: Gram::from_products(n, others),
            kinds: kinds.chunks_exact(truth.bins * square).map(grams).collect(),
            variance,
            window_residuals,
        })
    }

    /// Of all pixels, over all bins.
    pub fn whole(&self) -> Gram {
        let mut sum = Self::over(&self.frames, 0..self.frames.len());
        sum.add(&self.others);
        sum
    }

    /// Over a range of bins.
    pub fn over(frames: &[Gram], bins: Range<usize>) -> Gram {
        let mut sum = frames[bins.start].clone();
        for frame in &frames[bins.start + 1..bins.end] {
            sum.add(frame);
        }
        sum
    }
}

impl Sums {
    fn of(cubes: &[HalfCube], truth: &Truth, pixels: Range<usize>) -> Self {
        let (n, bins) = (cubes.len(), truth.bins);
        let square = n * n;
        let mut sums = Self {
            frames: vec![0.0; bins * square],
            others: vec![0.0; square],
            kinds: vec![0.0; Kind::ALL.len() * bins * square],
            variance: Vec::with_capacity(pixels.len()),
            window: Vec::with_capacity(pixels.len() * n),
        };
        let mut residuals = vec![vec![0.0; bins]; n];
        let mut products = vec![0.0; square];
        for pixel in pixels {
            let reference = truth.pixel(pixel);
            for (residuals, cube) in residuals.iter_mut().zip(cubes) {
                cube.means(pixel, residuals);
                for (residual, &r) in residuals.iter_mut().zip(reference) {
                    *residual -= f64::from(r);
                }
                sums.window.push(residuals.iter().sum());
            }
            let kinds = truth.kinds(pixel);
            let judged = truth.judged[pixel];
            let mut variance = 0.0;
            for bin in 0..bins {
                multiply(&residuals, bin, &mut products);
                let place = bin * square..(bin + 1) * square;
                let add = |to: &mut [f64]| {
                    to.iter_mut().zip(&products).for_each(|(sum, product)| *sum += product);
                };
                if judged {
                    add(&mut sums.frames[place]);
                    if let Some(&kind) = kinds.get(bin) {
                        let first = (kind as usize * bins + bin) * square;
                        add(&mut sums.kinds[first..first + square]);
                    }
                } else {
                    add(&mut sums.others);
                }
                variance += sample_variance(&residuals, bin);
            }
            sums.variance.push(variance);
        }
        sums
    }
}

fn multiply(residuals: &[Vec<f64>], bin: usize, products: &mut [f64]) {
    let n = residuals.len();
    for i in 0..n {
        for j in 0..=i {
            let product = residuals[i][bin] * residuals[j][bin];
            products[i * n + j] = product;
            products[j * n + i] = product;
        }
    }
}

fn sample_variance(residuals: &[Vec<f64>], bin: usize) -> f64 {
    let n = residuals.len() as f64;
    let mean = residuals.iter().map(|r| r[bin]).sum::<f64>() / n;
    residuals.iter().map(|r| (r[bin] - mean).powi(2)).sum::<f64>() / (n - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::testing::arrays;
    use crate::statistics::ReferenceNoise;

    #[test]
    fn parts_of_the_error_are_found_where_they_are() {
        // Replicates r + noise, and one bin with a bias of 1 in every pixel.
        let like = arrays(8, 4, 6, 1);
        let truth = Truth::of_cells((8, 4, 6), like.transient.clone(), 0.0);
        let cubes: Vec<HalfCube> = (0..4_u32)
            .map(|replicate| {
                let mut arrays = like.clone();
                for (cell, value) in arrays.transient.iter_mut().enumerate() {
                    let sign = if (cell as u32 * 7 + replicate * 3) % 4 < 2 { 1.0 } else { -1.0 };
                    *value += if cell % 6 == 2 { 1.0 } else { 0.25 * sign };
                }
                HalfCube::of(&arrays)
            })
            .collect();
        let products = Products::of(&cubes, &truth).unwrap();
        let parts = |bin: usize| products.frames[bin].parts(&ReferenceNoise::default(), None);
        let [_, variance, bias] = parts(2);
        assert!((bias / 32.0 - 1.0).abs() < 1e-3 && variance.abs() < 1e-3, "{variance} {bias}");
        let [error, variance, _] = parts(4);
        // Signs are balanced over the four replicates: variance 0.0625·4/3 of each of 32 cells.
        assert!((error / 2.0 - 1.0).abs() < 1e-3, "{error}");
        assert!((variance / (8.0 / 3.0) - 1.0).abs() < 1e-2, "{variance}");
        let whole = Products::over(&products.frames, 0..6).parts(&ReferenceNoise::default(), None);
        let sum: f64 = (0..6).map(|bin| parts(bin)[0]).sum();
        assert!((whole[0] / sum - 1.0).abs() < 1e-12);
        let of_pixels: f64 = products.variance.iter().sum();
        assert!((of_pixels / whole[1] - 1.0).abs() < 1e-9, "{of_pixels} {}", whole[1]);
        assert_eq!(products.window_residuals.len(), 4);
    }
}
