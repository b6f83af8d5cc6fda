use super::*;
use crate::numerics::quadrature::adaptive;

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

/// ∫ weight f_n over the support.
fn moment(sum: &ChordSum, weight: impl Fn(f64) -> f64) -> f64 {
    let knots: Vec<_> = (0..=sum.chords).map(f64::from).collect();
    adaptive(|x| weight(x) * sum.density(x), &knots, 1e-13).unwrap().value
}

#[test]
fn mass_mean_and_variance_are_those_of_independent_chords() {
    for chords in [1, 2, 3, 7, 20, 40] {
        let sum = ChordSum::new(chords).unwrap();
        let n = f64::from(chords);
        close(moment(&sum, |_| 1.0), 1.0, 1e-13);
        close(moment(&sum, |x| x), 2.0 * n / 3.0, 1e-13);
        close(moment(&sum, |x| (x - 2.0 * n / 3.0).powi(2)), n / 18.0, 1e-12);
    }
}

#[test]
fn one_more_chord_is_a_convolution() {
    for chords in 1..=6 {
        let (sum, next) = (ChordSum::new(chords).unwrap(), ChordSum::new(chords + 1).unwrap());
        for x in [0.3, 1.0, 1.7, 0.9 * f64::from(chords + 1)] {
            let knot = x.fract();
            let integrand = |y: f64| 2.0 * y * sum.density(x - y);
            let convolved = adaptive(integrand, &[0.0, knot, 1.0], 1e-13).unwrap().value;
            close(next.density(x), convolved, 1e-12);
        }
    }
}

#[test]
fn the_first_cell_is_a_power_however_small() {
    // f_n(x) = 2^n x^(2n−1) / (2n−1)! for x ≤ 1, down to 1e-215.
    for chords in [1, 5, 12, 40, 60] {
        let sum = ChordSum::new(chords).unwrap();
        for x in [0.01, 0.5, 1.0] {
            let exponent = (2 * chords - 1).cast_signed();
            let exact = 2.0_f64.powi(chords.cast_signed()) * f64::powi(x, exponent)
                / factorial(2 * chords - 1);
            close(sum.density(x), if x < 1.0 || chords > 1 { exact } else { 2.0 }, 1e-13);
        }
    }
}

#[test]
fn the_alternating_sum_agrees_where_it_has_digits() {
    let alternating = |n: u32, x: f64| {
        let binomial = |a: u32, b: u32| factorial(a) / factorial(b) / factorial(a - b);
        let term = |j: u32, m: u32| {
            let power = 2 * n - m - 1;
            let sign = if j.is_multiple_of(2) { 1.0 } else { -1.0 };
            let reach = (x - f64::from(j)).max(0.0);
            sign * binomial(n, j) * binomial(j, m) * reach.powi(power.cast_signed())
                / factorial(power)
        };
        let terms = (0..=n).flat_map(|j| (0..=j).map(move |m| (j, m)));
        2.0_f64.powi(n.cast_signed()) * terms.map(|(j, m)| term(j, m)).sum::<f64>()
    };
    for n in 2..=6 {
        for x in [0.4, 1.3, 1.9] {
            let exact = sphere_chords_pdf(&SphereChords { chords: n, x }).unwrap();
            close(alternating(n, x), exact, 1e-10);
        }
    }
}

#[test]
fn probabilities_of_pieces_add_up_to_one() {
    for chords in [1, 4, 15, 80] {
        let sum = ChordSum::new(chords).unwrap();
        let n = f64::from(chords);
        let edges = [-1.0, 0.0, 0.1, 0.15 * n, 0.5 * n, 0.66 * n, 0.9 * n, n + 3.0];
        let total: f64 = edges.windows(2).map(|bin| sum.probability(bin[0], bin[1])).sum();
        close(total, 1.0, 1e-13);
        assert_eq!(sum.probability(n, 2.0 * n), 0.0);
    }
}

#[test]
fn the_cdf_is_the_integral_of_the_pdf() {
    for (chords, x) in [(2, 1.5), (9, 4.0), (33, 25.0)] {
        let sum = ChordSum::new(chords).unwrap();
        let mut knots: Vec<_> = (0..=x as u32).map(f64::from).collect();
        knots.push(x);
        let integral = adaptive(|x| sum.density(x), &knots, 1e-13).unwrap().value;
        close(sphere_chords_cdf(&SphereChords { chords, x }).unwrap(), integral, 1e-12);
    }
}

#[test]
fn outside_the_support_there_is_nothing() {
    let pdf = |x: f64| sphere_chords_pdf(&SphereChords { chords: 3, x }).unwrap();
    let cdf = |x: f64| sphere_chords_cdf(&SphereChords { chords: 3, x }).unwrap();
    assert_eq!([pdf(-0.1), pdf(3.1), pdf(f64::INFINITY)], [0.0; 3]);
    assert_eq!([cdf(-0.1), cdf(0.0), cdf(3.0), cdf(1e9)], [0.0, 0.0, 1.0, 1.0]);
    assert!(sphere_chords_pdf(&SphereChords { chords: 3, x: f64::NAN }).is_err());
    assert!(sphere_chords_pdf(&SphereChords { chords: 0, x: 0.5 }).is_err());
    assert!(sphere_chords_pdf(&SphereChords { chords: MAX_CHORDS + 1, x: 0.5 }).is_err());
}

fn radiance(albedo: f64, order: Order, t0: f64, t1: f64) -> f64 {
    sphere_centre_radiance_bins(&SphereCentreBin { albedo, order, t0, t1 }).unwrap()
}

#[test]
fn the_integral_over_time_is_the_steady_state() {
    // Σ ρ^k / 4π²: for intensity π and albedo ½ the well-known radiance of exactly 1.
    for albedo in [0.0, 0.01, 0.5, 0.7] {
        let expected = albedo / (1.0 - albedo) / (4.0 * PI * PI);
        close(radiance(albedo, Order::All, 0.0, 200.0), expected, 1e-12);
    }
}

#[test]
fn without_absorption_light_returns_at_the_mean_chord() {
    // Renewal: one reflection per 4/3 R, once the first few are forgotten.
    let expected = 0.75 / (4.0 * PI * PI);
    close(radiance(1.0, Order::All, 100.0, 101.0), expected, 1e-12);
}

#[test]
fn all_orders_are_the_sum_of_each() {
    for (t0, t1) in [(1.0, 2.0), (1.9, 2.6), (2.0, 7.0), (9.0, 12.0)] {
        let each = (1..=60).map(|k| radiance(0.9, Order::Exactly(k), t0, t1));
        close(radiance(0.9, Order::All, t0, t1), each.sum(), 1e-13);
    }
}

#[test]
fn the_first_reflection_is_in_the_bin_that_starts_with_it() {
    let first = |t0, t1| radiance(0.5, Order::Exactly(1), t0, t1);
    assert_eq!(first(1.0, 2.0), 0.0);
    close(first(2.0, 3.0), 0.5 / (4.0 * PI * PI), 1e-15);
    assert_eq!(first(2.0_f64.next_up(), 3.0), 0.0);
}

#[test]
fn an_order_is_read_from_a_number_or_the_word_all() {
    let order = |json: &str| serde_json::from_str::<Order>(json);
    assert_eq!(order("3").unwrap(), Order::Exactly(3));
    assert_eq!(order("\"all\"").unwrap(), Order::All);
    for wrong in ["\"none\"", "-1", "1.5", "null"] {
        assert!(order(wrong).is_err());
    }
}

#[test]
fn inputs_without_meaning_are_errors() {
    let at = |albedo, order, t0, t1| {
        sphere_centre_radiance_bins(&SphereCentreBin { albedo, order, t0, t1 })
    };
    assert!(at(1.1, Order::All, 0.0, 1.0).is_err());
    assert!(at(0.5, Order::Exactly(0), 0.0, 1.0).is_err());
    assert!(at(0.5, Order::Exactly(2), 3.0, 1.0).is_err());
    assert!(at(0.5, Order::All, 0.0, f64::NAN).is_err());
    // Light of more than MAX_CHORDS reflections is needed here.
    assert!(at(0.9, Order::All, 0.0, 1e9).is_err());
}
