use super::*;
use proptest::prelude::*;

const SAMPLE: BallLens = BallLens { impact: 0.3, eta: 1.5, radius: 1.0, distance: 4.0, speed: 1.0 };

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

#[test]
fn near_the_axis_rays_meet_in_the_focus() {
    // Effective focal length η R / (2 (η − 1)), from the centre: 1.5 R for η = 1.5.
    let of = BallLens { impact: 1e-5, distance: 1.5, ..SAMPLE };
    assert!(ball_lens_landing(&of).unwrap().abs() < 1e-14);
    let beyond = BallLens { distance: 3.0, ..of };
    close(ball_lens_landing(&beyond).unwrap(), -1e-5, 1e-8);
    close(ball_lens_time(&BallLens { impact: 0.0, ..SAMPLE }).unwrap(), 3.0 + 3.0 + 3.0, 1e-15);
}

#[test]
fn a_ball_of_air_lets_rays_pass() {
    for impact in [0.0, 1e-300, -0.5, 0.999, 1.0] {
        for eta in [1.0, 1.0 + 1e-14] {
            let of = BallLens { impact, eta, ..SAMPLE };
            let grazing = if eta > 1.0 && impact == 1.0 { 1e-5 } else { 1e-11 };
            close(ball_lens_landing(&of).unwrap(), impact, grazing);
            close(ball_lens_time(&of).unwrap(), 8.0, grazing);
        }
    }
}

#[test]
fn the_deviation_keeps_its_digits_for_almost_equal_indices() {
    // To first order in η − 1, the deviation is 2 (η − 1) tan θi.
    let eta = 1.0 + 1e-9;
    let path = trace(&BallLens { eta, impact: 0.6, ..SAMPLE }).unwrap();
    close(path.sin_deviation, 2.0 * (eta - 1.0) * 0.75, 1e-8);
}

#[test]
fn rays_that_do_not_reach_the_plane_are_errors() {
    for of in [
        BallLens { impact: 1.1, ..SAMPLE },
        BallLens { impact: f64::NAN, ..SAMPLE },
        BallLens { distance: 0.9, ..SAMPLE },
        BallLens { eta: 0.5, impact: 0.6, ..SAMPLE },
        // Deviated by more than 90°.
        BallLens { eta: 2.5, impact: 0.999, ..SAMPLE },
        BallLens { eta: 0.0, ..SAMPLE },
        BallLens { radius: -1.0, ..SAMPLE },
    ] {
        assert!(ball_lens_time(&of).is_err() && ball_lens_landing(&of).is_err(), "{of:?}");
    }
}

/// Point of the sphere, refraction by Snell's law in vectors, and so on: nothing shared.
fn traced_with_vectors(of: &BallLens) -> (f64, f64) {
    let refract = |d: [f64; 2], n: [f64; 2], ratio: f64| {
        let cosine = -(d[0] * n[0] + d[1] * n[1]);
        let k = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
        [0, 1].map(|i| ratio * d[i] + (ratio * cosine - k.sqrt()) * n[i])
    };
    let (r, h) = (of.radius, of.impact);
    let entry = [-(r * r - h * h).sqrt(), h];
    let inside = refract([1.0, 0.0], entry.map(|x| x / r), 1.0 / of.eta);
    let chord = -2.0 * (entry[0] * inside[0] + entry[1] * inside[1]);
    let exit = [0, 1].map(|i| entry[i] + chord * inside[i]);
    let out = refract(inside, exit.map(|x| -x / r), of.eta);
    let last = (of.distance - exit[0]) / out[0];
    let time = (of.distance + entry[0] + of.eta * chord + last) / of.speed;
    (time, exit[1] + last * out[1])
}

proptest! {
    #[test]
    fn the_ray_obeys_snells_law(
        impact in -0.8..0.8_f64, eta in 0.85..2.0_f64, radius in 0.1..9.0_f64,
    ) {
        let of = BallLens { impact: impact * radius, eta, radius, distance: 4.0 * radius, speed: 0.3 };
        let (time, height) = traced_with_vectors(&of);
        close(ball_lens_time(&of).unwrap(), time, 1e-12);
        prop_assert!((ball_lens_landing(&of).unwrap() - height).abs() < 1e-11 * radius);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform5(-320.0..308.0_f64), fraction in -1.0..1.0_f64,
    ) {
        let [impact, eta, radius, distance, speed] = exponents.map(|e| 10.0_f64.powf(e));
        for impact in [impact, fraction * radius] {
            for (eta, distance) in [(eta, distance), (1.3, 2.0 * radius)] {
                let of = BallLens { impact, eta, radius, distance, speed };
                let time = ball_lens_time(&of);
                let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                prop_assert!(time.as_ref().map_or(true, fine), "{of:?} {time:?}");
                let landing = ball_lens_landing(&of);
                prop_assert!(landing.as_ref().map_or(true, |v| v.is_finite()), "{of:?} {landing:?}");
            }
        }
    }
}
