use super::*;
use crate::beams::beam_ray::{BeamRay1d, beam_ray_1d};
use crate::numerics::vector::fibonacci_direction;
use crate::single_scattering::{
    SingleScatter, SingleScatterBin, single_scatter_radiance, single_scatter_radiance_bins,
};
use proptest::prelude::*;

const SAMPLE: Blur1d = Blur1d {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    g: 0.6,
    speed: 0.75,
    ray_offset: 1.0,
    source_z: 0.7,
    radius: 0.4,
    time: 2.0,
};

fn bin(of: &Blur1d, t0: f64, t1: f64) -> Blur1dBin {
    let &Blur1d { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, .. } = of;
    Blur1dBin { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, t0, t1 }
}

fn in_bin(of: &Blur1d, t0: f64, t1: f64) -> f64 {
    expected_blur_1d_bins(&bin(of, t0, t1)).unwrap()
}

fn at(of: &Blur1d, time: f64) -> f64 {
    expected_blur_1d(&Blur1d { time, ..*of }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// Every relation of kernel and offset, and the source ahead, beside and behind.
fn geometries() -> impl Iterator<Item = Blur1d> {
    [0.1, 0.4, 1.0, 2.5]
        .into_iter()
        .flat_map(|radius| [-0.7, 0.0, 0.7].map(|source_z| Blur1d { source_z, radius, ..SAMPLE }))
}

/// The unblurred bin of a source at the distance `offset` from the ray.
fn unblurred_bin(of: &Blur1d, offset: f64, t0: f64, t1: f64) -> f64 {
    let &Blur1d { energy, sigma_s, sigma_t, g, speed, source_z, .. } = of;
    let (source_distance, alpha) = (source_z.hypot(offset), offset.atan2(source_z));
    single_scatter_radiance_bins(&SingleScatterBin {
        energy,
        sigma_s,
        sigma_t,
        g,
        speed,
        source_distance,
        alpha,
        t0,
        t1,
    })
    .unwrap()
}

#[test]
fn a_bin_is_the_average_of_the_bins_of_the_sources_in_the_kernel() {
    // The order of the two integrals exchanged: an independent route to the same number.
    for of in geometries() {
        for g in [-0.9, 0.0, 0.6, 0.95] {
            let of = Blur1d { g, ..of };
            let reach = of.radius.min(of.ray_offset);
            for (t0, t1) in [(0.0, 8.0), (1.5, 1.7), (0.0, 1.4)] {
                // The light of the source at y arrives at the edge of the bin: a kink.
                let kink = |t: f64| {
                    let y2 = 1.0 + of.source_z.powi(2) - (of.speed * t).powi(2);
                    y2.max(0.0).sqrt().min(reach)
                };
                let mut ends = [0.0, kink(t0), kink(t1), reach];
                ends.sort_by(f64::total_cmp);
                let average: f64 = ends
                    .windows(2)
                    .filter(|piece| piece[0] < piece[1])
                    .map(|piece| {
                        let integrand = |node: Node| {
                            let rest = (of.ray_offset - piece[1]) + node.to_end;
                            let offset = (rest * (of.ray_offset + node.x)).sqrt();
                            unblurred_bin(&of, offset, t0, t1)
                        };
                        tanh_sinh(integrand, piece[0], piece[1], 1e-9).unwrap().value
                    })
                    .sum();
                let value = in_bin(&of, t0, t1);
                let error = (value - average / of.radius).abs();
                assert!(error <= 1e-8 * value, "{error:e} of {value:e}: {of:?}, {t0} to {t1}");
            }
        }
    }
}

#[test]
fn the_integral_of_the_density_is_the_bin() {
    for of in geometries() {
        for g in [0.0, 0.9] {
            let of = Blur1d { g, ..of };
            let blur = Blur::new(g, of.ray_offset, of.source_z, of.radius).unwrap();
            let (onset, front) = (blur.onset() / of.speed, blur.front() / of.speed);
            // In time, nodes next to an infinite onset would have lost their distance from it.
            let start = if of.ray_offset > of.radius { onset } else { onset + 1e-3 };
            let integral: f64 = [(start, front), (front, 5.0)]
                .map(|(a, b)| tanh_sinh(|node| at(&of, node.x), a, b, 1e-9).unwrap().value)
                .iter()
                .sum();
            close(in_bin(&of, start, 5.0), integral, 1e-8);
        }
    }
}

#[test]
fn the_closed_form_is_the_limit_of_the_quadrature() {
    for of in geometries() {
        for time in [1.35, 1.6, 1.7, 4.0] {
            let isotropic = at(&Blur1d { g: 0.0, ..of }, time);
            close(at(&Blur1d { g: 1e-300, ..of }, time), isotropic, 1e-11);
        }
    }
}

#[test]
fn a_vanishing_kernel_gives_the_true_radiance() {
    let &Blur1d { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, time, .. } = &SAMPLE;
    let (source_distance, alpha) = (source_z.hypot(ray_offset), ray_offset.atan2(source_z));
    let sharp = SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time };
    let sharp = single_scatter_radiance(&sharp).unwrap();
    let bias = |radius: f64| at(&Blur1d { radius, ..SAMPLE }, time) / sharp - 1.0;
    assert!(bias(1e-7).abs() < 1e-11);
    // Elsewhere the bias falls with the square of the radius.
    close(bias(0.02) / bias(0.01), 4.0, 1e-3);
}

#[test]
fn a_kernel_wider_than_the_offset_only_divides() {
    // Nothing beyond y = b contributes: E is inverse in R from there on.
    for time in [1.3, 2.0] {
        let wide = at(&Blur1d { radius: 5.0, ..SAMPLE }, time);
        close(at(&Blur1d { radius: 1.0, ..SAMPLE }, time), 5.0 * wide, 1e-12);
    }
}

#[test]
fn there_is_light_between_the_onset_and_the_true_front() {
    let blur = Blur::new(0.6, 1.0, 0.7, 0.4).unwrap();
    let (onset, front) = (blur.onset() / SAMPLE.speed, blur.front() / SAMPLE.speed);
    assert_eq!(at(&SAMPLE, onset * (1.0 - 1e-15)), 0.0);
    assert_eq!(in_bin(&SAMPLE, 0.0, onset * (1.0 - 1e-15)), 0.0);
    assert!(at(&SAMPLE, 0.5 * (onset + front)) > 0.0);
    // The density is continuous at the true front; the bins meet there.
    close(at(&SAMPLE, front * (1.0 - 1e-15)), at(&SAMPLE, front * (1.0 + 1e-15)), 1e-6);
    close(
        in_bin(&SAMPLE, 0.0, front) + in_bin(&SAMPLE, front, 9.0),
        in_bin(&SAMPLE, 0.0, 9.0),
        1e-12,
    );
}

#[test]
fn a_kernel_that_covers_the_source_has_an_infinite_onset() {
    let of = Blur1d { radius: 2.0, speed: 1.0, ..SAMPLE };
    assert!(expected_blur_1d(&Blur1d { time: 0.7, ..of }).is_err());
    assert!(at(&of, 0.7 + 1e-12) > at(&of, 0.7 + 1e-6));
    let whole = in_bin(&of, 0.0, 9.0);
    close(in_bin(&of, 0.0, 0.7 + 1e-9) + in_bin(&of, 0.7 + 1e-9, 9.0), whole, 1e-10);
}

#[test]
fn the_expectation_is_the_average_over_beams_in_all_directions() {
    // Beams on a Fibonacci lattice of directions from the source, each through `beam_ray_1d`.
    let of = Blur1d { speed: 1.0, ..SAMPLE };
    let beams = 2_000_000;
    let mut sum = 0.0;
    for i in 0..beams {
        let beam_direction = fibonacci_direction(i, beams);
        // The arrival at closest approach to the line x = y = 0.
        let sine2 = beam_direction[0].powi(2) + beam_direction[1].powi(2);
        let on_beam = -of.ray_offset * beam_direction[0] / sine2;
        let path = on_beam + of.source_z + on_beam * beam_direction[2];
        if !(1.5..2.5).contains(&path) {
            continue;
        }
        sum += beam_ray_1d(&BeamRay1d {
            sigma_s: of.sigma_s,
            sigma_t: of.sigma_t,
            g: of.g,
            radius: of.radius,
            beam_origin: [of.ray_offset, 0.0, of.source_z],
            beam_direction,
            beam_length: 1e3,
            ray_origin: [0.0; 3],
            ray_direction: [0.0, 0.0, 1.0],
            ray_length: 1e3,
        })
        .unwrap();
    }
    close(of.energy * sum / f64::from(beams), in_bin(&of, 1.5, 2.5), 3e-4);
}

#[test]
fn inputs_without_meaning_are_errors() {
    for broken in [
        Blur1d { ray_offset: 0.0, ..SAMPLE },
        Blur1d { radius: 0.0, ..SAMPLE },
        Blur1d { source_z: f64::NAN, ..SAMPLE },
        Blur1d { g: -1.0, ..SAMPLE },
        Blur1d { speed: 0.0, ..SAMPLE },
    ] {
        assert!(expected_blur_1d(&broken).is_err());
        assert!(expected_blur_1d_bins(&bin(&broken, 0.0, 1.0)).is_err());
    }
}

prop_compose! {
    fn anywhere()(
        sigma_t in 0.0..5.0_f64,
        g in -0.95..0.95_f64,
        ray_offset in 0.05..3.0_f64,
        source_z in -5.0..5.0_f64,
        log_radius in -4.0..0.7_f64,
        time in 0.1..20.0_f64,
    ) -> Blur1d {
        let radius = 10.0_f64.powf(log_radius);
        Blur1d { sigma_t, g, ray_offset, source_z, radius, time, ..SAMPLE }
    }
}

proptest! {
    #[test]
    fn bins_add_up(of in anywhere(), splits in prop::array::uniform3(0.0..1.0_f64)) {
        let mut edges = [0.0, splits[0], splits[1], splits[2], 1.0].map(|x| x * of.time);
        edges.sort_by(f64::total_cmp);
        let sum: f64 = edges.windows(2).map(|bin| in_bin(&of, bin[0], bin[1])).sum();
        close(sum, in_bin(&of, 0.0, of.time), 1e-9);
    }

    #[test]
    fn absorption_acts_on_the_path_length_alone(of in anywhere(), sigma_a in 0.0..5.0_f64) {
        let absorbing = Blur1d { sigma_t: of.sigma_t + sigma_a, ..of };
        let factor = (-sigma_a * of.speed * of.time).exp();
        close(at(&absorbing, of.time), factor * at(&of, of.time), 1e-11);
    }

    #[test]
    fn lengths_and_times_scale(of in anywhere(), factor in 0.01..100.0_f64) {
        let scaled = Blur1d {
            sigma_s: of.sigma_s / factor,
            sigma_t: of.sigma_t / factor,
            ray_offset: of.ray_offset * factor,
            source_z: of.source_z * factor,
            radius: of.radius * factor,
            ..of
        };
        let late = in_bin(&scaled, 0.0, of.time * factor) * factor * factor;
        // The onset within the last digits of the end of the bin may move across it.
        prop_assert!((late - in_bin(&of, 0.0, of.time)).abs() <= 1e-9 * late + 1e-12);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform8(-320.0..308.0_f64),
        g in -1.1..1.1_f64,
        ahead in any::<bool>(),
    ) {
        let [energy, sigma_t, speed, ray_offset, z, radius, time, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let source_z = if ahead { z } else { -z };
        let of = Blur1d { energy, sigma_t, g, speed, ray_offset, source_z, radius, time, ..SAMPLE };
        for result in [expected_blur_1d(&of), expected_blur_1d_bins(&bin(&of, time, time + width))] {
            prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
        }
    }
}
