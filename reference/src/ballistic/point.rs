//! Ballistic light: what arrives without having been scattered.
//!
//! An isotropic point pulse of energy Q crosses a sphere of radius r at the time r/v, and what
//! crosses it is attenuated by Beer, Lambert and Bouguer (1729):
//!
//! > φ(r, t) = Q e^(−σt r) / (4π r²) · δ(t − r/v)
//!
//! [`ballistic_point_fluence`] is the weight of that delta, a fluence \[J/m²\]. A bin [t0, t1)
//! holds the whole weight if t0 ≤ r/v < t1, and nothing otherwise.
//!
//! Domain: r > 0. Where the transmittance underflows, the fluence is 0.

use crate::error::{Result, finite_result, non_negative, positive};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`ballistic_point_fluence`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallisticPoint {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Distance from the source \[m\].
    pub r: f64,
}

/// The fluence \[J/m²\] that the ballistic wave of an isotropic point pulse carries past r.
pub fn ballistic_point_fluence(input: &BallisticPoint) -> Result<f64> {
    let &BallisticPoint { energy, sigma_t, r } = input;
    non_negative("energy", energy)?;
    non_negative("sigma_t", sigma_t)?;
    positive("r", r)?;
    // Dividing by r twice keeps r² from underflowing or overflowing on the way.
    let fluence = energy * (-sigma_t * r).exp() / (4.0 * PI) / r / r;
    finite_result("ballistic_point_fluence", fluence)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fluence(energy: f64, sigma_t: f64, r: f64) -> f64 {
        ballistic_point_fluence(&BallisticPoint { energy, sigma_t, r }).unwrap()
    }

    #[test]
    fn the_energy_through_every_sphere_is_that_of_the_pulse_times_the_transmittance() {
        for r in [1e-100, 1e-3, 1.0, 40.0, 1e100] {
            let through = fluence(3.0, 1.25 / r, r) * 4.0 * PI * r * r;
            assert!((through / (3.0 * (-1.25_f64).exp()) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn an_opaque_medium_gives_zero() {
        assert_eq!(fluence(1.0, 50.0, 1e3), 0.0);
        assert_eq!(fluence(1.0, 1e300, 1e300), 0.0);
    }

    #[test]
    fn scaling_all_lengths_scales_the_fluence_by_the_inverse_square() {
        let ratio = fluence(1.0, 0.7, 2.0) / fluence(1.0, 0.7 / 8.0, 16.0);
        assert!((ratio - 64.0).abs() < 1e-12);
    }

    #[test]
    fn values_without_meaning_are_errors() {
        let input = BallisticPoint { energy: 1.0, sigma_t: 1.0, r: 1.0 };
        assert!(ballistic_point_fluence(&BallisticPoint { r: 0.0, ..input }).is_err());
        assert!(ballistic_point_fluence(&BallisticPoint { sigma_t: -1.0, ..input }).is_err());
        assert!(ballistic_point_fluence(&BallisticPoint { energy: f64::NAN, ..input }).is_err());
        assert!(ballistic_point_fluence(&BallisticPoint { r: 1e-200, ..input }).is_err());
    }
}
