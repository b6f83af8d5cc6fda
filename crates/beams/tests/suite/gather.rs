//! The hierarchy and the tiles against brute force over all beams: the same set of pairs, each once.

use glam::DVec3;
use tpb_beams::beam::{Attenuation, Beam, CameraRay};
use tpb_beams::beam_map::BeamMap;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_beams::kernel3d::Kernel3d;
use tpb_beams::tiles::Tiles;
use tpb_optics::{Coefficients, Phase, Spectrum, Stream, warp};
use tpb_scene::{MediumId, Scene};

use crate::scenes;

fn direction(rng: &mut Stream) -> DVec3 {
    // Some along axes, where boxes are thin and inverse directions infinite.
    match rng.index(8) {
        0 => DVec3::AXES[rng.index(3)],
        1 => -DVec3::AXES[rng.index(3)],
        _ => warp::uniform_sphere(rng.uniform(), rng.uniform()),
    }
}

fn position(scale: f64, rng: &mut Stream) -> DVec3 {
    scale * DVec3::new(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5)
}

fn beams(scale: f64, count: u32, rng: &mut Stream) -> Vec<Beam<1>> {
    (0..count)
        .map(|index| Beam {
            origin: position(scale, rng),
            direction: direction(rng),
            // A few are as long as in fog without walls.
            length: if index % 50 == 0 { 700.0 * scale } else { scale * rng.uniform() },
            opl: f64::from(index),
            power: Spectrum([1.0]),
            attenuation: Attenuation::Explicit,
            medium: MediumId(index % 2),
            depth: 2,
        })
        .collect()
}

fn rays(scale: f64, count: u32, rng: &mut Stream) -> Vec<CameraRay<1>> {
    (0..count)
        .map(|index| {
            let far = if index % 5 == 0 { 100.0 } else { 1.0 };
            let length = if index % 3 == 0 { f64::INFINITY } else { scale * far };
            let origin = position(scale * far, rng);
            let aim = position(scale, rng);
            let direction =
                if index % 2 == 0 { (aim - origin).normalize() } else { direction(rng) };
            CameraRay {
                origin,
                direction,
                length,
                opl: 0.0,
                throughput: Spectrum([1.0]),
                coefficients: Coefficients {
                    sigma_s: Spectrum([1.0]),
                    sigma_t: Spectrum([0.1 / scale]),
                },
                phase: Phase::Isotropic,
                eta: 1.0,
            }
        })
        .collect()
}

fn joins<K: RayBeamKernel>(kernel: K, beam: &Beam<1>, ray: &CameraRay<1>) -> bool {
    let of_beam = (beam.origin, beam.direction, beam.length);
    let of_ray = (ray.origin, ray.direction, ray.length);
    kernel.meet(of_beam.0, of_beam.1, of_beam.2, of_ray.0, of_ray.1, of_ray.2).is_some()
}

fn check<K: RayBeamKernel>(kernel: K, radius: f64, scale: f64, pieces: f64, seed: u64) -> usize {
    let mut rng = Stream::new(seed, 0, 0);
    let beams = beams(scale, 600, &mut rng);
    let rays = rays(scale, 400, &mut rng);
    let map = BeamMap::new(kernel, &beams, pieces * radius);
    let mut pairs = 0;
    for ray in &rays {
        let mut found = Vec::new();
        map.query(kernel, MediumId(1), ray, |beam, _| found.push(beam.opl as usize));
        found.sort_unstable();
        let all = beams.iter().enumerate();
        let brute: Vec<usize> = all
            .filter(|(_, b)| b.medium == MediumId(1) && joins(kernel, b, ray))
            .map(|(index, _)| index)
            .collect();
        assert_eq!(found, brute, "scale {scale}, pieces {pieces}");
        pairs += found.len();
    }
    pairs
}

#[test]
fn the_hierarchy_finds_exactly_the_pairs_of_brute_force() {
    for (seed, scale) in [1e-3, 1.0, 1e3].into_iter().enumerate() {
        for pieces in [1.0, 16.0, f64::INFINITY] {
            for relative in [0.002, 0.05] {
                let radius = relative * scale;
                let one = check(Kernel1d { radius }, radius, scale, pieces, seed as u64);
                let two = check(Kernel2d { radius }, radius, scale, pieces, seed as u64);
                let three = check(Kernel3d { radius }, radius, scale, pieces, seed as u64);
                assert!(one > 50 && two >= one, "pairs to compare: {one}, {two}");
                assert!(three >= two && (three > two || relative < 0.01), "{two}, {three}");
            }
        }
    }
}

/// Rays from an eye amid the beams, over the whole image, and segments of them.
fn check_tiles<K: RayBeamKernel>(kernel: K, radius: f64, scale: f64, fov: f64, seed: u64) -> usize {
    let mut rng = Stream::new(seed, 1, 0);
    let beams = beams(scale, 1500, &mut rng);
    let (width, height) = (37, 22);
    let eye = position(0.5 * scale, &mut rng);
    let sensor = scenes::camera(eye, direction(&mut rng), fov, (width, height));
    let light = scenes::point(DVec3::ZERO, tpb_optics::Rgb::ONE);
    let film = scenes::film(width, height, 1.0, 1);
    let parts = scenes::infinite(scenes::fog(1.0, 1.0, 0.0), light, sensor, film);
    let scene = Scene::assemble(parts).expect("the scene is consistent");
    let tiles = Tiles::new(&scene, &beams, radius);
    let mut pairs = 0;
    for index in 0..width * height {
        let (x, y) = (index % width, index / width);
        let (a, b) = (x as f64 + rng.uniform(), y as f64 + rng.uniform());
        let omega = scene.sensor.direction(a, b);
        let start = if index % 2 == 0 { 0.0 } else { 0.3 * scale * rng.uniform() };
        let ray = CameraRay {
            origin: eye + start * omega,
            direction: omega,
            length: if index % 3 == 0 { f64::INFINITY } else { scale * rng.uniform() },
            opl: 0.0,
            throughput: Spectrum([1.0]),
            coefficients: Coefficients { sigma_s: Spectrum([1.0]), sigma_t: Spectrum([1.0]) },
            phase: Phase::Isotropic,
            eta: 1.0,
        };
        let mut found = Vec::new();
        tiles.query(kernel, MediumId(1), (x, y), &ray, |beam, _| found.push(beam.opl as usize));
        let all = beams.iter().enumerate();
        let brute: Vec<usize> = all
            .filter(|(_, b)| b.medium == MediumId(1) && joins(kernel, b, &ray))
            .map(|(index, _)| index)
            .collect();
        assert_eq!(found, brute, "scale {scale}, field of view {fov}");
        pairs += found.len();
    }
    pairs
}

#[test]
fn the_tiles_find_exactly_the_pairs_of_brute_force() {
    for (seed, scale) in [1e-3, 1.0, 1e3].into_iter().enumerate() {
        for fov in [0.01, 40.0, 170.0] {
            for relative in [0.002, 0.05, 2.0] {
                let radius = relative * scale;
                let one = check_tiles(Kernel1d { radius }, radius, scale, fov, seed as u64);
                let two = check_tiles(Kernel2d { radius }, radius, scale, fov, seed as u64);
                let three = check_tiles(Kernel3d { radius }, radius, scale, fov, seed as u64);
                assert!(two >= one && (one > 0 || fov < 1.0), "pairs to compare: {one}, {two}");
                assert!(three >= two && (three > two || fov < 1.0), "{two}, {three}");
            }
        }
    }
}
