//! A diffuse sphere that is lit in one point of its wall, as by a laser.
//!
//! A pulse of energy Q meets a spot of the wall at the time 0. After k ≥ 1 reflections, the first one
//! at the spot, it meets a wall point at the angle γ from it. The mean over the wall is exact for every k
//! ([`sphere_spot_mean_irradiance_bins`] \[J/m²\]):
//!
//! > Ē_k(t) = Q ρ^k/(4πR²) f_k(x) v/(2R),   x = v t/(2R).
//!
//! At a given point it is not ([`two_hops`](super)): [`sphere_spot_irradiance_bins`] \[J/m²\] has
//!
//! > E_1 = Q ρ/(4πR²) δ(t − (2R/v) sin(γ/2)),   E_2 = Q ρ²/(4πR²) h(x; γ) v/(2R)
//!
//! within a bin. Three reflections and more are not handled locally: their law is a series of
//! Legendre polynomials without a closed form here.

use super::chords::ChordSum;
use super::two_hops::two_hop_probability;
use crate::error::{Result, finite_result, non_negative, path_bin, positive, require};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`sphere_spot_irradiance_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpotBin {
    /// Energy Q that meets the spot \[J\].
    pub energy: f64,
    /// Albedo ρ of the wall, 0 to 1.
    pub albedo: f64,
    /// Radius R of the sphere \[m\].
    pub radius: f64,
    /// Speed of light v in the sphere \[m/s\].
    pub speed: f64,
    /// Cosine of the angle γ between the spot and the lit point, seen from the centre.
    pub cos_gamma: f64,
    /// Number of reflections, 1 or 2.
    pub order: u32,
    /// Start of the bin, since the pulse met the spot \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// Inputs of [`sphere_spot_mean_irradiance_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of SpotBin without cos_gamma")]
pub struct SpotMeanBin {
    pub energy: f64,
    pub albedo: f64,
    pub radius: f64,
    pub speed: f64,
    /// Number of reflections, from 1.
    pub order: u32,
    pub t0: f64,
    pub t1: f64,
}

/// The irradiance \[J/m²\] of a wall point within a bin, after one or two reflections.
pub fn sphere_spot_irradiance_bins(input: &SpotBin) -> Result<f64> {
    let &SpotBin { energy, albedo, radius, speed, cos_gamma, order, t0, t1 } = input;
    let mean = SpotMeanBin { energy, albedo, radius, speed, order, t0, t1 };
    let (strength, x0, x1) = check(&mean)?;
    let sum = match order {
        1 => {
            let in_range = (-1.0..=1.0).contains(&cos_gamma);
            require(in_range, "cos_gamma", cos_gamma, "between -1 and 1")?;
            let arrival = (0.5 * (1.0 - cos_gamma)).sqrt();
            if x0 <= arrival && arrival < x1 { albedo } else { 0.0 }
        }
        2 => albedo * albedo * two_hop_probability(cos_gamma, x0, x1)?,
        _ => {
            require(false, "order", f64::from(order), "1 or 2 (the mean over the wall has all)")?;
            0.0
        }
    };
    finite_result("sphere_spot_irradiance_bins", strength * sum)
}

/// The irradiance \[J/m²\] within a bin, as the mean over the wall, after any number of reflections.
pub fn sphere_spot_mean_irradiance_bins(input: &SpotMeanBin) -> Result<f64> {
    let (strength, x0, x1) = check(input)?;
    let sum = ChordSum::new(input.order)?.probability(x0, x1);
    let reflected = input.albedo.powf(f64::from(input.order));
    finite_result("sphere_spot_mean_irradiance_bins", strength * reflected * sum)
}

/// Q/(4πR²) and the edges of the bin in diameters.
fn check(input: &SpotMeanBin) -> Result<(f64, f64, f64)> {
    let &SpotMeanBin { energy, albedo, radius, speed, order, t0, t1 } = input;
    non_negative("energy", energy)?;
    require((0.0..=1.0).contains(&albedo), "albedo", albedo, "between 0 and 1")?;
    positive("radius", radius)?;
    require(order > 0, "order", f64::from(order), "at least 1")?;
    let (start, end) = path_bin(speed, t0, t1)?;
    let strength = energy / (4.0 * PI) / radius / radius;
    Ok((strength, 0.5 * (start / radius), 0.5 * (end / radius)))
}

#[cfg(test)]
#[path = "spot_tests.rs"]
mod tests;
