use super::*;
use crate::numerics::quadrature::adaptive;
use proptest::prelude::*;

const SAMPLE: DiffusionSlab = DiffusionSlab {
    rho: 1.0,
    time: 10.0,
    mu_a: 0.0,
    mu_s_prime: 2.0,
    thickness: 5.0,
    eta: 1.0,
    speed: 1.0,
};

fn total(of: &DiffusionSlab) -> DiffusionSlabTotal {
    let &DiffusionSlab { time, mu_a, mu_s_prime, thickness, eta, speed, .. } = of;
    DiffusionSlabTotal { time, mu_a, mu_s_prime, thickness, eta, speed }
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn over_time(of: &DiffusionSlab, solution: fn(&DiffusionSlabTotal) -> Result<f64>) -> f64 {
    let at = |time: f64| solution(&DiffusionSlabTotal { time, ..total(of) }).unwrap();
    let unit = of.thickness * of.eta / of.speed;
    let breaks = [0.0, 0.01, 0.1, 0.5, 2.0, 10.0, 1e2, 1e3, 1e4].map(|t| t * unit);
    adaptive(at, &breaks, 1e-11).unwrap().value
}

#[test]
fn no_light_is_lost_without_absorption() {
    for eta in [0.8, 1.0, 1.5] {
        for mu_s_prime in [0.3, 2.0, 40.0] {
            let of = DiffusionSlab { mu_s_prime, eta, ..SAMPLE };
            let a = diffusion_boundary_parameter(&BoundaryParameter { eta }).unwrap();
            let (z0, ze) = (1.0 / mu_s_prime, 2.0 * a / (3.0 * mu_s_prime));
            let transmitted = over_time(&of, diffusion_slab_total_transmittance);
            close(transmitted, (z0 + ze) / (5.0 + 2.0 * ze), 1e-9);
            let reflected = over_time(&of, diffusion_slab_total_reflectance);
            close(reflected + transmitted, 1.0, 1e-9);
        }
    }
}

#[test]
fn images_and_modes_agree_where_both_converge() {
    for (near, far) in [(0.01, 0.05), (0.2, 0.3), (0.4, 0.9), (1e-9, 3e-9), (0.3, 1.0 - 1e-9)] {
        for a in [0.7, 1.0, 1.27, 1.6] {
            let images = Images { a, period: 1.0, near, far, to_back: 1.0 - far };
            for face in [Face::Front, Face::Back] {
                let value = |(factor, exponent): (f64, f64)| factor * (-exponent).exp();
                close(value(images.by_images(face)), value(images.by_modes(face)), 1e-12);
            }
        }
    }
}

#[test]
fn a_slab_without_end_is_a_half_space_with_its_boundary_outside() {
    // Only the source and its first image count early on.
    let of = DiffusionSlab { thickness: 1e4, time: 7.0, ..SAMPLE };
    let (z0, far) = (0.5, 0.5 + 4.0 / 6.0);
    let a = 4.0 * 7.0 / 6.0;
    let terms = [z0, far].map(|z: f64| z * (-z * z / a).exp());
    let expected = (terms[0] + terms[1]) * (-1.0 / a).exp() / (2.0 * (PI * a).powf(1.5) * 7.0);
    close(diffusion_slab_reflectance(&of).unwrap(), expected, 1e-13);
}

#[test]
fn early_and_late_light_is_finite() {
    let at = |time: f64| {
        let of = DiffusionSlab { time, ..SAMPLE };
        [diffusion_slab_reflectance(&of).unwrap(), diffusion_slab_transmittance(&of).unwrap()]
    };
    assert_eq!(at(-1.0), [0.0; 2]);
    assert_eq!(at(0.0), [0.0; 2]);
    assert_eq!(at(1e-300), [0.0; 2]);
    assert_eq!(at(1e300), [0.0; 2]);
    // Late light leaves both faces alike, to the last digit that the sum of images would lose.
    let [r, t] = at(2000.0);
    assert!(r > 0.0);
    close(r, t, 1e-12);
}

#[test]
fn inputs_without_meaning_are_errors() {
    for of in [
        DiffusionSlab { mu_s_prime: 0.2, ..SAMPLE },
        DiffusionSlab { mu_s_prime: 0.0, ..SAMPLE },
        DiffusionSlab { eta: 0.0, ..SAMPLE },
        DiffusionSlab { rho: -1.0, ..SAMPLE },
        DiffusionSlab { time: f64::NAN, ..SAMPLE },
        DiffusionSlab { speed: 0.0, ..SAMPLE },
    ] {
        assert!(diffusion_slab_transmittance(&of).is_err(), "{of:?}");
    }
}

proptest! {
    #[test]
    fn the_sum_over_rho_is_the_total(
        time in -2.0..3.0_f64, mu_a in 0.0..0.1_f64, eta in 0.8..2.0_f64,
    ) {
        let of = DiffusionSlab { time: 10.0_f64.powf(time), mu_a, eta, ..SAMPLE };
        let width = (of.time / of.mu_s_prime).sqrt();
        for (local, whole) in [
            (diffusion_slab_reflectance as fn(&_) -> _, diffusion_slab_total_reflectance as fn(&_) -> _),
            (diffusion_slab_transmittance, diffusion_slab_total_transmittance),
        ] {
            let ring = |rho: f64| 2.0 * PI * rho * local(&DiffusionSlab { rho, ..of }).unwrap();
            let sum = adaptive(ring, &[0.0, width, 4.0 * width, 16.0 * width], 1e-11).unwrap();
            let whole: f64 = whole(&total(&of)).unwrap();
            prop_assert!((sum.value - whole).abs() <= 1e-9 * whole + 1e-280, "{of:?}");
        }
    }

    #[test]
    fn lengths_and_times_scale(time in -2.0..3.0_f64, scale in 1e-6..1e6_f64) {
        let of = DiffusionSlab { time: 10.0_f64.powf(time), mu_a: 0.03, ..SAMPLE };
        let scaled = DiffusionSlab {
            rho: of.rho * scale,
            time: of.time * scale,
            thickness: of.thickness * scale,
            mu_a: of.mu_a / scale,
            mu_s_prime: of.mu_s_prime / scale,
            ..of
        };
        for solution in [diffusion_slab_reflectance, diffusion_slab_transmittance] {
            let (a, b) = (solution(&of).unwrap(), solution(&scaled).unwrap() * scale.powi(3));
            prop_assert!((a - b).abs() <= 1e-10 * a + 1e-280, "{a:e} {b:e}");
        }
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform7(-320.0..308.0_f64), depth in 0.0..9.0_f64,
    ) {
        let [rho, time, mu_a, mu_s_prime, thickness, eta, speed] =
            exponents.map(|e| 10.0_f64.powf(e));
        for (mu_s_prime, eta) in
            [(mu_s_prime, eta), (10.0_f64.powf(depth) / thickness, 1.3)]
        {
            for time in [time, thickness / speed] {
                let of = DiffusionSlab { rho, time, mu_a, mu_s_prime, thickness, eta, speed };
                for result in [
                    diffusion_slab_reflectance(&of),
                    diffusion_slab_transmittance(&of),
                    diffusion_slab_total_reflectance(&total(&of)),
                ] {
                    let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                    prop_assert!(result.as_ref().map_or(true, fine), "{of:?} {result:?}");
                }
            }
        }
    }
}
