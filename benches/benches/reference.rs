//! Values per second of the analytic solutions that curves are drawn with, on one thread.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use tpb_reference::dwell::{DwellSingleScatter, dwell_single_scatter_radiance};
use tpb_reference::error::Result;
use tpb_reference::infinite_medium::{
    PointPulse, PointPulseBin, SincMoment, infinite_medium_sinc_moment, point_pulse_fluence,
    point_pulse_fluence_bins,
};
use tpb_reference::single_scattering::{
    OnceScatteredBin, OnceScatteredHg, SingleScatter, SingleScatterBin,
    once_scattered_fluence_bins, once_scattered_fluence_hg, single_scatter_radiance,
    single_scatter_radiance_bins,
};

const CURVE: usize = 400;

/// Time `i` of a curve from just before the front at 2 to 8.
fn time(i: usize) -> f64 {
    1.99 + 6.0 / CURVE as f64 * i as f64
}

/// The sum of a curve.
fn curve(at: impl Fn(f64, f64) -> Result<f64>) -> f64 {
    let value = |i| at(time(i), time(i + 1)).expect("within the domain");
    (0..CURVE).map(value).sum()
}

fn radiance(g: f64) -> f64 {
    curve(|time, _| {
        single_scatter_radiance(&SingleScatter {
            energy: 1.0,
            sigma_s: 0.8,
            sigma_t: 1.0,
            g,
            speed: 1.0,
            source_distance: 2.0,
            alpha: 0.3,
            time,
        })
    })
}

fn radiance_bins(g: f64) -> f64 {
    curve(|t0, t1| {
        single_scatter_radiance_bins(&SingleScatterBin {
            energy: 1.0,
            sigma_s: 0.8,
            sigma_t: 1.0,
            g,
            speed: 1.0,
            source_distance: 2.0,
            alpha: 0.3,
            t0,
            t1,
        })
    })
}

fn fluence(g: f64) -> f64 {
    curve(|time, _| {
        once_scattered_fluence_hg(&OnceScatteredHg {
            energy: 1.0,
            sigma_s: 0.8,
            sigma_t: 1.0,
            g,
            speed: 1.0,
            r: 2.0,
            time,
        })
    })
}

fn fluence_bins(_g: f64) -> f64 {
    curve(|t0, t1| {
        once_scattered_fluence_bins(&OnceScatteredBin {
            energy: 1.0,
            sigma_s: 0.8,
            sigma_t: 1.0,
            speed: 1.0,
            r: 2.0,
            t0,
            t1,
        })
    })
}

fn dwell_radiance(g: f64) -> f64 {
    curve(|time, _| {
        dwell_single_scatter_radiance(&DwellSingleScatter {
            energy: 1.0,
            sigma_s: 0.8,
            sigma_t: 1.0,
            g,
            speed: 1.0,
            source_distance: 2.0,
            alpha: 0.3,
            mean_dwell: 0.2,
            time,
        })
    })
}

/// All orders at once, at r = 2 and an albedo of 0.9.
fn point_pulse(_g: f64) -> f64 {
    curve(|time, _| point_pulse_fluence(&PointPulse { r: 2.0, time, albedo: 0.9 }))
}

fn point_pulse_bins(_g: f64) -> f64 {
    curve(|t0, t1| point_pulse_fluence_bins(&PointPulseBin { r: 2.0, t0, t1, albedo: 0.9 }))
}

fn sinc_moment(g: f64) -> f64 {
    curve(|time, _| {
        infinite_medium_sinc_moment(&SincMoment { g, k: 1.0, time, sigma_s: 0.9, sigma_a: 0.1 })
    })
}

/// A name, the sum of a curve for a mean cosine, and the mean cosines.
type Curve = (&'static str, fn(f64) -> f64, &'static [f64]);

fn reference(criterion: &mut Criterion) {
    let solutions: [Curve; 8] = [
        ("single_scatter_radiance", radiance, &[0.0, 0.9]),
        ("single_scatter_radiance_bins", radiance_bins, &[0.0, 0.9]),
        ("once_scattered_fluence_hg", fluence, &[0.5, 0.9]),
        ("once_scattered_fluence_bins", fluence_bins, &[0.0]),
        ("dwell_single_scatter_radiance", dwell_radiance, &[0.0, 0.9]),
        ("point_pulse_fluence", point_pulse, &[0.0]),
        ("point_pulse_fluence_bins", point_pulse_bins, &[0.0]),
        ("infinite_medium_sinc_moment", sinc_moment, &[0.0, 0.9]),
    ];
    let mut group = criterion.benchmark_group("reference");
    group.throughput(Throughput::Elements(CURVE as u64));
    for (name, solution, mean_cosines) in solutions {
        for &g in mean_cosines {
            group.bench_function(BenchmarkId::new(name, format!("g = {g}")), |b| {
                b.iter(|| solution(black_box(g)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, reference);
criterion_main!(benches);
