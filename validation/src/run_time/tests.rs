use super::slope::{Resolved, slope};
use crate::statistics::{Gram, ReferenceNoise};

const NO_NOISE: ReferenceNoise =
    ReferenceNoise { power: 1.0, variance: 0.0, squares: 0.0, largest: 0.0 };

/// Residuals of four replicates whose size falls as seconds^exponent.
fn checkpoint(seconds: f64, exponent: f64) -> Resolved {
    let size = seconds.powf(0.5 * exponent);
    let residuals: Vec<Vec<f64>> = (0..4)
        .map(|i| (0..8).map(|cell| if cell % 4 == i { size } else { 0.0 }).collect())
        .collect();
    Resolved::new(&Gram::of(&residuals), &NO_NOISE, &[seconds; 4], 0)
}

#[test]
fn a_power_law_has_its_exponent_as_slope() {
    for exponent in [-1.0, -0.8, 0.0] {
        let points: Vec<Resolved> =
            (0..6).map(|k| checkpoint(0.1 * 2.0_f64.powi(k), exponent)).collect();
        let slope = slope(&points, 0.95).unwrap();
        assert!((slope.value - exponent).abs() < 1e-12, "{slope:?}");
        assert!(slope.standard_error < 1e-12, "replicates of one size do not scatter");
    }
}

#[test]
fn one_checkpoint_has_no_slope() {
    assert!(slope(&[checkpoint(1.0, -1.0)], 0.95).is_none());
}
