use super::*;
use crate::error::{decades, is_sound};
use crate::numerics::quadrature::adaptive;
use proptest::prelude::*;

const BOX: BoxPulseBin =
    BoxPulseBin { energy: 3.0, sigma_t: 0.4, speed: 0.5, r: 2.0, box_width: 0.5, t0: 4.1, t1: 4.3 };
const GAUSS: GaussPulseBin = GaussPulseBin {
    energy: 3.0,
    sigma_t: 0.4,
    speed: 0.5,
    r: 2.0,
    rms_width: 0.5,
    t0: 4.1,
    t1: 4.3,
};

fn whole() -> f64 {
    ballistic_point_fluence(&BallisticPoint { energy: 3.0, sigma_t: 0.4, r: 2.0 }).unwrap()
}

fn in_box(t0: f64, t1: f64) -> f64 {
    ballistic_box_pulse(&BoxPulseBin { t0, t1, ..BOX }).unwrap() / whole()
}

fn in_gauss(t0: f64, t1: f64) -> f64 {
    ballistic_gauss_pulse(&GaussPulseBin { t0, t1, ..GAUSS }).unwrap() / whole()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

#[test]
fn a_box_is_its_overlap_with_the_bin() {
    close(in_box(0.0, 9.0), 1.0, 1e-15);
    close(in_box(4.25, 9.0), 0.5, 1e-15);
    close(in_box(3.0, 4.125), 0.25, 1e-15);
    close(in_box(4.1, 4.1 + 1e-9), ((4.1 + 1e-9) - 4.1) / 0.5, 1e-15);
    assert_eq!(in_box(0.0, 4.0), 0.0);
    assert_eq!(in_box(4.5, 9.0), 0.0);
    assert_eq!(in_box(4.2, 4.2), 0.0);
}

#[test]
fn a_gauss_pulse_is_symmetric_and_complete() {
    close(in_gauss(-50.0, 50.0), 1.0, 1e-15);
    close(in_gauss(4.0, 50.0), 0.5, 1e-15);
    for (t0, t1) in [(0.25, 0.5), (1.5, 1.5 + 1e-7), (3.0, 9.0), (12.0, 12.5), (-0.25, 0.5)] {
        close(in_gauss(4.0 + t0, 4.0 + t1), in_gauss(4.0 - t1, 4.0 - t0), 1e-14);
    }
}

#[test]
fn bins_anywhere_meet_the_integral_of_the_density() {
    for (from, width) in [(-0.3_f64, 1e-9_f64), (0.0, 0.4), (3.0, 0.1), (8.0, 0.06), (8.0, 30.0)] {
        let (t0, t1) = (4.0 + from, 4.0 + from + width);
        let density = |t: f64| (-0.5 * ((t - 4.0) / 0.5_f64).powi(2)).exp();
        let breaks = [t0, (t0 + 0.5).min(t1), (t0 + 3.0).min(t1), t1];
        let integral = adaptive(density, &breaks, 1e-14).unwrap().value;
        close(in_gauss(t0, t1), integral / (0.5 * (2.0 * PI).sqrt()), 1e-12);
    }
}

#[test]
fn far_tails_have_their_digits() {
    // erfc(20)/2 within 37.7 … standard deviations, from the continued fraction.
    close(0.5 * erfc(20.0), 0.5 * 5.395_865_611_607_9e-176, 1e-12);
    close(normal_share(20.0, 1e3, 980.0).unwrap(), 0.5 * erfc(20.0), 1e-15);
    assert_eq!(normal_share(40.0, 41.0, 1.0).unwrap(), 0.0);
    assert_eq!(normal_share(f64::INFINITY, f64::INFINITY, f64::INFINITY).unwrap(), 0.0);
}

#[test]
fn pulses_of_no_width_are_outside_the_domain() {
    for width in [0.0, -1.0, f64::NAN] {
        assert!(ballistic_box_pulse(&BoxPulseBin { box_width: width, ..BOX }).is_err());
        assert!(ballistic_gauss_pulse(&GaussPulseBin { rms_width: width, ..GAUSS }).is_err());
    }
    assert!(ballistic_gauss_pulse(&GaussPulseBin { r: 0.0, ..GAUSS }).is_err());
}

proptest! {
    #[test]
    fn bins_add_up(from in -6.0..6.0_f64, width in 1e-6..9.0_f64, split in 0.0..1.0_f64) {
        let (t0, t1, t2) = (4.0 + from, 4.0 + from + split * width, 4.0 + from + width);
        close(in_gauss(t0, t1) + in_gauss(t1, t2), in_gauss(t0, t2), 1e-12);
        let sum = in_box(t0, t1) + in_box(t1, t2);
        prop_assert!((sum - in_box(t0, t2)).abs() < 1e-14);
    }

    #[test]
    fn narrow_and_wide_forms_join(a in -26.0..26.0_f64, share in 0.99..0.999_999_f64) {
        let width = share / f64::max(1.0, a.abs());
        let b = a + width;
        let exact_width = b - a;
        let narrow = normal_share(a, b, exact_width).unwrap();
        let wide = if a > 0.0 {
            0.5 * (erfc(a) - erfc(b))
        } else if b < 0.0 {
            0.5 * (erfc(-b) - erfc(-a))
        } else {
            0.5 * (erf(b) - erf(a))
        };
        close(narrow, wide, 1e-12);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<7>(), before in prop::bool::ANY,
    ) {
        let [energy, sigma_t, speed, r, scale, t0, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let t0 = if before { -t0 } else { t0 };
        let t1 = t0 + width;
        for result in [
            ballistic_box_pulse(&BoxPulseBin {
                energy, sigma_t, speed, r, box_width: scale, t0, t1,
            }),
            ballistic_gauss_pulse(&GaussPulseBin {
                energy, sigma_t, speed, r, rms_width: scale, t0, t1,
            }),
        ] {
            prop_assert!(is_sound(&result, &exponents), "{result:?}");
        }
    }
}
