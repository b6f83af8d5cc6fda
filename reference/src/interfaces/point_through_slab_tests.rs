use super::*;
use crate::interfaces::fresnel::Fresnel;
use crate::numerics::quadrature::adaptive;
use proptest::prelude::*;

const SAMPLE: PointThroughSlab = PointThroughSlab {
    energy: 2.0,
    air_gap: 1.0,
    thickness: 0.5,
    eta: 1.5,
    lateral: 0.8,
    speed: 0.5,
};

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn at_distance(lateral: f64) -> PointThroughSlab {
    PointThroughSlab { lateral, ..SAMPLE }
}

#[test]
fn a_slab_of_air_leaves_the_cosine_law() {
    for lateral in [0.0, 1e-9, 0.7, 100.0] {
        for eta in [1.0, 1.0_f64.next_up()] {
            let of = PointThroughSlab { eta, lateral, ..SAMPLE };
            let r = 1.5_f64.hypot(lateral);
            let expected = 2.0 / (4.0 * PI) * 1.5 / r.powi(3);
            close(point_through_slab_irradiance(&of).unwrap(), expected, 1e-10);
            close(point_through_slab_time(&of).unwrap(), r / 0.5, 1e-11);
            close(point_through_slab_sine(&of).unwrap(), lateral / r, 1e-10);
        }
    }
}

#[test]
fn the_irradiance_of_a_disc_is_the_power_of_its_cone() {
    // ∫ E 2πρ dρ = Q/2 ∫ (1 − R)² sin θ dθ up to the ray that meets the rim.
    for lateral in [0.3, 5.0] {
        let disc =
            |rho: f64| 2.0 * PI * rho * point_through_slab_irradiance(&at_distance(rho)).unwrap();
        let received = adaptive(disc, &[0.0, lateral], 1e-12).unwrap().value;
        let cosine = {
            let sine = point_through_slab_sine(&at_distance(lateral)).unwrap();
            ((1.0 - sine) * (1.0 + sine)).sqrt()
        };
        let cone = |mu: f64| Fresnel::new(SAMPLE.eta, mu).unwrap().transmitted().powi(2);
        let sent = 0.5 * SAMPLE.energy * adaptive(cone, &[cosine, 1.0], 1e-12).unwrap().value;
        close(received, sent, 1e-10);
    }
}

#[test]
fn without_air_the_slab_reaches_as_far_as_its_critical_angle() {
    let of = |lateral| PointThroughSlab { air_gap: 0.0, ..at_distance(lateral) };
    let reach = 0.5 / 1.25_f64.sqrt();
    assert!(point_through_slab_sine(&of(0.99 * reach)).unwrap() > 0.9);
    assert!(point_through_slab_sine(&of(reach * (1.0 - 1e-9))).unwrap() > 0.999_99);
    assert!(point_through_slab_sine(&of(reach * 1.000_001)).is_err());
}

#[test]
fn the_thinnest_air_gap_takes_the_grazing_ray() {
    let of = PointThroughSlab { air_gap: 1e-12, ..at_distance(1.0) };
    let sine = point_through_slab_sine(&of).unwrap();
    assert!(sine > 1.0 - 1e-12);
    // Along the face, and through the slab at the critical angle.
    let inside = 0.5 * 1.5 / (1.0 - 1.0 / 2.25_f64).sqrt();
    let along = 1.0 - 0.5 / 1.25_f64.sqrt();
    close(point_through_slab_time(&of).unwrap() * SAMPLE.speed, inside + along, 1e-11);
}

#[test]
fn inputs_without_meaning_are_errors() {
    for of in [
        PointThroughSlab { eta: 0.9, ..SAMPLE },
        PointThroughSlab { air_gap: 0.0, thickness: 0.0, ..SAMPLE },
        PointThroughSlab { speed: 0.0, ..SAMPLE },
        PointThroughSlab { lateral: -1.0, ..SAMPLE },
        PointThroughSlab { lateral: f64::NAN, ..SAMPLE },
    ] {
        assert!(point_through_slab_time(&of).is_err(), "{of:?}");
    }
}

proptest! {
    #[test]
    fn no_other_path_through_the_faces_is_quicker(
        gap in 0.01..3.0_f64,
        thickness in 0.01..3.0_f64,
        eta in 1.0..3.0_f64,
        lateral in 0.0..9.0_f64,
        shift in -1.0..1.0_f64,
    ) {
        // Fermat: the time over the point where light enters the slab, all air before it.
        let of = PointThroughSlab { air_gap: gap, thickness, eta, lateral, ..SAMPLE };
        let sine = point_through_slab_sine(&of).unwrap();
        let entry = gap * sine / ((1.0 - sine) * (1.0 + sine)).sqrt();
        let by = |entry: f64| {
            (gap.hypot(entry) + eta * thickness.hypot(lateral - entry)) / of.speed
        };
        let time = point_through_slab_time(&of).unwrap();
        prop_assert!((time / by(entry) - 1.0).abs() < 1e-9);
        prop_assert!(time <= by(entry + shift) * (1.0 + 1e-12));
    }

    #[test]
    fn the_ray_lands_where_it_should(
        gap in -6.0..6.0_f64, thickness in -6.0..6.0_f64, lateral in -6.0..6.0_f64,
        eta in 1.0..4.0_f64,
    ) {
        let [gap, thickness, lateral] = [gap, thickness, lateral].map(|e| 10.0_f64.powf(e));
        let of = PointThroughSlab { air_gap: gap, thickness, eta, lateral, ..SAMPLE };
        let ray = solve(&of).unwrap();
        let landed = ray.tangent * (gap + thickness / ray.w);
        prop_assert!((landed / lateral - 1.0).abs() < 1e-14, "{landed:e} {lateral:e}");
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform6(-320.0..308.0_f64), step in -20.0..1.0_f64,
    ) {
        let [energy, air_gap, thickness, eta, lateral, speed] =
            exponents.map(|e| 10.0_f64.powf(e));
        for eta in [eta, 1.0 + 10.0_f64.powf(step)] {
            for air_gap in [air_gap, 0.0] {
                let of = PointThroughSlab { energy, air_gap, thickness, eta, lateral, speed };
                for result in [
                    point_through_slab_irradiance(&of),
                    point_through_slab_sine(&of),
                    point_through_slab_time(&of),
                ] {
                    let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                    prop_assert!(result.as_ref().map_or(true, fine), "{of:?} {result:?}");
                }
            }
        }
    }
}
