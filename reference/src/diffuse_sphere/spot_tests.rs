use super::*;
use crate::numerics::quadrature::adaptive;

const SAMPLE: SpotBin = SpotBin {
    energy: 2.0,
    albedo: 0.6,
    radius: 1.5,
    speed: 0.5,
    cos_gamma: 0.3,
    order: 2,
    t0: 4.0,
    t1: 6.0,
};

fn mean(of: &SpotBin) -> f64 {
    let &SpotBin { energy, albedo, radius, speed, order, t0, t1, .. } = of;
    sphere_spot_mean_irradiance_bins(&SpotMeanBin { energy, albedo, radius, speed, order, t0, t1 })
        .unwrap()
}

#[test]
fn the_wall_receives_what_is_reflected() {
    for order in 1..6 {
        let of = SpotBin { order, t0: 0.0, t1: 1e3, ..SAMPLE };
        let received = mean(&of) * 4.0 * PI * 1.5 * 1.5;
        assert!((received / (2.0 * 0.6_f64.powi(order.cast_signed())) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_mean_of_the_places_is_the_mean() {
    for order in [1, 2] {
        let at = |cos_gamma: f64| {
            sphere_spot_irradiance_bins(&SpotBin { cos_gamma, order, ..SAMPLE }).unwrap()
        };
        // The first reflection reaches the cosines from 1 − 2 x1² to 1 − 2 x0² in the bin.
        let edges =
            [4.0, 6.0].map(|t: f64| 1.0 - 2.0 * (t * 0.5 / 3.0).powi(2)).map(|c| c.max(-1.0));
        let mut breaks = [-1.0, edges[0], edges[1], 0.0, 1.0];
        breaks.sort_by(f64::total_cmp);
        let places = 0.5 * adaptive(at, &breaks, 1e-7).unwrap().value;
        let expected = mean(&SpotBin { order, ..SAMPLE });
        assert!((places / expected - 1.0).abs() < 1e-6, "{places} for {expected}");
    }
}

#[test]
fn the_first_reflection_comes_at_its_time() {
    let at = |t0: f64, t1: f64| {
        sphere_spot_irradiance_bins(&SpotBin { order: 1, t0, t1, cos_gamma: -1.0, ..SAMPLE })
            .unwrap()
    };
    // A diameter of 3 m at 0.5 m/s.
    assert_eq!(at(0.0, 6.0), 0.0);
    assert!((at(6.0, 7.0) / (2.0 * 0.6 / (4.0 * PI * 2.25)) - 1.0).abs() < 1e-14);
}

#[test]
fn what_is_not_handled_is_an_error() {
    for of in [
        SpotBin { order: 3, ..SAMPLE },
        SpotBin { order: 0, ..SAMPLE },
        SpotBin { cos_gamma: 1.1, order: 1, ..SAMPLE },
        SpotBin { albedo: -0.1, ..SAMPLE },
        SpotBin { t1: 3.0, ..SAMPLE },
        SpotBin { speed: f64::NAN, ..SAMPLE },
    ] {
        assert!(sphere_spot_irradiance_bins(&of).is_err(), "{of:?}");
    }
}
