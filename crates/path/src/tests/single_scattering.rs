//! One scattering event in infinite fog, point light and camera within, against quadrature.
//!
//! With the foot of the light on the ray at distance c, its height h over the ray and
//! s = c + h·tanθ, ds/r² = dθ/h, so that
//!
//! ```text
//! L = (I σ_s/h) ∫ p(w·(light − x)/r) exp(−σ_t (s + r)) dθ,     τ = s + r,
//! ```
//!
//! which is smooth; and τ grows with s: s(τ) = (τ² − D²)/(2(τ − c)), D the light's distance.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use tpb_optics::{Phase, Rgb};
use tpb_scene::Scene;

use super::stats::{estimate, image_and_blocks};
use super::worlds::{FOG, ONE_RAY, camera, depths, medium, point_light, time, tracer};

const LIGHT: DVec3 = DVec3::new(0.3, 0.8, 1.5);
const INTENSITY: f64 = 2.0;
const BINS: usize = 10;
const WINDOW: (f64, f64) = (1.6, 5.6);

fn scene(sigma_s: Rgb, sigma_t: Rgb, g: f64) -> Scene {
    let mut parts = camera(DVec3::ZERO, DVec3::Z, ONE_RAY);
    parts.media.push(medium(sigma_s, sigma_t, g));
    parts.background = Some(FOG);
    parts.emitters.push(point_light(LIGHT, Rgb::splat(INTENSITY)));
    parts.film.time = Some(time(WINDOW.0, WINDOW.1, BINS));
    Scene::assemble(parts).unwrap()
}

/// Energy that arrives within `opl`, by the midpoint rule.
fn energy(sigma_s: f64, sigma_t: f64, g: f64, opl: (f64, f64)) -> f64 {
    let (c, h) = (LIGHT.z, LIGHT.truncate().length());
    let theta = |opl: f64| {
        let reached = (opl * opl - LIGHT.length_squared()) / (2.0 * (opl - c));
        if opl.is_infinite() { FRAC_PI_2 } else { (reached.max(0.0) - c).atan2(h) }
    };
    let (a, b) = (theta(opl.0.max(LIGHT.length())), theta(opl.1));
    let n = 100_000;
    let step = (b - a) / f64::from(n);
    let sum: f64 = (0..n)
        .map(|i| {
            let theta = a + (f64::from(i) + 0.5) * step;
            let (s, r) = (c + h * theta.tan(), h / theta.cos());
            Phase::with_mean_cosine(g).value((c - s) / r) * (-sigma_t * (s + r)).exp()
        })
        .sum();
    INTENSITY * sigma_s / h * sum * step
}

/// Steady radiance, then the bins; each for all channels.
fn expected(sigma_s: &[f64], sigma_t: &[f64], g: f64) -> Vec<f64> {
    let edge = |i: usize| WINDOW.0 + (WINDOW.1 - WINDOW.0) * i as f64 / BINS as f64;
    let intervals = (0..BINS).map(|i| (edge(i), edge(i + 1)));
    std::iter::once((0.0, f64::INFINITY))
        .chain(intervals)
        .flat_map(|opl| {
            sigma_s
                .iter()
                .zip(sigma_t)
                .map(move |(&s, &t)| energy(s, t, g, opl))
                .collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn grey_fog_isotropic_and_forward() {
    // False-alarm probability 1e-6 for each phase function.
    for (g, seed) in [(0.0, 11), (0.9, 12), (-0.6, 13)] {
        let scene = scene(Rgb::splat(0.4), Rgb::splat(0.5), g);
        let tracer = tracer::<1>(&scene, depths(2, 2), 3000);
        let got = estimate(&tracer, seed, 32, image_and_blocks(BINS));
        got.assert_are(&expected(&[0.4], &[0.5], g), 3e-3, "grey fog");
    }
}

#[test]
fn coloured_fog_isotropic_and_forward() {
    // False-alarm probability 1e-6 for each phase function.
    let (sigma_s, sigma_t) = ([0.1, 0.4, 1.2], [0.2, 0.5, 1.5]);
    for (g, seed) in [(0.0, 14), (0.9, 15)] {
        let scene = scene(tpb_optics::Spectrum(sigma_s), tpb_optics::Spectrum(sigma_t), g);
        let tracer = tracer::<3>(&scene, depths(2, 2), 3000);
        let got = estimate(&tracer, seed, 32, image_and_blocks(BINS));
        got.assert_are(&expected(&sigma_s, &sigma_t, g), 3e-3, "coloured fog");
    }
}

#[test]
fn a_one_percent_error_would_be_seen() {
    // The negative control of the tests above: 1 % more scattering must be rejected.
    let scene = scene(Rgb::splat(0.4), Rgb::splat(0.5), 0.0);
    let tracer = tracer::<1>(&scene, depths(2, 2), 3000);
    let got = estimate(&tracer, 11, 32, image_and_blocks(BINS));
    let wrong = expected(&[0.404], &[0.5], 0.0);
    let rejected = std::panic::catch_unwind(|| got.assert_are(&wrong, 3e-3, "control"));
    assert!(rejected.is_err());
}

#[test]
fn the_quadrature_is_that_of_the_plain_integral() {
    // Over s itself, without the substitution: PI only enters by the phase function.
    let n = 2_000_000;
    let step = 60.0 / f64::from(n);
    let plain: f64 = (0..n)
        .map(|i| {
            let s = (f64::from(i) + 0.5) * step;
            let r = (LIGHT - DVec3::Z * s).length();
            (-0.5 * (s + r)).exp() / (r * r) * step
        })
        .sum();
    let got = energy(0.4, 0.5, 0.0, (0.0, f64::INFINITY));
    assert!((got / (0.4 * INTENSITY * plain / (4.0 * PI)) - 1.0).abs() < 1e-8, "{got}");
}
