use super::*;
use proptest::prelude::*;

fn at(x: f64, time: f64, albedo: f64) -> f64 {
    plane_pulse_fluence(&PlanePulse { x, time, albedo }).unwrap()
}

fn order(x: f64, time: f64, order: u32) -> f64 {
    plane_pulse_fluence_by_order(&PlanePulseOrder { x, time, order }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// AZURV1 as printed: over u from 0 to π, with z = tan(u/2), without a shift of the contour.
fn azurv1(x: f64, t: f64, c: f64) -> f64 {
    let eta = x / t;
    let q = ((1.0 + eta) / (1.0 - eta)).ln();
    let integrand = |u: f64| {
        let xi = Complex::new(q, u).over(Complex::new(eta, (0.5 * u).tan()));
        let value = xi * xi * (xi * (0.5 * c * t * (1.0 - eta * eta))).exp();
        value.re / (0.5 * u).cos().powi(2)
    };
    let integral = adaptive(integrand, &[0.0, 1.0, PI], 1e-13).unwrap().value;
    (-t).exp() / (2.0 * t) * c * t * (1.0 - eta * eta) / (4.0 * PI) * integral
}

#[test]
fn the_shifted_contour_meets_the_printed_formula() {
    for t in [1e-3, 0.3, 1.0, 4.0, 15.0] {
        for eta in [1e-3, 0.1, 0.3, 0.7, 0.95] {
            for c in [0.3, 1.0, 1.2] {
                close(at(eta * t, t, c), azurv1(eta * t, t, c), 1e-11);
            }
        }
    }
}

#[test]
fn the_first_order_meets_the_series_of_the_contour() {
    // The general formula, at an order where a closed form exists: the light of a thin medium.
    for (x, t) in [(0.0, 1.0), (0.4, 1.0), (0.9, 1.0), (4.999, 5.0)] {
        let thin = 1e-9;
        close(at(x, t, thin) / thin, order(x, t, 1), 1e-7);
        let rest = at(x, t, 1e-3) - 1e-3 * order(x, t, 1);
        close(rest / 1e-6, order(x, t, 2), 1e-2);
    }
}

#[test]
fn nothing_is_lost_between_the_fronts() {
    for t in [1e-6, 0.1, 1.0, 20.0, 1e3] {
        for albedo in [0.2, 1.0, 1.1] {
            let cell = PlanePulseCell { x0: -2.0 * t, x1: 3.0 * t, time: t, albedo };
            let total = 5.0 * t * plane_pulse_cells_with_ballistic(&cell).unwrap();
            close(total, ((albedo - 1.0) * t).exp(), 1e-10 + 1e-15 * t);
        }
    }
}

#[test]
fn cells_add_up_and_are_symmetric() {
    let cell = |x0: f64, x1: f64| {
        let cell = PlanePulseCell { x0, x1, time: 3.0, albedo: 0.9 };
        (x1 - x0) * plane_pulse_cells(&cell).unwrap()
    };
    close(cell(-1.0, 0.5) + cell(0.5, 2.9) + cell(2.9, 3.5), cell(-1.0, 7.0), 1e-11);
    close(cell(0.3, 2.0), cell(-2.0, -0.3), 1e-15);
    close(cell(1.0, 1.0 + 1e-6), 1e-6 * at(1.0, 3.0, 0.9), 1e-6);
    assert_eq!(cell(3.0, 9.0), 0.0);
    let lit = PlanePulseCell { x0: 2.0, x1: 4.0, time: 3.0, albedo: 0.0 };
    close(plane_pulse_cells_with_ballistic(&lit).unwrap(), (-3.0_f64).exp() / 12.0, 1e-15);
}

#[test]
fn scattered_light_vanishes_on_the_front() {
    for t in [1e-6, 1.0, 1e3] {
        assert_eq!(at(t, t, 1.0), 0.0);
        assert_eq!(at(-2.0 * t, t, 1.0), 0.0);
        assert_eq!((order(t, t, 1), order(t, t, 7)), (0.0, 0.0));
    }
    let near = at(1.0_f64.next_down(), 1.0, 1.0);
    assert!(0.0 < near && near < 1e-14, "{near}");
}

#[test]
fn late_light_diffuses() {
    // e^(−3x²/4t)/√(4πt/3) (1 + O(1/t)).
    for t in [1e4, 1e8, 1e12_f64] {
        for y in [0.0, 1.0, 2.0_f64] {
            let expected = (-0.75 * y * y).exp() / (4.0 * PI * t / 3.0).sqrt();
            close(at(y * t.sqrt(), t, 1.0), expected, 10.0 / t);
        }
    }
}

#[test]
fn values_without_meaning_are_errors() {
    let pulse = PlanePulse { x: 0.1, time: 1.0, albedo: 1.0 };
    assert!(plane_pulse_fluence(&PlanePulse { time: 0.0, ..pulse }).is_err());
    assert!(plane_pulse_fluence(&PlanePulse { albedo: -0.1, ..pulse }).is_err());
    assert!(plane_pulse_fluence(&PlanePulse { albedo: 3.0, time: 1e3, ..pulse }).is_err());
    assert!(
        plane_pulse_fluence_by_order(&PlanePulseOrder { x: 0.1, time: 1.0, order: 0 }).is_err()
    );
    let cell = PlanePulseCell { x0: 1.0, x1: 1.0, time: 1.0, albedo: 1.0 };
    assert!(plane_pulse_cells(&cell).is_err());
}

proptest! {
    #[test]
    fn the_orders_add_up(
        log_time in -6.0..2.0_f64, gap in -9.0..0.0_f64, albedo in 0.01..1.2_f64,
    ) {
        let t = 10.0_f64.powf(log_time);
        let x = t * (1.0 - 10.0_f64.powf(gap));
        let mut sum = 0.0;
        for n in 1..600 {
            let term = albedo.powi(n) * order(x, t, n as u32);
            sum += term;
            if f64::from(n) > 2.0 * t && term < 1e-17 * sum {
                break;
            }
        }
        close(at(x, t, albedo), sum, 1e-10);
    }

    #[test]
    fn absorption_is_a_factor(
        log_time in -6.0..2.5_f64, eta in 0.0..1.0_f64, albedo in 0.01..1.0_f64,
    ) {
        // A medium of albedo c and extinction 1 is one of albedo 1 and extinction c, and absorption.
        let t = 10.0_f64.powf(log_time);
        let lossless = albedo * at(eta * t * albedo, t * albedo, 1.0);
        close(at(eta * t, t, albedo), lossless * (-(1.0 - albedo) * t).exp(), 1e-11);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform4(-320.0..308.0_f64), n in any::<u32>(), near in 0.0..1.1_f64,
    ) {
        let [x, time, albedo, width] = exponents.map(|e| 10.0_f64.powf(e));
        for x in [x, near * time] {
            let cell = PlanePulseCell { x0: x, x1: x + width, time, albedo };
            for result in [
                plane_pulse_fluence(&PlanePulse { x, time, albedo }),
                plane_pulse_fluence_by_order(&PlanePulseOrder { x, time, order: n }),
                plane_pulse_fluence_by_order(&PlanePulseOrder { x, time, order: n % 50 }),
                plane_pulse_cells_with_ballistic(&cell),
            ] {
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
            }
        }
    }
}
