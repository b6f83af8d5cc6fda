//! The point pulse in media of two, three and four dimensions, after Paasschens.
//!
//! Paasschens ("Solution of the time-dependent Boltzmann equation", Phys. Rev. E 56, 1135, 1997)
//! gives the density of scattered light around an isotropic point pulse with isotropic scattering, in
//! units of the mean free path with v = 1 and no absorption:
//!
//! * two dimensions, exact: e^(√(t² − r²) − t) / (2π t √(1 − r²/t²)); infinite on the front;
//! * four dimensions, exact: (2 + t (1 − r²/t²)) e^(−r²/t) / (π² t³);
//! * three dimensions, **an interpolation between the two**: with w = 1 − r²/t² and x = t w^(3/4),
//!   w^(1/8) e^(x − t) √(1 + 2.026/x) / (4πt/3)^(3/2); infinite on the front, where it is wrong.
//!
//! Scaling: the density of a medium of dimension d is σtᵈ times that at σt r and σt v t, and times e^(−σa v t)
//! for σs in place of σt. Density times v is the fluence rate. The three-dimensional form deviates
//! from the exact point pulse ([`point_pulse_fluence`](super::point_pulse_fluence)) by
//! [`VALIDITY_3D`]; do not use it as a reference below 5 %.
//!
//! # Stable form
//!
//! √(t² − r²) − t = −r²/(t + √(t² − r²)); x − t = t expm1(¾ ln w); w^(1/8) √(1 + 2.026/x) = w^(−1/4) √((x + 2.026)/t).

use crate::error::{Result, finite_result, non_negative, positive, require};
use serde::Deserialize;
use std::f64::consts::PI;

/// How well the three-dimensional form holds, measured against the exact solution.
pub const VALIDITY_3D: &str = "collided part within 5 % for times up to 4 mean free paths and r up to \
    0.95 t; worse near the front (+31 % at r = 0.999 t, unbounded on it) and, at late times, where \
    there is little light (+23 % at 20 mean free paths and r = 0.9 t)";

/// Inputs of the solutions of Paasschens.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paasschens {
    /// Distance from the source \[mean free paths\].
    pub r: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
}

/// The density of scattered light in two dimensions \[1/mfp²\]; exact.
pub fn paasschens_2d(input: &Paasschens) -> Result<f64> {
    let Some(Front { r, t, w }) = Front::behind(input)? else { return Ok(0.0) };
    require(w > 0.0, "time", t, "other than the arrival of the wavefront")?;
    let root = w.sqrt();
    // √(t² − r²) = t √w.
    let exponent = -r * (r / t) / (1.0 + root);
    finite_result("paasschens_2d_4d", exponent.exp() / (2.0 * PI * t * root))
}

/// The density of scattered light in four dimensions \[1/mfp⁴\]; exact.
pub fn paasschens_4d(input: &Paasschens) -> Result<f64> {
    let Some(Front { r, t, w }) = Front::behind(input)? else { return Ok(0.0) };
    let value = (2.0 + t * w) * (-r * (r / t)).exp() / (PI * PI) / t / t / t;
    finite_result("paasschens_2d_4d", value)
}

/// The density of scattered light in three dimensions \[1/mfp³\]; **approximate**.
pub fn paasschens_3d(input: &Paasschens) -> Result<f64> {
    let Some(Front { r, t, w }) = Front::behind(input)? else { return Ok(0.0) };
    require(w > 0.0, "time", t, "other than the arrival of the wavefront")?;
    let eta = r / t;
    let log_w = if eta < 0.5 { (-eta * eta).ln_1p() } else { w.ln() };
    let x = t * (0.75 * log_w).exp();
    let exponent = t * (0.75 * log_w).exp_m1();
    let shape = (-0.25 * log_w).exp() * ((x + 2.026) / t).sqrt();
    let spread = (4.0 * PI / 3.0 * t).sqrt();
    finite_result("paasschens_3d", shape * exponent.exp() / spread / spread / spread)
}

struct Front {
    r: f64,
    t: f64,
    /// 1 − r²/t².
    w: f64,
}

impl Front {
    /// The checked inputs, or `None` before the front.
    fn behind(input: &Paasschens) -> Result<Option<Self>> {
        let &Paasschens { r, time: t } = input;
        non_negative("r", r)?;
        positive("time", t)?;
        Ok((r <= t).then(|| Self { r, t, w: ((t - r) / t) * (1.0 + r / t) }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;
    use proptest::prelude::*;

    fn at(solution: fn(&Paasschens) -> Result<f64>, r: f64, time: f64) -> f64 {
        solution(&Paasschens { r, time }).unwrap()
    }

    #[test]
    fn the_exact_densities_hold_all_scattered_light() {
        for t in [1e-3, 0.3, 2.0, 30.0_f64] {
            let scattered = -(-t).exp_m1();
            let solid = |r: f64| 2.0 * PI * PI * r * r * r * at(paasschens_4d, r, t);
            let solid = adaptive(solid, &[0.0, t.min(1.0), t], 1e-12).unwrap().value;
            assert!((solid / scattered - 1.0).abs() < 1e-11, "{solid} for {scattered}");
            // Within r, the integral of the plane density is 1 − e^(√(t² − r²) − t).
            let r = 0.9 * t;
            let within = -((t * t - r * r).sqrt() - t).exp_m1();
            let plane = |r: f64| 2.0 * PI * r * at(paasschens_2d, r, t);
            let plane = adaptive(plane, &[0.0, r], 1e-12).unwrap().value;
            assert!((plane / within - 1.0).abs() < 1e-11, "{plane} for {within}");
        }
    }

    #[test]
    fn the_interpolation_is_one_of_diffusion_at_late_times() {
        let (r, t) = (30.0_f64, 1e5_f64);
        let diffusion = (-3.0 * r * r / (4.0 * t)).exp() / (4.0 * PI * t / 3.0_f64).powf(1.5);
        assert!((at(paasschens_3d, r, t) / diffusion - 1.0).abs() < 1e-4);
    }

    #[test]
    fn fronts_are_dark_before_and_infinite_or_finite_on() {
        for solution in [paasschens_2d, paasschens_3d, paasschens_4d] {
            assert_eq!(at(solution, 2.0, 2.0_f64.next_down()), 0.0);
            assert!(at(solution, 2.0, 2.0_f64.next_up()) > 0.0);
            assert!(solution(&Paasschens { r: 1.0, time: 0.0 }).is_err());
            assert!(solution(&Paasschens { r: -1.0, time: 1.0 }).is_err());
        }
        assert!(paasschens_2d(&Paasschens { r: 2.0, time: 2.0 }).is_err());
        assert!(paasschens_3d(&Paasschens { r: 2.0, time: 2.0 }).is_err());
        let expected = 2.0 * (-2.0_f64).exp() / (8.0 * PI * PI);
        assert!((at(paasschens_4d, 2.0, 2.0) / expected - 1.0).abs() < 1e-14);
    }

    proptest! {
        #[test]
        fn wild_inputs_give_a_value_or_an_error(exponents in prop::array::uniform2(-320.0..308.0_f64)) {
            let [r, time] = exponents.map(|e| 10.0_f64.powf(e));
            for solution in [paasschens_2d, paasschens_3d, paasschens_4d] {
                let result = solution(&Paasschens { r, time });
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
            }
        }
    }
}
