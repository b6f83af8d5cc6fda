use super::*;
use crate::beams::beam_ray_sphere::{BeamRay3dBin, beam_ray_3d_bins};
use crate::numerics::quadrature::tanh_sinh;
use crate::numerics::vector::fibonacci_direction;
use crate::single_scattering::{SingleScatter, single_scatter_radiance};
use proptest::prelude::*;

const SAMPLE: Blur3d = Blur3d {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    g: 0.0,
    speed: 0.75,
    ray_offset: 1.0,
    source_z: 0.7,
    radius: 0.4,
    time: 2.0,
};

fn bin(of: &Blur3d, t0: f64, t1: f64) -> Blur3dBin {
    let &Blur3d { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, .. } = of;
    Blur3dBin { energy, sigma_s, sigma_t, g, speed, ray_offset, source_z, radius, t0, t1 }
}

fn in_bin(of: &Blur3d, t0: f64, t1: f64) -> f64 {
    expected_blur_3d_bins(&bin(of, t0, t1)).unwrap()
}

fn at(of: &Blur3d, time: f64) -> f64 {
    expected_blur_3d(&Blur3d { time, ..*of }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// Times of the onset and of the completion.
fn fronts(of: &Blur3d) -> (f64, f64) {
    let front = of.source_z.hypot(of.ray_offset);
    ((front - of.radius) / of.speed, (front + of.radius) / of.speed)
}

/// By points of the ray: the share of the sphere of radius ρ around the source that lies within R
/// of the ray's point at the distance D is (R² − (ρ − D)²)/(4ρD).
fn along_the_ray(of: &Blur3d, time: f64) -> f64 {
    let x = of.speed * time;
    let share = |s: f64| {
        let distance = of.ray_offset.hypot(s - of.source_z);
        let way = x - s;
        let (r, gap) = (of.radius, way - distance);
        if gap.abs() < r { (r - gap) * (r + gap) / (4.0 * way * distance) } else { 0.0 }
    };
    // gap = δ at w = ((q − δ) − b²/(q − δ))/2.
    let place = |delta: f64| {
        let k = x - of.source_z - delta;
        if k > 0.0 { of.source_z + 0.5 * (k - of.ray_offset.powi(2) / k) } else { 0.0 }
    };
    let (start, end) = (place(of.radius).max(0.0), place(-of.radius).max(0.0));
    let integral = tanh_sinh(|node| share(node.x), start, end, 1e-11).unwrap().value;
    let density = 3.0 / (4.0 * PI * of.radius.powi(3));
    of.energy * of.sigma_s * of.speed * (-of.sigma_t * x).exp() * density * integral / (4.0 * PI)
}

#[test]
fn isotropic_scattering_is_what_the_points_of_the_ray_see() {
    for radius in [0.01, 0.4, 0.999] {
        for source_z in [-2.0, 0.0, 0.7, 5.0] {
            let of = Blur3d { source_z, radius, ..SAMPLE };
            let (onset, complete) = fronts(&of);
            for share in [0.01, 0.5, 0.99, 1.01, 1.5, 4.0] {
                let time = onset + share * (complete - onset);
                close(at(&of, time), along_the_ray(&of, time), 1e-9);
            }
        }
    }
}

#[test]
fn peaked_scattering_without_a_peak_is_isotropic() {
    for share in [0.1, 0.7, 1.2, 3.0] {
        let (onset, complete) = fronts(&SAMPLE);
        let time = onset + share * (complete - onset);
        close(at(&Blur3d { g: 1e-13, ..SAMPLE }, time), at(&SAMPLE, time), 1e-10);
    }
}

/// The mean of the single scattering over a ball of sources, by a grid of cells.
#[test]
fn it_is_the_mean_over_a_ball_of_sources() {
    for (g, time, tolerance) in
        [(0.0, 3.0, 1e-4), (0.7, 3.0, 1e-4), (-0.6, 2.0, 2e-3), (0.9, 1.7, 2e-3)]
    {
        let of = Blur3d { g, time, ..SAMPLE };
        let cells = 100;
        let cell = 2.0 * of.radius / f64::from(cells);
        let place = |i: i32| (f64::from(i) + 0.5) * cell - of.radius;
        let (mut sum, mut count) = (0.0, 0);
        for (i, j, k) in (0..cells)
            .flat_map(|i| (0..cells).flat_map(move |j| (0..cells).map(move |k| (i, j, k))))
        {
            let [dx, dy, dz] = [i, j, k].map(place);
            if dx * dx + dy * dy + dz * dz >= of.radius * of.radius {
                continue;
            }
            let (b, z) = ((of.ray_offset + dx).hypot(dy), of.source_z + dz);
            count += 1;
            sum += single_scatter_radiance(&SingleScatter {
                energy: of.energy,
                sigma_s: of.sigma_s,
                sigma_t: of.sigma_t,
                g,
                speed: of.speed,
                source_distance: b.hypot(z),
                alpha: b.atan2(z),
                time,
            })
            .unwrap();
        }
        close(at(&of, time), sum / f64::from(count), tolerance);
    }
}

#[test]
fn the_integral_of_the_density_is_the_bin() {
    for (radius, g) in [(0.01, 0.0), (0.4, 0.0), (0.999, 0.0), (0.4, 0.6), (0.2, -0.9)] {
        for source_z in [-2.0, 0.7, 5.0] {
            let of = Blur3d { g, source_z, radius, ..SAMPLE };
            let (onset, complete) = fronts(&of);
            let integral: f64 = [(onset, complete), (complete, complete + 5.0)]
                .map(|(a, b)| tanh_sinh(|node| at(&of, node.x), a, b, 1e-9).unwrap().value)
                .iter()
                .sum();
            close(in_bin(&of, 0.0, complete + 5.0), integral, 1e-8);
        }
    }
}

#[test]
fn a_vanishing_sphere_gives_the_true_radiance() {
    let &Blur3d { energy, sigma_s, sigma_t, speed, ray_offset, source_z, time, .. } = &SAMPLE;
    let (source_distance, alpha) = (source_z.hypot(ray_offset), ray_offset.atan2(source_z));
    for g in [0.0, 0.6] {
        let sharp =
            SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time };
        let sharp = single_scatter_radiance(&sharp).unwrap();
        let bias = |radius: f64| at(&Blur3d { g, radius, ..SAMPLE }, time) / sharp - 1.0;
        assert!(bias(1e-7).abs() < 1e-11);
        close(bias(0.02) / bias(0.01), 4.0, 1e-2);
    }
}

#[test]
fn nothing_comes_before_the_onset() {
    let (onset, _) = fronts(&SAMPLE);
    assert_eq!(at(&SAMPLE, onset), 0.0);
    assert_eq!(in_bin(&SAMPLE, 0.0, onset), 0.0);
    assert!(at(&SAMPLE, onset * (1.0 + 1e-9)) > 0.0);
    assert_eq!(at(&SAMPLE, 1e4), 0.0);
}

/// What the beams of all directions bring to the camera ray.
#[test]
fn it_is_the_mean_over_all_beams() {
    let (onset, complete) = fronts(&SAMPLE);
    for (g, t0, t1) in
        [(0.0, onset, complete), (0.0, 2.0, 3.0), (0.7, onset, complete), (0.7, 2.5, 4.0)]
    {
        let of = Blur3d { g, ..SAMPLE };
        let beams = 200_000;
        let through_beam = |i| {
            beam_ray_3d_bins(&BeamRay3dBin {
                energy: of.energy,
                sigma_s: of.sigma_s,
                sigma_t: of.sigma_t,
                g,
                speed: of.speed,
                radius: of.radius,
                beam_origin: [of.ray_offset, 0.0, of.source_z],
                beam_direction: fibonacci_direction(i, beams),
                beam_length: 1e2,
                ray_origin: [0.0; 3],
                ray_direction: [0.0, 0.0, 1.0],
                ray_length: 1e2,
                t0,
                t1,
            })
            .unwrap()
        };
        let average = (0..beams).map(through_beam).sum::<f64>() / f64::from(beams);
        close(average, in_bin(&of, t0, t1), 3e-4);
    }
}

#[test]
fn a_sphere_that_reaches_the_source_is_outside_the_domain() {
    for radius in [1.0, 2.0, 0.0, f64::NAN] {
        assert!(expected_blur_3d(&Blur3d { radius, ..SAMPLE }).is_err());
        assert!(expected_blur_3d_bins(&bin(&Blur3d { radius, ..SAMPLE }, 0.0, 1.0)).is_err());
    }
}

prop_compose! {
    fn anywhere()(
        sigma_t in 0.0..5.0_f64,
        ray_offset in 0.05..3.0_f64,
        source_z in -5.0..5.0_f64,
        fraction in 1e-4..0.999_f64,
        time in 0.1..20.0_f64,
    ) -> Blur3d {
        Blur3d { sigma_t, ray_offset, source_z, radius: fraction * ray_offset, time, ..SAMPLE }
    }
}

proptest! {
    #[test]
    fn bins_add_up(of in anywhere(), splits in prop::array::uniform3(0.0..1.0_f64)) {
        let mut edges = [0.0, splits[0], splits[1], splits[2], 1.0].map(|x| x * of.time);
        edges.sort_by(f64::total_cmp);
        let sum: f64 = edges.windows(2).map(|bin| in_bin(&of, bin[0], bin[1])).sum();
        close(sum, in_bin(&of, 0.0, of.time), 1e-9);
    }

    #[test]
    fn absorption_acts_on_the_path_length_alone(of in anywhere(), sigma_a in 0.0..5.0_f64) {
        let absorbing = Blur3d { sigma_t: of.sigma_t + sigma_a, ..of };
        let factor = (-sigma_a * of.speed * of.time).exp();
        close(at(&absorbing, of.time), factor * at(&of, of.time), 1e-12);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform8(-320.0..308.0_f64),
        ahead in any::<bool>(),
        g in prop::sample::select(vec![0.0, 0.5]),
    ) {
        let [energy, sigma_t, speed, ray_offset, z, radius, time, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let source_z = if ahead { z } else { -z };
        let of = Blur3d { energy, sigma_t, g, speed, ray_offset, source_z, radius, time, ..SAMPLE };
        for result in [expected_blur_3d(&of), expected_blur_3d_bins(&bin(&of, time, time + width))] {
            prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
        }
    }
}
