//! Whole camera paths of the path tracer on Cornell blocks (200 bins, depth 100), on one core: a path is
//! all flights from the eye on, with their connections to the lamp and their deposits.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tpb_benches::{film_of, one_thread, shipped_scene};
use tpb_path::{PathOptions, PathTracer};
use tpb_render::{Method, PassId};
use tpb_scene::Plan;

fn paths(criterion: &mut Criterion) {
    let scene = shipped_scene("cornell-blocks");
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    let tracer = PathTracer::<1>::new(&scene, &plan, integrator, &PathOptions::default());
    let mut film = film_of(&scene);
    let id = PassId { seed: 1, index: 0 };
    let count = tracer.pass(id, &mut film).counts.camera_paths;
    let mut group = criterion.benchmark_group("paths");
    group.throughput(Throughput::Elements(count));
    group.bench_function("cornell-blocks", |b| {
        one_thread(|| b.iter(|| tracer.pass(id, &mut film)));
    });
    group.finish();
}

criterion_group!(benches, paths);
criterion_main!(benches);
