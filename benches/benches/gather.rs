//! The beam query at R = 0.02 with about 1e5 beams on Cornell blocks, on one core: through image
//! tiles (primary rays) and through the hierarchy (any ray). Elements are accepted pairs; sorting
//! and building are included. A whole pass is measured beside them.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use tpb_beams::beam::{Beam, CameraRay};
use tpb_beams::beam_map::BeamMap;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::photons::PhotonTracer;
use tpb_beams::tiles::Tiles;
use tpb_beams::{BeamLength, BeamOptions, PhotonBeams};
use tpb_benches::{film_of, one_thread, shipped_scene};
use tpb_optics::Spectrum;
use tpb_render::{Method, PassId};
use tpb_scene::{MediumId, Plan, Scene};

const RADIUS: f64 = 0.02;
const PHOTONS: u64 = 19_000;
const ID: PassId = PassId { seed: 1, index: 0 };

/// The rays through all pixel centres, within the fog.
fn camera_rays(scene: &Scene) -> Vec<((usize, usize), MediumId, CameraRay<1>)> {
    let (width, height) = (scene.film.width, scene.film.height);
    let pixels = (0..width * height).map(|pixel| (pixel % width, pixel / width));
    let rays = pixels.filter_map(|(x, y)| {
        let direction = scene.sensor.direction(x as f64 + 0.5, y as f64 + 0.5);
        let flight = scene.fly(&scene.eye(), direction);
        let span = flight.spans.iter().find(|span| span.region.medium.is_some())?;
        let id = span.region.medium?;
        let medium = scene.medium(id);
        let ray = CameraRay {
            origin: flight.at(span.start),
            direction,
            length: span.end - span.start,
            opl: span.start,
            throughput: Spectrum::ONE,
            coefficients: medium.coefficients.channels(),
            phase: medium.phase,
            eta: span.region.eta,
        };
        Some(((x, y), id, ray))
    });
    rays.collect()
}

/// Adds a pair's energy, so that the estimate is not optimised away.
fn evaluate(beam: &Beam<1>, meeting: &<Kernel1d as RayBeamKernel>::Meeting, ray: &CameraRay<1>) {
    black_box(Kernel1d { radius: RADIUS }.contribution(meeting, beam, ray));
}

fn gather(criterion: &mut Criterion) {
    let scene = shipped_scene("cornell-blocks");
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    let tracer = PhotonTracer { scene: &scene, plan: &plan, integrator, length: BeamLength::Long };
    let beams = tracer.trace::<1>(ID, PHOTONS, PHOTONS).beams;
    let rays = camera_rays(&scene);
    let kernel = Kernel1d { radius: RADIUS };
    let by_tiles = || -> u64 {
        let tiles = Tiles::new(&scene, &beams, RADIUS);
        rays.iter()
            .map(|(pixel, id, ray)| {
                tiles.query(kernel, *id, *pixel, ray, |b, m| evaluate(b, m, ray)).accepted
            })
            .sum()
    };
    let by_hierarchy = || -> u64 {
        let map = BeamMap::new(kernel, &beams, 16.0 * RADIUS);
        rays.iter()
            .map(|(_, id, ray)| map.query(kernel, *id, ray, |b, m| evaluate(b, m, ray)).accepted)
            .sum()
    };

    let mut group = criterion.benchmark_group(format!("gather/{} beams", beams.len()));
    group.sample_size(10);
    group.throughput(Throughput::Elements(by_tiles()));
    group.bench_function("tiles", |b| one_thread(|| b.iter(by_tiles)));
    group.bench_function("hierarchy", |b| one_thread(|| b.iter(by_hierarchy)));

    let options = BeamOptions {
        radius: Some(RADIUS),
        photons_per_pass: Some(PHOTONS),
        beam_photons: Some(PHOTONS),
        ..BeamOptions::default()
    };
    let method = PhotonBeams::new(&scene, &plan, integrator, &options).expect("sound options");
    let pairs = method.pass(ID, &mut film_of(&scene)).counts.pairs_accepted;
    group.throughput(Throughput::Elements(pairs));
    group.bench_function("whole pass", |b| {
        one_thread(|| {
            b.iter_batched_ref(
                || film_of(&scene),
                |film| method.pass(ID, film),
                BatchSize::PerIteration,
            );
        });
    });
    group.finish();
}

criterion_group!(benches, gather);
criterion_main!(benches);
