//! Rays against surfaces: the nearest hit, and whole flights through null boundaries.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tpb_benches::shipped_scene;
use tpb_optics::{Stream, warp};
use tpb_scene::Vertex;

const RAYS: usize = 1000;

fn intersection(criterion: &mut Criterion) {
    for name in ["cornell-blocks", "mirror-caustic"] {
        let scene = shipped_scene(name);
        let mut rng = Stream::new(1, 0, 0);
        let bounds = scene.bounds();
        // From anywhere inside to anywhere: what scattered light asks.
        let rays: Vec<_> = (0..RAYS)
            .map(|_| {
                let u = glam::DVec3::new(rng.uniform(), rng.uniform(), rng.uniform());
                let position = bounds.min + u * (bounds.max - bounds.min);
                let vertex = Vertex { position, primitive: None, region: scene.background };
                (vertex, warp::uniform_sphere(rng.uniform(), rng.uniform()))
            })
            .collect();
        let mut group = criterion.benchmark_group(format!("intersection/{name}"));
        group.throughput(Throughput::Elements(RAYS as u64));
        group.bench_function("nearest", |b| {
            b.iter(|| {
                for (vertex, direction) in &rays {
                    black_box(scene.nearest(vertex, *direction, f64::INFINITY));
                }
            });
        });
        group.bench_function("flight", |b| {
            b.iter(|| {
                for (vertex, direction) in &rays {
                    black_box(scene.fly(vertex, *direction));
                }
            });
        });
        group.finish();
    }
}

criterion_group!(benches, intersection);
criterion_main!(benches);
