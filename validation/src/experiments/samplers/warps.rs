//! Warps of uniform numbers, in coordinates that their domains fill, and their stated densities.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::{Stream, warp};

use super::Draws;
use super::histogram::{Grid, Tested, test};
use super::polar;

const WORLD: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];

fn pair(rng: &mut Stream) -> (f64, f64) {
    (rng.uniform(), rng.uniform())
}

pub(super) fn tests(samples: u64, seed: Draws) -> Vec<Tested> {
    let direction = |name: &str,
                     grid,
                     warp: &(dyn Fn(f64, f64) -> DVec3 + Sync),
                     density: &(dyn Fn(f64) -> f64 + Sync)| {
        let sample = |rng: &mut Stream| {
            let (u1, u2) = pair(rng);
            polar(warp(u1, u2), WORLD)
        };
        test(name, grid, samples, seed, sample, |z, _| density(z))
    };
    let cut = 0.8;
    let mut tests = vec![
        direction("uniform sphere", Grid::SPHERE, &warp::uniform_sphere, &|_| 0.25 / PI),
        direction("cosine hemisphere", Grid::band([0.0, 1.0]), &warp::cosine_hemisphere, &|z| {
            z / PI
        }),
        direction(
            "uniform cone",
            Grid::band([cut, 1.0]),
            &|u1, u2| warp::uniform_cone(u1, u2, cut),
            &|_| 1.0 / (2.0 * PI * (1.0 - cut)),
        ),
    ];
    tests.push(test(
        "uniform disc",
        Grid { x: [0.0, 1.0], y: [-PI, PI], cells: [21, 31] },
        samples,
        seed,
        |rng| {
            let (u1, u2) = pair(rng);
            let p = warp::uniform_disc(u1, u2);
            [p.length(), p.y.atan2(p.x)]
        },
        |r, _| r / PI,
    ));
    tests.push(test(
        "uniform triangle",
        Grid::SQUARE,
        samples,
        seed,
        |rng| {
            let (u1, u2) = pair(rng);
            let (b1, b2) = warp::uniform_triangle(u1, u2);
            [b1, b2 / (1.0 - b1)]
        },
        |b1, _| 2.0 * (1.0 - b1),
    ));
    let stated = (0..=100).map(|i| f64::from(i) * 0.01).all(|z| {
        (warp::cosine_hemisphere_pdf(z) - z / PI).abs() < 1e-15
            && (warp::uniform_cone_pdf(z - 0.5) * 2.0 * PI * (1.5 - z) - 1.0).abs() < 1e-14
    });
    tests.push(Tested::exact(
        "stated densities",
        stated && warp::cosine_hemisphere_pdf(-0.1) == 0.0,
    ));
    tests
}
