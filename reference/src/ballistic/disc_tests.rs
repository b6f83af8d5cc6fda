use super::*;
use crate::error::{decades, is_sound};
use proptest::prelude::*;
use statrs::function::exponential::integral as exponential_integral;

const SAMPLE: BallisticDiscBin = BallisticDiscBin {
    energy: 2.0,
    sigma_t: 0.7,
    speed: 0.75,
    disc_distance: 1.5,
    disc_radius: 2.0,
    t0: 2.1,
    t1: 2.9,
};

fn value(input: &BallisticDiscBin) -> f64 {
    ballistic_disc_bins(input).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// The closed form with E₂, which cancels for thin bins.
fn with_exponential_integrals(input: &BallisticDiscBin) -> f64 {
    let &BallisticDiscBin { energy, sigma_t, speed, disc_distance, disc_radius, t0, t1 } = input;
    let rim = disc_distance.hypot(disc_radius);
    let at = |t: f64| {
        let s = (speed * t).clamp(disc_distance, rim);
        exponential_integral(sigma_t * s, 2).unwrap() / s
    };
    0.5 * energy * disc_distance * (at(t0) - at(t1))
}

#[test]
fn wide_bins_meet_the_closed_form() {
    for sigma_t in [1e-3, 0.4, 1.0, 30.0] {
        let input = BallisticDiscBin { sigma_t, t0: 0.0, t1: 1e3, ..SAMPLE };
        close(value(&input), with_exponential_integrals(&input), 1e-10);
    }
}

#[test]
fn a_clear_medium_gives_the_solid_angle() {
    for disc_radius in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
        let input = BallisticDiscBin { sigma_t: 0.0, disc_radius, t0: 0.0, t1: 1e30, ..SAMPLE };
        // 1 − cos of the half angle, as 2 sin².
        let half = 0.5 * (disc_radius / input.disc_distance).atan();
        close(value(&input), 2.0 * half.sin().powi(2), 1e-12);
    }
}

#[test]
fn thin_discs_are_as_good_as_wide_ones() {
    // All light arrives with the transmittance of the distance: Q (a/2d)² e^(−σt d).
    for disc_radius in [1e-9, 1e-30, 1e-100] {
        let input = BallisticDiscBin { disc_radius, t0: 0.0, t1: 10.0, ..SAMPLE };
        let expected = 2.0 * (disc_radius / 3.0).powi(2) * (-0.7 * 1.5_f64).exp();
        close(value(&input), expected, 1e-12);
    }
}

#[test]
fn bins_before_the_centre_and_after_the_rim_are_dark() {
    assert_eq!(value(&BallisticDiscBin { t0: 0.0, t1: 2.0, ..SAMPLE }), 0.0);
    assert!(value(&BallisticDiscBin { t0: 0.0, t1: 2.0_f64.next_up(), ..SAMPLE }) > 0.0);
    // The rim is reached at 2.5 / 0.75.
    assert_eq!(value(&BallisticDiscBin { t0: 10.0 / 3.0 + 1e-15, t1: 9.0, ..SAMPLE }), 0.0);
    assert_eq!(value(&BallisticDiscBin { sigma_t: 1e6, ..SAMPLE }), 0.0);
    assert_eq!(value(&BallisticDiscBin { disc_radius: 0.0, ..SAMPLE }), 0.0);
}

proptest! {
    #[test]
    fn bins_add_up(
        sigma_t in 0.0..60.0_f64, split in 0.0..1.0_f64, disc_radius in 1e-6..50.0_f64,
    ) {
        let input = BallisticDiscBin { sigma_t, disc_radius, t0: 1.5, t1: 200.0, ..SAMPLE };
        let last = 1.5_f64.hypot(disc_radius) / 0.75;
        let middle = 2.0 + split * (last - 2.0);
        let parts = value(&BallisticDiscBin { t1: middle, ..input })
            + value(&BallisticDiscBin { t0: middle, ..input });
        close(parts, value(&input), 1e-12);
    }

    #[test]
    fn lengths_scale_and_only_the_path_length_enters(
        scale in 1e-9..1e9_f64, eta in 1.0..3.0_f64, sigma_t in 0.0..9.0_f64,
    ) {
        let of = BallisticDiscBin { sigma_t, ..SAMPLE };
        let scaled = BallisticDiscBin {
            sigma_t: of.sigma_t / scale,
            speed: of.speed / eta,
            disc_distance: of.disc_distance * scale,
            disc_radius: of.disc_radius * scale,
            t0: of.t0 * scale * eta,
            t1: of.t1 * scale * eta,
            ..of
        };
        close(value(&scaled), value(&of), 1e-12);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<7>(),
    ) {
        let [energy, sigma_t, speed, disc_distance, disc_radius, t0, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let result = ballistic_disc_bins(&BallisticDiscBin {
            energy, sigma_t, speed, disc_distance, disc_radius, t0, t1: t0 + width,
        });
        prop_assert!(is_sound(&result, &exponents), "{result:?}");
    }
}
