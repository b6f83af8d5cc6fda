//! Rough surfaces: microfacets' normals as they are seen, and the directions that rough metal and
//! glass send light into. Draws that end on another microfacet have no direction: their share is
//! what the density falls short of 1.
//!
//! The densities are those of [`crate::microfacet`], written apart.

use glam::DVec3;
use tpb_optics::Stream;
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor, RoughDielectric};

use super::histogram::{Grid, Tested, test, test_part};
use super::{Draws, polar, world};
use crate::microfacet::{reflectance, refracting, visible};

const AXES: [DVec3; 3] = DVec3::AXES;
const UPPER: Grid = Grid::band([0.0, 1.0]);
const LOWER: Grid = Grid::band([-1.0, 0.0]);

pub(super) fn tests(samples: u64, seed: Draws) -> Vec<Tested> {
    let mut tests = Vec::new();
    for (alpha, cosine) in [(0.3, 0.2), (0.6, 0.6), (1.0, 0.05)] {
        let (ggx, from) = (Ggx::new(alpha), world(cosine, 0.7));
        tests.push(test(
            format!("visible normals, alpha = {alpha}, cosine {cosine}"),
            UPPER,
            samples,
            seed,
            |rng| polar(ggx.sample_visible(from, [rng.uniform(), rng.uniform()]), AXES),
            |z, phi| visible(alpha, from, world(z, phi)),
        ));
    }
    for (alpha, cosine) in [(0.4, 0.8), (1.0, 0.4)] {
        tests.push(metal(alpha, world(cosine, -1.2), samples, seed));
        tests.extend(glass(alpha, world(cosine, 2.0), [1.0, 1.5], samples, seed));
    }
    tests.extend(glass(0.7, world(0.8, 2.0), [1.5, 1.0], samples, seed));
    tests
}

fn metal(alpha: f64, from: DVec3, samples: u64, seed: Draws) -> Tested {
    let surface = RoughConductor { ggx: Ggx::new(alpha), metal: Metal::Perfect };
    let sample = |rng: &mut Stream| {
        let drawn = surface.sample(from, [rng.uniform(), rng.uniform()])?;
        Some(polar(drawn.direction, AXES))
    };
    let density = |z: f64, phi: f64| {
        let half = (from + world(z, phi)).normalize();
        visible(alpha, from, half) / (4.0 * from.dot(half))
    };
    test_part(format!("metal, alpha = {alpha}"), UPPER, samples, seed, sample, density)
}

fn glass(alpha: f64, from: DVec3, eta: [f64; 2], samples: u64, seed: Draws) -> [Tested; 2] {
    let [eta_before, eta_beyond] = eta;
    let surface = RoughDielectric { ggx: Ggx::new(alpha), eta_before, eta_beyond };
    let sample = |up: bool| {
        move |rng: &mut Stream| {
            let drawn = surface.sample(from, [rng.uniform(), rng.uniform()], rng.uniform())?;
            ((drawn.direction.z > 0.0) == up).then(|| polar(drawn.direction, AXES))
        }
    };
    let reflected = move |z: f64, phi: f64| {
        let half = (from + world(z, phi)).normalize();
        let cosine = from.dot(half);
        reflectance(cosine, eta) * visible(alpha, from, half) / (4.0 * cosine)
    };
    let refracted = move |z: f64, phi: f64| {
        refracting(from, world(z, phi), eta).map_or(0.0, |(half, jacobian)| {
            (1.0 - reflectance(from.dot(half), eta)) * visible(alpha, from, half) * jacobian
        })
    };
    let name = |way: &str| format!("glass {eta_before} to {eta_beyond}, alpha = {alpha}: {way}");
    [
        test_part(name("reflected"), UPPER, samples, seed, sample(true), reflected),
        test_part(name("refracted"), LOWER, samples, seed, sample(false), refracted),
    ]
}
