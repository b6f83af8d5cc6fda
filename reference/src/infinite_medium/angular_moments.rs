//! The angular moments of light in Fourier space, for any mean cosine of the phase function.
//!
//! Light of an isotropic point pulse, Fourier transformed in space and expanded in Legendre polynomials of the
//! angle between direction and wave vector, obeys ẏ = M y with (P_N equations; Case and Zweifel, Linear Transport
//! Theory, 1967, with the polynomials normalised)
//!
//! > M_ll = σs gˡ − σt,   M_(l+1, l) = −M_(l, l+1) = k β_l,   β_l = (l + 1)/√((2l + 1)(2l + 3)),   v = 1.
//!
//! The total over all directions and places, weighted with sin(kr)/(kr), is S(k, t) = \[exp(t M)\]₀₀. It is the
//! mean of sin(kr)/(kr) over photons alive at t, ballistic ones included, and the cosine transform of the
//! plane pulse. Scaling: v and t enter as v t.
//!
//! # Numbers
//!
//! * Mᵀ = D M D with D = diag((−1)ˡ), so that S(t) = Σ (−1)ˡ y_l(t/2)²: half of the time, a quarter of the work.
//! * Truncation at the level N: what it changes has climbed to N + 1 and come back, in 2N + 2 steps. With ∏ β² ≤
//!   (π/2) 4^−(N+1) that is at most (π/2) (kt/2)^(2N+2)/(2N + 2)! e^(σs t) times e^(−σt t), and N is chosen for
//!   1e-20 of e^(−σt t), the ballistic light.
//! * exp in steps h of σs h ≤ 1, as e^(−σs h) exp(h (M + σs)): by the series of Chebyshev polynomials, with Bessel functions as
//!   coefficients, exp(ρX) = J₀(ρ) + 2 Σ J_n(ρ) φ_n(X), φ_(n+1) = 2X φ_n + φ_(n−1) (Tal-Ezer and Kosloff 1984), or by
//!   that of Taylor for kh ≤ 2. Rounding made on the way decays with the light.

use crate::error::{Result, finite_result, non_negative, require};
use crate::phase::check_mean_cosine;
use serde::Deserialize;

/// Inputs of [`infinite_medium_sinc_moment`]; speed 1.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SincMoment {
    /// Mean cosine of the phase function, strictly between −1 and 1.
    pub g: f64,
    /// Wave number \[rad/m\], at least 0.
    pub k: f64,
    /// Length of the light's path \[m\], at least 0; k t and σs t up to 1e4.
    pub time: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Absorption coefficient \[1/m\].
    pub sigma_a: f64,
}

/// The mean of sin(kr)/(kr) over a pulse, absorbed light counting as 0, \[1\].
pub fn infinite_medium_sinc_moment(input: &SincMoment) -> Result<f64> {
    let &SincMoment { g, k, time, sigma_s, sigma_a } = input;
    check_mean_cosine(g)?;
    non_negative("k", k)?;
    non_negative("time", time)?;
    non_negative("sigma_s", sigma_s)?;
    non_negative("sigma_a", sigma_a)?;
    require(k * time <= MOST, "k * time", k * time, "at most 1e4")?;
    require(sigma_s * time <= MOST, "sigma_s * time", sigma_s * time, "at most 1e4")?;
    let alive = (-sigma_a * time).exp();
    let value = alive * sinc_moment(g, k * time, sigma_s * time);
    finite_result("infinite_medium_sinc_moment", value)
}

/// The largest k t and σs t, which bound the work.
const MOST: f64 = 1e4;

/// S without absorption, at the phase k t and the depth σs t.
pub(super) fn sinc_moment(g: f64, phase: f64, depth: f64) -> f64 {
    let levels = Levels::new(g, phase, depth);
    // Half of the time, in steps.
    let steps = (0.5 * depth).ceil().max(1.0);
    let (rotation, scattering) = (0.5 * phase / steps, 0.5 * depth / steps);
    let mut y = vec![0.0; levels.climb.len() + 1];
    y[0] = 1.0;
    let bessel = bessel_j(rotation);
    for _ in 0..steps as usize {
        y = if rotation <= TAYLOR {
            levels.taylor(&y, rotation, scattering)
        } else {
            levels.chebyshev(&y, rotation, scattering, &bessel)
        };
        let decay = (-scattering).exp();
        for value in &mut y {
            *value *= decay;
        }
    }
    // The small entries first.
    y.iter().enumerate().rev().map(|(l, v)| if l % 2 == 0 { v * v } else { -v * v }).sum()
}

/// Rotations k h up to which the series is that of Taylor.
const TAYLOR: f64 = 2.0;

/// The matrix, truncated.
struct Levels {
    /// β_l.
    climb: Vec<f64>,
    /// gˡ.
    kept: Vec<f64>,
}

impl Levels {
    fn new(g: f64, phase: f64, depth: f64) -> Self {
        let count = truncation(phase, depth);
        let climb = (0..count).map(|l| {
            let l = l as f64;
            (l + 1.0) / ((2.0 * l + 1.0) * (2.0 * l + 3.0)).sqrt()
        });
        let kept = (0..=count).map(|l| g.powi(i32::try_from(l).unwrap_or(i32::MAX)));
        Self { climb: climb.collect(), kept: kept.collect() }
    }

    /// `factor` (k A + σs diag gˡ) y + `rest`, added up into `out`, which holds the rest.
    fn apply(&self, y: &[f64], rotation: f64, scattering: f64, out: &mut [f64]) {
        let last = self.climb.len();
        for l in 0..=last {
            let below = if l > 0 { self.climb[l - 1] * y[l - 1] } else { 0.0 };
            let above = if l < last { self.climb[l] * y[l + 1] } else { 0.0 };
            out[l] += rotation * (below - above) + scattering * self.kept[l] * y[l];
        }
    }

    fn taylor(&self, y: &[f64], rotation: f64, scattering: f64) -> Vec<f64> {
        let (mut sum, mut term) = (y.to_vec(), y.to_vec());
        // The norm of the matrix is at most 3: 3^40/40! is 1e-29.
        for n in 1..=40 {
            let mut next = vec![0.0; y.len()];
            let share = 1.0 / f64::from(n);
            self.apply(&term, rotation * share, scattering * share, &mut next);
            term = next;
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += term);
        }
        sum
    }

    fn chebyshev(&self, y: &[f64], rotation: f64, scattering: f64, bessel: &[f64]) -> Vec<f64> {
        let mut sum: Vec<f64> = y.iter().map(|value| bessel[0] * value).collect();
        let (mut before, mut term) = (y.to_vec(), vec![0.0; y.len()]);
        self.apply(y, 1.0, scattering / rotation, &mut term);
        for &coefficient in &bessel[1..] {
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += 2.0 * coefficient * term);
            self.apply(&term, 2.0, 2.0 * scattering / rotation, &mut before);
            std::mem::swap(&mut before, &mut term);
        }
        sum
    }
}

/// The level N of the bound in the module's documentation.
fn truncation(phase: f64, depth: f64) -> usize {
    let square = (0.5 * phase).powi(2);
    let mut bound = depth;
    let mut steps = 0.0;
    let mut count = 0;
    while count == 0 || bound > NEGLIGIBLE || steps < 0.5 * phase {
        bound += (square / ((steps + 1.0) * (steps + 2.0))).ln();
        steps += 2.0;
        count += 1;
    }
    count
}

/// ln 1e-20.
const NEGLIGIBLE: f64 = -46.0;

/// J_0(ρ), J_1(ρ), … until they are negligible, by Miller's backward recurrence.
fn bessel_j(rho: f64) -> Vec<f64> {
    let count = (rho + 12.0 * rho.cbrt() + 40.0) as usize;
    let mut values = vec![0.0; count + 1];
    if rho <= TAYLOR {
        return values;
    }
    let (mut above, mut value) = (0.0, 1e-280);
    let mut norm = 0.0;
    for n in (0..=count).rev() {
        values[n] = value;
        norm += if n == 0 {
            value
        } else if n % 2 == 0 {
            2.0 * value
        } else {
            0.0
        };
        (above, value) = (value, 2.0 * n as f64 / rho * value - above);
    }
    for value in &mut values {
        *value /= norm;
    }
    values
}

#[cfg(test)]
#[path = "angular_moments_tests.rs"]
mod tests;
