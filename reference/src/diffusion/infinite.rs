//! Diffusion from a point pulse in an infinite medium.
//!
//! With the path length x = v t and k = 3 μs'/(4 x) = 1/(4 D t), the fluence rate per energy is
//!
//! > φ(r, t) = v (k/π)^(3/2) e^(−k r² − μa x)
//!
//! \[W/(m² J)\], the Green's function of the diffusion equation (Patterson, Chance and Wilson,
//! Appl. Opt. 28, 2331 (1989)). It is summed as one exponent ([`exponential`]): neither
//! the power at early times nor the exponential overflows or underflows alone.
//!
//! Approximate: it is acausal (light beyond r = v t), and good to some per cent only after several
//! 1/μs' of path. Domain: μs' > 0. Nothing before t = 0; at t = 0 and r = 0 it is infinite.

use crate::error::{Result, finite_result, non_negative, path_length, positive};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`diffusion_infinite`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiffusionInfinite {
    /// Distance from the source \[m\].
    pub r: f64,
    /// Time since the emission \[s\].
    pub time: f64,
    /// Absorption coefficient \[1/m\].
    pub mu_a: f64,
    /// Reduced scattering coefficient \[1/m\].
    pub mu_s_prime: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
}

/// The fluence rate \[W/(m² J)\] by diffusion.
pub fn diffusion_infinite(input: &DiffusionInfinite) -> Result<f64> {
    let &DiffusionInfinite { r, time, mu_a, mu_s_prime, speed } = input;
    let path = check_medium(time, mu_a, mu_s_prime, speed)?;
    non_negative("r", r)?;
    if path <= 0.0 && (r > 0.0 || time < 0.0) {
        return Ok(0.0);
    }
    let logarithm = speed.ln() + 1.5 * log_inverse_width(mu_s_prime, path);
    let spread = spread(r, mu_s_prime, path);
    finite_result("diffusion_infinite", exponential(logarithm, spread + mu_a * path))
}

/// The path length v t of inputs that make sense.
pub(super) fn check_medium(time: f64, mu_a: f64, mu_s_prime: f64, speed: f64) -> Result<f64> {
    non_negative("mu_a", mu_a)?;
    positive("mu_s_prime", mu_s_prime)?;
    path_length(speed, time)
}

/// ln(k/π), for any finite inputs.
pub(super) fn log_inverse_width(mu_s_prime: f64, path: f64) -> f64 {
    (0.75 / PI).ln() + mu_s_prime.ln() - path.ln()
}

/// k r², without overflow or underflow on the way.
pub(super) fn spread(r: f64, mu_s_prime: f64, path: f64) -> f64 {
    let root = r / path.sqrt() * (0.75 * mu_s_prime).sqrt();
    root * root
}

/// e^(growth − decay), where the decay may be infinite.
pub(super) fn exponential(growth: f64, decay: f64) -> f64 {
    if decay == f64::INFINITY { 0.0 } else { (growth - decay).exp() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;
    use proptest::prelude::*;

    const SAMPLE: DiffusionInfinite =
        DiffusionInfinite { r: 1.0, time: 4.0, mu_a: 0.1, mu_s_prime: 10.0, speed: 0.5 };

    fn at(of: DiffusionInfinite) -> f64 {
        diffusion_infinite(&of).unwrap()
    }

    #[test]
    fn energy_decays_by_absorption_and_spreads_by_diffusion() {
        let path: f64 = 2.0;
        let moment = |power: i32| {
            let shell =
                |r: f64| 4.0 * PI * r.powi(2 + power) * at(DiffusionInfinite { r, ..SAMPLE });
            adaptive(shell, &[0.0, 1.0, 6.0], 1e-12).unwrap().value / SAMPLE.speed
        };
        let energy = (-0.1 * path).exp();
        assert!((moment(0) / energy - 1.0).abs() < 1e-10);
        // ⟨r²⟩ = 6 D t.
        assert!((moment(2) / (energy * 6.0 * path / 30.0) - 1.0).abs() < 1e-10);
    }

    #[test]
    fn the_beginning() {
        assert_eq!(at(DiffusionInfinite { time: 0.0, ..SAMPLE }), 0.0);
        assert_eq!(at(DiffusionInfinite { time: -1.0, r: 0.0, ..SAMPLE }), 0.0);
        assert!(diffusion_infinite(&DiffusionInfinite { time: 0.0, r: 0.0, ..SAMPLE }).is_err());
        // The power overflows alone, the product does not.
        assert_eq!(at(DiffusionInfinite { time: 1e-300, ..SAMPLE }), 0.0);
        assert!(at(DiffusionInfinite { time: 1e-200, r: 0.0, ..SAMPLE }) > 1e290);
        assert!(at(DiffusionInfinite { time: 1e200, mu_a: 0.0, ..SAMPLE }) > 0.0);
        assert_eq!(at(DiffusionInfinite { time: 1e200, ..SAMPLE }), 0.0);
    }

    proptest! {
        #[test]
        fn wild_inputs_give_a_value_or_an_error(
            exponents in prop::array::uniform5(-320.0..308.0_f64),
        ) {
            let [r, time, mu_a, mu_s_prime, speed] = exponents.map(|e| 10.0_f64.powf(e));
            for (r, mu_a) in [(r, mu_a), (0.0, 0.0)] {
                let of = DiffusionInfinite { r, time, mu_a, mu_s_prime, speed };
                let result = diffusion_infinite(&of);
                let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                prop_assert!(result.as_ref().map_or(true, fine), "{of:?} {result:?}");
            }
        }
    }
}
