//! Fluence of light scattered once in an infinite medium, around an isotropic point pulse.
//!
//! With x = v t, the distance r < x and Y = atanh(r/x) = ln(1 + 2r/(x − r))/2:
//!
//! * [`once_scattered_fluence`] \[W/m²\], isotropic scattering (Ganapol, "Homogeneous Infinite Media
//!   Time-Dependent Analytical Benchmarks", 2001, first collision):
//!   > φ = Q σs v e^(−σt x) / (4π r x) · 2Y
//! * [`once_scattered_fluence_hg`] \[W/m²\], the phase function of Henyey and Greenstein:
//!   > φ = Q σs v e^(−σt x) / (r x) · ∫ p(θ) dy, −Y < y < Y,   sin²(θ/2) = (1 − r²/x²) cosh² y
//! * [`once_scattered_fluence_bins`] \[J/m²\], isotropic, within t0 ≤ t < t1:
//!   > Q σs / (4π r) · ∫ e^(−σt x) ln((x + r)/(x − r)) / x dx
//! * [`once_scattered_fluence_steady`] \[1/m²\], isotropic, over all times, per energy; in z = 2Y:
//!   > σs e^(−σt r) / (4π r) · ∫ z / sinh z · e^(−2 σt r/(e^z − 1)) dz, 0 < z < ∞
//!
//! The second is an own derivation from the same ellipsoid of equal path lengths; it is the
//! integral over directions of the radiance, which a test confirms.
//!
//! # Stable form
//!
//! x − r is rounded once. Y/r has the limit 1/x at the source. As cosh² Y = 1/(1 − r²/x²), the
//! backward half angle is a product as well, cos²(θ/2) = (1 − r²/x²) sinh(Y − y) sinh(Y + y). A
//! forward peak lies at y = 0 and a backward one at y = Y, so y is counted from the peak. A bin with
//! the wavefront has a logarithmic singularity at its start, which tanh-sinh takes; the rest is
//! smooth in ln(x − r).
//!
//! # Domain
//!
//! r ≥ 0 (steady: r > 0). The value is 0 before the front and infinite, an error, on it and, for a
//! bin, at the moment of emission at the source. σt = 0 is allowed everywhere.

use super::radiance::check_medium;
use crate::error::{Result, finite_result, non_negative, path_bin, path_length, positive, require};
use crate::numerics::front::{BehindFront, offset};
use crate::numerics::path_integral;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use crate::phase::{Deflection, henyey_greenstein};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`once_scattered_fluence`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnceScattered {
    /// Energy of the pulse \[J\].
    pub energy: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Distance from the source \[m\].
    pub r: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`once_scattered_fluence_hg`]: those of [`OnceScattered`] with a mean cosine.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of OnceScattered, except for the mean cosine")]
pub struct OnceScatteredHg {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
    pub speed: f64,
    pub r: f64,
    pub time: f64,
}

/// Inputs of [`once_scattered_fluence_bins`]: those of [`OnceScattered`] with a bin of time.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of OnceScattered, except for the bin")]
pub struct OnceScatteredBin {
    pub energy: f64,
    pub sigma_s: f64,
    pub sigma_t: f64,
    pub speed: f64,
    pub r: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// Inputs of [`once_scattered_fluence_steady`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnceScatteredSteady {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Distance from the source \[m\].
    pub r: f64,
}

/// The fluence rate \[W/m²\] of light scattered once and isotropically.
pub fn once_scattered_fluence(input: &OnceScattered) -> Result<f64> {
    let &OnceScattered { energy, sigma_s, sigma_t, speed, r, time } = input;
    check_medium(energy, sigma_s, sigma_t, 0.0)?;
    let Some((path, behind)) = behind_front(speed, r, time)? else { return Ok(0.0) };
    let strength = energy * sigma_s * speed * (-sigma_t * path).exp();
    let value = strength / (4.0 * PI) / path * logarithm_per_r(r, behind, 1.0);
    finite_result("once_scattered_fluence", value)
}

/// The fluence rate \[W/m²\] of light scattered once by the Henyey-Greenstein phase function.
pub fn once_scattered_fluence_hg(input: &OnceScatteredHg) -> Result<f64> {
    let &OnceScatteredHg { energy, sigma_s, sigma_t, g, speed, r, time } = input;
    check_medium(energy, sigma_s, sigma_t, g)?;
    let Some((path, behind)) = behind_front(speed, r, time)? else { return Ok(0.0) };
    let strength = energy * sigma_s * speed * (-sigma_t * path).exp();
    if strength == 0.0 {
        return Ok(0.0);
    }
    let value = strength * mean_phase(g, r, behind)? / path * logarithm_per_r(r, behind, 1.0);
    finite_result("once_scattered_fluence_hg", value)
}

/// The fluence \[J/m²\] of light scattered once and isotropically, within a bin.
pub fn once_scattered_fluence_bins(input: &OnceScatteredBin) -> Result<f64> {
    let &OnceScatteredBin { energy, sigma_s, sigma_t, speed, r, t0, t1 } = input;
    check_medium(energy, sigma_s, sigma_t, 0.0)?;
    non_negative("r", r)?;
    path_bin(speed, t0, t1)?;
    let Some(bin) = BehindFront::of_bin(speed, t0, t1, r) else { return Ok(0.0) };
    require(r + bin.start > 0.0, "r", r, "above 0 where the bin holds the emission")?;
    let strength = energy * sigma_s / (4.0 * PI) * (-sigma_t * (r + bin.start)).exp();
    if strength == 0.0 {
        return Ok(0.0);
    }
    let (unit, integral) = (r + bin.start, integrated_logarithm(r, sigma_t, bin)?);
    finite_result("once_scattered_fluence_bins", strength * (integral / unit / unit))
}

/// The fluence per energy \[1/m²\] of light scattered once and isotropically, over all times.
pub fn once_scattered_fluence_steady(input: &OnceScatteredSteady) -> Result<f64> {
    let &OnceScatteredSteady { sigma_s, sigma_t, r } = input;
    check_medium(1.0, sigma_s, sigma_t, 0.0)?;
    positive("r", r)?;
    let depth = sigma_t * r;
    let strength = sigma_s * (-depth).exp() / (4.0 * PI) / r;
    if strength == 0.0 {
        return Ok(0.0);
    }
    let integrand = |z: f64| z / z.sinh() * (-2.0 * depth / z.exp_m1()).exp();
    // Below the knee the exponential cuts off, above it z e^(−z) falls.
    let knee = depth.ln_1p();
    let breaks = [0.0, 0.5 * knee, knee, knee + 2.0, knee + 8.0, knee + 50.0];
    let integral = adaptive(integrand, &breaks, RELATIVE_TOLERANCE)?.value;
    finite_result("once_scattered_fluence_steady", strength * integral)
}

/// The path length and its offset behind the wavefront at r, or `None` before the wavefront.
fn behind_front(speed: f64, r: f64, time: f64) -> Result<Option<(f64, f64)>> {
    non_negative("r", r)?;
    let path = path_length(speed, time)?;
    let behind = offset(speed, time, r);
    require(behind != 0.0, "time", time, "other than the arrival of the wavefront")?;
    Ok((behind > 0.0).then_some((path, behind)))
}

/// `unit` · ln((x + r)/(x − r)) / r, where x = r + `behind`.
fn logarithm_per_r(r: f64, behind: f64, unit: f64) -> f64 {
    // The next term of the series is r²/3x².
    if r < 1e-9 * behind {
        unit * 2.0 / (r + behind)
    } else {
        (2.0 * (r / behind)).ln_1p() * (unit / r)
    }
}

/// The mean of p over −Y < y < Y.
fn mean_phase(g: f64, r: f64, behind: f64) -> Result<f64> {
    let path = r + behind;
    let half_range = 0.5 * (2.0 * (r / behind)).ln_1p();
    let squeeze = behind / path * (1.0 + r / path);
    let backward = g < 0.0;
    let phase = |share: f64| {
        // y is counted from the peak.
        let (near, far) = (half_range * share, half_range * (1.0 - share));
        let (y, to_end) = if backward { (far, near) } else { (near, far) };
        let sin2_half = squeeze * y.cosh().powi(2);
        let cos2_half = squeeze * to_end.sinh() * (half_range + y).sinh();
        henyey_greenstein(g, Deflection { sin2_half, cos2_half })
    };
    // Where p turns from its peak to its tail: a square of a half angle of (1 − |g|)²/(4 |g|).
    let knee = (1.0 - g.abs()).powi(2) / (4.0 * g.abs());
    let turn = if backward {
        knee / (squeeze * (2.0 * half_range).sinh())
    } else {
        (knee / squeeze).max(1.0).sqrt().acosh()
    };
    let mut breaks = vec![0.0, 1.0];
    breaks.extend([1.0, 10.0].map(|factor| factor * turn / half_range));
    breaks.retain(|share| (0.0..=1.0).contains(share));
    breaks.sort_by(f64::total_cmp);
    Ok(adaptive(phase, &breaks, RELATIVE_TOLERANCE)?.value)
}

/// x0² ∫ e^(−σt (x − x0)) ln((x + r)/(x − r)) / (r x) dx over a bin that starts at x0.
fn integrated_logarithm(r: f64, sigma_t: f64, bin: BehindFront) -> Result<f64> {
    // In units of x0, in which squares of lengths stay in range.
    let unit = r + bin.start;
    let integrand = |behind: f64| {
        // Offsets that underflow have no weight, but must have a value.
        let behind = behind.max(f64::MIN_POSITIVE);
        logarithm_per_r(r, behind, unit) * (unit / (r + behind))
    };
    path_integral::behind_front(bin.start, bin.width, sigma_t, &[unit], integrand)
}

#[cfg(test)]
#[path = "fluence_tests.rs"]
mod tests;
