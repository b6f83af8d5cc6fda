//! Distances along rays. Unbounded ones are put into the unit interval by t = x/(1 − x), which has
//! nothing to do with how they are sampled.

use glam::DVec3;
use tpb_optics::medium::{choose_channel, sample_exponential};
use tpb_optics::warp::Equiangular;
use tpb_optics::{Spectrum, Stream};

use super::Draws;
use super::histogram::{Grid, Tested, test};

/// t to x, and the density of t to that of x.
fn bounded(t: f64) -> f64 {
    if t.is_infinite() { 1.0 } else { t / (1.0 + t) }
}

fn of_bounded(x: f64, density: impl Fn(f64) -> f64) -> f64 {
    let rest = 1.0 - x;
    density(x / rest) / (rest * rest)
}

pub(super) fn tests(samples: u64, seed: Draws) -> Vec<Tested> {
    let mut tests = Vec::new();
    for sigma in [0.3, 1.0, 12.0] {
        tests.push(test(
            format!("free flight, sigma_t = {sigma}"),
            Grid::UNIT,
            samples,
            seed,
            |rng: &mut Stream| [bounded(sample_exponential(sigma, rng.uniform())), 0.5],
            |x, _| of_bounded(x, |t| sigma * (-sigma * t).exp()),
        ));
    }
    tests.push(Tested::exact(
        "free flight in vacuum never ends",
        (0..1000).all(|i| sample_exponential(0.0, f64::from(i) / 1000.0) == f64::INFINITY),
    ));
    tests.extend(channels(samples, seed));
    tests.extend(equiangular(samples, seed));
    tests
}

/// The choice of a channel, and a free flight of the mixture.
fn channels(samples: u64, seed: Draws) -> Vec<Tested> {
    let (weights, sigma) = (Spectrum([0.2, 1.0, 0.05]), Spectrum([4.0, 0.5, 1.5]));
    let mut rng = Stream::new(seed.seed, 0, 77);
    let mut counts = [0_u64; 3];
    for _ in 0..samples {
        counts[choose_channel(weights, &mut rng)] += 1;
    }
    let q = weights.0.map(|w| w / 1.25);
    let mixture = test(
        "free flight of a channel mixture",
        Grid::UNIT,
        samples,
        seed,
        |rng| {
            let channel = choose_channel(weights, rng);
            [bounded(sample_exponential(sigma[channel], rng.uniform())), 0.5]
        },
        |x, _| of_bounded(x, |t| (0..3).map(|c| q[c] * sigma[c] * (-sigma[c] * t).exp()).sum()),
    );
    vec![Tested::discrete("choice of a channel", &counts, &q), mixture]
}

/// Lights beside, before and behind the part of the ray, near and far; the density as stated.
fn equiangular(samples: u64, seed: Draws) -> Vec<Tested> {
    let cases = [
        (0.0, 4.0, DVec3::new(0.3, 0.0, 2.0)),
        (1.0, 4.0, DVec3::new(0.0, 0.05, 2.5)),
        (0.0, 3.0, DVec3::new(1.0, 1.0, -2.0)),
        (0.5, 2.0, DVec3::new(0.0, 8.0, 6.0)),
        (0.5, f64::INFINITY, DVec3::new(0.7, 0.0, 3.0)),
    ];
    cases
        .into_iter()
        .map(|(start, end, light)| {
            let towards = Equiangular::new(DVec3::ZERO, DVec3::Z, start, end, light);
            let name = format!("equiangular, {start}..{end} m, light at {light}");
            test(
                name,
                Grid::line([bounded(start), bounded(end)], 101),
                samples,
                seed,
                |rng| [bounded(towards.sample(rng.uniform())), 0.5],
                |x, _| of_bounded(x, |t| towards.pdf(t)),
            )
        })
        .collect()
}
