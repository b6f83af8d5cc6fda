use super::*;
use proptest::prelude::*;

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn fraction(scattering_rate: f64, mean_dwell: f64, time: f64) -> f64 {
    dwell_flight_fraction(&DwellFlight { scattering_rate, mean_dwell, time }).unwrap()
}

fn order(scattering_rate: f64, mean_dwell: f64, scatterings: u32, time: f64) -> f64 {
    let input = DwellOrder { scattering_rate, mean_dwell, scatterings, time };
    dwell_order_in_flight(&input).unwrap()
}

/// The definition with ₁F₁ as its series, transformed to a positive argument (Kummer).
fn with_kummer_series(lambda: f64, tau: f64, n: u32, time: f64) -> f64 {
    let (events, dwells) = (lambda * time, time / tau);
    let (first, argument, factor) = if events >= dwells {
        (f64::from(n), events - dwells, (-events).exp())
    } else {
        (f64::from(n) + 1.0, dwells - events, (-dwells).exp())
    };
    let (mut term, mut sum) = (1.0, 0.0);
    for k in 0..400 {
        sum += term;
        let k = f64::from(k);
        term *= (first + k) / (f64::from(2 * n + 1) + k) * argument / (k + 1.0);
    }
    let factorial: f64 = (1..=2 * n).map(f64::from).product();
    (events * dwells).powi(n.cast_signed()) / factorial * factor * sum
}

#[test]
fn orders_meet_the_confluent_series() {
    for (lambda, tau) in [(1.0, 1.0), (3.0, 0.2), (0.5, 5.0), (8.0, 0.125), (1e-3, 40.0)] {
        for n in [1, 2, 3, 8, 20] {
            for time in [0.01, 1.0, 7.0] {
                let expected = with_kummer_series(lambda, tau, n, time);
                close(order(lambda, tau, n, time), expected, 1e-12);
            }
        }
    }
}

#[test]
fn the_orders_together_are_all_that_is_in_flight() {
    for (lambda, tau, time) in
        [(1.0, 1.0, 3.0), (5.0, 2.0, 9.0), (0.1, 30.0, 50.0), (2.0, 1e-4, 6.0), (40.0, 0.5, 4.0)]
    {
        let sum: f64 = (0..400).map(|n| order(lambda, tau, n, time)).sum();
        close(sum, fraction(lambda, tau, time), 1e-11);
    }
}

#[test]
fn without_dwell_all_is_in_flight_and_the_orders_are_poisson() {
    for tau in [0.0, 1e-320, 1e-30] {
        close(fraction(3.0, tau, 2.0), 1.0, 1e-15);
        close(order(3.0, tau, 4, 2.0), 6.0_f64.powi(4) * (-6.0_f64).exp() / 24.0, 1e-13);
    }
    // The first correction of the series is as it is where the two forms meet.
    close(order(3.0, 1e-13, 4, 2.0), order(3.0, 0.0, 4, 2.0), 1e-11);
}

#[test]
fn late_light_is_in_balance_and_early_light_in_flight() {
    close(fraction(2.0, 0.5, 1e300), 0.5, 1e-15);
    close(fraction(2.0, 1e200, 1e300), 5e-201, 1e-14);
    close(1.0 - fraction(2.0, 0.5, 1e-6), 2e-6, 1e-5);
    assert_eq!(fraction(2.0, 0.5, 0.0), 1.0);
    assert_eq!(fraction(0.0, 0.5, 9.0), 1.0);
    assert_eq!(order(0.0, 0.5, 0, 9.0), 1.0);
    assert_eq!(order(0.0, 0.5, 1, 9.0), 0.0);
    assert_eq!(order(2.0, 0.5, 1, 0.0), 0.0);
}

#[test]
fn long_dwells_let_few_scatterings_happen() {
    // One flight, one dwell, one flight: λt²/(2τ) for short times; first order in 1/τ else.
    close(order(1.0, 1e9, 1, 1e-5), 1e-5_f64.powi(2) / 2e9, 1e-4);
    let lambda_t = 3.0;
    // ∫ λℓ e^(−λℓ) dℓ/τ.
    let expected = 1e-9 * (1.0 - (1.0 + lambda_t) * f64::exp(-lambda_t));
    close(order(1.0, 1e9, 1, lambda_t), expected, 1e-8);
}

#[test]
fn many_scatterings_have_their_digits() {
    // Deep in the regime of both central limits: λ = 1/τ, n = 1e4 of t = 2e4.
    let sum: f64 = (9_500..10_500).map(|n| order(1.0, 1.0, n, 2e4)).sum();
    close(sum, 0.5, 1e-9);
}

proptest! {
    #[test]
    fn only_ratios_of_times_enter(
        lambda in 0.01..9.0_f64, tau in 0.01..9.0_f64, time in 0.01..30.0_f64, n in 0..9_u32,
        scale in 1e-9..1e9_f64,
    ) {
        let scaled = order(lambda / scale, tau * scale, n, time * scale);
        close(scaled, order(lambda, tau, n, time), 1e-11);
        let scaled = fraction(lambda / scale, tau * scale, time * scale);
        close(scaled, fraction(lambda, tau, time), 1e-13);
    }

    #[test]
    fn wild_inputs_give_a_share_or_a_domain_error(
        exponents in prop::array::uniform3(-320.0..308.0_f64),
        scatterings in prop_oneof![0..20_u32, 0..=u32::MAX],
    ) {
        let [scattering_rate, mean_dwell, time] = exponents.map(|e| 10.0_f64.powf(e));
        let fraction =
            dwell_flight_fraction(&DwellFlight { scattering_rate, mean_dwell, time }).unwrap();
        prop_assert!((0.0..=1.0).contains(&fraction), "{fraction}");
        let input = DwellOrder { scattering_rate, mean_dwell, scatterings, time };
        match dwell_order_in_flight(&input) {
            Ok(share) => prop_assert!((0.0..=1.0 + 1e-12).contains(&share), "{share} of {input:?}"),
            Err(error) => prop_assert!(
                matches!(error, crate::ReferenceError::Domain { .. }), "{error} of {input:?}"
            ),
        }
    }

    #[test]
    fn tame_ratios_of_any_size_have_a_share(
        log_scale in -200.0..200.0_f64, log_events in -9.0..9.0_f64, log_dwells in -9.0..9.0_f64,
        scatterings in 0..50_u32,
    ) {
        let time = 10.0_f64.powf(log_scale);
        let input = DwellOrder {
            scattering_rate: 10.0_f64.powf(log_events) / time,
            mean_dwell: time / 10.0_f64.powf(log_dwells),
            scatterings,
            time,
        };
        let share = dwell_order_in_flight(&input);
        prop_assert!(share.as_ref().is_ok_and(|p| (0.0..=1.0).contains(p)), "{share:?} {input:?}");
    }
}
