use super::*;
use crate::diffuse_sphere::{SphereChords, sphere_chords_cdf};
use proptest::prelude::*;

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn value(chords: u32, x: f64, mean_dwell: f64) -> f64 {
    dwell_sphere_cdf(&DwellSphere { chords, x, mean_dwell }).unwrap()
}

#[test]
fn one_chord_meets_the_closed_form() {
    // ∫ 2u (1 − e^(−(x − u)/τ)) du up to m = min(x, 1).
    for tau in [0.05, 0.5, 3.0] {
        for x in [0.3, 1.0, 2.5] {
            let m = f64::min(x, 1.0);
            let exponential =
                (-(x - m) / tau).exp() * tau * (m - tau) + tau * tau * (-x / tau).exp();
            close(value(1, x, tau), m * m - 2.0 * exponential, 1e-10);
        }
    }
}

#[test]
fn short_dwells_tend_to_the_chords_alone() {
    for chords in [1, 4, 30] {
        for share in [0.1, 0.6, 0.9] {
            let x = share * f64::from(chords);
            let plain = sphere_chords_cdf(&SphereChords { chords, x }).unwrap();
            for tau in [0.0, 1e-320, 1e-30, 1e-15] {
                close(value(chords, x, tau), plain, 1e-9);
            }
        }
    }
}

#[test]
fn short_delays_have_their_digits() {
    // f_1 ⊗ the density of the dwell ≈ ∫ 2u (x − u)/τ du = x³/(3τ).
    for x in [1e-3, 1e-9, 1e-60] {
        close(value(1, x, 2.0), x.powi(3) / 6.0, x.max(1e-13));
    }
    // f_n ≈ (2u)…: 2^n u^(2n−1)/(2n−1)!, P ≈ y^n/n!: 2^n x^(3n) / (τ^n (3n)!).
    close(value(3, 1e-6, 1.0), 8.0 * 1e-6_f64.powi(9) / 362_880.0, 1e-5);
}

#[test]
fn it_is_a_law() {
    for chords in [1, 2, 7, 40] {
        assert_eq!(value(chords, 0.0, 0.5), 0.0);
        assert_eq!(value(chords, -3.0, 0.5), 0.0);
        close(value(chords, 1e6, 0.5), 1.0, 1e-11);
        let mut last = 0.0;
        for step in 1..40 {
            let next = value(chords, 0.1 * f64::from(step) * f64::from(chords), 0.5);
            assert!(next >= last * (1.0 - 1e-11), "{next} after {last}");
            last = next;
        }
    }
}

#[test]
fn its_mean_is_that_of_the_chords_and_the_dwells() {
    let complement = |x: f64| 1.0 - value(3, x, 0.7);
    let mean = adaptive(complement, &[0.0, 1.0, 2.0, 3.0, 8.0, 60.0], 1e-10).unwrap().value;
    close(mean, 3.0 * (2.0 / 3.0 + 0.7), 1e-8);
}

proptest! {
    #[test]
    fn wild_inputs_give_a_probability_or_an_error(
        chords in 0..30_u32,
        exponents in prop::array::uniform2(-320.0..308.0_f64),
        ordinary in prop::array::uniform2(-3.0..3.0_f64),
    ) {
        for [log_x, log_dwell] in [exponents, ordinary, [ordinary[0], exponents[1]]] {
            let (x, mean_dwell) = (10.0_f64.powf(log_x), 10.0_f64.powf(log_dwell));
            let result = dwell_sphere_cdf(&DwellSphere { chords, x, mean_dwell });
            prop_assert_eq!(result.is_ok(), chords > 0, "{:?}", result);
            prop_assert!(result.as_ref().map_or(true, |p| (0.0..=1.0).contains(p)), "{result:?}");
        }
    }
}
