//! Results to show: a pulse that sweeps over the image and fades, in two noisy versions.

use tpb_film::{Arrays, Quantity};
use tpb_viewer::{Comparison, Method};

/// Shape of the test scene: (columns, rows, bins).
pub(crate) const SHAPE: (usize, usize, usize) = (14, 10, 40);

/// Metres of OPL of a bin.
pub(crate) const BIN: f64 = 0.06;

/// A result; `noise` is its relative standard deviation, kept as variance if not 0.
pub(crate) fn arrays(channels: usize, noise: f64, seed: u32) -> Arrays {
    let (width, height, bins) = SHAPE;
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) - 0.5
    };
    let mut transient = Vec::new();
    let mut variance = Vec::new();
    for pixel in 0..width * height {
        let (x, y) = (pixel % width, pixel / width);
        let front = 3.0 + 0.9 * x as f64 + 1.1 * y as f64;
        for bin in 0..bins {
            let age = bin as f64 - front;
            let light = if age < 0.0 { 0.0 } else { 2e-3 * (-age / 9.0).exp() };
            // Uniform noise of the wanted deviation: √12 times its width.
            let factor = 1.0 + noise * 12.0_f64.sqrt() * random();
            for channel in 0..channels {
                let value = light * factor * (1.0 - 0.3 * channel as f64);
                transient.push(value as f32);
                variance.push((noise * value).powi(2) as f32);
            }
        }
    }
    let outside = vec![3e-5; width * height * channels];
    let mut steady: Vec<f64> = outside.iter().map(|o| 2.0 * o).collect();
    for (pixel, cells) in transient.chunks_exact(bins * channels).enumerate() {
        for (at, &cell) in cells.iter().enumerate() {
            steady[pixel * channels + at % channels] += f64::from(cell);
        }
    }
    Arrays {
        width,
        height,
        bins,
        channels,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| 2.0 + BIN * edge as f64).collect(),
        transient,
        variance: (noise > 0.0).then_some(variance),
        before: outside.clone(),
        after: outside,
        steady,
    }
}

/// A steady result.
pub(crate) fn steady() -> Arrays {
    let mut arrays = arrays(1, 0.0, 1);
    arrays.bins = 0;
    for list in [&mut arrays.before, &mut arrays.after, &mut arrays.opl_edges] {
        list.clear();
    }
    arrays.transient.clear();
    arrays
}

/// Two methods and a reference.
pub(crate) struct Scene {
    pub(crate) path: Arrays,
    pub(crate) beams: Arrays,
    pub(crate) reference: Arrays,
}

impl Scene {
    pub(crate) fn new(channels: usize) -> Self {
        Self {
            path: arrays(channels, 0.2, 1),
            beams: arrays(channels, 0.05, 2),
            reference: arrays(channels, 0.0, 3),
        }
    }

    /// All three, the reference last.
    pub(crate) fn comparison(&self) -> Comparison<'_> {
        let mut path = Method::new("path", "path tracing", &self.path);
        path.batches = Some(5);
        path.provenance.push(("seed".to_owned(), "7".to_owned()));
        path.command = Some("tpb render scene.json --method path".to_owned());
        let beams = Method::new("beams", "photon beams", &self.beams);
        let mut reference = Method::new("reference", "reference", &self.reference);
        reference.is_reference = true;
        Comparison::new("A sweep", vec![path, beams, reference])
    }

    /// In the order of the number keys.
    pub(crate) fn all(&self) -> [&Arrays; 3] {
        [&self.path, &self.beams, &self.reference]
    }
}

/// A cell of some arrays.
pub(crate) fn cell(arrays: &Arrays, x: usize, y: usize, bin: usize, channel: usize) -> f64 {
    f64::from(arrays.pixel(y * arrays.width + x)[bin * arrays.channels + channel])
}
