use super::*;
use crate::error::{decades, is_sound};
use crate::single_scattering::{SingleScatter, single_scatter_radiance};
use proptest::prelude::*;

const SAMPLE: OnceScatteredHg = OnceScatteredHg {
    energy: 2.0,
    sigma_s: 0.8,
    sigma_t: 1.1,
    g: 0.6,
    speed: 1.0,
    r: 1.0,
    time: 1.3,
};

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} for {expected:e}");
}

fn isotropic(of: &OnceScatteredHg) -> OnceScattered {
    let &OnceScatteredHg { energy, sigma_s, sigma_t, speed, r, time, .. } = of;
    OnceScattered { energy, sigma_s, sigma_t, speed, r, time }
}

fn bin(of: &OnceScatteredHg, t0: f64, t1: f64) -> OnceScatteredBin {
    let &OnceScatteredHg { energy, sigma_s, sigma_t, speed, r, .. } = of;
    OnceScatteredBin { energy, sigma_s, sigma_t, speed, r, t0, t1 }
}

fn hg(of: &OnceScatteredHg) -> f64 {
    once_scattered_fluence_hg(of).unwrap()
}

fn in_bin(of: &OnceScatteredHg, t0: f64, t1: f64) -> f64 {
    once_scattered_fluence_bins(&bin(of, t0, t1)).unwrap()
}

fn steady(sigma_t: f64, r: f64) -> f64 {
    once_scattered_fluence_steady(&OnceScatteredSteady { sigma_s: 1.0, sigma_t, r }).unwrap()
}

/// ∫ radiance dΩ at the distance r from the source.
fn radiance_over_the_sphere(of: &OnceScatteredHg) -> f64 {
    let &OnceScatteredHg { energy, sigma_s, sigma_t, g, speed, r, time } = of;
    let integrand = |alpha: f64| {
        let input =
            SingleScatter { energy, sigma_s, sigma_t, g, speed, source_distance: r, alpha, time };
        2.0 * PI * alpha.sin() * single_scatter_radiance(&input).unwrap()
    };
    adaptive(integrand, &[0.0, 0.01, 0.3, PI], 1e-12).unwrap().value
}

#[test]
fn it_is_the_integral_of_the_radiance_over_all_directions() {
    for g in [-0.99, -0.6, 0.0, 0.5, 0.9, 0.99] {
        for (r, time) in [(1.0, 1.2), (0.3, 4.0), (5.0, 5.01), (1.0, 1.0 + 1e-6)] {
            let of = OnceScatteredHg { g, r, time, ..SAMPLE };
            close(hg(&of), radiance_over_the_sphere(&of), 1e-10);
        }
    }
}

#[test]
fn without_a_mean_cosine_it_is_the_closed_form() {
    for (r, time) in [(1e-9, 3.0), (1.0, 1.2), (1.0, 1.0_f64.next_up()), (1.0, 1e5)] {
        let of = OnceScatteredHg { g: 0.0, sigma_t: 1e-3, r, time, ..SAMPLE };
        close(hg(&of), once_scattered_fluence(&isotropic(&of)).unwrap(), 1e-12);
    }
}

#[test]
fn at_the_source_all_light_comes_back() {
    // 2 p(π) / x² per Q σs v.
    for g in [-0.99, -0.5, 0.0, 0.5, 0.99] {
        let backward = henyey_greenstein(g, Deflection { sin2_half: 1.0, cos2_half: 0.0 });
        let expected = 1.6 * (-1.1 * 1.3_f64).exp() * 2.0 * backward / 1.69;
        for r in [0.0, 1e-300, 1e-20, 1e-8] {
            close(hg(&OnceScatteredHg { g, r, ..SAMPLE }), expected, 1e-11);
        }
    }
}

#[test]
fn just_behind_the_front_light_goes_forward() {
    // p is p(0) almost everywhere in y: the isotropic value times 4π p(0), within 1/Y.
    let of = OnceScatteredHg { g: 0.3, time: 1.0_f64.next_up(), ..SAMPLE };
    let forward = 4.0 * PI * henyey_greenstein(0.3, Deflection { sin2_half: 0.0, cos2_half: 1.0 });
    let ratio = hg(&of) / once_scattered_fluence(&isotropic(&of)).unwrap();
    assert!(ratio < forward && ratio > 0.9 * forward, "{ratio} of {forward}");
}

#[test]
fn the_isotropic_fluence_at_the_source_is_the_limit() {
    let input =
        OnceScattered { energy: 1.0, sigma_s: 0.8, sigma_t: 1.0, speed: 1.0, r: 0.0, time: 1.3 };
    let centre = once_scattered_fluence(&input).unwrap();
    close(centre, 0.8 * (-1.3_f64).exp() / (2.0 * PI * 1.69), 1e-14);
    for r in [f64::from_bits(1), 1e-300, 1e-20, 1e-8] {
        close(once_scattered_fluence(&OnceScattered { r, ..input }).unwrap(), centre, 1e-12);
    }
}

#[test]
fn it_is_dark_before_infinite_on_and_finite_behind_the_front() {
    let at = |time: f64| {
        let of = OnceScatteredHg { r: 2.0, time, ..SAMPLE };
        (once_scattered_fluence(&isotropic(&of)), once_scattered_fluence_hg(&of))
    };
    let before = at(2.0_f64.next_down());
    assert_eq!((before.0.unwrap(), before.1.unwrap()), (0.0, 0.0));
    let front = at(2.0);
    assert!(front.0.is_err() && front.1.is_err());
    let behind = 2.0_f64.next_up();
    let expected = 1.6 * (-2.2_f64).exp() / (16.0 * PI) * (4.0 / (behind - 2.0)).ln();
    close(at(behind).0.unwrap(), expected, 1e-12);
    assert!(at(behind).1.unwrap() > 0.0);
}

#[test]
fn bins_meet_the_integral_of_the_rate() {
    let rate = |time: f64| once_scattered_fluence(&isotropic(&OnceScatteredHg { time, ..SAMPLE }));
    for (t0, t1) in [(1.0 + 1e-9, 1.0 + 1e-8), (1.2, 1.2 + 1e-7), (1.1, 9.0)] {
        let integral = adaptive(|t| rate(t).unwrap(), &[t0, t1], 1e-12).unwrap();
        close(in_bin(&SAMPLE, t0, t1), integral.value, 1e-8);
    }
}

/// ∫ ln((1 + u)/(1 − u))/u du from 0 to u: Li₂(u) − Li₂(−u), by its series.
fn dilogarithm_difference(u: f64) -> f64 {
    (0..2000).map(|k| 2.0 * u.powi(2 * k + 1) / f64::from(2 * k + 1).powi(2)).sum()
}

#[test]
fn bins_of_a_clear_medium_meet_the_dilogarithm() {
    let clear = OnceScatteredHg { sigma_t: 0.0, ..SAMPLE };
    let scale = 1.6 / (4.0 * PI);
    let until = |x: f64| PI * PI / 4.0 - dilogarithm_difference(1.0 / x);
    for x in [1.01, 1.5, 3.0] {
        close(in_bin(&clear, 0.5, x), scale * until(x), 1e-11);
    }
    close(in_bin(&clear, 1.0, 1e12), scale * PI * PI / 4.0, 1e-11);
}

#[test]
fn all_bins_together_are_the_steady_state() {
    for sigma_t in [1e-6, 0.01, 1.0, 30.0] {
        let of = OnceScatteredHg { energy: 1.0, sigma_s: 1.0, sigma_t, ..SAMPLE };
        close(in_bin(&of, 0.0, 1.0 + 800.0 / sigma_t), steady(sigma_t, 1.0), 1e-10);
    }
}

#[test]
fn the_steady_state_has_its_limits() {
    // Clear: σs π/(16 r). Energy: ∫ 4π r² φ dr = σs/σt².
    close(steady(0.0, 2.0), PI / 32.0, 1e-12);
    close(steady(1e-200, 2.0), PI / 32.0, 1e-12);
    assert_eq!(steady(1e3, 1.0), 0.0);
    let energy =
        adaptive(|r| 4.0 * PI * r * r * steady(1.5, r), &[1e-9, 0.1, 1.0, 5.0, 40.0], 1e-11);
    close(energy.unwrap().value, 1.0 / 2.25, 1e-9);
    for depth in [50.0_f64, 200.0, 700.0] {
        // e^(−τ)/(4π r²) · σs/(2 σt) … with ln(2τ) + γ for the integral, to first order.
        let euler = 0.577_215_664_901_532_9;
        let leading = (-depth).exp() / (4.0 * PI) * (f64::ln(2.0 * depth) + euler) / depth;
        close(steady(depth, 1.0), leading, 2.0 / depth);
    }
}

#[test]
fn the_moment_of_emission_at_the_source_is_outside_the_domain() {
    let centre = OnceScatteredHg { r: 0.0, ..SAMPLE };
    assert!(once_scattered_fluence_bins(&bin(&centre, -1.0, 1.0)).is_err());
    assert_eq!(in_bin(&centre, -2.0, -1.0), 0.0);
    let clear = OnceScatteredHg { sigma_t: 0.0, ..centre };
    // ∫ 2/x² dx.
    close(in_bin(&clear, 0.5, 2.0), 1.6 / (4.0 * PI) * 2.0 * (2.0 - 0.5), 1e-11);
    let near = OnceScatteredHg { r: 1e-12, ..clear };
    close(in_bin(&near, 0.5, 2.0), in_bin(&clear, 0.5, 2.0), 1e-11);
}

prop_compose! {
    fn anywhere()(
        depth in 0.0..100.0_f64,
        g in -0.99..0.99_f64,
        speed in 0.1..3.0_f64,
        log_r in -6.0..1.5_f64,
        log_delay in -9.0..2.0_f64,
    ) -> OnceScatteredHg {
        let r = 10.0_f64.powf(log_r);
        let time = r * (1.0 + 10.0_f64.powf(log_delay)) / speed;
        let sigma_t = depth / (speed * time);
        OnceScatteredHg { sigma_t, g, speed, r, time, ..SAMPLE }
    }
}

proptest! {
    #[test]
    fn bins_add_up(of in anywhere(), split in 0.001..0.999_f64, early in prop::bool::ANY) {
        let (t0, t2) = (if early { 0.0 } else { of.time }, 3.0 * of.time);
        let front = of.r / of.speed;
        let t1 = t0.max(front) + split * (t2 - t0.max(front));
        let parts = in_bin(&of, t0, t1) + in_bin(&of, t1, t2);
        close(parts, in_bin(&of, t0, t2), 1e-10);
    }

    #[test]
    fn lengths_scale_and_only_the_path_length_enters(
        of in anywhere(), power in -40..40_i32, eta_power in 0..3_i32,
    ) {
        // Powers of 2, so that the distance behind the front does not change by rounding.
        let (scale, eta) = (2.0_f64.powi(power), 2.0_f64.powi(eta_power));
        let scaled = OnceScatteredHg {
            sigma_s: of.sigma_s / scale,
            sigma_t: of.sigma_t / scale,
            speed: of.speed / eta,
            r: of.r * scale,
            time: of.time * scale * eta,
            ..of
        };
        close(hg(&scaled) * scale.powi(3) * eta, hg(&of), 1e-10);
        let (t0, t1) = (1.1 * of.time, 1.7 * of.time);
        let in_scaled = in_bin(&scaled, t0 * scale * eta, t1 * scale * eta);
        close(in_scaled * scale * scale, in_bin(&of, t0, t1), 1e-10);
    }

    #[test]
    fn absorption_acts_on_the_path_length_alone(of in anywhere(), depth in 0.0..100.0_f64) {
        let sigma_a = depth / (of.speed * of.time);
        let absorbing = OnceScatteredHg { sigma_t: of.sigma_t + sigma_a, ..of };
        let factor = (-sigma_a * of.speed * of.time).exp();
        close(hg(&absorbing), factor * hg(&of), 1e-10);
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in decades::<7>(),
        g in -1.1..1.1_f64,
    ) {
        let [energy, sigma_s, sigma_t, speed, r, t0, width] = exponents.map(|e| 10.0_f64.powf(e));
        let of = OnceScatteredHg { energy, sigma_s, sigma_t, g, speed, r, time: t0 };
        for result in [
            once_scattered_fluence(&isotropic(&of)),
            once_scattered_fluence_hg(&of),
            once_scattered_fluence_bins(&bin(&of, t0, t0 + width)),
            once_scattered_fluence_bins(&bin(&of, 0.0, width)),
            once_scattered_fluence_steady(&OnceScatteredSteady { sigma_s, sigma_t, r }),
        ] {
            prop_assert!(is_sound(&result, &exponents), "{result:?}");
        }
    }
}
