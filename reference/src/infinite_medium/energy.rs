//! How much light there is at a time, wherever it is.
//!
//! A pulse of energy 1 in an infinite homogeneous medium, with x = v t:
//!
//! * `alive`: all that is not absorbed, e^(−σa x) (Beer and Lambert);
//! * `order`: what has been scattered exactly n times, e^(−σt x) (σs x)ⁿ/n!. Collisions come at a constant
//!   rate along the path, whatever the directions, so that their number has the distribution of
//!   Poisson.
//!
//! Both hold for any phase function and any emission. Units are the caller's; the results are
//! fractions of the pulse. The second is evaluated as the Poisson probability of mean σs x (in the
//! form of Loader, `numerics::poisson`) times e^(−(σt − σs) x). `sigma_t` below `sigma_s` means gain.
//! Before the emission there is no light.

use crate::error::{Result, finite_result, non_negative, path_length};
use crate::numerics::poisson::poisson;
use serde::Deserialize;

/// Inputs of [`energy_alive`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Alive {
    /// Absorption coefficient \[1/m\].
    pub sigma_a: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`energy_of_order`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AliveOfOrder {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Time since the emission \[s\].
    pub time: f64,
    /// Number of scatterings; 0 is ballistic light.
    pub order: u32,
}

/// The share of a pulse that is not yet absorbed, \[1\].
pub fn energy_alive(input: &Alive) -> Result<f64> {
    let &Alive { sigma_a, speed, time } = input;
    non_negative("sigma_a", sigma_a)?;
    let path = path_length(speed, time)?;
    Ok(if path < 0.0 { 0.0 } else { (-sigma_a * path).exp() })
}

/// The share of a pulse that has been scattered exactly n times, \[1\].
pub fn energy_of_order(input: &AliveOfOrder) -> Result<f64> {
    let &AliveOfOrder { sigma_s, sigma_t, speed, time, order } = input;
    non_negative("sigma_s", sigma_s)?;
    non_negative("sigma_t", sigma_t)?;
    let path = path_length(speed, time)?;
    if path < 0.0 {
        return Ok(0.0);
    }
    let probability = poisson(order, sigma_s * path);
    if probability == 0.0 {
        return Ok(0.0);
    }
    let value = probability * (-(sigma_t - sigma_s) * path).exp();
    finite_result("infinite_medium_energy", value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of_order(sigma_s: f64, sigma_t: f64, time: f64, order: u32) -> f64 {
        energy_of_order(&AliveOfOrder { sigma_s, sigma_t, speed: 0.5, time, order }).unwrap()
    }

    #[test]
    fn the_pulse_is_complete_at_its_emission_and_absent_before() {
        let at = |time| energy_alive(&Alive { sigma_a: 0.3, speed: 1.0, time }).unwrap();
        assert_eq!((at(0.0), at(-1.0)), (1.0, 0.0));
        assert_eq!((of_order(1.0, 1.0, 0.0, 0), of_order(1.0, 1.0, 0.0, 3)), (1.0, 0.0));
        assert_eq!(of_order(1.0, 1.0, -1.0, 0), 0.0);
    }

    proptest! {
        #[test]
        fn the_orders_add_up_to_what_is_alive(
            sigma_s in 0.0..5.0_f64, sigma_a in -0.5..2.0_f64, time in 0.0..40.0_f64,
        ) {
            let sigma_t = (sigma_s + sigma_a).max(0.0);
            let sum: f64 = (0..400).map(|n| of_order(sigma_s, sigma_t, time, n)).sum();
            let alive = (-(sigma_t - sigma_s) * 0.5 * time).exp();
            prop_assert!((sum / alive - 1.0).abs() < 1e-12, "{sum} for {alive}");
        }

        #[test]
        fn wild_inputs_give_a_value_or_an_error(
            exponents in prop::array::uniform4(-320.0..308.0_f64), order in any::<u32>(),
        ) {
            let [sigma_s, sigma_t, speed, time] = exponents.map(|e| 10.0_f64.powf(e));
            for result in [
                energy_of_order(&AliveOfOrder { sigma_s, sigma_t, speed, time, order }),
                energy_alive(&Alive { sigma_a: sigma_s, speed, time }),
            ] {
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0));
            }
        }
    }
}
