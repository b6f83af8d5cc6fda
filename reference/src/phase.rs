//! The phase function of Henyey and Greenstein (1941), normalised to 1 over the sphere.
//!
//! With the cosine c of the deflection (1 is forward) and the mean cosine g,
//!
//! > p(c) = (1 − g²) / (4π) · (1 + g² − 2 g c)^(−3/2)   \[1/sr\]
//!
//! The bracket cancels near the peak of a strongly peaked function: at g = 0.99 it is 1e-4 of its
//! terms. In half angles it is a sum of terms of one sign,
//!
//! > 1 + g² − 2 g c = (1 − g)² + 4 g sin²(θ/2) = (1 + g)² − 4 g cos²(θ/2),
//!
//! the first for g ≥ 0 and the second for g < 0. Geometry therefore hands over *both* squares,
//! each computed without a subtraction from 1 ([`Deflection`]).
//!
//! Domain: |g| < 1.

use crate::error::{Result, require};
use std::f64::consts::PI;

/// A deflection θ by the squares of its half angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deflection {
    /// sin²(θ/2): 0 is forward.
    pub sin2_half: f64,
    /// cos²(θ/2): 0 is backward.
    pub cos2_half: f64,
}

impl Deflection {
    /// The deflection with tan(θ/2) = `opposite` / `adjacent`; both at least 0, not both 0.
    pub fn from_half_tangent(opposite: f64, adjacent: f64) -> Self {
        let hypotenuse = opposite.hypot(adjacent);
        Self {
            sin2_half: (opposite / hypotenuse).powi(2),
            cos2_half: (adjacent / hypotenuse).powi(2),
        }
    }
}

/// The phase function \[1/sr\] of mean cosine `g` at a deflection.
///
/// `g` is checked once per solution by [`check_mean_cosine`], not here.
pub fn henyey_greenstein(g: f64, deflection: Deflection) -> f64 {
    let bracket = if g >= 0.0 {
        (1.0 - g).powi(2) + 4.0 * g * deflection.sin2_half
    } else {
        (1.0 + g).powi(2) - 4.0 * g * deflection.cos2_half
    };
    (1.0 - g) * (1.0 + g) / (4.0 * PI * bracket * bracket.sqrt())
}

/// `g` if it lies strictly between −1 and 1.
pub fn check_mean_cosine(g: f64) -> Result<f64> {
    require(g.abs() < 1.0, "g", g, "strictly between -1 and 1")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;

    const MEAN_COSINES: [f64; 7] = [-0.99, -0.5, -1e-9, 0.0, 0.3, 0.9, 0.99];

    /// ∫ weight(θ) p dΩ.
    fn moment(g: f64, weight: fn(f64) -> f64) -> f64 {
        let integrand = |theta: f64| {
            let half = 0.5 * theta;
            let deflection = Deflection::from_half_tangent(half.sin(), half.cos());
            2.0 * PI * theta.sin() * weight(theta) * henyey_greenstein(g, deflection)
        };
        adaptive(integrand, &[0.0, PI], 1e-13).unwrap().value
    }

    #[test]
    fn it_is_normalised() {
        for g in MEAN_COSINES {
            assert!((moment(g, |_| 1.0) - 1.0).abs() < 1e-12, "g = {g}");
        }
    }

    #[test]
    fn its_mean_cosine_is_g() {
        for g in MEAN_COSINES {
            assert!((moment(g, f64::cos) - g).abs() < 1e-12, "g = {g}");
        }
    }

    #[test]
    fn the_peaks_keep_their_digits() {
        // (1 + g) / (4π (1 − g)²) on the axis, in either direction.
        for (g, sin2, cos2) in [(0.999_999, 0.0, 1.0), (-0.999_999, 1.0, 0.0)] {
            let peak = henyey_greenstein(g, Deflection { sin2_half: sin2, cos2_half: cos2 });
            let side = 1.0 - f64::abs(g);
            let expected = (2.0 - side) / (4.0 * PI * side * side);
            assert!((peak / expected - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn mirrored_functions_are_mirror_images() {
        let forward = Deflection { sin2_half: 0.2, cos2_half: 0.8 };
        let mirrored = Deflection { sin2_half: 0.8, cos2_half: 0.2 };
        assert_eq!(henyey_greenstein(0.7, forward), henyey_greenstein(-0.7, mirrored));
    }

    #[test]
    fn the_limits_are_outside_the_domain() {
        for g in [-1.0, 1.0, 1.5, f64::NAN] {
            assert!(check_mean_cosine(g).is_err());
        }
    }
}
