//! The gather by each kernel and way, and a whole pass of the renderer.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_beams::{BeamOptions, PhotonBeams};
use tpb_benches::gathers::Gathers;
use tpb_benches::{film_of, one_thread, sized_scene};
use tpb_render::{Method, PassId};
use tpb_scene::Plan;

const ID: PassId = PassId { seed: 1, index: 0 };
/// Photons for 1e5 and 1e6 beams.
const PHOTONS: [u64; 2] = [17_500, 175_000];
/// Radii of beams \[m\].
const RADII: [f64; 2] = [0.005, 0.02];

fn gather(criterion: &mut Criterion) {
    for photons in PHOTONS {
        let mut gathers = Gathers::new(photons);
        let mut group = criterion.benchmark_group(format!("gather/{} beams", gathers.beams()));
        group.sample_size(10);
        for radius in RADII {
            let (one, two) = (Kernel1d { radius }, Kernel2d { radius });
            group.throughput(Throughput::Elements(gathers.drawn(one)));
            group.bench_function(format!("drawn, 1D, R = {radius}"), |b| {
                one_thread(|| b.iter(|| gathers.drawn(one)));
            });
            group.throughput(Throughput::Elements(gathers.drawn(two)));
            group.bench_function(format!("drawn, 2D, R = {radius}"), |b| {
                one_thread(|| b.iter(|| gathers.drawn(two)));
            });
            group.throughput(Throughput::Elements(gathers.bundled(one)));
            group.bench_function(format!("bundled, 1D, R = {radius}"), |b| {
                one_thread(|| b.iter(|| gathers.bundled(one)));
            });
        }
        group.finish();
    }
}

fn pass(criterion: &mut Criterion) {
    let scene = sized_scene("cornell-blocks", Some(128));
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    let options = BeamOptions {
        radius: Some(0.02),
        photons_per_pass: Some(19_000),
        beam_photons: Some(19_000),
        ..BeamOptions::default()
    };
    let method = PhotonBeams::new(&scene, &plan, integrator, &options).expect("sound options");
    let pairs = method.pass(ID, &mut film_of(&scene)).counts.pairs_accepted;
    let mut group = criterion.benchmark_group("pass");
    group.sample_size(10);
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

criterion_group!(benches, gather, pass);
criterion_main!(benches);
