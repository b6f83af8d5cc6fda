use super::*;
use crate::beams::beam_ray::{BeamRay2dBin, beam_ray_2d_bins};
use crate::beams::expected_blur_disc::{
    Blur2d, Blur2dBin, expected_blur_2d, expected_blur_2d_bins,
};
use crate::numerics::quadrature::tanh_sinh;
use crate::numerics::vector::fibonacci_direction;
use crate::single_scattering::{SingleScatter, single_scatter_radiance};
use proptest::prelude::*;

const SAMPLE: Blur2dHg = Blur2dHg {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    g: 0.7,
    speed: 0.75,
    ray_offset: 1.0,
    source_z: 0.7,
    radius: 0.4,
    time: 2.0,
};

fn in_bin(of: &Blur2dHg, t0: f64, t1: f64) -> f64 {
    let &Blur2dHg { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, .. } = of;
    expected_blur_2d_hg_bins(&Blur2dHgBin {
        energy,
        sigma_s,
        sigma_t,
        g,
        speed,
        ray_offset,
        source_z,
        radius,
        t0,
        t1,
    })
    .unwrap()
}

fn at(of: &Blur2dHg, time: f64) -> f64 {
    expected_blur_2d_hg(&Blur2dHg { time, ..*of }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn fronts(of: &Blur2dHg) -> (f64, f64) {
    let disc = DiscBlur::new(of.ray_offset, of.source_z, of.radius).unwrap();
    (disc.onset() / of.speed, disc.front() / of.speed)
}

#[test]
fn isotropic_scattering_meets_the_closed_form() {
    for (radius, source_z) in [(0.01, 0.7), (0.4, -2.0), (0.9, 0.0), (0.999, 5.0)] {
        let of = Blur2dHg { g: 0.0, radius, source_z, ..SAMPLE };
        let &Blur2dHg { energy, sigma_s, sigma_t, speed, ray_offset, .. } = &of;
        let (onset, front) = fronts(&of);
        for time in [onset + 0.01 * (front - onset), 0.5 * (onset + front), front, front + 0.3, 9.0]
        {
            let closed =
                Blur2d { energy, sigma_s, sigma_t, speed, ray_offset, source_z, radius, time };
            close(at(&of, time), expected_blur_2d(&closed).unwrap(), 1e-10);
            let t0 = 0.0;
            let t1 = time;
            let closed =
                Blur2dBin { energy, sigma_s, sigma_t, speed, ray_offset, source_z, radius, t0, t1 };
            close(in_bin(&of, t0, t1), expected_blur_2d_bins(&closed).unwrap(), 1e-9);
        }
    }
}

#[test]
fn a_vanishing_disc_gives_the_true_radiance() {
    let &Blur2dHg { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, time, .. } = &SAMPLE;
    let (source_distance, alpha) = (source_z.hypot(ray_offset), ray_offset.atan2(source_z));
    let sharp = SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time };
    let sharp = single_scatter_radiance(&sharp).unwrap();
    let bias = |radius: f64| at(&Blur2dHg { radius, ..SAMPLE }, time) / sharp - 1.0;
    assert!(bias(1e-7).abs() < 1e-11);
    close(bias(0.02) / bias(0.01), 4.0, 1e-2);
}

#[test]
fn the_integral_of_the_density_is_the_bin() {
    for (g, source_z) in [(0.7, 0.7), (-0.5, -2.0), (0.95, 5.0)] {
        let of = Blur2dHg { g, source_z, ..SAMPLE };
        let (onset, front) = fronts(&of);
        let integral: f64 = [(onset, front), (front, front + 5.0)]
            .map(|(a, b)| tanh_sinh(|node| at(&of, node.x), a, b, 1e-10).unwrap().value)
            .iter()
            .sum();
        close(in_bin(&of, 0.0, front + 5.0), integral, 1e-9);
    }
}

/// What the beams of all directions bring to the camera ray.
#[test]
fn it_is_the_mean_over_all_beams() {
    let (onset, front) = fronts(&SAMPLE);
    for (g, t0, t1) in
        [(0.7, onset, front), (0.7, 1.8, 3.0), (-0.6, onset, front), (-0.6, 1.8, 3.0)]
    {
        let of = Blur2dHg { g, ..SAMPLE };
        let beams = 500_000;
        let through_beam = |i| {
            beam_ray_2d_bins(&BeamRay2dBin {
                energy: of.energy,
                sigma_s: of.sigma_s,
                sigma_t: of.sigma_t,
                g,
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
fn a_disc_that_reaches_the_source_is_outside_the_domain() {
    for radius in [1.0, 2.0, 0.0, f64::NAN] {
        assert!(expected_blur_2d_hg(&Blur2dHg { radius, ..SAMPLE }).is_err());
    }
    assert!(expected_blur_2d_hg(&Blur2dHg { g: 1.0, ..SAMPLE }).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn bins_add_up(
        sigma_t in 0.0..5.0_f64,
        g in -0.95..0.95_f64,
        source_z in -5.0..5.0_f64,
        radius in 1e-3..0.999_f64,
        time in 0.1..20.0_f64,
        splits in prop::array::uniform3(0.0..1.0_f64),
    ) {
        let of = Blur2dHg { sigma_t, g, source_z, radius, time, ..SAMPLE };
        let mut edges = [0.0, splits[0], splits[1], splits[2], 1.0].map(|x| x * of.time);
        edges.sort_by(f64::total_cmp);
        let sum: f64 = edges.windows(2).map(|bin| in_bin(&of, bin[0], bin[1])).sum();
        close(sum, in_bin(&of, 0.0, of.time), 1e-9);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform8(-320.0..308.0_f64),
        ahead in any::<bool>(),
    ) {
        let [energy, sigma_t, speed, ray_offset, z, radius, time, share] =
            exponents.map(|e| 10.0_f64.powf(e));
        let source_z = if ahead { z } else { -z };
        let g = share.min(0.9);
        let of = Blur2dHg { energy, sigma_t, g, speed, ray_offset, source_z, radius, time, ..SAMPLE };
        let result = expected_blur_2d_hg(&of);
        prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
    }
}
