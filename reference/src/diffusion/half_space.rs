//! Diffuse reflectance of a half-space.
//!
//! A pencil pulse enters at ρ = 0; its light is taken to start at the depth z0 = 1/μs', below a
//! plane where the fluence is 0. The flux out through the plane per area, time and energy is
//! (Patterson, Chance and Wilson, Appl. Opt. 28, 2331 (1989), equation 7), with x = v t and
//! k = 3 μs'/(4 x),
//!
//! > R(ρ, t) = v z0/x (k/π)^(3/2) e^(−k (ρ² + z0²) − μa x)
//!
//! \[1/(m² s)\], summed as one exponent. Over ρ and all time, R is e^(−z0 √(3 μa μs')).
//!
//! Approximate: matched indices, several 1/μs' of path and of ρ. Nothing before t = 0.

use super::infinite::{check_medium, exponential, log_inverse_width, spread};
use crate::error::{Result, finite_result, non_negative};
use serde::Deserialize;

/// Inputs of [`diffusion_semi_infinite`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiffusionSemiInfinite {
    /// Distance ρ from the pencil, on the surface \[m\].
    pub rho: f64,
    /// Time since the pencil met the surface \[s\].
    pub time: f64,
    /// Absorption coefficient \[1/m\].
    pub mu_a: f64,
    /// Reduced scattering coefficient \[1/m\].
    pub mu_s_prime: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
}

/// The reflectance \[1/(m² s)\] by diffusion.
pub fn diffusion_semi_infinite(input: &DiffusionSemiInfinite) -> Result<f64> {
    let &DiffusionSemiInfinite { rho, time, mu_a, mu_s_prime, speed } = input;
    let path = check_medium(time, mu_a, mu_s_prime, speed)?;
    non_negative("rho", rho)?;
    if path <= 0.0 {
        return Ok(0.0);
    }
    let logarithm =
        speed.ln() - mu_s_prime.ln() - path.ln() + 1.5 * log_inverse_width(mu_s_prime, path);
    let depth = 0.75 / mu_s_prime / path;
    let decay = spread(rho, mu_s_prime, path) + depth + mu_a * path;
    finite_result("diffusion_semi_infinite", exponential(logarithm, decay))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    const SAMPLE: DiffusionSemiInfinite =
        DiffusionSemiInfinite { rho: 1.0, time: 4.0, mu_a: 0.1, mu_s_prime: 2.0, speed: 0.5 };

    #[test]
    fn all_light_comes_back_or_is_absorbed() {
        for mu_a in [0.01, 0.3] {
            // Over ρ, the Gaussian integrates to π/k.
            let over_the_face = |time: f64| {
                let of = DiffusionSemiInfinite { rho: 0.0, time, mu_a, ..SAMPLE };
                let k = 0.75 * of.mu_s_prime / (of.speed * time);
                diffusion_semi_infinite(&of).unwrap() * PI / k
            };
            let breaks = [0.0, 0.1, 1.0, 10.0, 100.0, 10_000.0];
            let total = adaptive(over_the_face, &breaks, 1e-11).unwrap().value;
            let expected = (-(3.0 * mu_a / 2.0_f64).sqrt()).exp();
            assert!((total / expected - 1.0).abs() < 1e-9, "{total} for {expected}");
        }
    }

    #[test]
    fn nothing_returns_before_it_enters() {
        for time in [-1.0, 0.0, 1e-300] {
            let of = DiffusionSemiInfinite { time, ..SAMPLE };
            assert_eq!(diffusion_semi_infinite(&of).unwrap(), 0.0);
        }
        let of = DiffusionSemiInfinite { mu_s_prime: 0.0, ..SAMPLE };
        assert!(diffusion_semi_infinite(&of).is_err());
        let of = DiffusionSemiInfinite { rho: f64::NAN, ..SAMPLE };
        assert!(diffusion_semi_infinite(&of).is_err());
    }

    proptest! {
        #[test]
        fn wild_inputs_give_a_value_or_an_error(
            exponents in prop::array::uniform5(-320.0..308.0_f64),
        ) {
            let [rho, time, mu_a, mu_s_prime, speed] = exponents.map(|e| 10.0_f64.powf(e));
            for (rho, mu_a) in [(rho, mu_a), (0.0, 0.0)] {
                let of = DiffusionSemiInfinite { rho, time, mu_a, mu_s_prime, speed };
                let result = diffusion_semi_infinite(&of);
                let fine = |v: &f64| v.is_finite() && *v >= 0.0;
                prop_assert!(result.as_ref().map_or(true, fine), "{of:?} {result:?}");
            }
        }
    }
}
