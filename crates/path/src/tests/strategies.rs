//! The strategies that find light agree, alone and together, with colour and several scatterings.

use glam::DVec3;
use tpb_optics::{Rgb, Spectrum};
use tpb_scene::Scene;

use super::stats::{Estimates, estimate, image_and_blocks};
use super::worlds::{BLACK, ball};
use super::worlds::{
    FOG, camera, depths, diffuse, filled, lamp, medium, plate, shape, time, tracer,
};
use crate::world::Strategies;

const BLOCKS: usize = 4;

/// A lamp in a ball of fog before a diffuse wall, seen from outside the fog.
fn scene() -> Scene {
    let mut parts = camera(DVec3::new(0.0, 0.5, -5.0), DVec3::ZERO, (30.0, 4, 4));
    parts.media.push(medium(Spectrum([0.2, 0.5, 0.3]), Spectrum([0.25, 0.6, 1.5]), 0.5));
    let fog = shape("fog", vec![ball(DVec3::ZERO, 2.0, false)], tpb_scene::Bsdf::Null);
    parts.shapes.push(filled(fog, None));
    let panel = plate(DVec3::new(0.2, 0.9, 0.0), DVec3::X * 0.6, DVec3::Z * 0.5);
    parts.shapes.push(lamp(panel, 5.0));
    let floor = plate(DVec3::new(0.0, -0.8, 0.0), DVec3::Z * 1.5, DVec3::X * 1.5);
    parts.shapes.push(shape("floor", vec![floor], diffuse(Rgb::splat(0.6))));
    let post = ball(DVec3::new(0.4, 0.0, 0.2), 0.3, false);
    parts.shapes.push(shape("post", vec![post], BLACK));
    parts.film.time = Some(time(4.0, 12.0, 4 * BLOCKS));
    Scene::assemble(parts).unwrap()
}

fn run(scene: &Scene, seed: u64, samples: u32, strategies: Strategies) -> Estimates {
    let mut tracer = tracer::<3>(scene, depths(2, 4), samples);
    tracer.world.strategies = strategies;
    estimate(&tracer, seed, 32, image_and_blocks(BLOCKS))
}

#[test]
fn all_strategies_agree() {
    // False-alarm probability 1e-6 for each of four comparisons.
    let scene = scene();
    let all = Strategies { next_event: true, hits: true, equiangular: true };
    let whole = run(&scene, 21, 2000, all);
    let others = [
        (Strategies { equiangular: false, ..all }, 2000, 4e-3, "no equiangular"),
        (Strategies { equiangular: false, hits: false, ..all }, 2000, 1e-2, "next event alone"),
        (Strategies { hits: false, ..all }, 2000, 1e-2, "next event and equiangular"),
        (Strategies { next_event: false, equiangular: false, ..all }, 2000, 2e-2, "hits alone"),
    ];
    for (index, (strategies, samples, precision, what)) in others.into_iter().enumerate() {
        let part = run(&scene, 22 + index as u64, samples, strategies);
        part.assert_agree(&whole, precision, what);
        assert!(part.errors[1] > 0.8 * whole.errors[1], "{what} is better than all together");
    }
}

#[test]
fn a_lamp_behind_absorption_is_seen_without_noise() {
    let mut parts = camera(DVec3::ZERO, DVec3::Z, super::worlds::ONE_RAY);
    parts.media.push(medium(Rgb::splat(0.3), Spectrum([0.4, 1.0, 50.0]), 0.0));
    parts.background = Some(FOG);
    parts.shapes.push(lamp(plate(DVec3::Z * 2.0, DVec3::Y, DVec3::X), 7.0));
    let scene = Scene::assemble(parts).unwrap();
    let arrays = super::stats::pass::<3>(&tracer(&scene, depths(1, 1), 4), 25, 0);
    for (value, sigma_t) in arrays.steady.iter().zip([0.4, 1.0, 50.0]) {
        let expected = 7.0 * f64::exp(-2.0 * sigma_t);
        assert!((value / expected - 1.0).abs() < 1e-8, "{value} {expected}");
    }
}
