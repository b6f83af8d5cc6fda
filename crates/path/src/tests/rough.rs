//! Rough surfaces: energy, η², and the strategies that find light at them.

use glam::{DMat3, DVec3};
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor, RoughDielectric};
use tpb_optics::quasi::Points;
use tpb_optics::{Rgb, Spectrum, Stream};
use tpb_scene::{Bsdf, Dielectric, Reflector, RoughMetal, Scene};

use super::stats::{estimate, image_and_blocks};
use super::worlds::{ONE_RAY, camera, cuboid, depths, lamp, plate, shape, time, tracer};
use crate::world::Strategies;

const ALPHA: f64 = 0.4;
const ETA: f64 = 1.5;

/// A plate in the plane z = 0 under two lamps that emit 1 on either side, all very wide. The camera
/// looks down onto it at 45 degrees.
fn between_lamps(bsdf: Bsdf) -> Scene {
    let wide = 1e4;
    let (x, y) = (wide * DVec3::X, wide * DVec3::Y);
    let mut parts = camera(DVec3::ONE.with_y(0.0), DVec3::ZERO, ONE_RAY);
    parts.shapes.push(shape("plate", vec![plate(DVec3::ZERO, x, y)], bsdf));
    parts.shapes.push(lamp(plate(2.0 * DVec3::Z, y, x), 1.0));
    parts.shapes.push(lamp(plate(-2.0 * DVec3::Z, x, y), 1.0));
    parts.shapes[2].name = "lower lamp".into();
    Scene::assemble(parts).unwrap()
}

/// The share of weights drawn, up and down, by many draws that fill space evenly: quadrature enough.
fn shares(sample: impl Fn([f64; 2], f64) -> Option<(f64, f64)>) -> (f64, f64) {
    let (points, mut fill) = (Points::new(51), Stream::new(51, 0, 0));
    let n = 1 << 22;
    let (mut up, mut down) = (0.0, 0.0);
    for index in 0..n {
        let [u, v, choice, _] = points.at(index, 0, &mut fill);
        if let Some((z, weight)) = sample([u, v], choice) {
            *if z > 0.0 { &mut up } else { &mut down } += weight / n as f64;
        }
    }
    (up, down)
}

/// Seen is the albedo, what comes from the denser side over η². Lamps of 10⁴ m leave out what is
/// within 2e-4 of the horizon: 1e-7 of the light at most.
#[test]
fn a_plate_between_wide_lamps_shows_its_albedo() {
    let from = DVec3::new(0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
    let ggx = Ggx::new(ALPHA);
    let surface = RoughConductor { ggx, metal: Metal::Perfect };
    let (up, _) = shares(|u, _| surface.sample(from, u).map(|d| (d.direction.z, d.weight[0])));
    let metal = RoughMetal { surface, reflectance: Rgb::splat(0.8) };
    let metal = Bsdf::Opaque { front: Reflector::Rough(metal), back: Reflector::Black };

    let surface = RoughDielectric { ggx, eta_before: 1.0, eta_beyond: ETA };
    let glass = Dielectric {
        interior_eta: ETA,
        exterior_eta: 1.0,
        reflectance: Rgb::splat(0.9),
        transmittance: Rgb::splat(0.7),
    };
    let (reflected, refracted) =
        shares(|u, choice| surface.sample(from, u, choice).map(|d| (d.direction.z, d.weight)));
    for (bsdf, expected) in [
        (metal, 0.8 * up),
        (Bsdf::RoughDielectric(glass, ggx), 0.9 * reflected + 0.7 * refracted / (ETA * ETA)),
    ] {
        let scene = between_lamps(bsdf);
        let tracer = tracer::<1>(&scene, depths(2, 2), 8000);
        // False-alarm probability 1e-6; the expectation's own error is less than that of the batches:
        // it has 16 times their points.
        let got = estimate(&tracer, 52, 32, |arrays| vec![arrays.steady[0]]);
        got.assert_are(&[expected], 1.5e-3, "plate between lamps");
    }
}

/// A rough pane of glass before a lamp, and a rough metal wall beside it, in colour.
fn pane() -> Scene {
    let mut parts = camera(DVec3::new(0.0, 0.0, -2.0), DVec3::ZERO, (40.0, 2, 2));
    let glass = Dielectric {
        interior_eta: ETA,
        exterior_eta: 1.0,
        reflectance: Spectrum([0.9, 1.0, 0.8]),
        transmittance: Spectrum([0.7, 0.8, 1.0]),
    };
    let glass = Bsdf::RoughDielectric(glass, Ggx::new(0.25));
    let half = DMat3::from_diagonal(DVec3::new(2.0, 2.0, 0.1));
    parts.shapes.push(shape("pane", cuboid(DVec3::ZERO, half), glass));
    let metal = Metal::Index { eta: Spectrum([0.2, 0.5, 1.2]), k: Spectrum([3.0, 2.4, 2.0]) };
    let surface = RoughConductor { ggx: Ggx::new(0.3), metal };
    let metal = RoughMetal { surface, reflectance: Rgb::ONE };
    let bsdf = Bsdf::Opaque { front: Reflector::Rough(metal), back: Reflector::Black };
    let wall = plate(DVec3::new(-1.5, 0.0, 1.0), 0.8 * DVec3::Y, 0.8 * DVec3::Z);
    parts.shapes.push(shape("wall", vec![wall], bsdf));
    let small = 0.4;
    parts.shapes.push(lamp(plate(DVec3::Z * 1.5, small * DVec3::Y, small * DVec3::X), 5.0));
    // What comes later, chance finds once in millions of paths.
    parts.film.time = Some(time(3.0, 7.5, 9));
    Scene::assemble(parts).unwrap()
}

#[test]
fn connections_and_chance_find_the_same_light_through_rough_glass() {
    let scene = pane();
    let run = |strategies: Strategies, seed| {
        let mut tracer = tracer::<3>(&scene, depths(2, 5), 16_000);
        tracer.world.strategies = strategies;
        estimate(&tracer, seed, 32, image_and_blocks(3))
    };
    let both = Strategies { next_event: true, hits: true, equiangular: false };
    let all = run(both, 53);
    run(Strategies { hits: false, ..both }, 54).assert_agree(&all, 0.02, "connections alone");
    run(Strategies { next_event: false, ..both }, 55).assert_agree(&all, 0.02, "chance alone");
}
