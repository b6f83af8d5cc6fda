//! Photon tracing on Cornell blocks, on one core: emission, flights, scattering, storing. A segment is one
//! flight of a photon, from its emission or last event to the next.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tpb_beams::photons::PhotonTracer;
use tpb_beams::{BeamLength, Sampler, Sampling};
use tpb_benches::{one_thread, shipped_scene};
use tpb_render::PassId;
use tpb_scene::Plan;

const PHOTONS: u64 = 10_000;

fn photons(criterion: &mut Criterion) {
    let scene = shipped_scene("cornell-blocks");
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    let tracer = PhotonTracer {
        scene: &scene,
        plan: &plan,
        integrator,
        length: BeamLength::Long,
        sampling: Sampling { sampler: Sampler::Sobol, thin_from: 2, horizon: None },
    };
    let id = PassId { seed: 1, index: 0 };
    let mut group = criterion.benchmark_group("photons");
    // One segment leaves one beam in this scene, whose medium fills all of it.
    let segments = tracer.trace::<1>(id, PHOTONS, PHOTONS).beams.len();
    group.throughput(Throughput::Elements(segments as u64));
    group.bench_function("segments", |b| {
        one_thread(|| b.iter(|| tracer.trace::<1>(id, PHOTONS, PHOTONS)));
    });
    group.finish();
}

criterion_group!(benches, photons);
criterion_main!(benches);
