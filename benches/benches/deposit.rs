//! Deposits into the film: an instant, and profiles over one and many bins.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tpb_film::{Arrival, FilmOptions, Layout, TemporalProfile, TimeAxis, TransientFilm};
use tpb_optics::Spectrum;

const DEPOSITS_PER_PIXEL: usize = 100;

/// Makes an arrival that starts at an OPL.
type ArrivalAt = fn(f64) -> Arrival<'static, 1>;

fn deposit(criterion: &mut Criterion) {
    let time = TimeAxis { start_opl: 0.0, bin_width_opl: 0.07, bins: 200 };
    let layout = Layout { width: 64, height: 64, time: Some(time) };
    let kinds: [(&str, ArrivalAt); 4] = [
        ("instant", Arrival::Instant),
        ("uniform over 3 bins", |t| {
            Arrival::Profile(TemporalProfile::Uniform { start: t, end: t + 0.2 })
        }),
        ("exponential within a bin", |t| {
            let depth = Spectrum([0.1]);
            Arrival::Profile(TemporalProfile::Exponential { start: t, end: t + 0.01, depth })
        }),
        ("exponential over 3 bins", |t| {
            let depth = Spectrum([0.1]);
            Arrival::Profile(TemporalProfile::Exponential { start: t, end: t + 0.2, depth })
        }),
    ];
    let mut group = criterion.benchmark_group("deposit");
    group.throughput(Throughput::Elements((64 * 64 * DEPOSITS_PER_PIXEL) as u64));
    for (name, arrival) in kinds {
        let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).expect("fits");
        group.bench_function(name, |b| {
            b.iter(|| {
                film.add_pass(|tile| {
                    for pixel in tile.pixels() {
                        for i in 0..DEPOSITS_PER_PIXEL {
                            let opl = 0.13 * i as f64;
                            tile.deposit(pixel, 0.0, &arrival(opl), Spectrum([1.0]));
                        }
                    }
                })
            });
        });
    }
    group.finish();
}

criterion_group!(benches, deposit);
criterion_main!(benches);
