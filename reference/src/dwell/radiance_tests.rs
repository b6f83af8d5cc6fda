use super::*;
use crate::error::{decades, is_sound};
use crate::numerics::quadrature::tanh_sinh;
use crate::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};
use proptest::prelude::*;

const SAMPLE: DwellSingleScatter = DwellSingleScatter {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    g: 0.6,
    speed: 0.75,
    source_distance: 1.5,
    alpha: 0.7,
    mean_dwell: 0.4,
    time: 2.6,
};

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn value(of: &DwellSingleScatter) -> f64 {
    dwell_single_scatter_radiance(of).unwrap()
}

fn without_dwell(of: &DwellSingleScatter, time: f64) -> f64 {
    let &DwellSingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, .. } = of;
    let input = SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time };
    single_scatter_radiance(&input).unwrap()
}

#[test]
fn it_is_the_convolution_with_the_law_of_the_dwell() {
    for g in [-0.9, 0.0, 0.9] {
        for mean_dwell in [0.05, 0.4, 1.0 / (1.1 * 0.75), 9.0] {
            for time in [2.1, 2.6, 5.0] {
                let of = DwellSingleScatter { g, mean_dwell, time, ..SAMPLE };
                let integrand =
                    |t: f64| without_dwell(&of, t) * (-(time - t) / mean_dwell).exp() / mean_dwell;
                let expected = tanh_sinh(|node| integrand(2.0 + node.from_start), 2.0, time, 1e-11);
                close(value(&of), expected.unwrap().value, 1e-9);
            }
        }
    }
}

#[test]
fn the_dwell_conserves_the_energy() {
    let of = DwellSingleScatter { mean_dwell: 0.3, ..SAMPLE };
    let at = |time: f64| value(&DwellSingleScatter { time, ..of });
    let breaks = [2.0, 2.1, 2.5, 4.0, 9.0, 60.0];
    let all = adaptive(at, &breaks, 1e-11).unwrap().value;
    let &DwellSingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, .. } =
        &of;
    let bin = SingleScatterBin {
        energy,
        sigma_s,
        sigma_t,
        g,
        speed,
        source_distance,
        alpha,
        t0: 0.0,
        t1: 60.0,
    };
    close(all, single_scatter_radiance_bins(&bin).unwrap(), 1e-9);
}

#[test]
fn short_dwells_tend_to_none() {
    let plain = without_dwell(&SAMPLE, 2.6);
    for mean_dwell in [0.0, 1e-320, 1e-300, 1e-20, 1e-13] {
        close(value(&DwellSingleScatter { mean_dwell, ..SAMPLE }), plain, 1e-11);
    }
    // To first order, light is late by the mean dwell.
    let late = without_dwell(&SAMPLE, 2.6 - 1e-5);
    close(value(&DwellSingleScatter { mean_dwell: 1e-5, ..SAMPLE }), late, 1e-8);
}

#[test]
fn long_dwells_release_all_light_evenly() {
    // (1/τ) times what has arrived without dwell.
    let &DwellSingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, .. } =
        &SAMPLE;
    let bin = SingleScatterBin {
        energy,
        sigma_s,
        sigma_t,
        g,
        speed,
        source_distance,
        alpha,
        t0: 0.0,
        t1: 2.6,
    };
    let arrived = single_scatter_radiance_bins(&bin).unwrap();
    let of = DwellSingleScatter { mean_dwell: 1e12, ..SAMPLE };
    close(value(&of), arrived / 1e12, 1e-9);
}

#[test]
fn it_starts_at_zero_on_the_front() {
    assert_eq!(value(&DwellSingleScatter { time: 2.0, ..SAMPLE }), 0.0);
    assert_eq!(value(&DwellSingleScatter { time: 0.0, ..SAMPLE }), 0.0);
    let after = 2.0 + 1e-9;
    let step = without_dwell(&SAMPLE, 2.0) * (after - 2.0) / 0.4;
    close(value(&DwellSingleScatter { time: after, ..SAMPLE }), step, 1e-7);
}

#[test]
fn sharp_peaks_and_rays_past_the_source_keep_their_digits() {
    for g in [-0.99, 0.99] {
        for alpha in [1e-9, 1e-4, 3.1, std::f64::consts::PI] {
            for mean_dwell in [1e-6, 0.01, 100.0] {
                let of = DwellSingleScatter { g, alpha, mean_dwell, ..SAMPLE };
                let later = DwellSingleScatter { mean_dwell: mean_dwell * (1.0 + 1e-9), ..of };
                close(value(&of), value(&later), 1e-7);
            }
        }
    }
    assert!(dwell_single_scatter_radiance(&DwellSingleScatter { alpha: 0.0, ..SAMPLE }).is_err());
}

proptest! {
    #[test]
    fn lengths_and_times_scale(
        g in -0.99..0.99_f64, alpha in 1e-3..3.1_f64, mean_dwell in 1e-4..1e3_f64,
        delay in 1.001..9.0_f64, length in 1e-9..1e9_f64,
    ) {
        let of = DwellSingleScatter { g, alpha, mean_dwell, time: 2.0 * delay, ..SAMPLE };
        let scaled = DwellSingleScatter {
            sigma_s: of.sigma_s / length,
            sigma_t: of.sigma_t / length,
            source_distance: of.source_distance * length,
            mean_dwell: of.mean_dwell * length,
            time: of.time * length,
            ..of
        };
        close(value(&scaled) * length.powi(3), value(&of), 1e-9);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<7>(),
        g in -1.1..1.1_f64,
        alpha in -0.1..3.3_f64,
    ) {
        let [energy, sigma_s, sigma_t, speed, source_distance, mean_dwell, time] =
            exponents.map(|e| 10.0_f64.powf(e));
        let result = dwell_single_scatter_radiance(&DwellSingleScatter {
            energy, sigma_s, sigma_t, g, speed, source_distance, alpha, mean_dwell, time,
        });
        prop_assert!(is_sound(&result, &exponents), "{result:?}");
    }
}
