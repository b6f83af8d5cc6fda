use super::*;
use crate::infinite_medium::point_pulse;
use crate::infinite_medium::{Moment, mean_fourth_power_of_distance, mean_square_distance};
use crate::numerics::quadrature::adaptive;
use proptest::prelude::*;

fn at(g: f64, k: f64, time: f64, sigma_s: f64) -> f64 {
    infinite_medium_sinc_moment(&SincMoment { g, k, time, sigma_s, sigma_a: 0.0 }).unwrap()
}

#[test]
fn bessel_functions_meet_known_values() {
    // Abramowitz and Stegun, tables 9.1 and 9.2.
    let five = bessel_j(5.0);
    for (n, expected) in [(0, -0.177_596_771_314_338_3), (1, -0.327_579_137_591_465_2)] {
        assert!((five[n] - expected).abs() < 1e-15, "J_{n}(5) = {}", five[n]);
    }
    let hundred = bessel_j(100.0);
    assert!((hundred[0] - 0.019_985_850_304_223_12).abs() < 1e-15, "{}", hundred[0]);
    assert!(hundred.last().unwrap().abs() < 1e-20);
    assert!(bessel_j(5e3).iter().all(|value| value.is_finite()));
}

#[test]
fn without_scattering_only_the_front_is_left() {
    for phase in [0.0, 1e-6, 0.3, 3.9, 4.1, 50.0, 3000.0, 1e4] {
        let expected = if phase > 0.0 { f64::sin(phase) / phase } else { 1.0 };
        let found = at(0.5, phase, 1.0, 0.0);
        assert!((found - expected).abs() < 1e-13, "{found} for {expected} at {phase}");
    }
}

#[test]
fn the_energy_is_kept() {
    for depth in [0.1, 10.0, 1e3, 1e4] {
        let found = at(0.3, 0.0, 1.0, depth);
        assert!((found - 1.0).abs() < 1e-11, "{found} at {depth}");
    }
}

#[test]
fn small_wave_numbers_see_the_moments() {
    for (time, sigma_s, g) in [(1.0, 1.0, 0.0), (5.0, 2.0, 0.9), (0.3, 1.0, -0.7), (2.0, 3.0, 0.99)]
    {
        let k = 1e-2 / time;
        let input = Moment { time, sigma_s, g };
        let r2 = mean_square_distance(&input).unwrap();
        let r4 = mean_fourth_power_of_distance(&input).unwrap();
        let expected = 1.0 - k * k * r2 / 6.0 + k.powi(4) * r4 / 120.0;
        // The next term is (kr)⁶/5040.
        let found = at(g, k, time, sigma_s);
        assert!((found - expected).abs() < 1e-15 + 2e-16, "{found} for {expected}");
    }
}

#[test]
fn it_is_the_transform_of_the_point_pulse() {
    for (k, t) in [(0.5_f64, 1.0_f64), (3.0, 2.0), (1.0, 10.0), (20.0, 1.0)] {
        let integrand = |root: f64| {
            let gap = t * root.powi(4);
            let r = t - gap;
            let weight = 4.0 * std::f64::consts::PI * r * (k * r).sin() / k;
            weight * point_pulse::scattered(r, gap, 1.0) * 4.0 * t * root.powi(3)
        };
        let scattered = adaptive(integrand, &[1e-30, 0.5, 1.0 - 1e-12], 1e-11).unwrap().value;
        let expected = scattered + (-t).exp() * (k * t).sin() / (k * t);
        let found = at(0.0, k, t, 1.0);
        assert!(
            (found - expected).abs() < 1e-10 * expected.abs() + 1e-13,
            "{found} for {expected}"
        );
    }
}

#[test]
fn values_without_meaning_are_errors() {
    let input = SincMoment { g: 0.0, k: 1.0, time: 1.0, sigma_s: 1.0, sigma_a: 0.0 };
    assert!(infinite_medium_sinc_moment(&SincMoment { g: 1.0, ..input }).is_err());
    assert!(infinite_medium_sinc_moment(&SincMoment { k: -1.0, ..input }).is_err());
    assert!(infinite_medium_sinc_moment(&SincMoment { k: 2e4, ..input }).is_err());
    assert!(infinite_medium_sinc_moment(&SincMoment { time: f64::NAN, ..input }).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn lengths_scale(
        g in -0.99..0.99_f64, phase in 0.0..60.0_f64, depth in 0.0..20.0_f64, scale in 0.01..100.0_f64,
    ) {
        let (value, scaled) = (at(g, phase, 1.0, depth), at(g, phase / scale, scale, depth / scale));
        prop_assert!((value - scaled).abs() < 1e-13);
        prop_assert!(value.abs() <= 1.0 + 1e-13);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform4(-320.0..4.0_f64), g in -1.1..1.1_f64,
    ) {
        let [k, time, sigma_s, sigma_a] = exponents.map(|e| 10.0_f64.powf(e));
        let result = infinite_medium_sinc_moment(&SincMoment { g, k, time, sigma_s, sigma_a });
        prop_assert!(result.as_ref().map_or(true, |v| v.is_finite()), "{result:?}");
    }
}
