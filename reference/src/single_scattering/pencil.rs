//! A pencil beam seen by a pinhole.
//!
//! A pulse of energy Φ runs as an infinitely thin beam. Along a single camera ray its radiance is
//! 0, or infinite where the two lines cross; what is finite is the irradiance \[W/m²\] at a pinhole
//! that faces the light, integrated over the directions. With D the distance from the start of
//! the beam to the pinhole and α the angle between the beam and the direction to it, the path
//! through a point of the beam is that of the mirrored problem of a point source and a camera
//! ray (`radiance`), so with the same z, b, q and θ
//!
//! > E(t) = 2 Φ σs v p(θ) e^(−σt v t) / (q² + b²),   v t ≥ D.
//!
//! Source: own derivation; 4π times the radiance of the point source, because the energy of the
//! beam is not spread over the sphere. [`single_scatter_pencil_irradiance_bins`] \[J/m²\]
//! integrates over t0 ≤ t < t1. Stable forms, domain and limits are those of the radiance: only
//! the front of a beam that points straight at the pinhole is infinite.

use super::radiance::{
    SingleScatter, SingleScatterBin, single_scatter_radiance, single_scatter_radiance_bins,
};
use crate::error::{Result, finite_result};
use std::f64::consts::PI;

/// The irradiance \[W/m²\] of once-scattered light of a pencil beam at an instant.
///
/// `source_distance` is the distance from the start of the beam to the pinhole, and `alpha` the
/// angle between the beam and the direction to it.
pub fn single_scatter_pencil_irradiance(input: &SingleScatter) -> Result<f64> {
    let radiance = single_scatter_radiance(input)?;
    finite_result("single_scatter_pencil_irradiance", 4.0 * PI * radiance)
}

/// The irradiation \[J/m²\] by once-scattered light of a pencil beam within a bin.
pub fn single_scatter_pencil_irradiance_bins(input: &SingleScatterBin) -> Result<f64> {
    let radiance = single_scatter_radiance_bins(input)?;
    finite_result("single_scatter_pencil_irradiance_bins", 4.0 * PI * radiance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::adaptive;

    /// ∫ Φ σs p(θ) e^(−σt (s + r)) / r² ds along the beam: the definition, with vectors.
    fn steady_state_along_the_beam(of: &SingleScatterBin) -> f64 {
        let (z, b) = (of.source_distance * of.alpha.cos(), of.source_distance * of.alpha.sin());
        let integrand = |s: f64| {
            let r = (s - z).hypot(b);
            let cosine = (z - s) / r;
            let bracket = 1.0 + of.g * of.g - 2.0 * of.g * cosine;
            let phase = (1.0 - of.g * of.g) / (4.0 * PI * bracket.powf(1.5));
            of.energy * of.sigma_s * phase * (-of.sigma_t * (s + r)).exp() / (r * r)
        };
        let far = z.abs() + 40.0 / of.sigma_t;
        adaptive(integrand, &[0.0, z.max(0.0), far], 1e-12).unwrap().value
    }

    #[test]
    fn all_time_is_the_steady_state_of_the_definition() {
        for g in [-0.9, 0.0, 0.6, 0.95] {
            for alpha in [0.05, 1.0, 2.0, 3.1] {
                let of = SingleScatterBin {
                    energy: 2.0,
                    sigma_s: 0.8,
                    sigma_t: 1.1,
                    g,
                    speed: 0.75,
                    source_distance: 1.5,
                    alpha,
                    t0: 0.0,
                    t1: 1e4,
                };
                let value = single_scatter_pencil_irradiance_bins(&of).unwrap();
                let expected = steady_state_along_the_beam(&of);
                assert!((value / expected - 1.0).abs() < 1e-9, "{value} for {expected}");
            }
        }
    }

    #[test]
    fn a_beam_straight_at_the_pinhole_is_infinite_on_its_front_alone() {
        let at_front = SingleScatter {
            energy: 1.0,
            sigma_s: 1.0,
            sigma_t: 1.0,
            g: 0.0,
            speed: 1.0,
            source_distance: 1.0,
            alpha: 0.0,
            time: 1.0,
        };
        assert!(single_scatter_pencil_irradiance(&at_front).is_err());
        let behind = SingleScatter { time: 2.0, ..at_front };
        let expected = (-2.0_f64).exp() / (2.0 * PI);
        let value = single_scatter_pencil_irradiance(&behind).unwrap();
        assert!((value / expected - 1.0).abs() < 1e-14);
    }
}
