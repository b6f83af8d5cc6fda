//! The unit sphere with diffuse walls, light and camera at its centre, order by order.
//!
//! Reflection order k has radiance L_k = Qρ^k/(4π²R²) everywhere, Q the light's power. It arrives
//! at 2R plus k − 1 chords, each of density l/(2R²) on [0, 2R] (J. Arvo's chord statistics of the
//! sphere: the next wall point is uniform over the area). In x = l/2R: f_1(x) = 2x, and two chords
//! together have the distribution below.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_scene::{IntegratorSpec, Scene};

use super::stats::{estimate, image_and_blocks, pass};
use super::worlds::{ball, camera, depths, diffuse, point_light, shape, time, tracer};

const REFLECTANCE: f64 = 0.7;
const INTENSITY: f64 = 3.0;
const BINS: usize = 8;

/// Bins cover `span` from 2R on.
fn scene(span: f64) -> Scene {
    let mut parts = camera(DVec3::ZERO, DVec3::new(0.1, 0.2, 1.0), (40.0, 4, 4));
    let wall = diffuse(Rgb::splat(REFLECTANCE));
    parts.shapes.push(shape("wall", vec![ball(DVec3::ZERO, 1.0, true)], wall));
    parts.emitters.push(point_light(DVec3::ZERO, Rgb::splat(INTENSITY)));
    // Half a millionth early: order 1 arrives at 2 up to rounding.
    parts.film.time = Some(time(2.0 - 5e-7, 2.0 - 5e-7 + span, BINS));
    Scene::assemble(parts).unwrap()
}

/// L_k, with Q = 4π·intensity.
fn radiance(order: u32) -> f64 {
    INTENSITY * REFLECTANCE.powf(f64::from(order)) / PI
}

/// P(x_1 + x_2 < s) for two chords: ∫ 2a·2(s−a) over 0 ≤ a, s−a ≤ 1 and its integral.
fn two_chords(s: f64) -> f64 {
    if s <= 1.0 {
        return s.powi(4) / 6.0;
    }
    // 1 − ∫_s^2 of the density ∫_{s−1}^1 4a(s−a) da = (−2s³ + 12s − 8)/3.
    let integral = |s: f64| (-0.5 * s.powi(4) + 6.0 * s * s - 8.0 * s) / 3.0;
    1.0 - (integral(2.0) - integral(s))
}

#[test]
fn every_order_has_its_exact_radiance() {
    // Without roulette all paths of an order have the same weight: no variance.
    let scene = scene(2.0);
    for order in 1..=6 {
        let arrays = pass::<1>(&tracer(&scene, depths(order + 1, order + 1), 3), 1, 0);
        for value in arrays.steady {
            assert!((value / radiance(order) - 1.0).abs() < 1e-12, "order {order}: {value}");
        }
    }
}

#[test]
fn the_first_order_arrives_after_one_diameter() {
    let arrays = pass::<1>(&tracer(&scene(2.0), depths(2, 2), 5), 2, 0);
    for pixel in 0..arrays.pixels() {
        assert!((f64::from(arrays.pixel(pixel)[0]) / radiance(1) - 1.0).abs() < 1e-6);
        assert!(arrays.pixel(pixel)[1..].iter().all(|&v| v == 0.0));
    }
}

#[test]
fn chords_delay_the_second_and_third_order() {
    // False-alarm probability 1e-6 for each order.
    let edges = |i: usize| i as f64 / BINS as f64;
    for (order, span) in [(2, 2.0), (3, 4.0)] {
        let scene = scene(span);
        let tracer = tracer::<1>(&scene, depths(order + 1, order + 1), 200);
        let got = estimate(&tracer, 3, 32, image_and_blocks(BINS));
        let below = |i| {
            if order == 2 { edges(i) * edges(i) } else { two_chords(2.0 * edges(i)) }
        };
        let mut expected = vec![radiance(order)];
        expected.extend((0..BINS).map(|i| radiance(order) * (below(i + 1) - below(i))));
        got.assert_are(&expected, 1e-9, "chords");
    }
}

#[test]
fn roulette_keeps_the_total() {
    // Σ_k ρ^k = ρ/(1 − ρ); false-alarm probability 1e-6.
    let scene = scene(2.0);
    let integrator = IntegratorSpec { rr_depth: 3, ..IntegratorSpec::default() };
    let tracer = tracer::<1>(&scene, integrator, 400);
    let got = estimate(&tracer, 4, 32, |a| vec![a.steady.iter().sum::<f64>() / 16.0]);
    let total = INTENSITY / PI * REFLECTANCE / (1.0 - REFLECTANCE);
    got.assert_are(&[total], 2e-3, "all orders");
}
