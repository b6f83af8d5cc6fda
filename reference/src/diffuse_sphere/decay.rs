//! How fast light in a diffuse sphere dies out.
//!
//! Late light has forgotten where it came from: the irradiance falls as e^(−κ v t/(2R)), where κ > 0
//! solves
//!
//! > ρ F(−κ) = 1,   F(s) = ∫₀¹ 2x e^(−s x) dx = 2 [1 − (1 + s) e^(−s)] / s²,
//!
//! F being the Laplace transform of the chord density (the renewal equation of light that is reflected
//! with albedo ρ after each chord; Feller, vol. II, section XI.6). For ρ → 1, κ → −(3/2) ln ρ, the
//! mean chord being 4R/3.
//!
//! [`chord_transform`] is F, the mean transmittance of a chord in an absorbing filling with
//! s = 2R σa. For |s| ≤ 1 it is a power series, beyond it the closed form.
//! [`sphere_decay_rate`] applies Newton's iteration to ln F(−κ) = −ln ρ. The left side is convex and
//! has a slope between 2/3 and 1; written without a difference of near numbers, and without e^κ, it
//! gives κ to full precision from ρ = 1 (κ = 0) to the smallest albedo.

use crate::error::{Result, require};
use serde::Deserialize;

/// Inputs of [`sphere_decay_rate`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereDecay {
    /// Albedo ρ of the wall, above 0 and at most 1.
    pub albedo: f64,
}

/// κ, the rate of decay in v/(2R).
pub fn sphere_decay_rate(input: &SphereDecay) -> Result<f64> {
    let albedo = input.albedo;
    require(albedo > 0.0 && albedo <= 1.0, "albedo", albedo, "above 0 and at most 1")?;
    // At albedo 1, 0 and not -0.
    let target = 0.0 - albedo.ln();
    // The line through 0 with the slope 1 is below the root: Newton's iteration of a convex
    // function then falls towards it from the second step on.
    let mut kappa = target;
    for _ in 0..MAX_STEPS {
        let (logarithm, slope) = log_growth(kappa);
        let next = kappa - (logarithm - target) / slope;
        if (next - kappa).abs() <= 2.0 * f64::EPSILON * next {
            return Ok(next);
        }
        kappa = next;
    }
    // Rounding makes the last digit alternate.
    Ok(kappa)
}

const MAX_STEPS: u32 = 30;

/// F(s): the mean of e^(−s x) over a chord of x diameters.
pub fn chord_transform(s: f64) -> f64 {
    if s.abs() <= SERIES {
        return 1.0 + excess(-s);
    }
    // In two factors: e^(−s) may be 0, and s² infinite.
    2.0 * (1.0 / s - (1.0 / s + 1.0) * (-s).exp()) / s
}

/// Below this, the series has all its digits after 24 terms.
const SERIES: f64 = 1.0;

/// F(−κ) − 1 = Σ_{k≥1} 2 κ^k / (k! (k + 2)).
fn excess(kappa: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 0.0;
    for k in 1..24 {
        term *= kappa / f64::from(k);
        sum += 2.0 * term / f64::from(k + 2);
    }
    sum
}

/// ln F(−κ) and its slope, for κ ≥ 0.
fn log_growth(kappa: f64) -> (f64, f64) {
    if kappa <= SERIES {
        let excess = excess(kappa);
        return (excess.ln_1p(), slope_by_series(kappa) / (1.0 + excess));
    }
    let decay = (-kappa).exp();
    let numerator = (kappa - 1.0) + decay;
    let logarithm = kappa + (2.0 * numerator / kappa / kappa).ln();
    let slope = ((kappa - 2.0) + 2.0 / kappa * (1.0 - decay)) / numerator;
    (logarithm, slope)
}

/// dF(−κ)/dκ = Σ_{k≥0} 2 κ^k / (k! (k + 3)).
fn slope_by_series(kappa: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 2.0 / 3.0;
    for k in 1..24 {
        term *= kappa / f64::from(k);
        sum += 2.0 * term / f64::from(k + 3);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;
    use proptest::prelude::*;

    fn kappa(albedo: f64) -> f64 {
        sphere_decay_rate(&SphereDecay { albedo }).unwrap()
    }

    #[test]
    fn the_transform_is_the_mean_transmittance() {
        assert_eq!(chord_transform(0.0), 1.0);
        for s in [-30.0, -1.001, -0.999, 1e-9, 0.999, 1.001, 50.0, 1e3] {
            let mean = adaptive(|x| 2.0 * x * (-s * x).exp(), &[0.0, 0.05, 1.0], 1e-13).unwrap();
            assert!((chord_transform(s) / mean.value - 1.0).abs() < 1e-13, "{s}");
        }
        assert!(chord_transform(1e200) >= 0.0);
    }

    #[test]
    fn limits() {
        assert_eq!(kappa(1.0), 0.0);
        let near_one = 1.0 - 1e-12;
        // −(3/2) ln ρ (1 + O(1 − ρ)).
        assert!((kappa(near_one) / (-1.5 * near_one.ln()) - 1.0).abs() < 1e-11);
        assert!((kappa(0.5) - 1.0).abs() < 1e-15);
        // ln ρ + κ + ln(2 (κ − 1)/κ²) = 0 for the smallest albedo.
        let dark = kappa(f64::MIN_POSITIVE);
        let residual = f64::MIN_POSITIVE.ln() + dark + (2.0 * (dark - 1.0) / dark / dark).ln();
        assert!(residual.abs() < 1e-12, "{residual}");
        for albedo in [0.0, -0.1, 1.1, f64::NAN] {
            assert!(sphere_decay_rate(&SphereDecay { albedo }).is_err());
        }
    }

    proptest! {
        #[test]
        fn the_rate_solves_its_equation(exponent in -300.0..0.0_f64, fraction in 0.001..1.0_f64) {
            for albedo in [10.0_f64.powf(exponent), fraction] {
                let product = albedo * chord_transform(-kappa(albedo));
                prop_assert!((product - 1.0).abs() < 1e-12, "{product}");
            }
        }
    }
}
