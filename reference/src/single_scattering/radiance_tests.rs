use super::*;
use crate::error::{decades, is_sound};
use crate::numerics::quadrature::{adaptive, tanh_sinh};
use proptest::prelude::*;

const SAMPLE: SingleScatter = SingleScatter {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    g: 0.6,
    speed: 0.75,
    source_distance: 1.5,
    alpha: 0.7,
    time: 2.6,
};

fn bin(of: &SingleScatter, t0: f64, t1: f64) -> SingleScatterBin {
    let &SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, .. } = of;
    SingleScatterBin { energy, sigma_s, sigma_t, g, speed, source_distance, alpha, t0, t1 }
}

fn in_bin(of: &SingleScatter, t0: f64, t1: f64) -> f64 {
    single_scatter_radiance_bins(&bin(of, t0, t1)).unwrap()
}

fn at(of: &SingleScatter, time: f64) -> f64 {
    single_scatter_radiance(&SingleScatter { time, ..*of }).unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

/// ∫ σs p Q e^(−σt (s + r)) / (4π r²) ds along the ray: the definition, with vectors.
fn steady_state_along_the_ray(of: &SingleScatter) -> f64 {
    let (z, b) = (of.source_distance * of.alpha.cos(), of.source_distance * of.alpha.sin());
    let integrand = |s: f64| {
        let r = (s - z).hypot(b);
        let cosine = (z - s) / r;
        let phase =
            (1.0 - of.g * of.g) / (4.0 * PI * (1.0 + of.g * of.g - 2.0 * of.g * cosine).powf(1.5));
        of.sigma_s * phase * of.energy * (-of.sigma_t * (s + r)).exp() / (4.0 * PI * r * r)
    };
    let far = z.abs() + 40.0 / of.sigma_t;
    adaptive(integrand, &[0.0, z.max(0.0), far], 1e-12).unwrap().value
}

#[test]
fn all_time_is_the_steady_state_of_the_definition() {
    for g in [-0.9, 0.0, 0.6, 0.95] {
        for alpha in [0.05, 1.0, 2.0, 3.1] {
            let of = SingleScatter { g, alpha, ..SAMPLE };
            close(in_bin(&of, 0.0, 1e4), steady_state_along_the_ray(&of), 1e-9);
        }
    }
}

#[test]
fn the_integral_of_the_radiance_is_the_bin() {
    for g in [-0.99, -0.3, 0.0, 0.5, 0.99] {
        let of = SingleScatter { g, alpha: 0.02, ..SAMPLE };
        let front = of.source_distance / of.speed;
        let time_integral =
            tanh_sinh(|node| at(&of, front + node.from_start), front, 4.0, 1e-11).unwrap();
        close(in_bin(&of, 0.0, 4.0), time_integral.value, 1e-9);
    }
}

#[test]
fn the_front_belongs_to_the_light() {
    // q² + b² = 4 D² sin²(α/2) and θ = α at the front.
    let of = SingleScatter { g: 0.0, ..SAMPLE };
    let front = of.source_distance / of.speed;
    let chord = 2.0 * of.source_distance * (of.alpha / 2.0).sin();
    let transmittance = (-of.sigma_t * of.source_distance).exp();
    let expected =
        of.energy * of.sigma_s * of.speed * transmittance / (8.0 * PI * PI * chord * chord);
    close(at(&of, front), expected, 1e-14);
    assert_eq!(at(&of, front.next_down()), 0.0);
    assert_eq!(in_bin(&of, 0.0, front), 0.0);
    assert!(in_bin(&of, 0.0, front * (1.0 + 1e-12)) > 0.0);
}

#[test]
fn on_the_line_of_the_source_only_the_front_is_infinite() {
    let ahead = SingleScatter { alpha: 0.0, g: 0.0, sigma_t: 0.0, speed: 1.0, ..SAMPLE };
    assert!(single_scatter_radiance(&SingleScatter { time: 1.5, ..ahead }).is_err());
    assert!(single_scatter_radiance_bins(&bin(&ahead, 1.0, 2.0)).is_err());
    // ∫ dq / q², with q = x − D ahead and q = x + D behind.
    let scale = ahead.energy * ahead.sigma_s / (8.0 * PI * PI);
    close(in_bin(&ahead, 2.0, 3.5), scale * (1.0 / 0.5 - 1.0 / 2.0), 1e-10);
    let behind = SingleScatter { alpha: PI, ..ahead };
    close(in_bin(&behind, 0.0, 3.5), scale * (1.0 / 3.0 - 1.0 / 5.0), 1e-10);
}

#[test]
fn small_angles_tend_to_the_limit() {
    for g in [-0.99, 0.0, 0.99] {
        let zero = SingleScatter { alpha: 0.0, g, ..SAMPLE };
        for alpha in [1e-9, 1e-40, 1e-100] {
            let small = SingleScatter { alpha, ..zero };
            close(at(&small, 2.6), at(&zero, 2.6), 1e-12);
            close(in_bin(&small, 2.1, 9.0), in_bin(&zero, 2.1, 9.0), 1e-9);
        }
    }
    // With the front, the energy diverges as 1/b: Q σs ∫ p dθ / (4π b) over the half circle.
    let of = SingleScatter { alpha: 1e-8, g: 0.0, sigma_t: 0.0, ..SAMPLE };
    let expected = of.energy * of.sigma_s * PI / (16.0 * PI * PI * 1.5e-8);
    close(in_bin(&of, 0.0, 1e6), expected, 1e-7);
}

#[test]
fn great_optical_depths_and_late_times_end_in_zero() {
    let depth_50 = SingleScatter { sigma_t: 50.0 / 3.0, g: 0.0, ..SAMPLE };
    let clear = SingleScatter { sigma_t: 0.0, ..depth_50 };
    close(at(&depth_50, 4.0), at(&clear, 4.0) * (-50.0_f64).exp(), 1e-13);
    assert_eq!(at(&SAMPLE, 1e4), 0.0);
    assert_eq!(in_bin(&SAMPLE, 1e4, 1e300), 0.0);
    assert!(at(&clear, 1e100) > 0.0);
    assert_eq!(at(&clear, 1e200), 0.0);
}

prop_compose! {
    fn anywhere()(
        sigma_t in 0.0..5.0_f64,
        g in -0.99..0.99_f64,
        speed in 0.1..3.0_f64,
        source_distance in 0.01..10.0_f64,
        log_alpha in -6.0..0.49_f64,
        delay in 1.0..4.0_f64,
    ) -> SingleScatter {
        let time = delay * source_distance / speed;
        let alpha = 10.0_f64.powf(log_alpha);
        SingleScatter { energy: 1.0, sigma_s: 0.8, sigma_t, g, speed, source_distance, alpha, time }
    }
}

proptest! {
    #[test]
    fn isotropic_bins_of_a_clear_medium_are_an_angle(of in anywhere(), width in 1e-3..50.0_f64) {
        let of = SingleScatter { g: 0.0, sigma_t: 0.0, ..of };
        let (z, b) = (of.source_distance * of.alpha.cos(), of.source_distance * of.alpha.sin());
        let theta = |t: f64| 2.0 * (of.speed * t - z).atan2(b);
        let expected = 0.8 * (theta(of.time + width) - theta(of.time)) / (16.0 * PI * PI * b);
        // The angle itself is a difference; allow it its own rounding.
        let error = (in_bin(&of, of.time, of.time + width) - expected).abs();
        prop_assert!(error <= 1e-9 * expected + 1e-15 / b, "{error:e} of {expected:e}");
    }

    #[test]
    fn bins_add_up(of in anywhere(), split in 0.01..0.99_f64) {
        let (t0, t2) = (0.9 * of.time, 2.0 * of.time);
        let t1 = t0 + split * (t2 - t0);
        let whole = in_bin(&of, t0, t2);
        close(in_bin(&of, t0, t1) + in_bin(&of, t1, t2), whole, 1e-10);
    }

    #[test]
    fn absorption_acts_on_the_path_length_alone(of in anywhere(), sigma_a in 0.0..5.0_f64) {
        let absorbing = SingleScatter { sigma_t: of.sigma_t + sigma_a, ..of };
        let factor = (-sigma_a * of.speed * of.time).exp();
        close(at(&absorbing, of.time), factor * at(&of, of.time), 1e-12);
    }

    #[test]
    fn lengths_and_times_scale(of in anywhere(), scale in 0.01..100.0_f64) {
        let scaled = SingleScatter {
            sigma_s: of.sigma_s / scale,
            sigma_t: of.sigma_t / scale,
            source_distance: of.source_distance * scale,
            ..of
        };
        let (t0, t1) = (1.1 * of.time, 1.7 * of.time);
        close(in_bin(&scaled, t0 * scale, t1 * scale) * scale * scale, in_bin(&of, t0, t1), 1e-9);
    }

    #[test]
    fn only_the_path_length_enters(of in anywhere(), eta in 1.0..3.0_f64) {
        let slower = SingleScatter { speed: of.speed / eta, ..of };
        let (t0, t1) = (1.1 * of.time, 1.7 * of.time);
        close(in_bin(&slower, t0 * eta, t1 * eta), in_bin(&of, t0, t1), 1e-9);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<7>(),
        g in -1.1..1.1_f64,
        alpha in -0.1..3.3_f64,
    ) {
        let [energy, sigma_s, sigma_t, speed, source_distance, t0, width] =
            exponents.map(|e| 10.0_f64.powf(e));
        let of = SingleScatter {
            energy, sigma_s, sigma_t, g, speed, source_distance, alpha, time: t0,
        };
        for result in [
            single_scatter_radiance(&of),
            single_scatter_radiance_bins(&bin(&of, t0, t0 + width)),
        ] {
            prop_assert!(is_sound(&result, &exponents), "{result:?}");
        }
    }
}
