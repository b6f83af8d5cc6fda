//! Phase functions: the cosine alone for many g, and whole directions around three axes, in the
//! world's coordinates, so that the sampler's frames are tested too. Densities are written from
//! the textbook form of Henyey & Greenstein.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::Phase;

use super::Draws;
use super::histogram::{Grid, Tested, test};
use super::{axes, polar, world};

const MEAN_COSINES: [f64; 8] = [0.0, 0.2, 0.5, 0.9, 0.99, -0.5, -0.9, 1e-3];

fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    let bracket = (1.0 - g).powi(2) + 2.0 * g * (1.0 - cosine);
    (1.0 - g * g) / (4.0 * PI * bracket.powf(1.5))
}

pub(super) fn tests(samples: u64, seed: Draws) -> Vec<Tested> {
    let mut tests = Vec::new();
    for g in MEAN_COSINES {
        let phase = Phase::with_mean_cosine(g);
        let sample = |rng: &mut tpb_optics::Stream| [phase.sample_cosine(rng.uniform()), 0.5];
        let grid = Grid::line([-1.0, 1.0], 201);
        let density = |c: f64, _: f64| 2.0 * PI * henyey_greenstein(g, c);
        tests.push(test(format!("cosine, g = {g}"), grid, samples, seed, sample, density));
        let cosines = (0..=200).map(|i| f64::from(i) * 0.01 - 1.0);
        let agrees = |c: f64| (phase.value(c) / henyey_greenstein(g, c) - 1.0).abs() < 1e-11;
        tests.push(Tested::exact(format!("value, g = {g}"), cosines.into_iter().all(agrees)));
    }
    for (g, forward) in [0.0, 0.5, -0.8].into_iter().flat_map(|g| {
        [DVec3::X, -DVec3::Z, DVec3::new(-0.3, 0.5, 0.81).normalize()].map(|f| (g, f))
    }) {
        let phase = Phase::with_mean_cosine(g);
        let name = format!("directions around {forward:.2}, g = {g}");
        tests.push(test(
            name,
            Grid::SPHERE,
            samples,
            seed,
            |rng| polar(phase.sample(forward, rng), axes_of_world()),
            |z, phi| henyey_greenstein(g, world(z, phi).dot(forward)),
        ));
    }
    let forward = axes(DVec3::new(0.6, 0.0, 0.8))[2];
    tests.push(test(
        "directions around a sharp peak, g = 0.95",
        Grid::band([-1.0, 1.0]),
        samples,
        seed,
        |rng| polar(Phase::with_mean_cosine(0.95).sample(forward, rng), axes_of_world()),
        |z, phi| henyey_greenstein(0.95, world(z, phi).dot(forward)),
    ));
    tests
}

fn axes_of_world() -> [DVec3; 3] {
    [DVec3::X, DVec3::Y, DVec3::Z]
}
