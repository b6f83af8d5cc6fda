//! How far beyond a boundary with reflection the diffuse fluence extrapolates to zero.
//!
//! Light inside (relative index η) meets the boundary under the cosine μ and is reflected with the
//! unpolarised Fresnel reflectance R(μ), totally below the critical cosine. Matching the currents
//! that come back puts the fluence to zero 2 A D/v beyond the boundary, with (Haskell et al., J. Opt.
//! Soc. Am. A 11, 2727 (1994), section 2.3; Contini, Martelli and Zaccanti, Appl. Opt. 36,
//! 4587 (1997), equation 27)
//!
//! > A = (1 + 3 ∫₀¹ R μ² dμ) / (1 − 2 ∫₀¹ R μ dμ).
//!
//! # Stable form
//!
//! With the transmittance T = 1 − R, A = (2 − 3 ∫ T μ² dμ) / (2 ∫ T μ dμ): the denominator no longer
//! cancels for large η. Only light above the critical angle counts; in the cosine μt behind
//! the boundary, μ dμ = μt dμt / η² and η² μ² = η² − 1 + μt², so that both integrals are smooth on
//! 0 ≤ μt ≤ 1, the root of the critical angle included:
//!
//! > A = (2 η² − 3 ∫₀¹ T μ μt dμt) / (2 ∫₀¹ T μt dμt).
//!
//! For η < 1 the integrals run over μ. A = 1 for η = 1.
//!
//! The integrals are exact; the condition that uses them is an approximation, like diffusion.

use crate::error::{Result, finite_result, positive};
use crate::interfaces::fresnel::Fresnel;
use crate::numerics::quadrature::adaptive;
use serde::Deserialize;

/// Inputs of [`diffusion_boundary_parameter`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoundaryParameter {
    /// Index η of the inside, relative to the outside.
    pub eta: f64,
}

/// A, the extrapolation length in units of 2D/v.
pub fn diffusion_boundary_parameter(input: &BoundaryParameter) -> Result<f64> {
    let eta = positive("eta", input.eta)?;
    let value = if eta >= 1.0 { from_the_denser_side(eta)? } else { from_the_thinner_side(eta)? };
    finite_result("diffusion_boundary_parameter", value)
}

fn from_the_denser_side(eta: f64) -> Result<f64> {
    let difference = (eta - 1.0) * (eta + 1.0);
    // Reciprocity: a face transmits alike from both sides.
    let passed = |cosine: f64| {
        let transmitted = Fresnel::new(eta, cosine).map_or(0.0, |face| face.transmitted());
        cosine * transmitted
    };
    let scaled_inside = |cosine: f64| (difference + cosine * cosine).sqrt() / eta;
    // Around √(η² − 1) the inner cosine turns from constant to proportional.
    let breaks = breaks(difference.sqrt());
    let flux = adaptive(passed, &breaks, TOLERANCE)?.value;
    let tilt = adaptive(|c| passed(c) * scaled_inside(c), &breaks, TOLERANCE)?.value;
    Ok((2.0 * eta * eta - 3.0 * tilt) / (2.0 * flux))
}

fn from_the_thinner_side(eta: f64) -> Result<f64> {
    let transmitted =
        |cosine: f64| Fresnel::new(1.0 / eta, cosine).map_or(0.0, |face| face.transmitted());
    let breaks = breaks((1.0 - eta).sqrt() * (1.0 + eta).sqrt() / eta);
    let flux = adaptive(|c| transmitted(c) * c, &breaks, TOLERANCE)?.value;
    let tilt = adaptive(|c| transmitted(c) * c * c, &breaks, TOLERANCE)?.value;
    Ok((2.0 - 3.0 * tilt) / (2.0 * flux))
}

const TOLERANCE: f64 = 1e-12;

fn breaks(scale: f64) -> [f64; 5] {
    let within = |factor: f64| (factor * scale).min(1.0);
    [0.0, within(0.5), within(2.0), within(8.0), 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn a(eta: f64) -> f64 {
        diffusion_boundary_parameter(&BoundaryParameter { eta }).unwrap()
    }

    /// The definition, with reflectances from inside.
    fn by_definition(eta: f64) -> f64 {
        let critical = (1.0 - 1.0 / (eta * eta)).max(0.0).sqrt();
        let reflected =
            |cosine: f64| Fresnel::new(1.0 / eta, cosine).map_or(1.0, |face| face.reflected());
        let moment = |power: i32| {
            let integrand = |cosine: f64| reflected(cosine) * cosine.powi(power);
            adaptive(integrand, &[0.0, critical, 1.0], 1e-10).unwrap().value
        };
        (1.0 + 3.0 * moment(2)) / (1.0 - 2.0 * moment(1))
    }

    #[test]
    fn the_stable_form_is_the_definition() {
        for eta in [0.3, 0.7, 0.99, 1.0, 1.01, 1.33, 1.5, 3.0] {
            assert!((a(eta) / by_definition(eta) - 1.0).abs() < 1e-8, "{eta}");
        }
    }

    #[test]
    fn equal_indices_do_not_reflect() {
        assert!((a(1.0) - 1.0).abs() < 1e-15);
        for step in [1e-15, 1e-12, 1e-9] {
            for eta in [1.0 + step, 1.0 - step] {
                assert!((a(eta) - 1.0).abs() < 100.0 * step + 1e-12, "{eta} {}", a(eta));
            }
        }
    }

    #[test]
    fn it_grows_with_the_index_and_meets_the_fit_of_the_literature() {
        let values: Vec<_> = (10..40).map(|n| a(0.1 * f64::from(n))).collect();
        assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
        // The fit of Contini et al. (1997), equation A2, for indices above 1.
        let fit = |n: f64| {
            504.332_889 - 2_641.002_14 * n + 5_923.699_064 * n.powi(2) - 7_376.355_814 * n.powi(3)
                + 5_507.531_041 * n.powi(4)
                - 2_463.357_945 * n.powi(5)
                + 610.956_547 * n.powi(6)
                - 64.8047 * n.powi(7)
        };
        for eta in [1.1, 1.4, 1.58] {
            assert!((a(eta) / fit(eta) - 1.0).abs() < 0.005, "{} {}", a(eta), fit(eta));
        }
    }

    #[test]
    fn extremes_are_values_or_errors() {
        // 2η²/(2∫T μt dμt), and T falls as 1/η for large indices.
        assert!(a(1e6) > 1e17 && a(1e-6) > 0.0);
        assert!(diffusion_boundary_parameter(&BoundaryParameter { eta: 0.0 }).is_err());
        assert!(diffusion_boundary_parameter(&BoundaryParameter { eta: f64::NAN }).is_err());
        for exponent in -300..300 {
            let eta = 10.0_f64.powi(exponent);
            let result = diffusion_boundary_parameter(&BoundaryParameter { eta });
            assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v > 0.0), "{result:?}");
        }
    }
}
