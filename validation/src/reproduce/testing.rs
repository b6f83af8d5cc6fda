//! Arrays for tests.

use tpb_film::{Arrays, Quantity};

/// Arrays whose cells are all different and positive; before, after and steady agree with them.
pub(crate) fn arrays(width: usize, height: usize, bins: usize, channels: usize) -> Arrays {
    let pixels = width * height;
    let transient: Vec<f32> =
        (0..pixels * bins * channels).map(|cell| 1.0 + (cell * 37 % 101) as f32 * 0.01).collect();
    let mut steady = vec![0.0; pixels * channels];
    for (cell, value) in transient.iter().enumerate() {
        steady[cell / (bins * channels) * channels + cell % channels] += f64::from(*value);
    }
    Arrays {
        width,
        height,
        bins,
        channels,
        quantity: Quantity::BinEnergy,
        opl_edges: (0..=bins).map(|edge| edge as f64).collect(),
        transient,
        variance: None,
        before: vec![0.0; pixels * channels],
        after: vec![0.0; pixels * channels],
        steady,
    }
}
