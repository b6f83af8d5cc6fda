//! Arrays and comparisons for tests.

use tpb_film::{Arrays, Quantity};

use super::compare::{AtTime, Comparison, Standing};
use super::race::Spent;
use crate::statistics::Split;
use crate::statistics::split::Estimate;

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

/// A comparison of path tracing, 4 passes, and beams, 2, without any parts.
pub(crate) fn comparison() -> Comparison {
    let estimate = Estimate { value: 1.0, standard_error: 0.1, interval: [0.8, 1.2] };
    let split = Split {
        nmse: estimate,
        variance: estimate,
        squared_bias: estimate,
        p_no_bias: 0.5,
        replicates: vec![1.0; 5],
    };
    let standing = |passes: u64| Standing {
        spent: Spent { wall_seconds: 1.0, cpu_seconds: 2.0, passes },
        passes: passes as f64,
        judged: split.clone(),
        whole: Some(split.clone()),
    };
    let whole = AtTime {
        seconds: 1.0,
        methods: vec![standing(4), standing(2)],
        factor: None,
        factor_whole: None,
        factor_wall: None,
    };
    Comparison {
        methods: vec!["path".into(), "beams".into()],
        options: vec![serde_json::Value::Null; 2],
        replicates: 5,
        shape: [4, 4, 8],
        pixels: [12, 16],
        reference: None,
        reference_cpu_seconds: 10.0,
        reference_nmse: 1e-3,
        times: vec![whole],
        windows: Vec::new(),
        kinds: Vec::new(),
        kinds_in_windows: Vec::new(),
        lamps: None,
        frames: Vec::new(),
    }
}
