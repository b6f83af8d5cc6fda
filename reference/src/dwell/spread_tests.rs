use super::*;
use crate::error::{decades, is_sound};
use proptest::prelude::*;

const SAMPLE: DwellSpread =
    DwellSpread { sigma_s: 1.3, g: 0.4, speed: 0.75, mean_dwell: 0.6, time: 2.0 };

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn value(of: &DwellSpread) -> f64 {
    dwell_mean_square_distance(of).unwrap()
}

/// The differential equation in flight and dwell, by the method of Runge and Kutta.
fn by_integration(of: &DwellSpread, steps: u32) -> f64 {
    let (v, lambda, mu) = (of.speed, of.sigma_s * of.speed, 1.0 / of.mean_dwell);
    // Share in flight; ⟨x·ω⟩ in flight and dwell; ⟨x²⟩ of all.
    let derivative = |[flight, along, held, _]: [f64; 4]| {
        [
            mu * (1.0 - flight) - lambda * flight,
            v * flight - lambda * along + mu * of.g * held,
            lambda * along - mu * held,
            2.0 * v * along,
        ]
    };
    let step = of.time / f64::from(steps);
    let moved = |y: [f64; 4], d: [f64; 4], by: f64| std::array::from_fn(|i| y[i] + by * d[i]);
    let mut y = [1.0, 0.0, 0.0, 0.0];
    for _ in 0..steps {
        let a = derivative(y);
        let b = derivative(moved(y, a, 0.5 * step));
        let c = derivative(moved(y, b, 0.5 * step));
        let d = derivative(moved(y, c, step));
        y = std::array::from_fn(|i| y[i] + step / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
    }
    y[3]
}

#[test]
fn it_solves_the_differential_equation() {
    for g in [-0.99, -0.5, -0.1, 0.0, 0.5, 0.99] {
        // Equal rates, and each of them the faster one.
        for mean_dwell in [1.0 / (1.3 * 0.75), 0.2, 4.0] {
            for time in [0.01, 2.0, 30.0] {
                let of = DwellSpread { g, mean_dwell, time, ..SAMPLE };
                close(value(&of), by_integration(&of, 20_000), 1e-10);
            }
        }
    }
}

#[test]
fn the_two_ways_agree() {
    for g in [-0.9, -0.4, 0.0, 1e-9, 0.3, 0.9] {
        for release in [0.1, 0.9, 1.0, 1.1, 8.0] {
            let rates = Rates::new(1.0, release, g);
            // The quadrature is for rates of about the same size.
            if rates.splitting > 0.7 * rates.sum() {
                continue;
            }
            for time in [1e-6, 1.0, 12.0, 700.0] {
                close(rates.mean(time).unwrap(), rates.mean_by_quadrature(time).unwrap(), 1e-10);
            }
        }
    }
}

#[test]
fn light_starts_straight_and_ends_in_diffusion() {
    close(value(&DwellSpread { time: 1e-9, ..SAMPLE }), (0.75_f64 * 1e-9).powi(2), 1e-8);
    close(value(&DwellSpread { time: 1e-150, ..SAMPLE }), (0.75e-150_f64).powi(2), 1e-12);
    for g in [-0.9, 0.0, 0.9] {
        let of = DwellSpread { g, time: 1e12, ..SAMPLE };
        let (lambda, mu) = (1.3 * 0.75, 1.0 / 0.6);
        let slope = 2.0 * 0.75 * 0.75 * mu / ((lambda + mu) * lambda * (1.0 - g));
        close(value(&of), slope * 1e12, 1e-9);
    }
}

#[test]
fn without_dwell_it_is_the_telegraph_process() {
    for g in [-0.9, 0.0, 0.9] {
        for mean_dwell in [0.0, 1e-320, 1e-30, 1e-14] {
            let rate = 1.3 * 0.75 * (1.0 - g);
            let of = DwellSpread { g, mean_dwell, ..SAMPLE };
            let expected = 2.0 * 0.5625 * (2.0 / rate + (-rate * 2.0_f64).exp_m1() / rate / rate);
            close(value(&of), expected, 1e-12);
        }
    }
}

#[test]
fn without_scattering_it_is_the_square_of_the_path() {
    assert_eq!(value(&DwellSpread { sigma_s: 0.0, ..SAMPLE }), 2.25);
    close(value(&DwellSpread { g: 1.0 - 1e-16, mean_dwell: 0.0, ..SAMPLE }), 2.25, 1e-15);
}

#[test]
fn divided_differences_meet_their_closed_form_and_their_limits() {
    close(divided_difference(0.0, 0.0).unwrap(), 0.5, 1e-15);
    close(divided_difference(2.0, 2.0).unwrap(), (1.0 - 3.0 * (-2.0_f64).exp()) / 4.0, 1e-15);
    close(divided_difference(1e200, 1e200).unwrap(), 1e-200 * 1e-200, 1e-15);
    for (a, b) in [(0.1, 0.7), (0.0, 0.4), (3.0, 4.4), (50.0, 60.0), (1.0, 1e9)] {
        let expected = ((-f64::exp_m1(-a) / f64::max(a, 1e-300)) + f64::exp_m1(-b) / b) / (b - a);
        let expected = if a == 0.0 { (1.0 + f64::exp_m1(-b) / b) / b } else { expected };
        close(divided_difference(a, b).unwrap(), expected, 1e-14);
    }
    close(slope(1.0), slope(1.0_f64.next_up()), 1e-15);
}

proptest! {
    #[test]
    fn lengths_and_times_scale(
        g in -0.999..0.999_f64, mean_dwell in 1e-3..1e3_f64, time in 1e-3..1e3_f64,
        length in 1e-9..1e9_f64, duration in 1e-9..1e9_f64,
    ) {
        let of = DwellSpread { g, mean_dwell, time, ..SAMPLE };
        let scaled = DwellSpread {
            sigma_s: of.sigma_s / length,
            speed: of.speed * length / duration,
            mean_dwell: mean_dwell * duration,
            time: time * duration,
            g,
        };
        close(value(&scaled) / length / length, value(&of), 1e-10);
    }

    #[test]
    fn dwelling_and_scattering_back_only_slow_down(
        g in -0.99..0.98_f64, log_dwell in -9.0..9.0_f64, log_time in -9.0..9.0_f64,
    ) {
        let (mean_dwell, time) = (10.0_f64.powf(log_dwell), 10.0_f64.powf(log_time));
        let of = DwellSpread { g, mean_dwell, time, ..SAMPLE };
        let swift = value(&DwellSpread { mean_dwell: 0.5 * mean_dwell, ..of });
        let forward = value(&DwellSpread { g: g + 0.01, ..of });
        let allowed = 1.0 + 1e-11;
        prop_assert!(value(&of) <= swift * allowed && value(&of) <= forward * allowed);
        prop_assert!(value(&of) <= (0.75 * time).powi(2) * allowed);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<4>(), g in -1.1..1.1_f64,
    ) {
        let [sigma_s, speed, mean_dwell, time] = exponents.map(|e| 10.0_f64.powf(e));
        let result = dwell_mean_square_distance(
            &DwellSpread { sigma_s, g, speed, mean_dwell, time }
        );
        prop_assert!(is_sound(&result, &exponents), "{result:?}");
    }
}
