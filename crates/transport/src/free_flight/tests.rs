//! Free flights through two fogs and a medium that only absorbs, against closed forms.

use glam::{DAffine3, DVec3};
use smallvec::smallvec;
use tpb_optics::{Phase, Rgb};
use tpb_scene::{
    FilmSpec, FovAxis, IntegratorSpec, MediumId, PixelFormat, SceneParts, Sensor, Span,
};

use super::*;

const FOGS: [(f64, f64); 3] = [(0.3, 0.5), (0.0, 0.7), (1.0, 1.0)];

fn medium(sigma_s: Rgb, sigma_t: Rgb) -> Medium {
    let coefficients = Coefficients { sigma_s, sigma_t };
    Medium { name: "fog".into(), coefficients, phase: Phase::Isotropic, eta: None }
}

fn world(media: Vec<Medium>) -> Scene {
    Scene::assemble(SceneParts {
        shapes: vec![],
        media,
        textures: vec![],
        emitters: vec![],
        background: None,
        sensor: Sensor::perspective(DAffine3::IDENTITY, 40.0, FovAxis::X, 1, 1),
        film: FilmSpec { width: 1, height: 1, pixel_format: PixelFormat::Rgb, time: None },
        integrator: IntegratorSpec::default(),
    })
    .expect("a consistent scene")
}

/// Spans of a metre each, filled with these media, and vacuum.
fn through(media: &[Option<u32>]) -> Flight {
    let mut spans = smallvec![];
    for (i, medium) in media.iter().enumerate() {
        let region = Region { medium: medium.map(MediumId), eta: 1.0 };
        spans.push(Span { start: i as f64, end: i as f64 + 1.0, region });
    }
    Flight { origin: DVec3::ZERO, direction: DVec3::Z, spans, hit: None }
}

/// The density, and the chance of survival, sum to 1; outside scattering media it is 0.
#[test]
fn the_density_integrates_to_what_does_not_survive() {
    let media = FOGS.map(|(s, t)| medium(Rgb::splat(s), Rgb::splat(t))).to_vec();
    let scene = world(media);
    let flight = through(&[Some(0), None, Some(1), Some(2)]);
    let free = FreeFlight::new(&scene, &flight, Spectrum([2.0]));
    assert_eq!(free.extent(), Some((0.0, 4.0)));
    let steps = 40_000;
    let h = 4.0 / f64::from(steps);
    let sum: f64 = (0..steps).map(|i| free.density((f64::from(i) + 0.5) * h) * h).sum();
    // The absorbing medium in between takes no part.
    assert!((sum - (1.0 - f64::exp(-1.5))).abs() < 1e-9, "{sum}");
    assert!(free.density(1.5) == 0.0 && free.density(2.5) == 0.0);
    let passing = free.passing(f64::INFINITY);
    assert!(passing.choice == Spectrum([1.0]));
    assert!((passing.absorption[0] - f64::exp(-0.7)).abs() < 1e-15);
    assert!((free.transmittance()[0] - f64::exp(-2.2)).abs() < 1e-15);
}

/// E[weight at the end] is the transmittance, E[weight of collisions] the single-scattering albedo
/// of the way, for each channel. 10⁵ flights of weights below 1/m_c ≤ 5: Hoeffding's bound on a
/// deviation of 0.06 is 2 exp(−2·10⁵·0.06²/25) < 1e-12 for each of six means.
#[test]
fn coloured_weights_are_bounded_and_unbiased() {
    let sigma_s = Spectrum([0.3, 2.0, 0.9]);
    let sigma_t = Spectrum([0.6, 2.0, 5.0]);
    let absorbing = Spectrum([0.1, 0.0, 0.4]);
    let scene = world(vec![medium(sigma_s, sigma_t), medium(Rgb::ZERO, absorbing)]);
    let flight = through(&[Some(1), Some(0)]);
    let carried = Spectrum([2.0, 1.0, 2.0]);
    let free = FreeFlight::new(&scene, &flight, carried);
    let (mut survived, mut collided) = (Rgb::ZERO, Rgb::ZERO);
    let mut rng = Stream::new(31, 0, 0);
    let n = 100_000;
    for _ in 0..n {
        let (sum, weight) = match free.sample(&mut rng) {
            Outcome::Collision { distance, weight, .. } => {
                assert!((1.0..2.0).contains(&distance));
                (&mut collided, weight)
            }
            Outcome::Survival { weight } => (&mut survived, weight),
        };
        let weighted = free.mixture() * weight.total();
        assert!((0..3).all(|c| weighted[c] <= 1.0 + 1e-12), "{weighted:?}");
        *sum += weight.total();
    }
    for c in 0..3 {
        let before = f64::exp(-absorbing[c]);
        let left = f64::exp(-sigma_t[c]);
        let (survived, collided) = (survived[c] / f64::from(n), collided[c] / f64::from(n));
        assert!((survived - before * left).abs() < 0.06, "{c} {survived}");
        let expected = before * sigma_s[c] / sigma_t[c] * (1.0 - left);
        assert!((collided - expected).abs() < 0.06, "{c} {collided} {expected}");
    }
}

/// Optical depths of thousands, infinite ones, and a channel that carries nothing.
#[test]
fn deep_flights_have_finite_weights() {
    for sigma_t in [[1.0, 1e-3, 2.0], [2000.0, 1.0, 3000.0], [f64::MAX, 0.0, f64::MAX]] {
        let scene = world(vec![medium(Rgb::splat(1e-3), Spectrum(sigma_t))]);
        let flight = through(&[Some(0), Some(0)]);
        let carried = Spectrum([3.0, 0.0, 1.0]);
        let free = FreeFlight::new(&scene, &flight, carried);
        for distance in [0.5, 1.0, 2.0, f64::INFINITY] {
            let weighted = carried * free.passing(distance).total();
            let bounded = weighted.is_finite() && weighted.max_channel() <= 4.0 + 1e-12;
            assert!(bounded, "{weighted:?}");
        }
    }
}
