//! Cubes for tests: bright and dark cells over many decades, zeros, a moving front.

use tpb_film::{Arrays, Quantity};

/// A cube with a front that crosses the image, the same for the same shape.
pub(crate) fn cube(width: usize, height: usize, bins: usize, channels: usize) -> Arrays {
    let mut transient = Vec::with_capacity(width * height * bins * channels);
    let mut steady = vec![0.0; width * height * channels];
    let mut state = 12_345_u32;
    for pixel in 0..width * height {
        let front = (pixel % width + pixel / width) * bins / (width + height);
        for bin in 0..bins {
            for channel in 0..channels {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let noise = f64::from(state >> 8) / f64::from(1 << 24);
                let age = bin as f64 - front as f64;
                let decay = (-age / 20.0).exp() * (0.9 + 0.2 * noise) * (1.0 + channel as f64);
                let value = if age < 0.0 { 0.0 } else { (1e-3 * decay) as f32 };
                transient.push(value);
                steady[pixel * channels + channel] += f64::from(value);
            }
        }
    }
    let outside = vec![1e-4; width * height * channels];
    let steady: Vec<f64> = steady.iter().map(|s| s + 2e-4).collect();
    Arrays {
        width,
        height,
        bins,
        channels,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| 1.0 + 0.01 * edge as f64).collect(),
        transient,
        variance: None,
        before: outside.clone(),
        after: outside,
        steady,
    }
}

/// The same with a relative standard error of each cell.
pub(crate) fn with_error(mut arrays: Arrays, relative: f32) -> Arrays {
    let variance = arrays.transient.iter().map(|value| (relative * value).powi(2)).collect();
    arrays.variance = Some(variance);
    arrays
}
