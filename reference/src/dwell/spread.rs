//! How far light spreads, where every scattering takes an exponential time.
//!
//! Light of a point pulse flies at the speed v, scatters at the rate λ = σs v with the mean cosine
//! g, and dwells for a mean time τ = 1/μ at every scattering, without absorption. The mean square
//! distance from the source, of the light in flight and of that which dwells together, solves a
//! linear differential equation of five states; its Laplace transform is
//!
//! > L⟨r²⟩ = 2v² (s + μ)² / (s² (s + λ + μ) (s + p)(s + q)),
//!
//! where −p and −q are the roots of (s + λ)(s + μ) = g λ μ. Source: own derivation; without dwell it
//! is the ⟨r²⟩ of the telegraph process, 2v² (t/λ₁ − (1 − e^(−λ₁t))/λ₁²) with λ₁ = λ(1 − g).
//!
//! # Stable form
//!
//! Partial fractions cancel for short times, for g → 0 and for τ → 0. ⟨r²⟩ is the convolution of the
//! share in flight, F = (μ + λ e^(−kt))/k with k = λ + μ, and the integral of the correlation G of
//! the velocity, both sums of exponentials:
//!
//! > ⟨r²⟩ = 2v²t² Σ w e\[0, −αt, −βt\],   α of F, β ∈ {p, q} of G,
//!
//! where e\[…\] is the divided difference of the exponential, a mean of its values. For g ≥ 0 all
//! weights w are positive. For g < 0 one is negative, or p and q are complex: if they are close
//! together, G = e^(−kt/2) (cos ωt + (μ − λ)/(2ω) sin ωt) is integrated numerically, which is easy,
//! because all its rates are then about the same.
//!
//! Domain: rates and times of at least 0, |g| < 1; τ = 0 is the medium without dwell.

use super::flight::check;
use crate::error::{Result, finite, finite_result, path_length, positive};
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive, single_panel};
use crate::phase::check_mean_cosine;
use serde::Deserialize;

/// Inputs of [`dwell_mean_square_distance`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DwellSpread {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Mean dwell time τ \[s\].
    pub mean_dwell: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// The mean square distance \[m²\] of all light from the source.
pub fn dwell_mean_square_distance(input: &DwellSpread) -> Result<f64> {
    let &DwellSpread { sigma_s, g, speed, mean_dwell, time } = input;
    positive("speed", speed)?;
    let scattering_rate = sigma_s * speed;
    check(scattering_rate, mean_dwell, time)?;
    check_mean_cosine(g)?;
    let path = path_length(speed, time)?;
    let release_rate = 1.0 / mean_dwell;
    // The relative effect of the dwells is at most λτ.
    let mean = if scattering_rate <= 1e-20 * release_rate {
        divided_difference(0.0, scattering_rate * (1.0 - g) * time)?
    } else {
        finite(
            "(sigma_s * speed + 1 / mean_dwell) * time",
            (scattering_rate + release_rate) * time,
        )?;
        Rates::new(scattering_rate, release_rate, g).mean(time)?
    };
    // One factor after the other: the square can overflow where the product does not.
    finite_result("dwell_mean_square_distance", 2.0 * path * (path * mean))
}

/// The rates of the process.
#[derive(Debug, Clone, Copy)]
struct Rates {
    /// λ
    scattering: f64,
    /// μ
    release: f64,
    /// p − q, or the square root of −(p − q)² if they are complex.
    splitting: f64,
    complex: bool,
    g: f64,
}

impl Rates {
    fn new(scattering: f64, release: f64, g: f64) -> Self {
        let largest = scattering.max(release);
        let (a, b) = (scattering / largest, release / largest);
        let discriminant = (a - b).powi(2) + 4.0 * g * a * b;
        let splitting = largest * discriminant.abs().sqrt();
        Self { scattering, release, splitting, complex: discriminant < 0.0, g }
    }

    fn sum(self) -> f64 {
        self.scattering + self.release
    }

    /// ⟨r²⟩ / (2v²t²).
    fn mean(self, time: f64) -> Result<f64> {
        if self.g < 0.0 && (self.complex || self.splitting < 0.5 * self.sum()) {
            return self.mean_by_quadrature(time);
        }
        let p = 0.5 * (self.sum() + self.splitting);
        let (slow, fast) = (self.scattering.min(self.release), self.scattering.max(self.release));
        let q = slow * (1.0 - self.g) * (fast / p);
        let share_in_flight =
            [(self.release / self.sum(), 0.0), (self.scattering / self.sum(), self.sum())];
        let mut mean = 0.0;
        for (share, alpha) in share_in_flight {
            for (weight, beta) in self.correlation(p, q) {
                mean += share * weight * divided_difference(alpha * time, beta * time)?;
            }
        }
        Ok(mean)
    }

    /// G as weights and rates: (p − μ)/(p − q) for p and (μ − q)/(p − q) for q.
    fn correlation(self, p: f64, q: f64) -> [(f64, f64); 2] {
        if self.splitting == 0.0 {
            return [(1.0, p), (0.0, q)];
        }
        // (p − μ)(μ − q) = gλμ gives the one that would cancel.
        let large = 0.5 * ((self.scattering - self.release).abs() + self.splitting);
        let slow = self.scattering.min(self.release);
        let small = self.g * slow * (self.scattering.max(self.release) / large);
        let weights = [large / self.splitting, small / self.splitting];
        let [of_p, of_q] =
            if self.scattering >= self.release { weights } else { [weights[1], weights[0]] };
        [(of_p, p), (of_q, q)]
    }

    /// The same as (1/t²) ∫ G(u) ∫_0^(t−u) F du, for p and q of the same size.
    fn mean_by_quadrature(self, time: f64) -> Result<f64> {
        let sum = self.sum();
        let half = 0.5 * self.splitting;
        let correlation = |u: f64| {
            let (cosine, sine) = if self.complex {
                ((half * u).cos(), sine_per_argument(half * u))
            } else {
                ((half * u).cosh(), hyperbolic_sine_per_argument(half * u))
            };
            (-0.5 * sum * u).exp() * (cosine + 0.5 * (self.release - self.scattering) * u * sine)
        };
        let in_flight =
            |y: f64| self.release / sum * y - self.scattering / sum * (-sum * y).exp_m1() / sum;
        // G has decayed to nothing at the end of the last one.
        let mut breaks = vec![0.0, time];
        breaks.extend([1.0, 3.0, 8.0, 20.0, 50.0, 200.0].map(|decays| decays / sum));
        let end = time.min(400.0 / sum);
        breaks.retain(|&u| u <= end);
        breaks.push(end);
        breaks.sort_by(f64::total_cmp);
        // Shares of the time and of the duration keep the square of t in range.
        let integrand = |u: f64| correlation(u) * (in_flight(time - u) / time);
        Ok(adaptive(integrand, &breaks, RELATIVE_TOLERANCE)?.value / time)
    }
}

fn sine_per_argument(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

fn hyperbolic_sine_per_argument(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sinh() / x }
}

/// The divided difference e\[0, −a, −b\] of the exponential, for a, b ≥ 0; 1/2 at a = b = 0.
fn divided_difference(a: f64, b: f64) -> Result<f64> {
    let (a, b) = (a.min(b), a.max(b));
    if a == f64::INFINITY {
        return Ok(0.0);
    }
    if b - a > 0.5 * a.max(1.0) {
        return Ok((first_difference(a) - first_difference(b)) / (b - a));
    }
    // The mean of −E′ over [a, b], with E(x) = (1 − e^(−x))/x.
    single_panel(|share| slope(a + (b - a) * share), 0.0, 1.0)
}

/// (1 − e^(−x))/x.
fn first_difference(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x }
}

/// (1 − (1 + x) e^(−x))/x².
fn slope(x: f64) -> f64 {
    if x > 1.0 {
        return (1.0 - (1.0 + x) * (-x).exp()) / x / x;
    }
    // e^(−x) Σ x^k / (k + 2)!: positive terms.
    let mut term = 0.5;
    let mut sum = 0.0;
    for k in 3..22 {
        sum += term;
        term *= x / f64::from(k);
    }
    (-x).exp() * sum
}

#[cfg(test)]
#[path = "spread_tests.rs"]
mod tests;
