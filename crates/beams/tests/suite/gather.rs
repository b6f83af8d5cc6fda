//! The hierarchy against brute force over all beams: the same set of pairs, each once.

use glam::DVec3;
use tpb_beams::beam::{Attenuation, Beam, CameraRay};
use tpb_beams::beam_map::BeamMap;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_optics::{Coefficients, Phase, Spectrum, Stream, warp};
use tpb_scene::MediumId;

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

fn check<K: RayBeamKernel>(kernel: K, radius: f64, scale: f64, pieces: f64, seed: u64) -> usize {
    let mut rng = Stream::new(seed, 0, 0);
    let beams = beams(scale, 600, &mut rng);
    let rays = rays(scale, 400, &mut rng);
    let map = BeamMap::new(beams.clone(), radius, pieces * radius);
    let mut pairs = 0;
    for ray in &rays {
        let mut found = Vec::new();
        map.query(kernel, MediumId(1), ray, |beam, _| found.push(beam.opl as usize));
        found.sort_unstable();
        let all = beams.iter().enumerate();
        let brute: Vec<usize> = all
            .filter(|(_, b)| b.medium == MediumId(1) && kernel.evaluate(b, ray).is_some())
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
                assert!(one > 50 && two >= one, "pairs to compare: {one}, {two}");
            }
        }
    }
}
