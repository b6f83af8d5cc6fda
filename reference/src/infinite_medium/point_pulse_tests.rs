use super::*;
use crate::infinite_medium::{AliveOfOrder, energy_of_order};
use proptest::prelude::*;

fn at(r: f64, time: f64, albedo: f64) -> f64 {
    point_pulse_fluence(&PointPulse { r, time, albedo }).unwrap()
}

fn order(r: f64, time: f64, order: u32) -> f64 {
    point_pulse_fluence_by_order(&PointPulseOrder { r, time, order }).unwrap()
}

fn bin(r: f64, t0: f64, t1: f64, albedo: f64) -> f64 {
    point_pulse_fluence_bins(&PointPulseBin { r, t0, t1, albedo }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// ∫ 4πr² φ dr up to the front, with the logarithm of the front removed.
fn energy(t: f64, fluence: impl Fn(f64, f64) -> f64) -> f64 {
    let integrand = |root: f64| {
        let gap = t * root.powi(4);
        let r = t - gap;
        4.0 * PI * r * r * fluence(r, gap) * 4.0 * t * root.powi(3)
    };
    adaptive(integrand, &[1e-30, 0.5, 1.0 - 1e-12], 1e-11).unwrap().value
}

#[test]
fn the_energy_of_all_orders_is_what_is_alive() {
    for t in [1e-6, 0.1, 1.0, 7.0, 100.0, 1e3_f64] {
        for albedo in [0.3, 1.0, 1.05_f64] {
            let expected = ((albedo - 1.0) * t).exp() * -(-albedo * t).exp_m1();
            close(energy(t, |r, gap| scattered(r, gap, albedo)), expected, 1e-10);
        }
    }
}

#[test]
fn the_energy_of_an_order_is_that_of_poisson() {
    for t in [1e-3, 1.0, 30.0] {
        for n in [1, 2, 3, 10, 60] {
            let input = AliveOfOrder { sigma_s: 1.0, sigma_t: 1.0, speed: 1.0, time: t, order: n };
            let expected = energy_of_order(&input).unwrap();
            close(energy(t, |r, gap| of_order(r, gap, n)), expected, 1e-10);
        }
    }
}

#[test]
fn it_is_the_slope_of_the_plane_pulse() {
    use crate::infinite_medium::plane_pulse;
    for t in [0.01, 1.0, 20.0] {
        for eta in [0.1, 0.5, 0.9] {
            let (r, h) = (eta * t, 1e-4 * t);
            let slope = |f: &dyn Fn(f64) -> f64| {
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(r + k * h));
                -(a - 8.0 * b + 8.0 * c - d) / (12.0 * h) / (2.0 * PI * r)
            };
            let all = slope(&|x| plane_pulse::scattered(x, t - x, 0.9));
            close(at(r, t, 0.9), all, 1e-9);
            let sixth = slope(&|x| plane_pulse::of_order(x, t - x, 6));
            close(order(r, t, 6), sixth, 1e-9);
        }
    }
}

#[test]
fn the_first_order_follows_from_the_contour_too() {
    for (r, t) in [(0.0, 1.0), (1e-6, 1.0), (0.4, 1.0), (0.99, 1.0), (4.999, 5.0)] {
        close(at(r, t, 1e-9) / 1e-9, order(r, t, 1), 1e-7);
    }
}

#[test]
fn the_source_is_the_limit() {
    for t in [1e-6, 1.0, 1e3] {
        let centre = at(0.0, t, 1.0);
        for r in [1e-300, 1e-12, 1e-9, 1e-7].map(|eta| eta * t) {
            close(at(r, t, 1.0), centre, 1e-10);
            for n in [1, 2, 5, 40] {
                close(order(r, t, n), order(0.0, t, n), 1e-10);
            }
        }
        // On the way in, the value changes with the square of the distance.
        close(at(1e-4 * t, t, 1.0) - centre, (at(2e-4 * t, t, 1.0) - centre) / 4.0, 1e-3);
    }
}

#[test]
fn the_front_is_dark_before_infinite_on_and_logarithmic_behind() {
    assert_eq!(at(2.0, 2.0_f64.next_down(), 1.0), 0.0);
    assert_eq!(order(2.0, 1.0, 3), 0.0);
    assert_eq!(order(2.0, 2.0, 3), 0.0);
    assert!(point_pulse_fluence(&PointPulse { r: 2.0, time: 2.0, albedo: 1.0 }).is_err());
    assert!(
        point_pulse_fluence_by_order(&PointPulseOrder { r: 2.0, time: 2.0, order: 1 }).is_err()
    );
    // Only the first order is left there.
    let behind = 2.0_f64.next_up();
    close(at(2.0, behind, 0.7), 0.7 * order(2.0, behind, 1), 1e-12);
}

#[test]
fn late_light_diffuses() {
    for t in [1e5, 1e8, 1e12_f64] {
        for y in [0.0, 1.0, 2.0_f64] {
            let expected = (-0.75 * y * y).exp() / (4.0 * PI * t / 3.0).powf(1.5);
            close(at(y * t.sqrt(), t, 1.0), expected, 10.0 / t);
        }
    }
}

#[test]
fn bins_are_integrals_and_add_up() {
    for r in [1e-6, 0.3, 1.0, 20.0] {
        for albedo in [0.5, 1.0] {
            let edges = [0.5 * r, 1.01 * r, 1.5 * r, 3.0 * r + 1.0, 10.0 * r + 10.0];
            let parts: f64 = edges.windows(2).map(|e| bin(r, e[0], e[1], albedo)).sum();
            close(bin(r, edges[0], edges[4], albedo), parts, 1e-9);
            let narrow = bin(r, 2.0 * r, 2.0 * r * (1.0 + 1e-5), albedo);
            close(narrow, 2e-5 * r * at(r, 2.0 * r * (1.0 + 5e-6), albedo), 1e-8);
        }
    }
    assert_eq!(bin(1.0, 0.0, 1.0, 1.0), 0.0);
    assert_eq!(bin(1.0, 2.0, 2.0, 1.0), 0.0);
    let at_the_source = PointPulseBin { r: 0.0, t0: 0.0, t1: 1.0, albedo: 1.0 };
    assert!(point_pulse_fluence_bins(&at_the_source).is_err());
    assert!(bin(0.0, 0.5, 1.0, 1.0) > 0.0);
}

#[test]
fn all_time_is_the_steady_state_of_the_diffusion_length() {
    // Case's kernel decays as e^(−r/L); its sum rule: ∫ 4πr² ∫ φ dt dr = c/(1 − c).
    let albedo = 0.6;
    let shell = |y: f64| {
        let r = y.exp();
        4.0 * PI * r * r * r * bin(r, 0.0, 1e4, albedo)
    };
    let total = adaptive(shell, &[1e-6_f64.ln(), 0.0, 60.0_f64.ln()], 1e-7).unwrap().value;
    close(total, albedo / (1.0 - albedo), 1e-6);
}

#[test]
fn values_without_meaning_are_errors() {
    let pulse = PointPulse { r: 0.1, time: 1.0, albedo: 1.0 };
    assert!(point_pulse_fluence(&PointPulse { time: 0.0, ..pulse }).is_err());
    assert!(point_pulse_fluence(&PointPulse { r: -0.1, ..pulse }).is_err());
    assert!(point_pulse_fluence(&PointPulse { albedo: f64::NAN, ..pulse }).is_err());
    assert!(point_pulse_fluence(&PointPulse { albedo: 3.0, time: 1e3, ..pulse }).is_err());
    assert!(
        point_pulse_fluence_by_order(&PointPulseOrder { r: 0.1, time: 1.0, order: 0 }).is_err()
    );
}

proptest! {
    #[test]
    fn the_orders_add_up(
        log_time in -6.0..2.0_f64, gap in -9.0..0.0_f64, albedo in 0.01..1.2_f64,
    ) {
        let t = 10.0_f64.powf(log_time);
        let r = t * (1.0 - 10.0_f64.powf(gap));
        let mut sum = 0.0;
        for n in 1..600 {
            let term = albedo.powi(n) * order(r, t, n as u32);
            sum += term;
            if f64::from(n) > 2.0 * t && term < 1e-17 * sum {
                break;
            }
        }
        close(at(r, t, albedo), sum, 1e-10);
    }

    #[test]
    fn absorption_is_a_factor(
        log_time in -6.0..2.5_f64, eta in 0.0..0.999_f64, albedo in 0.01..1.0_f64,
    ) {
        let t = 10.0_f64.powf(log_time);
        let lossless = albedo.powi(3) * at(eta * t * albedo, t * albedo, 1.0);
        close(at(eta * t, t, albedo), lossless * (-(1.0 - albedo) * t).exp(), 1e-11);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform3(-320.0..308.0_f64), n in any::<u32>(), near in 0.0..1.1_f64,
    ) {
        let [r, time, albedo] = exponents.map(|e| 10.0_f64.powf(e));
        for r in [r, near * time] {
            for result in [
                point_pulse_fluence(&PointPulse { r, time, albedo }),
                point_pulse_fluence_by_order(&PointPulseOrder { r, time, order: n }),
                point_pulse_fluence_by_order(&PointPulseOrder { r, time, order: n % 50 }),
            ] {
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn wild_bins_give_a_value_or_an_error(
        r in -12.0..12.0_f64, t0 in -12.0..12.0_f64, width in -12.0..12.0_f64, albedo in 0.0..1.5_f64,
    ) {
        let [r, t0, width] = [r, t0, width].map(|e| 10.0_f64.powf(e));
        let result = point_pulse_fluence_bins(&PointPulseBin { r, t0, t1: t0 + width, albedo });
        prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
    }
}
