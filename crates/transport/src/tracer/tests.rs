//! Photons in closed balls, where what visitors must see is known.

use glam::{DAffine3, DVec3};
use tpb_optics::{Coefficients, Phase, Rgb, Spectrum};
use tpb_scene::geometry::Sphere;
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, FilmSpec, FovAxis, Medium, MediumId, PixelFormat, Primitive,
    Reflector, SceneParts, Sensor, ShapePart,
};

use super::*;

const RADIUS: f64 = 2.0;

/// A point of 4π W in the middle of a closed diffuse ball that is filled with a medium.
fn ball(reflectance: f64, sigma_s: [f64; 3], sigma_t: [f64; 3]) -> Scene {
    let coefficients = Coefficients { sigma_s: Spectrum(sigma_s), sigma_t: Spectrum(sigma_t) };
    let phase = Phase::with_mean_cosine(0.4);
    let kind = EmitterKind::Point { position: DVec3::ZERO, intensity: Rgb::ONE };
    let sphere = Sphere { centre: DVec3::ZERO, radius: RADIUS, flipped: true };
    let diffuse = Reflector::Diffuse(Rgb::splat(reflectance));
    Scene::assemble(SceneParts {
        shapes: vec![ShapePart {
            name: "ball".into(),
            primitives: vec![Primitive::Sphere(sphere)],
            bsdf: Bsdf::Opaque { front: diffuse, back: Reflector::Black },
            boundary: None,
            radiance: None,
        }],
        media: vec![Medium { name: "fog".into(), coefficients, phase, eta: None }],
        textures: vec![],
        emitters: vec![EmitterPart { name: "point".into(), kind, stated_medium: None }],
        background: Some(MediumId(0)),
        sensor: Sensor::perspective(DAffine3::IDENTITY, 40.0, FovAxis::X, 1, 1),
        film: FilmSpec { width: 1, height: 1, pixel_format: PixelFormat::Rgb, time: None },
        integrator: IntegratorSpec::default(),
    })
    .expect("a consistent scene")
}

/// What one chunk saw, in order: number of the photon, events, OPL and power at each event.
#[derive(Default, PartialEq, Debug)]
struct Seen {
    photons: Vec<u64>,
    starts: Vec<(u32, f64, f64)>,
    collisions: Vec<(u32, f64, f64)>,
    arrivals: Vec<(u32, f64, f64)>,
}

impl<const C: usize> PhotonVisitor<C> for Seen {
    fn emission(&mut self, photon: &Photon<C>, _: &mut Stream) {
        self.photons.push(photon.index);
    }

    fn flight(
        &mut self,
        photon: &Photon<C>,
        free: &FreeFlight<'_, C>,
        outcome: &Outcome<'_, C>,
        _: &mut Stream,
    ) {
        assert!(free.flight().origin == photon.vertex.position);
        assert!(outcome.collision().is_none_or(|d| d < free.flight().length()));
        self.starts.push((photon.events, photon.opl, photon.power[0]));
    }

    fn collision(&mut self, photon: &Photon<C>, part: &Part<'_, C>, _: &mut Stream) {
        assert!(part.coefficients.scatters());
        self.collisions.push((photon.events, photon.opl, photon.power[0]));
    }

    fn surface(&mut self, photon: &Photon<C>, arrival: &SurfaceArrival, _: &mut Stream) {
        assert!((photon.vertex.position.length() - RADIUS).abs() < 1e-12);
        assert!(arrival.lobe.normal.dot(photon.direction) < 0.0);
        self.arrivals.push((photon.events, photon.opl, photon.power[0]));
    }
}

fn trace<const C: usize>(scene: &Scene, integrator: IntegratorSpec) -> (Vec<Seen>, Ledger) {
    let tracer = PhotonTracer { scene, integrator, sampling: Sampling::default() };
    let batch = PhotonBatch { seed: 3, pass: 1, count: 3 * CHUNK + 5 };
    tracer.trace::<C, _>(batch, |_| Seen::default())
}

fn up_to(depth: u32) -> IntegratorSpec {
    IntegratorSpec { max_depth: Some(depth), rr_depth: 3, ..IntegratorSpec::default() }
}

#[test]
fn the_ledger_closes_and_every_photon_is_seen_once_in_order() {
    let scene = ball(0.5, [1.0, 0.0, 0.3], [1.5, 2.0, 0.3]);
    for integrator in [up_to(6), IntegratorSpec { max_depth: None, ..up_to(6) }] {
        for (seen, ledger) in [trace::<1>(&scene, integrator), trace::<3>(&scene, integrator)] {
            assert!(ledger.closure().abs() < 1e-9, "{ledger:?}");
            assert!((ledger.emitted / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-12);
            assert!(ledger.roulette_lost > 0.0 && ledger.absorbed_in_media > 0.0);
            let photons = seen.iter().flat_map(|s| &s.photons).copied();
            assert!(photons.eq(0..3 * CHUNK + 5));
            let deepest = seen.iter().flat_map(|s| &s.starts).map(|s| s.0 + 2).max();
            assert!(integrator.max_depth.is_none_or(|max| deepest == Some(max)));
        }
    }
}

#[test]
fn the_same_bits_for_one_two_and_seven_threads() {
    let scene = ball(0.5, [1.0, 0.0, 0.3], [1.5, 2.0, 0.3]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| trace::<3>(&scene, up_to(9)))
    };
    let one = with(1);
    assert!(one.0.len() == 4 && one == with(2) && one == with(7));
}

/// No photon dies in a medium that only absorbs: each arrives with the transmittance.
#[test]
fn media_that_only_absorb_weigh_photons() {
    let sigma_t = 1.7;
    let scene = ball(0.5, [0.0; 3], [sigma_t; 3]);
    let (seen, ledger) = trace::<1>(&scene, up_to(2));
    let power = ledger.emitted / (3 * CHUNK + 5) as f64;
    let arrivals: Vec<_> = seen.iter().flat_map(|s| &s.arrivals).collect();
    assert_eq!(arrivals.len() as u64, 3 * CHUNK + 5);
    for &&(events, opl, arrived) in &arrivals {
        assert!(events == 0 && (opl / RADIUS - 1.0).abs() < 1e-12);
        let expected = power * f64::exp(-sigma_t * RADIUS);
        assert!((arrived / expected - 1.0).abs() < 1e-9, "{arrived} {expected}");
    }
    assert!(seen.iter().all(|s| s.collisions.is_empty()));
}

/// First collisions have the OPL's exponential distribution; their power is the albedo's share.
/// The fraction that reaches the wall is e^−1 of 1541: within 6 standard errors (0.0123 each),
/// false-alarm probability 2e-9.
#[test]
fn collisions_come_after_free_paths_and_leave_the_albedo() {
    let scene = ball(0.0, [0.4; 3], [0.5; 3]);
    let (seen, ledger) = trace::<1>(&scene, up_to(2));
    let n = 3 * CHUNK + 5;
    let collisions: Vec<_> = seen.iter().flat_map(|s| &s.collisions).collect();
    let power = ledger.emitted / n as f64;
    assert!(collisions.iter().all(|c| c.1 < RADIUS && (c.2 / (0.8 * power) - 1.0).abs() < 1e-9));
    let through = 1.0 - collisions.len() as f64 / n as f64;
    assert!((through - f64::exp(-0.5 * RADIUS)).abs() < 6.0 * 0.0123, "{through}");
}
