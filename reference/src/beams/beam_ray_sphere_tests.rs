use super::super::beam_ray::{BeamRay1d, beam_ray_1d};
use super::*;
use crate::numerics::quadrature::tanh_sinh;
use crate::numerics::vector::unit;
use proptest::prelude::*;

const EVER: f64 = 1e6;

/// A ray that crosses a beam along x at right angles, at the height 0.03.
const CROSSING: BeamRay3dBin = BeamRay3dBin {
    energy: 1.5,
    sigma_s: 0.8,
    sigma_t: 1.2,
    g: 0.4,
    speed: 0.5,
    radius: 0.1,
    beam_origin: [0.0, 0.0, 0.0],
    beam_direction: [1.0, 0.0, 0.0],
    beam_length: 8.0,
    ray_origin: [2.0, 0.03, -3.0],
    ray_direction: [0.0, 0.0, 1.0],
    ray_length: 30.0,
    t0: -EVER,
    t1: EVER,
};

fn sphere(of: &BeamRay3dBin) -> f64 {
    let bins = beam_ray_3d_bins(of).unwrap();
    if of.t0 == -EVER && of.t1 == EVER {
        close(bins, beam_ray_3d(&of.pair()).unwrap(), 1e-11);
    }
    bins
}

fn in_bin(of: &BeamRay3dBin, t0: f64, t1: f64) -> f64 {
    sphere(&BeamRay3dBin { t0, t1, ..*of })
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn phase(of: &BeamRay3dBin) -> f64 {
    let (d, ray) = (unit("d", of.beam_direction).unwrap(), unit("w", of.ray_direction).unwrap());
    let g = of.g;
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g + 2.0 * g * dot(d, ray)).powf(1.5))
}

/// e^(−x) 2 I₁(x)/x = 2/π ∫ √(1 − y²) e^(x (y − 1)) dy.
fn bessel_mean(x: f64) -> f64 {
    // In y = cos a.
    let integrand = |a: f64| a.sin().powi(2) * (x * (a.cos() - 1.0)).exp();
    let knee = (3.0 / x.sqrt()).min(PI);
    2.0 / PI * adaptive(integrand, &[0.0, knee, PI], 1e-12).unwrap().value
}

/// The definition: a sum over a grid of points of both lines.
fn gridded(of: &BeamRay3dBin, steps: u32) -> f64 {
    let d = unit("d", of.beam_direction).unwrap();
    let ray = unit("w", of.ray_direction).unwrap();
    let (step_b, step_r) = (of.beam_length / f64::from(steps), of.ray_length / f64::from(steps));
    let mut sum = 0.0;
    for i in 0..steps {
        let s_r = (f64::from(i) + 0.5) * step_r;
        let from = subtract(add(of.ray_origin, scale(ray, s_r)), of.beam_origin);
        // No point of the beam's line is closer.
        if length(cross(from, d)) >= of.radius {
            continue;
        }
        for j in 0..steps {
            let s_b = (f64::from(j) + 0.5) * step_b;
            let offset = subtract(from, scale(d, s_b));
            let path = s_b + s_r;
            let seen = dot(offset, offset) < of.radius * of.radius
                && (of.speed * of.t0..of.speed * of.t1).contains(&path);
            sum += if seen { (-of.sigma_t * path).exp() } else { 0.0 };
        }
    }
    let density = 3.0 / (4.0 * PI * of.radius.powi(3));
    of.energy * of.sigma_s * phase(of) * density * sum * step_b * step_r
}

#[test]
fn an_unclipped_crossing_meets_the_closed_form() {
    for (ray_direction, radius, sigma_t) in [
        ([0.0, 0.0, 1.0], 0.1, 1.2),
        ([0.7, 0.0, 1.0], 0.031, 0.0),
        ([-0.4, 0.0, 1.0], 0.5, 7.0),
        ([-0.4, 0.0, 1.0], 0.5, 700.0),
        ([0.2, 0.0, 1.0], 0.5, 1e5),
    ] {
        let of = BeamRay3dBin { radius, ray_direction, ..CROSSING };
        let norm = length(ray_direction);
        let (sin_psi, cos_psi) = (1.0 / norm, ray_direction[0] / norm);
        // Close enough to the corner that light arrives.
        let shift = 3.0_f64.min(700.0 / sigma_t).max(4.0 * radius);
        let z = -shift;
        let x = 2.0 * shift / 3.0;
        let of = BeamRay3dBin { ray_origin: [x, 0.03, z], sigma_t, ..of };
        let path = x + shift * ray_direction[0] + shift * norm;
        let free2 = radius * radius - 0.03 * 0.03;
        let half = (2.0 * free2 / (1.0 - cos_psi)).sqrt();
        // Relative to the earliest path, because both underflow for the densest medium.
        let expected = of.energy * of.sigma_s * phase(&of) * 0.75 * free2
            / (radius.powi(3) * sin_psi)
            * (-sigma_t * (path - half)).exp()
            * bessel_mean(sigma_t * half);
        close(sphere(&of), expected, 1e-9);
    }
}

#[test]
fn every_kind_of_meeting_is_what_a_grid_finds() {
    let x = [1.0, 0.0, 0.0];
    let base = BeamRay3dBin { beam_length: 1.5, ray_length: 2.0, radius: 0.2, ..CROSSING };
    let through = |origin: Vector, direction: Vector| BeamRay3dBin {
        ray_origin: origin,
        ray_direction: direction,
        ..base
    };
    let cases = [
        through([0.7, 0.05, -1.0], [0.0, 0.0, 1.0]),
        through([0.1, 0.05, -0.5], [0.3, 0.0, 1.0]),
        through([-0.5, 0.05, 0.02], x),
        through([1.8, 0.05, 0.02], [-1.0, 0.0, 0.0]),
        through([1.8, 0.05, 0.02], [-1.0, 0.02, 0.0]),
        through([0.3, 0.05, 0.02], [-1.0, 0.3, 0.0]),
        through([0.3, 0.05, 0.02], [1.0, 0.3, 0.0]),
        through([-0.1, 0.0, -1.0], [0.0, 0.1, 1.0]),
        through([1.6, 0.05, -1.0], [0.05, 0.0, 1.0]),
        through([-0.15, 0.05, -0.3], [1.0, 0.0, 2.0]),
        BeamRay3dBin { ray_length: 1.05, ..through([0.7, 0.05, -1.0], [0.0, 0.0, 1.0]) },
        BeamRay3dBin { beam_length: 0.1, ..through([0.05, 0.05, -1.0], [0.1, 0.0, 1.0]) },
        BeamRay3dBin { t0: 3.2, t1: 3.6, ..through([0.7, 0.05, -1.0], [0.3, 0.0, 1.0]) },
        BeamRay3dBin { t0: 3.5, t1: 3.6, ..through([1.8, 0.05, 0.02], [-1.0, 0.0, 0.0]) },
        BeamRay3dBin { t0: 1.0, t1: 2.0, ..through([-0.5, 0.05, 0.02], x) },
    ];
    for (index, of) in cases.iter().enumerate() {
        let (value, expected) = (sphere(of), gridded(of, 4000));
        // The grid's 4000 cells along each line are its error.
        assert!((value / expected - 1.0).abs() < 1e-3, "case {index}: {value:e} for {expected:e}");
    }
}

#[test]
fn integrated_over_the_offset_it_agrees_with_the_1d_kernel_in_a_clear_medium() {
    for (ray_direction, radius) in [([0.0, 0.0, 1.0], 0.1), ([0.9, 0.0, 1.0], 0.4)] {
        let at_height = |h: f64| BeamRay3dBin {
            sigma_t: 0.0,
            radius,
            ray_direction,
            ray_origin: [2.0, h, -3.0],
            ..CROSSING
        };
        let line = |of: &BeamRay3dBin| {
            let &BeamRay3dBin { sigma_s, sigma_t, g, radius, beam_length, ray_length, .. } = of;
            let weight = beam_ray_1d(&BeamRay1d {
                sigma_s,
                sigma_t,
                g,
                radius,
                beam_origin: of.beam_origin,
                beam_direction: of.beam_direction,
                beam_length,
                ray_origin: of.ray_origin,
                ray_direction: of.ray_direction,
                ray_length,
            });
            of.energy * weight.unwrap()
        };
        let integral = |f: &dyn Fn(&BeamRay3dBin) -> f64| {
            tanh_sinh(|node| f(&at_height(node.x)), -radius, radius, 1e-9).unwrap().value
        };
        close(integral(&sphere), integral(&line), 1e-8);
    }
}

#[test]
fn head_on_the_arrival_lasts_as_long_as_the_chord() {
    // Looking straight into the beam, T = s_b + s_r moves the beam's point against a fixed one.
    let of = BeamRay3dBin {
        ray_origin: [10.0, 0.06, 0.0],
        ray_direction: [-1.0, 0.0, 0.0],
        sigma_t: 0.0,
        speed: 1.0,
        ..CROSSING
    };
    // Every T within √(R² − h²) = 0.08 of 10 meets all of the overlap, 8 m or less by |T − 10|.
    let width = 0.75 / PI / 1e-3 * 1.5 * 0.8 * phase(&of);
    close(in_bin(&of, 9.92, 10.0), width * 0.08 * 8.0, 1e-10);
    close(in_bin(&of, 0.0, 9.95), width * 0.03 * 8.0, 1e-10);
    assert_eq!(in_bin(&of, 10.08, 99.0) + in_bin(&of, 0.0, 9.92), 0.0);
}

#[test]
fn almost_parallel_pairs_tend_to_the_parallel_ones() {
    for along in [1.0, -1.0] {
        let origin = if along > 0.0 { [-1.0, 0.0, 0.05] } else { [10.0, 0.0, 0.05] };
        let tilted = |tilt: f64| {
            let ray_direction = [along, tilt, 0.0];
            sphere(&BeamRay3dBin { ray_origin: origin, ray_direction, ..CROSSING })
        };
        for tilt in [1e-8, 1e-12, 1e-100, 1e-200] {
            close(tilted(tilt), tilted(0.0), 1e-10_f64.max(100.0 * tilt));
        }
    }
}

#[test]
fn balls_around_the_ends_are_part_of_the_sweep_and_beyond_them_is_nothing() {
    let before = |x: f64| BeamRay3dBin { ray_origin: [x, 0.0, -3.0], ..CROSSING };
    assert!(sphere(&before(-0.09)) > 0.0);
    assert_eq!(sphere(&before(-0.100_001)), 0.0);
    assert!(sphere(&before(8.09)) > 0.0);
    assert_eq!(sphere(&before(8.100_001)), 0.0);
    let at_height = |h: f64| BeamRay3dBin { ray_origin: [2.0, h, -3.0], ..CROSSING };
    assert_eq!(sphere(&at_height(0.1)), 0.0);
    assert!(sphere(&at_height(0.1_f64.next_down())) > 0.0);
    // A ray that ends on the beam keeps half.
    let half = BeamRay3dBin { ray_length: 3.0, sigma_t: 0.0, ..CROSSING };
    close(sphere(&half), 0.5 * sphere(&BeamRay3dBin { sigma_t: 0.0, ..CROSSING }), 1e-10);
}

#[test]
fn inputs_without_meaning_are_errors() {
    for broken in [
        BeamRay3dBin { radius: 0.0, ..CROSSING },
        BeamRay3dBin { beam_direction: [0.0; 3], ..CROSSING },
        BeamRay3dBin { ray_origin: [f64::NAN, 0.0, 0.0], ..CROSSING },
        BeamRay3dBin { ray_length: f64::INFINITY, ..CROSSING },
        BeamRay3dBin { g: 1.0, ..CROSSING },
    ] {
        assert!(beam_ray_3d_bins(&broken).is_err() && beam_ray_3d(&broken.pair()).is_err());
    }
}

fn vector(range: std::ops::Range<f64>) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(range)
}

prop_compose! {
    /// A ray that is likely to pass through the swept sphere.
    fn pair()(
        sigma_t in 0.0..3.0_f64,
        g in -0.99..0.99_f64,
        radius in 0.05..1.0_f64,
        beam_direction in vector(-1.0..1.0),
        ray_direction in vector(-1.0..1.0),
        on_beam in -0.5..3.0_f64,
        on_ray in -0.5..3.0_f64,
        miss in vector(-0.4..0.4),
        beam_length in 0.5..3.0_f64,
        ray_length in 0.5..3.0_f64,
    ) -> BeamRay3dBin {
        let beam_origin = [0.3, -0.2, 0.1];
        let d = unit("d", beam_direction).unwrap_or([1.0, 0.0, 0.0]);
        let ray = unit("w", ray_direction).unwrap_or([0.0, 1.0, 0.0]);
        let meeting = add(add(beam_origin, scale(d, on_beam)), miss);
        BeamRay3dBin {
            energy: 1.0, sigma_s: 0.8, sigma_t, g, speed: 0.7, radius, beam_origin,
            beam_direction: scale(d, 3.0), beam_length,
            ray_origin: subtract(meeting, scale(ray, on_ray)),
            ray_direction: scale(ray, 0.2), ray_length, t0: -EVER, t1: EVER,
        }
    }
}

proptest! {
    #[test]
    fn the_sphere_is_what_a_grid_finds(of in pair(), t0 in 0.0..4.0_f64, width in 0.2..4.0_f64) {
        let of = BeamRay3dBin { t0, t1: t0 + width, ..of };
        let steps = 500;
        // A border of at most twice the shorter segments' lengths, one cell thick.
        let cell = of.beam_length.max(of.ray_length) / f64::from(steps);
        let border = 8.0 * (of.beam_length + of.ray_length).min(4.0 * of.radius) * cell;
        let bound = 0.8 * phase(&of) * 0.75 / PI / of.radius.powi(3) * border;
        prop_assert!((sphere(&of) - gridded(&of, steps)).abs() <= bound);
    }

    #[test]
    fn bins_add_up(of in pair(), times in prop::array::uniform3(-1.0..9.0_f64)) {
        let mut edges = [-EVER, times[0], times[1], times[2], EVER];
        edges.sort_by(f64::total_cmp);
        let sum: f64 = edges.windows(2).map(|bin| in_bin(&of, bin[0], bin[1])).sum();
        close(sum, sphere(&of), 1e-9);
    }

    #[test]
    fn beam_and_ray_may_be_exchanged(of in pair(), t0 in 0.0..4.0_f64, width in 0.2..4.0_f64) {
        let of = BeamRay3dBin { t0, t1: t0 + width, ..of };
        let exchanged = BeamRay3dBin {
            beam_origin: of.ray_origin, beam_direction: of.ray_direction,
            beam_length: of.ray_length, ray_origin: of.beam_origin,
            ray_direction: of.beam_direction, ray_length: of.beam_length, ..of
        };
        let scale = 1.0 / (of.radius * (1.0 - of.g.abs()).powi(2));
        prop_assert!((sphere(&exchanged) - sphere(&of)).abs() <= 1e-9 * sphere(&of) + 1e-13 * scale);
    }

    #[test]
    fn lengths_scale(of in pair(), factor in 0.01..100.0_f64) {
        let scaled = BeamRay3dBin {
            sigma_s: of.sigma_s / factor,
            sigma_t: of.sigma_t / factor,
            radius: of.radius * factor,
            beam_origin: scale(of.beam_origin, factor),
            beam_length: of.beam_length * factor,
            ray_origin: scale(of.ray_origin, factor),
            ray_length: of.ray_length * factor,
            ..of
        };
        let bound = 1e-13 / (of.radius * (1.0 - of.g.abs()).powi(2));
        prop_assert!((sphere(&scaled) * factor * factor - sphere(&of)).abs() <= 1e-9 * sphere(&of) + bound);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        of in pair(),
        exponents in prop::array::uniform7(-320.0..308.0_f64),
        tilt in -300.0..0.0_f64,
    ) {
        let [energy, sigma_t, speed, radius, beam_length, ray_length, t1] =
            exponents.map(|e| 10.0_f64.powf(e));
        let of = BeamRay3dBin {
            energy, sigma_t, speed, radius, beam_length, ray_length, t0: 0.0, t1,
            ray_direction: add(of.beam_direction, scale(of.ray_direction, 10.0_f64.powf(tilt))),
            ..of
        };
        for result in [beam_ray_3d_bins(&of), beam_ray_3d(&of.pair())] {
            prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
        }
    }
}
