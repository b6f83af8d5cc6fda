//! Single scattering in endless fog around a point light, against the exact expected blur.
//!
//! Camera at 0 looking along +z, isotropic light of energy Q at axial distance z and distance b
//! from the ray, time as path length x, q = x − z. The mean over directions of the kernels in closed form:
//!
//! ```text
//! 1D: E[L](x) = 1/(2R) ∫_{−min(R,b)}^{min(R,b)} L(x; √(b² − y²), z) dy,
//!     L(x; b, z) = Q σs p e^{−σt x} / (2π (q² + b²)) from x = √(b² + z²) on;
//! 2D (b > R): E[L](x) = Q σs p e^{−σt x}/(2π R²) [asinh(w/b)] from w1 to w2,
//!     w1 = max((q² − b²)/(2q), −z), w2 = (q² − b² + R²)/(2q); 0 where w2 ≤ w1.
//! ```

use glam::DVec3;
use tpb_beams::{BeamLength, BeamOptions, KernelChoice};
use tpb_optics::Rgb;
use tpb_scene::{IntegratorSpec, Scene};

use crate::scenes;
use crate::transport::render;

const SIGMA_S: f64 = 0.4;
const SIGMA_T: f64 = 0.5;
const Z: f64 = 1.0;
const B: f64 = 0.7;
const RADIUS: f64 = 0.3;
const BINS: usize = 24;
const WIDTH: f64 = 0.25;

/// Isotropic: Q σs p e^{−σt x}/(2π), for Q = 4π.
fn strength(x: f64) -> f64 {
    SIGMA_S * (-SIGMA_T * x).exp() / (2.0 * std::f64::consts::PI)
}

fn expected_1d(x: f64) -> f64 {
    // y = b sin φ removes nothing singular here (R < b); plain midpoints in y.
    let n = 400;
    let dy = 2.0 * RADIUS / f64::from(n);
    let q = x - Z;
    (0..n)
        .map(|i| {
            let y = (f64::from(i) + 0.5) * dy - RADIUS;
            let b2 = B * B - y * y;
            if x * x < b2 + Z * Z { 0.0 } else { dy * strength(x) / (q * q + b2) }
        })
        .sum::<f64>()
        / (2.0 * RADIUS)
}

fn expected_2d(x: f64) -> f64 {
    let q = x - Z;
    if q <= 0.0 {
        return 0.0;
    }
    let w1 = ((q * q - B * B) / (2.0 * q)).max(-Z);
    let w2 = (q * q - B * B + RADIUS * RADIUS) / (2.0 * q);
    if w2 <= w1 {
        return 0.0;
    }
    strength(x) / (RADIUS * RADIUS) * ((w2 / B).asinh() - (w1 / B).asinh())
}

/// The ball's mean of sources, with y the path length since the onset:
/// ½ [y − (H² − R²)/(2H) ln(1 + 2Hy/((H − R)(H + R − y)))].
fn expected_3d(x: f64) -> f64 {
    let y = (x - Z.hypot(B) + RADIUS).min(2.0 * RADIUS);
    if y <= 0.0 {
        return 0.0;
    }
    let h = (x - Z).hypot(B);
    let logarithm = (2.0 * h * y / ((h - RADIUS) * (h + RADIUS - y))).ln_1p();
    let integral = 0.5 * (y - (h * h - RADIUS * RADIUS) / (2.0 * h) * logarithm);
    1.5 * strength(x) * integral / RADIUS.powi(3)
}

fn bins(density: impl Fn(f64) -> f64) -> Vec<f64> {
    let n = 400;
    let dx = WIDTH / f64::from(n);
    (0..BINS)
        .map(|bin| {
            (0..n).map(|i| density(bin as f64 * WIDTH + (f64::from(i) + 0.5) * dx) * dx).sum()
        })
        .collect()
}

/// One pixel so narrow that all its rays are the axis.
fn scene() -> Scene {
    let sensor = scenes::camera(DVec3::ZERO, DVec3::Z, 1e-9, (1, 1));
    let light = scenes::point(DVec3::new(B, 0.0, Z), Rgb::ONE);
    let film = scenes::film(1, 1, WIDTH, BINS);
    let parts = scenes::infinite(scenes::fog(SIGMA_S, SIGMA_T, 0.0), light, sensor, film);
    Scene::assemble(parts).expect("the scene is consistent")
}

/// 24 bins, 4 runs: 96 normal deviates of the mean of 60 passes. Beyond 5.5 sigma (Student's t
/// with 59 degrees of freedom) each with 9e-7: false alarm below 1e-4.
#[test]
fn single_scattering_in_fog_is_the_expected_blur() {
    let scene = scene();
    let integrator = IntegratorSpec { max_depth: Some(2), min_depth: 2, ..Default::default() };
    for kernel in [KernelChoice::OneD, KernelChoice::TwoD, KernelChoice::ThreeD] {
        let expected = match kernel {
            KernelChoice::OneD => bins(expected_1d),
            KernelChoice::TwoD => bins(expected_2d),
            KernelChoice::ThreeD => bins(expected_3d),
        };
        for length in [BeamLength::Long, BeamLength::Short] {
            let options = BeamOptions {
                kernel: Some(kernel),
                length: Some(length),
                radius: Some(RADIUS),
                radius_exponent: Some(0.0),
                photons_per_pass: Some(5_000),
                ..Default::default()
            };
            let (arrays, _) = render(&scene, integrator, &options, 60);
            let variance = arrays.variance.expect("variance was asked for");
            let mut largest_z: f64 = 0.0;
            for (bin, &truth) in expected.iter().enumerate() {
                let (value, error) =
                    (f64::from(arrays.transient[bin]), f64::from(variance[bin]).sqrt());
                if truth == 0.0 {
                    assert!(value == 0.0, "{kernel:?} {length:?} bin {bin}: light too early");
                    continue;
                }
                // Quadrature of the step at the front: 1 part in 400 of a bin, in one bin.
                let slack = 1e-5 * truth + if bin < 6 { 2e-3 * truth } else { 0.0 };
                let z = ((value - truth).abs() - slack) / error;
                largest_z = largest_z.max(z);
                assert!(z < 5.5, "{kernel:?} {length:?} bin {bin}: {value} {truth} ± {error}");
            }
            let total: f64 = arrays.transient.iter().map(|&v| f64::from(v)).sum();
            let error = variance.iter().map(|&v| f64::from(v)).sum::<f64>().sqrt();
            assert!(error < 0.02 * total, "power of the test: {error} of {total}");
        }
    }
}
