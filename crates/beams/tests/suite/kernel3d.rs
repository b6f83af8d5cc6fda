//! The 3D kernel: one beam and one ray against the sum over points of both, in energy and time.

use glam::DVec3;
use tpb_beams::Temporal;
use tpb_beams::beam::{Attenuation, Beam, CameraRay};
use tpb_beams::contribution::Contribution;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::kernel3d::Kernel3d;
use tpb_film::{FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_optics::Spectrum;

use crate::kernels::{RADIUS, SAMPLED, beam, left, pairs, ray};

const BINS: usize = 24;

/// Bins that just hold a contribution, with a margin.
fn axis(contribution: &Contribution<3>) -> TimeAxis {
    let length = contribution.end - contribution.start;
    let bin_width_opl = 1.1 * length / BINS as f64;
    TimeAxis { start_opl: contribution.start - 0.05 * length, bin_width_opl, bins: BINS }
}

/// Energy per bin and channel, what is outside included.
fn deposited(contribution: &Contribution<3>, temporal: Temporal) -> Vec<[f64; 3]> {
    let layout = Layout::new(1, 1, Some(axis(contribution))).expect("the axis is sound");
    let mut film = TransientFilm::<3>::new(layout, FilmOptions::default()).expect("it is small");
    film.add_pass(|tile| contribution.deposit(temporal, 1.0, (tile, 0, 0.0)));
    assert_eq!(film.non_finite(), 0);
    let arrays = film.develop();
    for c in 0..3 {
        let sum: f64 = (0..BINS).map(|bin| f64::from(arrays.transient[3 * bin + c])).sum();
        let steady = arrays.steady[c];
        assert!((sum / steady - 1.0).abs() < 1e-6, "all of it arrives within the interval");
        assert!((steady / contribution.energy[c] - 1.0).abs() < 1e-12);
    }
    arrays.transient.chunks(3).map(|bin| std::array::from_fn(|c| f64::from(bin[c]))).collect()
}

/// A sum over a grid of points of both lines, which knows neither ellipses nor widths.
fn summed(beam: &Beam<3>, ray: &CameraRay<3>, axis: TimeAxis) -> Vec<[f64; 3]> {
    let mut bins = vec![[0.0; 3]; BINS];
    let end = ray.length.min(20.0);
    let (step_r, step_b) = (1e-4, 2e-4);
    let density = 3.0 / (4.0 * std::f64::consts::PI * RADIUS.powi(3)) * step_r * step_b;
    let phase = ray.phase.value(-ray.direction.dot(beam.direction));
    let channel = |c: usize| ray.throughput[c] * beam.power[c] * ray.coefficients.sigma_s[c];
    let scattered: [f64; 3] = std::array::from_fn(|c| channel(c) * phase * density);
    for i in 0..(end / step_r) as usize {
        let s_r = (i as f64 + 0.5) * step_r;
        let point = ray.origin + s_r * ray.direction - beam.origin;
        let foot = point.dot(beam.direction);
        if (point - foot * beam.direction).length() >= RADIUS {
            continue;
        }
        let cell = |s: f64| (s.clamp(0.0, beam.length) / step_b) as usize;
        for j in cell(foot - RADIUS)..=cell(foot + RADIUS) {
            let s_b = (j as f64 + 0.5) * step_b;
            let near = (point - s_b * beam.direction).length_squared() < RADIUS * RADIUS;
            if s_b >= beam.length || !near {
                continue;
            }
            let opl = beam.opl + ray.opl + ray.eta * (s_b + s_r);
            let bin = ((opl - axis.start_opl) / axis.bin_width_opl).floor();
            assert!((0.0..BINS as f64).contains(&bin), "outside of its interval");
            for c in 0..3 {
                bins[bin as usize][c] += scattered[c] * left(beam.attenuation, s_b, s_r, c);
            }
        }
    }
    bins
}

#[test]
fn every_pair_is_the_sum_over_its_points_in_every_bin() {
    for attenuation in [Attenuation::Explicit, SAMPLED] {
        let beyond = [
            ("around the beam's start", DVec3::new(-1.0, 0.02, -0.05), DVec3::new(1.0, 0.0, 0.02)),
            ("around the beam's end", DVec3::new(-1.0, 0.02, 2.06), DVec3::new(1.0, 0.0, 0.01)),
            ("beyond, looking back", DVec3::new(0.0, 0.02, 2.5), DVec3::new(0.0, 0.0, -1.0)),
        ];
        let along_z = || beam(DVec3::ZERO, DVec3::Z, 2.0, attenuation);
        let more =
            beyond.map(|(name, origin, direction)| (name, along_z(), ray(origin, direction, 3.0)));
        for (name, beam, ray) in pairs(attenuation).into_iter().chain(more) {
            let contribution = Kernel3d { radius: RADIUS }.evaluate(&beam, &ray).expect(name);
            let found = deposited(&contribution, Temporal::Exact);
            let expected = summed(&beam, &ray, axis(&contribution));
            for c in 0..3 {
                let total: f64 = expected.iter().map(|bin| bin[c]).sum();
                // The grid's cells along the border are its error: 1e-4 m of up to 0.2 m.
                let tolerance = if name == "grazing" { 0.05 } else { 4e-3 };
                assert!(
                    (contribution.energy[c] / total - 1.0).abs() < tolerance,
                    "{name} {c}: {} {total}",
                    contribution.energy[c]
                );
                for (bin, (a, b)) in found.iter().zip(&expected).enumerate() {
                    assert!(
                        (a[c] - b[c]).abs() < tolerance * total,
                        "{name}, channel {c}, bin {bin}: {} {} of {total}",
                        a[c],
                        b[c]
                    );
                }
            }
        }
    }
}

#[test]
fn a_short_beam_of_one_channel_is_attenuated_along_the_ray_alone() {
    // Three equal channels are one.
    let sampled = Attenuation::Sampled { mixture: Spectrum([0.3, 0.3, 0.4]) };
    for (name, mut beam, mut ray) in pairs(sampled) {
        ray.coefficients.sigma_t = Spectrum([0.9; 3]);
        let of_three = Kernel3d { radius: RADIUS }.evaluate(&beam, &ray).expect(name);
        beam.attenuation = Attenuation::Sampled { mixture: Spectrum([1.0, 0.0, 0.0]) };
        let first = |s: Spectrum<3>| Spectrum([s[0]]);
        let single = Beam {
            power: first(beam.power),
            attenuation: Attenuation::Sampled { mixture: Spectrum([1.0]) },
            origin: beam.origin,
            direction: beam.direction,
            length: beam.length,
            opl: beam.opl,
            medium: beam.medium,
            depth: beam.depth,
        };
        let single_ray = CameraRay {
            throughput: first(ray.throughput),
            coefficients: tpb_optics::Coefficients {
                sigma_s: first(ray.coefficients.sigma_s),
                sigma_t: first(ray.coefficients.sigma_t),
            },
            origin: ray.origin,
            direction: ray.direction,
            length: ray.length,
            opl: ray.opl,
            phase: ray.phase,
            eta: ray.eta,
        };
        let of_one = Kernel3d { radius: RADIUS }.evaluate(&single, &single_ray).expect(name);
        assert!((of_one.energy[0] / of_three.energy[0] - 1.0).abs() < 1e-9, "{name}");
    }
}

#[test]
fn even_spreading_keeps_total_and_interval() {
    for (name, beam, ray) in pairs(Attenuation::Explicit) {
        let contribution = Kernel3d { radius: RADIUS }.evaluate(&beam, &ray).expect(name);
        let (even, exact) =
            (deposited(&contribution, Temporal::Even), deposited(&contribution, Temporal::Exact));
        let sum = |bins: &[[f64; 3]]| bins.iter().map(|bin| bin[0]).sum::<f64>();
        assert!((sum(&even) / sum(&exact) - 1.0).abs() < 1e-6, "{name}");
        assert!((even[5][0] / even[12][0] - 1.0).abs() < 1e-5, "{name}: even");
    }
}

/// Where optical depths are too large for the series, quadrature takes over at the same value.
#[test]
fn whole_ellipses_have_one_value_by_series_and_by_quadrature() {
    let radius = 0.5;
    let at = |sigma: f64| {
        let beam = beam(DVec3::ZERO, DVec3::Z, 9.0, Attenuation::Explicit);
        let mut ray = ray(DVec3::new(-1.0, 0.1, 1.0), DVec3::new(1.0, 0.0, 0.3), 9.0);
        ray.coefficients.sigma_t = Spectrum([sigma; 3]);
        Kernel3d { radius }.evaluate(&beam, &ray).expect("they cross").energy[0]
    };
    // Half length in T: √(2 (R² − h²)/(1 − cosψ)).
    let cosine = 0.3 / 1.09_f64.sqrt();
    let half = (2.0 * (radius * radius - 0.01) / (1.0 - cosine)).sqrt();
    let limit = 4.0 / half;
    let (below, above) = (at(limit * (1.0 - 1e-9)), at(limit * (1.0 + 1e-9)));
    assert!((below / above - 1.0).abs() < 1e-7, "{below} {above}");
    let deep = at(2000.0);
    assert!(deep.is_finite() && deep >= 0.0);
}
