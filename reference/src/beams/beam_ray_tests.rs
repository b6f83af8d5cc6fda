use super::*;
use crate::numerics::quadrature::tanh_sinh;
use crate::numerics::vector::add;
use proptest::prelude::*;

const EVER: f64 = 1e6;

/// A ray that crosses a beam along x at right angles, at the height 0.03.
const CROSSING: BeamRay2dBin = BeamRay2dBin {
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

fn disc(of: &BeamRay2dBin) -> f64 {
    beam_ray_2d_bins(of).unwrap()
}

fn in_bin(of: &BeamRay2dBin, t0: f64, t1: f64) -> f64 {
    disc(&BeamRay2dBin { t0, t1, ..*of })
}

fn line(of: &BeamRay2dBin) -> BeamRay1d {
    let &BeamRay2dBin { sigma_s, sigma_t, g, radius, beam_length, ray_length, .. } = of;
    BeamRay1d {
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
    }
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// The definition: a sum over points of the ray of what the disc kernel gives each of them.
fn marched(of: &BeamRay2dBin, steps: u32) -> f64 {
    let d = unit("d", of.beam_direction).unwrap();
    let ray = unit("w", of.ray_direction).unwrap();
    let cosine = -dot(d, ray);
    let phase =
        (1.0 - of.g * of.g) / (4.0 * PI * (1.0 + of.g * of.g - 2.0 * of.g * cosine).powf(1.5));
    let step = of.ray_length / f64::from(steps);
    let sum: f64 = (0..steps)
        .map(|i| {
            let s = (f64::from(i) + 0.5) * step;
            let from_origin = subtract(add(of.ray_origin, scale(ray, s)), of.beam_origin);
            let foot = dot(from_origin, d);
            let distance = length(subtract(from_origin, scale(d, foot)));
            let path = foot + s;
            let seen = distance < of.radius
                && (0.0..=of.beam_length).contains(&foot)
                && (of.speed * of.t0..of.speed * of.t1).contains(&path);
            if seen { (-of.sigma_t * path).exp() * step } else { 0.0 }
        })
        .sum();
    of.energy * of.sigma_s * phase * sum / (PI * of.radius * of.radius)
}

#[test]
fn an_unclipped_crossing_meets_the_closed_form() {
    for ray_direction in [[0.0, 0.0, 1.0], [0.7, 0.0, 1.0], [-0.4, 0.0, 1.0]] {
        let of = BeamRay2dBin { ray_direction, ..CROSSING };
        let norm = length(ray_direction);
        let (sin_psi, kappa) = (ray_direction[2] / norm, 1.0 + ray_direction[0] / norm);
        let s_ray = 3.0 * norm;
        let s_beam = 2.0 + 3.0 * ray_direction[0];
        let half = (0.1_f64.powi(2) - 0.03_f64.powi(2)).sqrt() / sin_psi;
        let phase = (1.0 - 0.16) / (4.0 * PI * (1.16 + 0.8 * (kappa - 1.0)).powf(1.5));
        let expected = 1.5 * 0.8 * phase / (PI * 0.01)
            * (-1.2 * (s_beam + s_ray)).exp()
            * 2.0
            * (1.2 * kappa * half).sinh()
            / (1.2 * kappa);
        close(disc(&of), expected, 1e-12);
    }
}

#[test]
fn integrated_over_the_offset_both_kernels_agree_in_a_clear_medium() {
    for (ray_direction, radius) in [([0.0, 0.0, 1.0], 0.1), ([0.9, 0.0, 1.0], 0.4)] {
        let clear = BeamRay2dBin { sigma_t: 0.0, radius, ray_direction, ..CROSSING };
        let at_height = |h: f64| BeamRay2dBin { ray_origin: [2.0, h, -3.0], ..clear };
        let integral = |f: &dyn Fn(&BeamRay2dBin) -> f64| {
            tanh_sinh(|node| f(&at_height(node.x)), -radius, radius, 1e-9).unwrap().value
        };
        let of_line = integral(&|of| beam_ray_1d(&line(of)).unwrap());
        let of_disc = integral(&|of| of.energy.recip() * disc(of));
        close(of_disc, of_line, 1e-8);
    }
}

#[test]
fn a_ray_into_the_beam_receives_everything_at_one_instant() {
    let of = BeamRay2dBin {
        ray_origin: [10.0, 0.05, 0.0],
        ray_direction: [-1.0, 0.0, 0.0],
        speed: 1.0,
        ..CROSSING
    };
    let peak = henyey_greenstein(0.4, Deflection { sin2_half: 0.0, cos2_half: 1.0 });
    let expected = 1.5 * 0.8 * peak / (PI * 0.01) * (-12.0_f64).exp() * 8.0;
    close(in_bin(&of, 10.0, 10.0_f64.next_up()), expected, 1e-13);
    assert_eq!(in_bin(&of, 9.0, 10.0), 0.0);
    assert_eq!(in_bin(&of, 10.0_f64.next_up(), 11.0), 0.0);
    assert_eq!(beam_ray_1d(&line(&of)).unwrap(), 0.0);
}

#[test]
fn almost_parallel_pairs_tend_to_the_parallel_ones() {
    for along in [1.0, -1.0] {
        let origin = if along > 0.0 { [-1.0, 0.0, 0.05] } else { [10.0, 0.0, 0.05] };
        let tilted = |tilt: f64| {
            let ray_direction = [along, tilt, 0.0];
            disc(&BeamRay2dBin { ray_origin: origin, ray_direction, ..CROSSING })
        };
        for tilt in [1e-8, 1e-12, 1e-100, 1e-200] {
            close(tilted(tilt), tilted(0.0), 1e-13_f64.max(100.0 * tilt));
        }
    }
}

#[test]
fn grazing_and_missing_rays_see_nothing_of_a_cylinder() {
    let at_height = |h: f64| BeamRay2dBin { ray_origin: [2.0, h, -3.0], ..CROSSING };
    assert_eq!(disc(&at_height(0.1)), 0.0);
    assert_eq!(beam_ray_1d(&line(&at_height(0.1))).unwrap(), 0.0);
    assert_eq!(disc(&at_height(-7.0)), 0.0);
    assert!(disc(&at_height(0.1_f64.next_down())) > 0.0);
    // Through the axis: an offset of exactly 0.
    assert!(disc(&at_height(0.0)) > disc(&at_height(0.01)));
}

#[test]
fn rays_and_beams_that_end_in_time_see_nothing() {
    let short_ray = BeamRay2dBin { ray_length: 2.8, ..CROSSING };
    assert_eq!(disc(&short_ray), 0.0);
    assert_eq!(beam_ray_1d(&line(&short_ray)).unwrap(), 0.0);
    let short_beam = BeamRay2dBin { beam_length: 1.8, ..CROSSING };
    assert_eq!(disc(&short_beam), 0.0);
    assert_eq!(beam_ray_1d(&line(&short_beam)).unwrap(), 0.0);
    // A ray that ends in the middle of the cylinder keeps the near half.
    let half = BeamRay2dBin { ray_length: 3.0, sigma_t: 0.0, ..CROSSING };
    close(disc(&half), 0.5 * disc(&BeamRay2dBin { sigma_t: 0.0, ..CROSSING }), 1e-12);
}

#[test]
fn inputs_without_meaning_are_errors() {
    for broken in [
        BeamRay2dBin { radius: 0.0, ..CROSSING },
        BeamRay2dBin { beam_direction: [0.0; 3], ..CROSSING },
        BeamRay2dBin { ray_origin: [f64::NAN, 0.0, 0.0], ..CROSSING },
        BeamRay2dBin { ray_length: f64::INFINITY, ..CROSSING },
        BeamRay2dBin { g: 1.0, ..CROSSING },
    ] {
        assert!(beam_ray_2d_bins(&broken).is_err());
        assert!(beam_ray_1d(&line(&broken)).is_err());
    }
}

fn vector(range: std::ops::Range<f64>) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(range)
}

prop_compose! {
    /// A ray that is likely to pass through the cylinder.
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
    ) -> BeamRay2dBin {
        let beam_origin = [0.3, -0.2, 0.1];
        let d = unit("d", beam_direction).unwrap_or([1.0, 0.0, 0.0]);
        let ray = unit("w", ray_direction).unwrap_or([0.0, 1.0, 0.0]);
        let meeting = add(add(beam_origin, scale(d, on_beam)), miss);
        BeamRay2dBin {
            energy: 1.0, sigma_s: 0.8, sigma_t, g, speed: 0.7, radius, beam_origin,
            beam_direction: scale(d, 3.0), beam_length,
            ray_origin: subtract(meeting, scale(ray, on_ray)),
            ray_direction: scale(ray, 0.2), ray_length, t0: -EVER, t1: EVER,
        }
    }
}

/// The vector rotated by fixed angles about two axes.
fn rotated(v: Vector) -> Vector {
    let (s, c) = 0.83_f64.sin_cos();
    let v = [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]];
    let (s, c) = 2.1_f64.sin_cos();
    [v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]]
}

proptest! {
    #[test]
    fn the_disc_kernel_is_what_marching_finds(of in pair(), t0 in 0.0..4.0_f64, width in 0.2..4.0_f64) {
        let of = BeamRay2dBin { t0, t1: t0 + width, ..of };
        let steps = 20_000;
        // At most six ends of intervals, each wrong by half a step of the largest contribution.
        let phase = (1.0 + of.g.abs()) / (4.0 * PI * (1.0 - of.g.abs()).powi(2));
        let step = of.ray_length / f64::from(steps);
        let bound = 3.0 * step * 0.8 * phase / (PI * of.radius * of.radius);
        prop_assert!((disc(&of) - marched(&of, steps)).abs() <= bound * (-of.sigma_t * of.speed * t0).exp());
    }

    #[test]
    fn bins_add_up(of in pair(), times in prop::array::uniform3(-1.0..9.0_f64)) {
        let mut edges = [-EVER, times[0], times[1], times[2], EVER];
        edges.sort_by(f64::total_cmp);
        let sum: f64 = edges.windows(2).map(|bin| in_bin(&of, bin[0], bin[1])).sum();
        close(sum, disc(&of), 1e-11);
    }

    #[test]
    fn a_rotation_changes_nothing(of in pair()) {
        let turned = BeamRay2dBin {
            beam_origin: rotated(of.beam_origin),
            beam_direction: rotated(of.beam_direction),
            ray_origin: rotated(of.ray_origin),
            ray_direction: rotated(of.ray_direction),
            ..of
        };
        // Grazing pairs lose digits to the rotation itself.
        let scale = 1.0 / (of.radius * of.radius * (1.0 - of.g.abs()).powi(2));
        prop_assert!((disc(&turned) - disc(&of)).abs() <= 1e-9 * disc(&of) + 1e-13 * scale);
    }

    #[test]
    fn lengths_scale(of in pair(), factor in 0.01..100.0_f64) {
        let scaled = BeamRay2dBin {
            sigma_s: of.sigma_s / factor,
            sigma_t: of.sigma_t / factor,
            radius: of.radius * factor,
            beam_origin: scale(of.beam_origin, factor),
            beam_length: of.beam_length * factor,
            ray_origin: scale(of.ray_origin, factor),
            ray_length: of.ray_length * factor,
            ..of
        };
        let bound = 1e-12 / (of.radius * of.radius * (1.0 - of.g.abs()).powi(2));
        prop_assert!((disc(&scaled) * factor * factor - disc(&of)).abs() <= 1e-9 * disc(&of) + bound);
    }

    #[test]
    fn beam_and_ray_may_be_exchanged_in_the_1d_kernel(of in pair()) {
        let forward = line(&of);
        let exchanged = BeamRay1d {
            beam_origin: of.ray_origin, beam_direction: of.ray_direction,
            beam_length: of.ray_length, ray_origin: of.beam_origin,
            ray_direction: of.beam_direction, ray_length: of.beam_length, ..forward
        };
        close(beam_ray_1d(&exchanged).unwrap(), beam_ray_1d(&forward).unwrap(), 1e-9);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        of in pair(),
        exponents in prop::array::uniform7(-320.0..308.0_f64),
        tilt in -300.0..0.0_f64,
    ) {
        let [energy, sigma_t, speed, radius, beam_length, ray_length, t1] =
            exponents.map(|e| 10.0_f64.powf(e));
        let of = BeamRay2dBin {
            energy, sigma_t, speed, radius, beam_length, ray_length, t0: 0.0, t1,
            ray_direction: add(of.beam_direction, scale(of.ray_direction, 10.0_f64.powf(tilt))),
            ..of
        };
        for result in [beam_ray_2d_bins(&of), beam_ray_1d(&line(&of))] {
            prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
        }
    }
}
