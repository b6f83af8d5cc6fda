use super::*;
use crate::diffuse_sphere::{SphereCentreBin, sphere_centre_radiance_bins};
use proptest::prelude::*;

const SAMPLE: AbsorbingCentreBin = AbsorbingCentreBin {
    energy: 1.0,
    albedo: 0.7,
    radius: 1.0,
    sigma_a: 0.0,
    speed: 1.0,
    order: Order::Exactly(3),
    t0: 3.0,
    t1: 4.5,
};

fn radiance(of: &AbsorbingCentreBin) -> f64 {
    sphere_centre_radiance_absorbing_bins(of).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn left(chords: u32, x: f64, absorption: f64) -> f64 {
    sphere_chords_absorbing(&AbsorbingChords { chords, x, absorption }).unwrap()
}

#[test]
fn nothing_is_absorbed_in_an_empty_sphere() {
    for order in [Order::Exactly(1), Order::Exactly(2), Order::Exactly(9), Order::All] {
        for (t0, t1) in [(1.0, 2.5), (3.0, 4.5), (10.0, 11.0)] {
            let empty = SphereCentreBin { albedo: 0.7, order, t0, t1 };
            let expected = sphere_centre_radiance_bins(&empty).unwrap();
            close(radiance(&AbsorbingCentreBin { order, t0, t1, ..SAMPLE }), expected, 1e-9);
        }
    }
}

#[test]
fn full_chords_lose_the_transform_of_each() {
    for (chords, absorption) in [(1, 0.3), (4, 7.0), (12, 1e-9), (30, 40.0)] {
        let almost_all = left(chords, f64::from(chords) * (1.0 - 1e-14), absorption);
        close(almost_all, left(chords, f64::from(chords), absorption), 1e-9);
    }
    assert_eq!(left(3, -1.0, 2.0), 0.0);
    // The first chord alone: F in closed form on a part.
    close(left(1, 0.5, 2.0), 0.5 * (1.0 - 2.0 * (-1.0_f64).exp()), 1e-12);
    // Opaque: 2^n / a^2n.
    close(left(3, 2.0, 1e6), 8.0 / 1e36, 1e-9);
}

#[test]
fn all_orders_over_all_time_are_the_steady_state() {
    // Σ ρ^k F^(k−1) e^(−a) / 4π².
    let of = AbsorbingCentreBin { sigma_a: 0.4, order: Order::All, t0: 0.0, t1: 1e3, ..SAMPLE };
    let transform = chord_transform(0.8);
    let expected = 0.7 / (1.0 - 0.7 * transform) * (-0.8_f64).exp() / (4.0 * PI * PI);
    close(radiance(&of), expected, 1e-9);
    let each: f64 =
        (1..=60).map(|k| radiance(&AbsorbingCentreBin { order: Order::Exactly(k), ..of })).sum();
    close(each, expected, 1e-9);
}

#[test]
fn units_only_scale() {
    let of = AbsorbingCentreBin { sigma_a: 0.4, ..SAMPLE };
    let scaled = AbsorbingCentreBin {
        energy: 3.0,
        radius: 1e-3,
        sigma_a: 400.0,
        speed: 2e8,
        t0: 1.5e-11,
        t1: 2.25e-11,
        ..of
    };
    close(radiance(&scaled), 3e6 * radiance(&of), 1e-9);
}

#[test]
fn inputs_without_meaning_are_errors() {
    for of in [
        AbsorbingCentreBin { albedo: 1.1, ..SAMPLE },
        AbsorbingCentreBin { order: Order::Exactly(0), ..SAMPLE },
        AbsorbingCentreBin { t1: 1.0, ..SAMPLE },
        AbsorbingCentreBin { radius: 0.0, ..SAMPLE },
        AbsorbingCentreBin { sigma_a: f64::NAN, ..SAMPLE },
    ] {
        assert!(sphere_centre_radiance_absorbing_bins(&of).is_err(), "{of:?}");
    }
    assert!(
        sphere_chords_absorbing(&AbsorbingChords { chords: 2, x: 1.0, absorption: -1.0 }).is_err()
    );
}

proptest! {
    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform6(-320.0..308.0_f64), albedo in 0.0..1.0_f64, order in 1..9_u32,
    ) {
        let [energy, radius, sigma_a, speed, t0, width] = exponents.map(|e| 10.0_f64.powf(e));
        for (t0, t1) in [(t0, t0 + width), (2.1 * radius / speed, 5.0 * radius / speed)] {
            for order in [Order::Exactly(order), Order::All] {
                let of = AbsorbingCentreBin {
                    energy, albedo: albedo.min(0.5), radius, sigma_a, speed, order, t0, t1,
                };
                let result = sphere_centre_radiance_absorbing_bins(&of);
                let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                prop_assert!(result.as_ref().map_or(true, fine), "{of:?} {result:?}");
            }
        }
    }
}
