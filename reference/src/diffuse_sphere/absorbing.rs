//! A diffuse sphere filled with a medium that absorbs and does not scatter.
//!
//! Absorption multiplies light by e^(−σa v t), t being its whole way: with a = 2R σa, a factor e^(−a)
//! per diameter. [`sphere_chords_absorbing`] is what is left of light on n chords of together at most x
//! diameters,
//!
//! > ∫₀^x f_n(u) e^(−a u) du,   and F(a)^n for x ≥ n,
//!
//! f_n and F being those of [`ChordSum`] and [`chord_transform`].
//! [`sphere_centre_radiance_absorbing_bins`] is the radiance at the centre, source and camera there, of
//! k ≥ 1 reflections within a bin \[J/(m² sr)\], for any radius, speed and energy:
//!
//! > L_k = Q ρ^k/(4π² R²) e^(−a) ∫ f_{k−1}(x) e^(−a x) dx,   x = (v t − 2R)/(2R),
//!
//! the first reflection being a delta at t = 2R/v.
//!
//! f_n is a polynomial between whole x; quadrature from one to the next with e^(−a (x − x₀)), x₀ the
//! lower end, has positive terms alone.

use super::chords::{ChordSum, MAX_CHORDS, Order};
use super::decay::chord_transform;
use crate::error::{Result, finite_result, non_negative, path_bin, positive, require};
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`sphere_chords_absorbing`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsorbingChords {
    /// Number of chords, 1 to [`MAX_CHORDS`](super::MAX_CHORDS).
    pub chords: u32,
    /// Largest sum of their lengths, in diameters.
    pub x: f64,
    /// Optical depth a of a diameter.
    pub absorption: f64,
}

/// Inputs of [`sphere_centre_radiance_absorbing_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsorbingCentreBin {
    /// Energy Q of the pulse \[J\].
    pub energy: f64,
    /// Albedo ρ of the wall, 0 to 1.
    pub albedo: f64,
    /// Radius R of the sphere \[m\].
    pub radius: f64,
    /// Absorption coefficient σa of the filling \[1/m\].
    pub sigma_a: f64,
    /// Speed of light v in the sphere \[m/s\].
    pub speed: f64,
    /// Which reflections.
    pub order: Order,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// What is left of light on n chords of together at most x diameters.
pub fn sphere_chords_absorbing(input: &AbsorbingChords) -> Result<f64> {
    let &AbsorbingChords { chords, x, absorption } = input;
    non_negative("absorption", absorption)?;
    require(!x.is_nan(), "x", x, "a number")?;
    let sum = ChordSum::new(chords)?;
    finite_result("sphere_chords_absorbing", sum.transmitted(absorption, 0.0, x)?)
}

/// The radiance \[J/(m² sr)\] seen at the centre of an absorbing sphere within a bin.
pub fn sphere_centre_radiance_absorbing_bins(input: &AbsorbingCentreBin) -> Result<f64> {
    let &AbsorbingCentreBin { energy, albedo, radius, sigma_a, speed, order, .. } = input;
    non_negative("energy", energy)?;
    require((0.0..=1.0).contains(&albedo), "albedo", albedo, "between 0 and 1")?;
    positive("radius", radius)?;
    non_negative("sigma_a", sigma_a)?;
    let diameter = 2.0 * radius;
    let absorption = non_negative("2 * radius * sigma_a", diameter * sigma_a)?;
    let (start, end) = path_bin(speed, input.t0, input.t1)?;
    let (x0, x1) = (start / diameter - 1.0, end / diameter - 1.0);
    let first = if start <= diameter && diameter < end { albedo } else { 0.0 };
    let sum = match order {
        Order::Exactly(1) => first,
        Order::Exactly(k) => {
            require(k > 0, "order", f64::from(k), "at least 1")?;
            albedo.powf(f64::from(k)) * ChordSum::new(k - 1)?.transmitted(absorption, x0, x1)?
        }
        Order::All => first + further_orders(albedo, absorption, x0, x1)?,
    };
    let strength = energy * (-absorption).exp() / (4.0 * PI * PI) / radius / radius;
    finite_result("sphere_centre_radiance_absorbing_bins", strength * sum)
}

/// Σ ρ^(n+1) ∫ f_n e^(−a x) over n ≥ 1 and the bin.
fn further_orders(albedo: f64, absorption: f64, x0: f64, x1: f64) -> Result<f64> {
    if x1 <= 0.0 || albedo == 0.0 || (-absorption * x0).exp() == 0.0 {
        return Ok(0.0);
    }
    let late = "early enough for 400 chords";
    require(x0 < f64::from(MAX_CHORDS), "t0 * speed / (2 * radius)", x0 + 1.0, late)?;
    let mut chords = ChordSum::one();
    let mut weight = albedo * albedo;
    let mut sum = weight * chords.transmitted(absorption, x0, x1)?;
    // Two bounds of the rest: ρ F(a) per order, and f ≤ 2x as without absorption.
    let per_order = albedo * chord_transform(absorption);
    let mut geometric = weight * chord_transform(absorption);
    let mut power = weight * x1 * x1;
    let mut n = 1.0;
    loop {
        let ratio = 2.0 * albedo * x1 * x1 / ((2.0 * n + 1.0) * (2.0 * n + 2.0));
        let rest = [(power, ratio), (geometric, per_order)].map(|(bound, ratio)| {
            if ratio < 1.0 { bound * ratio / (1.0 - ratio) } else { f64::INFINITY }
        });
        if rest[0].min(rest[1]) <= 1e-12 * sum {
            return Ok(sum);
        }
        chords = chords.with_one_more()?;
        weight *= albedo;
        power *= ratio;
        geometric *= per_order;
        n += 1.0;
        sum += weight * chords.transmitted(absorption, x0, x1)?;
    }
}

impl ChordSum {
    /// ∫ f_n(x) e^(−a x) dx over x0 ≤ x < x1.
    pub fn transmitted(&self, absorption: f64, x0: f64, x1: f64) -> Result<f64> {
        let chords = f64::from(self.chords());
        let (start, end) = (x0.clamp(0.0, chords), x1.clamp(0.0, chords));
        let before = (-absorption * start).exp();
        if end <= start || before == 0.0 {
            return Ok(0.0);
        }
        if start == 0.0 && end == chords {
            return Ok(chord_transform(absorption).powf(chords));
        }
        let mut breaks = vec![start, end];
        let whole = (start.ceil() as u32)..=(end.floor() as u32);
        breaks.extend(whole.map(f64::from));
        // Where the product of a power and the exponential has its peak and its tail.
        breaks.extend([0.25, 1.0, 4.0, 16.0].map(|f| start + f * 2.0 * chords / absorption));
        breaks.retain(|x| (start..=end).contains(x));
        breaks.sort_by(f64::total_cmp);
        let integrand = |x: f64| self.density(x) * (-absorption * (x - start)).exp();
        let integral = adaptive(integrand, &breaks, RELATIVE_TOLERANCE)?.value;
        Ok(before * integral)
    }
}

#[cfg(test)]
#[path = "absorbing_tests.rs"]
mod tests;
