use super::*;
use crate::diffuse_sphere::ChordSum;
use crate::numerics::quadrature::adaptive;
use proptest::prelude::*;
use std::f64::consts::PI;

fn density(x: f64, cos_gamma: f64) -> f64 {
    sphere_two_hop_density(&TwoHops { x, cos_gamma }).unwrap()
}

#[test]
fn it_is_a_density() {
    for cos_gamma in [1.0, 1.0 - 1e-12, 0.9, 0.5, 0.0, -0.5, -0.999_999, -1.0] {
        let all = two_hop_probability(cos_gamma, 0.0, 2.0).unwrap();
        assert!((all - 1.0).abs() < 1e-9, "{cos_gamma}: {all}");
        let parts: f64 = [0.0, 0.3, 0.9, 1.2, 1.5, 2.0]
            .windows(2)
            .map(|bin| two_hop_probability(cos_gamma, bin[0], bin[1]).unwrap())
            .sum();
        assert!((parts - 1.0).abs() < 1e-9, "{cos_gamma}: {parts}");
    }
}

#[test]
fn the_mean_over_the_second_end_is_the_convolution() {
    let two = ChordSum::new(2).unwrap();
    for (x0, x1) in [(0.1, 0.4), (0.7, 0.9), (1.3, 1.8)] {
        let probability = |cos_gamma: f64| two_hop_probability(cos_gamma, x0, x1).unwrap();
        let breaks = [-1.0, -0.5, 0.0, 0.5, 0.9, 1.0];
        let mean = 0.5 * adaptive(probability, &breaks, 1e-7).unwrap().value;
        let expected = two.probability(x0, x1);
        assert!((mean / expected - 1.0).abs() < 1e-6, "{mean} for {expected}");
    }
}

/// The share of points of the sphere, on a fine regular grid, whose two chords sum up to the bin.
fn counted(cos_gamma: f64, x0: f64, x1: f64) -> f64 {
    const CELLS: u32 = 1500;
    let sine = ((1.0 - cos_gamma) * (1.0 + cos_gamma)).sqrt();
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(CELLS);
    let mut hits = 0_u32;
    for i in 0..CELLS {
        let z = 2.0 * middle(i) - 1.0;
        for j in 0..CELLS {
            let azimuth = PI * middle(j);
            let to_second = z * cos_gamma + ((1.0 - z) * (1.0 + z)).sqrt() * sine * azimuth.cos();
            let chord = |cosine: f64| (0.5 * (1.0 - cosine).max(0.0)).sqrt();
            let sum = chord(z) + chord(to_second);
            hits += u32::from(x0 <= sum && sum < x1);
        }
    }
    f64::from(hits) / f64::from(CELLS).powi(2)
}

#[test]
fn bins_are_the_area_of_the_wall_that_reflects_into_them() {
    for (cos_gamma, x0, x1) in
        [(0.6, 0.44, 0.47), (0.6, 0.9, 1.1), (-0.3, 0.8, 1.2), (0.0, 1.2, 2.0)]
    {
        let exact = two_hop_probability(cos_gamma, x0, x1).unwrap();
        let area = counted(cos_gamma, x0, x1);
        assert!((exact - area).abs() < 3e-4, "{exact} for {area}");
    }
}

#[test]
fn both_ends_in_one_place_give_twice_one_chord() {
    for cos_gamma in [1.0, 1.0 - f64::EPSILON] {
        for x in [1e-6, 0.5, 1.9] {
            assert!((density(x, cos_gamma) / (0.5 * x) - 1.0).abs() < 1e-7, "{x}");
        }
    }
    // Opposite ends: 2 (X − 1)/√(2 − X).
    let expected = 2.0 * 0.69 / 0.31_f64.sqrt();
    assert!((density(1.3, -1.0) / expected - 1.0).abs() < 1e-14);
}

#[test]
fn the_edges_of_the_support() {
    let ends = Ends::new(0.2).unwrap();
    assert_eq!(density(ends.first().next_down(), 0.2), 0.0);
    assert!(density(ends.first() * (1.0 + 1e-9), 0.2) < 1e-7);
    assert!(density(ends.last(), 0.2) > 0.5);
    assert_eq!(density(ends.last().next_up(), 0.2), 0.0);
    assert_eq!(density(-1.0, 0.2), 0.0);
    assert_eq!(density(f64::INFINITY, 0.2), 0.0);
    // The pole: finite at its neighbours, an error (or a huge number by rounding) on it.
    let pole = ends.pole();
    assert!(density(pole * (1.0 + 1e-12), 0.2) > density(pole * (1.0 + 1e-6), 0.2));
    let on_it = sphere_two_hop_density(&TwoHops { x: pole, cos_gamma: 0.2 });
    assert!(on_it.as_ref().map_or(true, |v| *v > 1.0), "{on_it:?}");
}

#[test]
fn below_the_support_there_is_only_the_continuation_of_the_table() {
    let place = TwoHops { x: 0.3, cos_gamma: 0.0 };
    assert!(sphere_two_hop_local(&place).unwrap() < 0.0);
    assert_eq!(sphere_two_hop_density(&place).unwrap(), 0.0);
}

proptest! {
    #[test]
    fn on_the_support_both_are_the_same_and_positive(cos_gamma in -1.0..1.0_f64, part in 0.001..0.999_f64) {
        let ends = Ends::new(cos_gamma).unwrap();
        let place = TwoHops { x: ends.first() + part * (ends.last() - ends.first()), cos_gamma };
        let value = sphere_two_hop_density(&place).unwrap();
        prop_assert!(value > 0.0);
        prop_assert_eq!(value, sphere_two_hop_local(&place).unwrap());
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(exponent in -320.0..308.0_f64, cos_gamma in -1.1..1.1_f64) {
        for x in [10.0_f64.powf(exponent), 10.0_f64.powf(exponent / 320.0)] {
            for cos_gamma in [cos_gamma, 1.0 - x, x - 1.0] {
                let place = TwoHops { x, cos_gamma };
                let result = sphere_two_hop_density(&place);
                let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                prop_assert!(result.as_ref().map_or(true, fine), "{place:?} {result:?}");
                let result = sphere_two_hop_local(&place);
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite()), "{place:?} {result:?}");
            }
        }
    }
}
