use super::*;
use crate::beams::beam_ray::{BeamRay2dBin, beam_ray_2d_bins};
use crate::numerics::quadrature::tanh_sinh;
use crate::numerics::vector::fibonacci_direction;
use crate::single_scattering::{SingleScatter, single_scatter_radiance};
use proptest::prelude::*;

const SAMPLE: Blur2d = Blur2d {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    speed: 0.75,
    ray_offset: 1.0,
    source_z: 0.7,
    radius: 0.4,
    time: 2.0,
};

fn bin(of: &Blur2d, t0: f64, t1: f64) -> Blur2dBin {
    let &Blur2d { energy, sigma_s, sigma_t, speed, ray_offset, source_z, radius, .. } = of;
    Blur2dBin { energy, sigma_s, sigma_t, speed, ray_offset, source_z, radius, t0, t1 }
}

fn in_bin(of: &Blur2d, t0: f64, t1: f64) -> f64 {
    expected_blur_2d_bins(&bin(of, t0, t1)).unwrap()
}

fn at(of: &Blur2d, time: f64) -> f64 {
    expected_blur_2d(&Blur2d { time, ..*of }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn fronts(of: &Blur2d) -> (f64, f64) {
    let blur = DiscBlur::new(of.ray_offset, of.source_z, of.radius).unwrap();
    (blur.onset() / of.speed, blur.front() / of.speed)
}

#[test]
fn the_difference_of_asinh_keeps_its_digits() {
    for a in [-50.0, -1e-3, 0.0, 0.3, 1e8] {
        for width in [1e-3, 1.0, 100.0] {
            let (from, to) = (f64::asinh(a), f64::asinh(a + width));
            // The subtraction has only the digits of its terms.
            assert!((asinh_difference(a, width) - (to - from)).abs() <= 1e-15 * to.abs().max(1.0));
        }
        // For small widths, width / √(1 + a²) with a relative error of the order of the width.
        close(
            asinh_difference(a, 1e-13 * (1.0 + a.abs())),
            1e-13 * (1.0 + a.abs()) / a.hypot(1.0),
            1e-12,
        );
    }
    assert_eq!(asinh_difference(0.0, 0.0), 0.0);
}

#[test]
fn the_integral_of_the_density_is_the_bin() {
    for radius in [0.01, 0.4, 0.999] {
        for source_z in [-2.0, 0.0, 0.7, 5.0] {
            let of = Blur2d { source_z, radius, ..SAMPLE };
            let (onset, front) = fronts(&of);
            let integral: f64 = [(onset, front), (front, front + 5.0)]
                .map(|(a, b)| tanh_sinh(|node| at(&of, node.x), a, b, 1e-10).unwrap().value)
                .iter()
                .sum();
            close(in_bin(&of, 0.0, front + 5.0), integral, 1e-9);
        }
    }
}

#[test]
fn a_vanishing_disc_gives_the_true_radiance() {
    let &Blur2d { energy, sigma_s, sigma_t, speed, ray_offset, source_z, time, .. } = &SAMPLE;
    let (source_distance, alpha) = (source_z.hypot(ray_offset), ray_offset.atan2(source_z));
    let g = 0.0;
    let sharp = SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time };
    let sharp = single_scatter_radiance(&sharp).unwrap();
    let bias = |radius: f64| at(&Blur2d { radius, ..SAMPLE }, time) / sharp - 1.0;
    assert!(bias(1e-7).abs() < 1e-12);
    close(bias(0.02) / bias(0.01), 4.0, 1e-2);
}

#[test]
fn there_is_light_between_the_onset_and_the_true_front() {
    let (onset, front) = fronts(&SAMPLE);
    assert_eq!(at(&SAMPLE, onset * (1.0 - 1e-15)), 0.0);
    assert_eq!(in_bin(&SAMPLE, 0.0, onset * (1.0 - 1e-15)), 0.0);
    assert!(at(&SAMPLE, 0.5 * (onset + front)) > 0.0);
    close(at(&SAMPLE, front * (1.0 - 1e-15)), at(&SAMPLE, front * (1.0 + 1e-15)), 1e-12);
    assert_eq!(at(&SAMPLE, 1e4), 0.0);
}

#[test]
fn the_expectation_is_the_average_over_beams_in_all_directions() {
    let of = Blur2d { speed: 1.0, ..SAMPLE };
    let (onset, front) = fronts(&of);
    let beams = 500_000;
    for (t0, t1) in [(onset, front), (1.5, 2.5)] {
        let through_beam = |i| {
            beam_ray_2d_bins(&BeamRay2dBin {
                energy: of.energy,
                sigma_s: of.sigma_s,
                sigma_t: of.sigma_t,
                g: 0.0,
                speed: of.speed,
                radius: of.radius,
                beam_origin: [of.ray_offset, 0.0, of.source_z],
                beam_direction: fibonacci_direction(i, beams),
                beam_length: 1e3,
                ray_origin: [0.0; 3],
                ray_direction: [0.0, 0.0, 1.0],
                ray_length: 1e3,
                t0,
                t1,
            })
            .unwrap()
        };
        let average = (0..beams).map(through_beam).sum::<f64>() / f64::from(beams);
        close(average, in_bin(&of, t0, t1), 3e-4);
    }
}

#[test]
fn a_distant_source_close_to_the_ray_keeps_its_digits() {
    // q starts at (b² − R²) / 2z, which x − z no longer resolves at z = 1e9. Values of 40-digit
    // quadrature.
    let unit = Blur2d { energy: 1.0, sigma_s: 1.0, speed: 1.0, ..SAMPLE };
    for (source_z, radius, end, expected) in [
        (1e3, 0.5, 1001.0, 0.003_941_391_155_805_56),
        (1e9, 0.5, 1e9 + 1.0, 0.003_945_409_249_534_386),
        (1e3, 0.999, 1001.0, 0.005_768_925_147_230_157),
        (-1e3, 0.999, 1001.0, 1.163_355_728_496_988_4e-9),
    ] {
        let of = Blur2d { sigma_t: 1.0 / f64::abs(source_z), source_z, radius, ..unit };
        close(in_bin(&of, 0.0, end), expected, 1e-9);
    }
}

#[test]
fn a_disc_that_reaches_the_source_is_outside_the_domain() {
    for radius in [1.0, 2.0, 0.0, f64::NAN] {
        assert!(expected_blur_2d(&Blur2d { radius, ..SAMPLE }).is_err());
        assert!(expected_blur_2d_bins(&bin(&Blur2d { radius, ..SAMPLE }, 0.0, 1.0)).is_err());
    }
}

prop_compose! {
    fn anywhere()(
        sigma_t in 0.0..5.0_f64,
        ray_offset in 0.05..3.0_f64,
        source_z in -5.0..5.0_f64,
        fraction in 1e-4..0.999_f64,
        time in 0.1..20.0_f64,
    ) -> Blur2d {
        Blur2d { sigma_t, ray_offset, source_z, radius: fraction * ray_offset, time, ..SAMPLE }
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
        let absorbing = Blur2d { sigma_t: of.sigma_t + sigma_a, ..of };
        let factor = (-sigma_a * of.speed * of.time).exp();
        close(at(&absorbing, of.time), factor * at(&of, of.time), 1e-12);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform8(-320.0..308.0_f64),
        ahead in any::<bool>(),
    ) {
        let [energy, sigma_t, speed, ray_offset, z, radius, time, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let source_z = if ahead { z } else { -z };
        let of = Blur2d { energy, sigma_t, speed, ray_offset, source_z, radius, time, ..SAMPLE };
        for result in [expected_blur_2d(&of), expected_blur_2d_bins(&bin(&of, time, time + width))] {
            prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
        }
    }
}
