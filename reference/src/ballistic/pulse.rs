//! Ballistic light of pulses that take time.
//!
//! At the distance r from an isotropic point source, unscattered light repeats the emission r/v
//! later. With the share F of the emission that falls into t0 − r/v ≤ t < t1 − r/v, a bin holds
//!
//! > φ = Q e^(−σt r) / (4π r²) · F   \[J/m²\]
//!
//! * [`ballistic_box_pulse`]: the emission is constant from 0 to the width; F is the overlap.
//! * [`ballistic_gauss_pulse`]: the emission is a normal distribution about t = 0, of which also the
//!   half before 0 counts; F = (erf b − erf a)/2 with a, b = (t0,1 − r/v)/(√2 rms width).
//!
//! Source: the law of Beer, Lambert and Bouguer (1729), convolved.
//!
//! # Stable form
//!
//! Both a and b in one tail: the difference of erfc, which has its digits there. A bin that is
//! narrow where it lies: the integral of e^(−x²) over it, from its inner edge.
//!
//! Domain: r > 0, width > 0.

use super::point::{BallisticPoint, ballistic_point_fluence};
use crate::error::{Result, finite_result, path_bin, positive};
use crate::numerics::front::offset;
use crate::numerics::quadrature::single_panel;
use libm::{erf, erfc};
use serde::Deserialize;
use std::f64::consts::{PI, SQRT_2};

/// Inputs of [`ballistic_box_pulse`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxPulseBin {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Distance from the source \[m\].
    pub r: f64,
    /// How long the emission lasts \[s\].
    pub box_width: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// Inputs of [`ballistic_gauss_pulse`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaussPulseBin {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Distance from the source \[m\].
    pub r: f64,
    /// Standard deviation of the emission about t = 0 \[s\].
    pub rms_width: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The ballistic fluence \[J/m²\] of a constant emission, within a bin.
pub fn ballistic_box_pulse(input: &BoxPulseBin) -> Result<f64> {
    let &BoxPulseBin { energy, sigma_t, speed, r, box_width, t0, t1 } = input;
    let fluence = ballistic_point_fluence(&BallisticPoint { energy, sigma_t, r })?;
    positive("box_width", box_width)?;
    let (start, end) = emission_times(speed, r, t0, t1)?;
    let whole_bin = start >= 0.0 && end <= box_width;
    let overlap = if whole_bin { t1 - t0 } else { (end.min(box_width) - start.max(0.0)).max(0.0) };
    finite_result("ballistic_pulse_shapes", fluence * (overlap / box_width))
}

/// The ballistic fluence \[J/m²\] of an emission with a normal distribution, within a bin.
pub fn ballistic_gauss_pulse(input: &GaussPulseBin) -> Result<f64> {
    let &GaussPulseBin { energy, sigma_t, speed, r, rms_width, t0, t1 } = input;
    let fluence = ballistic_point_fluence(&BallisticPoint { energy, sigma_t, r })?;
    positive("rms_width", rms_width)?;
    let (start, end) = emission_times(speed, r, t0, t1)?;
    let in_widths = |time: f64| time / rms_width / SQRT_2;
    let share = normal_share(in_widths(start), in_widths(end), in_widths(t1 - t0))?;
    finite_result("ballistic_pulse_shapes", fluence * share)
}

/// When the light that arrives at the edges of a bin was emitted.
fn emission_times(speed: f64, r: f64, t0: f64, t1: f64) -> Result<(f64, f64)> {
    path_bin(speed, t0, t1)?;
    Ok((offset(speed, t0, r) / speed, offset(speed, t1, r) / speed))
}

/// (erf b − erf a)/2; `width` is b − a, with all its digits.
fn normal_share(a: f64, b: f64, width: f64) -> Result<f64> {
    // Mirrored, the tail that holds both edges is the upper one.
    let (a, b) = if b <= 0.0 { (-b, -a) } else { (a, b) };
    // The tail is below the range of f64.
    if a > 40.0 {
        return Ok(0.0);
    }
    if width * a.abs().max(1.0) < 1.0 {
        let integral = single_panel(|y| (-y * (2.0 * a + y)).exp(), 0.0, width)?;
        return Ok((-a * a).exp() * integral / PI.sqrt());
    }
    Ok(0.5 * if a > 0.0 { erfc(a) - erfc(b) } else { erf(b) - erf(a) })
}

#[cfg(test)]
#[path = "pulse_tests.rs"]
mod tests;
