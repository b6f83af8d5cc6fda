//! The Cornell box with two blocks in fog, built in code, and a coloured relative of it with glass
//! and a mirror: threads, and speed.

use glam::{DMat3, DVec3};
use rayon::ThreadPoolBuilder;
use tpb_optics::{Rgb, Spectrum};
use tpb_render::{Method, PassId};
use tpb_scene::{Bsdf, IntegratorSpec, Reflector, Scene, SceneParts, ShapePart};

use super::stats::{film, pass};
use super::worlds::{
    ball, camera, cuboid, diffuse, filled, glass, lamp, medium, plate, shape, time, tracer,
};

fn wall(name: &str, centre: DVec3, u: DVec3, v: DVec3, reflectance: f64) -> ShapePart {
    shape(name, vec![plate(centre, u, v)], diffuse(Rgb::splat(reflectance)))
}

fn block(name: &str, centre: DVec3, half: DVec3, degrees: f64) -> ShapePart {
    let edges = DMat3::from_rotation_y(degrees.to_radians()) * DMat3::from_diagonal(half);
    shape(name, cuboid(centre, edges), diffuse(Rgb::splat(0.75)))
}

fn box_in_fog(size: usize, bins: usize) -> SceneParts {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let mut parts = camera(z * 3.9, DVec3::ZERO, (38.0, size, size));
    parts.media.push(medium(Rgb::splat(0.4), Rgb::splat(0.5), 0.0));
    parts.shapes = vec![
        filled(shape("front", vec![plate(z, x, y)], Bsdf::Null), None),
        wall("back", -z, x, y, 0.75),
        wall("floor", -y, x, -z, 0.75),
        wall("ceiling", y, x, z, 0.75),
        wall("left", -x, -z, y, 0.45),
        wall("right", x, z, y, 0.3),
        block("tall", DVec3::new(-0.35, -0.4, -0.3), DVec3::new(0.3, 0.6, 0.3), 18.0),
        block("short", DVec3::new(0.35, -0.7, 0.35), DVec3::splat(0.3), -17.0),
        lamp(plate(y * 0.99, x * 0.2, z * 0.2), 10.0),
    ];
    parts.film.time = Some(time(0.0, 14.0, bins));
    parts.integrator =
        IntegratorSpec { max_depth: Some(100), rr_depth: 8, ..IntegratorSpec::default() };
    parts
}

/// The scene `cornell-blocks` at any size.
pub(super) fn blocks(size: usize, bins: usize) -> Scene {
    Scene::assemble(box_in_fog(size, bins)).unwrap()
}

/// With coloured fog, a glass ball and a mirror.
fn colourful() -> Scene {
    let mut parts = box_in_fog(8, 20);
    parts.media[0] = medium(Spectrum([0.3, 0.5, 0.8]), Spectrum([0.35, 0.6, 1.4]), 0.6);
    parts.shapes[4].bsdf = Bsdf::Opaque {
        front: Reflector::Mirror(Spectrum([0.9, 0.8, 0.7])),
        back: Reflector::Black,
    };
    let glassy = ball(DVec3::new(0.3, 0.2, 0.3), 0.25, false);
    parts.shapes.push(shape("ball", vec![glassy], glass(1.5)));
    Scene::assemble(parts).unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = colourful();
    let integrator = scene.integrator;
    let render = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let tracer = tracer::<3>(&scene, integrator, 3);
            let mut film = film(&tracer);
            let reports: Vec<_> =
                (0..4).map(|index| tracer.pass(PassId { seed: 61, index }, &mut film)).collect();
            (film.develop(), reports)
        })
    };
    let one = render(1);
    assert!(one.0.steady.iter().all(|&v| v > 0.0));
    for threads in [2, 7] {
        assert_eq!(render(threads), one);
    }
}

#[test]
fn a_grey_scene_looks_the_same_in_one_channel_and_in_three() {
    // One channel cancels exponentials by hand, three divide them; the same random numbers but
    // for the choice of a channel, so compare depth 1, where there is none, and totals of depth 2.
    let scene = blocks(8, 20);
    let mono = pass::<1>(&tracer(&scene, super::worlds::depths(1, 1), 4), 62, 0);
    let rgb = pass::<3>(&tracer(&scene, super::worlds::depths(1, 1), 4), 62, 0);
    for (i, &value) in rgb.steady.iter().enumerate() {
        assert!((value - mono.steady[i / 3]).abs() <= 1e-12 * value, "{value}");
    }
    let sum = |arrays: &tpb_film::Arrays| {
        vec![arrays.steady.iter().sum::<f64>() / arrays.channels as f64]
    };
    let integrator = super::worlds::depths(2, 6);
    let mono = super::stats::estimate(&tracer::<1>(&scene, integrator, 50), 63, 32, sum);
    let rgb = super::stats::estimate(&tracer::<3>(&scene, integrator, 50), 64, 32, sum);
    // False-alarm probability 1e-6.
    rgb.assert_agree(&mono, 1e-2, "channels");
}
