use super::*;
use crate::error::{decades, is_sound};
use crate::numerics::quadrature::adaptive;
use crate::single_scattering::{OnceScattered, once_scattered_fluence};
use proptest::prelude::*;
use std::f64::consts::PI;

const SAMPLE: OnceScatteredShell =
    OnceScatteredShell { sigma_s: 0.8, sigma_t: 1.1, speed: 0.75, r0: 0.5, r1: 1.2, time: 2.0 };

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn energy(of: &OnceScatteredShell) -> f64 {
    once_scattered_shell_energy(of).unwrap()
}

fn in_bin(of: &OnceScatteredShell, t0: f64, t1: f64) -> f64 {
    let &OnceScatteredShell { sigma_s, sigma_t, speed, r0, r1, .. } = of;
    let input = OnceScatteredShellBin { sigma_s, sigma_t, speed, r0, r1, t0, t1 };
    once_scattered_shell_energy_bins(&input).unwrap()
}

/// ∫ 4π r² φ/v dr.
fn integrated_fluence(of: &OnceScatteredShell) -> f64 {
    let &OnceScatteredShell { sigma_s, sigma_t, speed, r0, r1, time } = of;
    let integrand = |r: f64| {
        let input = OnceScattered { energy: 1.0, sigma_s, sigma_t, speed, r, time };
        4.0 * PI * r * r * once_scattered_fluence(&input).unwrap() / speed
    };
    adaptive(integrand, &[r0, r1], 1e-13).unwrap().value
}

#[test]
fn a_shell_is_the_integral_of_the_fluence() {
    for (r0, r1) in [(0.0, 0.3), (0.5, 1.2), (0.5, 0.5 + 1e-6), (1.49, 1.499), (0.0, 1.49)] {
        let of = OnceScatteredShell { r0, r1, ..SAMPLE };
        close(energy(&of), integrated_fluence(&of), 1e-11);
    }
}

#[test]
fn all_shells_together_hold_what_was_scattered_once() {
    // σs x e^(−σt x), whatever the outer radius beyond the front.
    let x = 1.5_f64;
    for r1 in [1.5, 2.0, 1e300] {
        let of = OnceScatteredShell { r0: 0.0, r1, ..SAMPLE };
        close(energy(&of), 0.8 * x * (-1.1 * x).exp(), 1e-15);
    }
}

#[test]
fn small_and_thin_shells_keep_their_digits() {
    let weight = 0.8 * 1.5 * (-1.1 * 1.5_f64).exp();
    for r1 in [1e-3, 1e-9, 1e-90] {
        // G = 2ρ³/3 + 2ρ⁵/15 + …
        let rho = r1 / 1.5;
        let of = OnceScatteredShell { r0: 0.0, r1, ..SAMPLE };
        close(energy(&of), weight * (2.0 / 3.0 * rho.powi(3) + 2.0 / 15.0 * rho.powi(5)), 1e-13);
    }
    for width in [1e-3, 1e-9, 1e-15] {
        // The outermost shell: H(δ).
        let (r0, delta) = (1.5 - width, (1.5 - (1.5 - width)) / 1.5);
        let of = OnceScatteredShell { r0, r1: 1.5, ..SAMPLE };
        close(
            energy(&of),
            weight * delta * (1.0 + (2.0 - delta) / 2.0 * (2.0 / delta - 1.0).ln()),
            1e-13,
        );
    }
}

#[test]
fn nothing_is_beyond_the_front_or_before_the_pulse() {
    assert_eq!(energy(&OnceScatteredShell { r0: 1.5, r1: 2.0, ..SAMPLE }), 0.0);
    assert_eq!(energy(&OnceScatteredShell { time: 0.0, r0: 0.0, ..SAMPLE }), 0.0);
    assert_eq!(energy(&OnceScatteredShell { r1: 0.5, ..SAMPLE }), 0.0);
    assert_eq!(in_bin(&SAMPLE, -1.0, 0.5 / 0.75 - 1e-15), 0.0);
    assert!(once_scattered_shell_energy(&OnceScatteredShell { r1: 0.4, ..SAMPLE }).is_err());
    assert!(once_scattered_shell_energy(&OnceScatteredShell { time: -1.0, ..SAMPLE }).is_err());
}

#[test]
fn bins_are_the_integral_of_the_energy() {
    let at = |time: f64| energy(&OnceScatteredShell { time, ..SAMPLE });
    for (t0, t1) in
        [(0.1, 0.9), (0.8, 1.5), (0.8, 5.0), (1.7, 1.7 + 1e-6), (2.0, 30.0), (0.0, 30.0)]
    {
        let mut breaks = vec![t0, 0.5 / 0.75, 1.2 / 0.75, t1];
        breaks.retain(|t| (t0..=t1).contains(t));
        close(in_bin(&SAMPLE, t0, t1), adaptive(at, &breaks, 1e-12).unwrap().value, 1e-9);
    }
}

#[test]
fn all_of_space_and_time_is_the_mean_number_of_singly_scattering_flights() {
    // ∫ σs x e^(−σt x) dx/v = σs/(σt² v).
    let of = OnceScatteredShell { r0: 0.0, r1: 1e3, ..SAMPLE };
    close(in_bin(&of, 0.0, 1e3), 0.8 / (1.21 * 0.75), 1e-10);
}

proptest! {
    #[test]
    fn shells_add_up(inner in 0.0..1.5_f64, split in 0.0..1.0_f64, outer in 0.0..1.0_f64) {
        let r2 = inner + outer * (1.6 - inner);
        let r1 = inner + split * (r2 - inner);
        let between = |r0, r1| energy(&OnceScatteredShell { r0, r1, ..SAMPLE });
        let sum = between(inner, r1) + between(r1, r2);
        // The thickness of a thin shell is a difference of the inputs.
        let rounding = 4e-16 * (1.0 + energy(&OnceScatteredShell { r0: 0.0, r1: 9.0, ..SAMPLE }));
        prop_assert!((sum - between(inner, r2)).abs() <= 1e-13 * sum + rounding);
    }

    #[test]
    fn bins_add_up(t0 in 0.0..3.0_f64, width in 0.01..20.0_f64, split in 0.01..0.99_f64) {
        let (t1, t2) = (t0 + split * width, t0 + width);
        close(in_bin(&SAMPLE, t0, t1) + in_bin(&SAMPLE, t1, t2), in_bin(&SAMPLE, t0, t2), 1e-10);
    }

    #[test]
    fn lengths_scale(scale in 1e-9..1e9_f64, r0 in 0.0..1.0_f64) {
        let of = OnceScatteredShell { r0, ..SAMPLE };
        let scaled = OnceScatteredShell {
            sigma_s: of.sigma_s / scale,
            sigma_t: of.sigma_t / scale,
            r0: r0 * scale,
            r1: of.r1 * scale,
            time: of.time * scale,
            ..of
        };
        close(energy(&scaled), energy(&of), 1e-12);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<7>(),
    ) {
        let [sigma_s, sigma_t, speed, r0, thickness, t0, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let r1 = r0 + thickness;
        for result in [
            once_scattered_shell_energy(&OnceScatteredShell {
                sigma_s, sigma_t, speed, r0, r1, time: t0,
            }),
            once_scattered_shell_energy_bins(&OnceScatteredShellBin {
                sigma_s, sigma_t, speed, r0, r1, t0, t1: t0 + width,
            }),
        ] {
            prop_assert!(is_sound(&result, &exponents), "{result:?}");
        }
    }
}
