//! The contour integral behind every pulse in the infinite isotropically scattering medium.
//!
//! Ganapol ("Homogeneous Infinite Media Time-Dependent Analytical Benchmarks", LA-UR-01-1854, 2001,
//! AZURV1) writes the plane pulse at the distance x and the time t, in mean free paths, as an integral
//! over z from 0 to ∞ of the real part of functions of
//!
//! > ξ = 2 (atanh η + atanh σ)/(η + σ),   η = x/t,   σ = i z.
//!
//! Light scattered n times has ξⁿ⁺¹, light of all orders ξ² e^((c t/2)(1 − η²) ξ). Along the imaginary axis of
//! σ these oscillate, and near the front or for high orders the integral is a small remainder of large
//! parts: 2ⁿ n times smaller at order n. But ξ is analytic between the branch points ±1 and has a saddle
//! on the real axis, where 2/(1 − σ²) = ξ. On the parallel σ = σ0 + i s through the saddle, |ξ| falls on both
//! sides and the phase is stationary: nothing cancels. The saddle lies at η/2 for small η and approaches
//! 1 slowly at the front (0.95 at 1 − η = 1e-16).
//!
//! # Numbers
//!
//! The late exponent −t + (c t/2)(1 − η²) ξ is a small difference as well. It is kept as −(1 − c) t − c t D with
//! D = 1 − (1 − η²) ξ/2 ([`Node::deficit`]), by its power series where η and |σ| are small. On the contour,
//! s = (1 − σ0) tan u with 64 points of Gauss and Legendre in u, up to where the integrand is
//! 1e-17 of its peak, or to infinity: in u, the integrand is analytic at both ends. Near the front, where
//! 1 − σ0 is small, a second panel has s = tan u. As η → 0, values that
//! are odd in η come out as real parts proportional to η, computed without cancellation.

use crate::numerics::complex::Complex;
use crate::numerics::gauss_legendre::gauss_legendre;
use std::sync::LazyLock;

/// Where the light is, relative to the front: x or r < t.
#[derive(Debug, Clone, Copy)]
pub(super) struct Saddle {
    /// η = x/t.
    pub(super) eta: f64,
    /// m = 1 − η².
    pub(super) m: f64,
    /// The saddle itself.
    pub(super) peak: Node,
    atanh_eta: f64,
    /// σ0 and 1 − σ0.
    sigma: f64,
    sigma_gap: f64,
    /// d²ξ/dσ² at the saddle.
    curvature: f64,
}

/// A point of the contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// σ.
    pub(super) sigma: Complex,
    /// ξ.
    pub(super) xi: Complex,
    /// D = 1 − m ξ/2.
    pub(super) deficit: Complex,
}

impl Saddle {
    /// At the distance `x` of at least 0 and `gap` > 0 behind the front.
    pub(super) fn new(x: f64, gap: f64) -> Self {
        let time = x + gap;
        let eta = x / time;
        let atanh_eta = 0.5 * (2.0 * eta / (gap / time)).ln_1p();
        let sigma = saddle_point(eta, atanh_eta);
        let mut saddle = Self {
            eta,
            m: (gap / time) * (1.0 + eta),
            peak: Node {
                sigma: Complex::new(sigma, 0.0),
                xi: Complex::new(0.0, 0.0),
                deficit: Complex::new(0.0, 0.0),
            },
            atanh_eta,
            sigma,
            sigma_gap: 1.0 - sigma,
            curvature: 0.0,
        };
        saddle.peak = saddle.at(0.0);
        let share = if eta < NEARLY_CENTRAL { 1.0 / 3.0 } else { sigma / (eta + sigma) };
        saddle.curvature = 4.0 * share / ((1.0 - sigma) * (1.0 + sigma)).powi(2);
        saddle
    }

    /// ξ at the saddle.
    pub(super) fn height(&self) -> f64 {
        self.peak.xi.re
    }

    /// ln(ξ/ξ0), with ξ0 at the saddle.
    pub(super) fn log_ratio(&self, node: &Node) -> Complex {
        let peak = self.peak.deficit.re;
        ((node.deficit + -peak) * (-1.0 / (1.0 - peak))).ln_1p()
    }

    /// ∫ Re factor e^exponent ds from 0 to ∞, for an exponent that is 0 at the saddle.
    ///
    /// `steepness` is the derivative of the exponent with ξ at the saddle, for the first guess of where
    /// the integrand ends.
    pub(super) fn integral(
        &self,
        steepness: f64,
        exponent: impl Fn(&Node) -> Complex,
        factor: impl Fn(&Node) -> Complex,
    ) -> f64 {
        let end = self.end(steepness, &exponent);
        let value = |s: f64| {
            let node = self.at(s);
            (factor(&node) * exponent(&node).exp()).re
        };
        if self.sigma_gap > WIDE {
            return panel(&RULE, self.sigma_gap, 0.0, end, value);
        }
        // The scales 1 − σ0 and 1 are apart: a panel for each.
        let middle = self.sigma_gap.sqrt();
        let near = panel(&SHORT_RULE, self.sigma_gap, 0.0, end.min(middle), value);
        let far = if end > middle { panel(&SHORT_RULE, 1.0, middle, end, value) } else { 0.0 };
        near + far
    }

    /// The s beyond which the integrand is negligible, or infinity.
    fn end(&self, steepness: f64, exponent: &impl Fn(&Node) -> Complex) -> f64 {
        let mut s = (9.0 / (self.curvature * steepness).sqrt()).max(f64::MIN_POSITIVE);
        while s < FAR * self.sigma_gap {
            if exponent(&self.at(s)).re < NEGLIGIBLE {
                return s;
            }
            s *= 1.5;
        }
        f64::INFINITY
    }

    /// The point σ0 + i s.
    fn at(&self, s: f64) -> Node {
        let sigma = Complex::new(self.sigma, s);
        if self.eta < SMALL && self.sigma * self.sigma + s * s < SMALL * SMALL {
            return self.by_series(sigma);
        }
        let (plus, minus) = (1.0 + self.sigma, self.sigma_gap);
        let atanh = Complex::new(
            0.25 * (4.0 * self.sigma / (minus * minus + s * s)).ln_1p(),
            0.5 * (2.0 * s).atan2(plus * minus - s * s),
        );
        let xi = ((atanh + self.atanh_eta) * 2.0).over(sigma + self.eta);
        Node { sigma, xi, deficit: xi * (-0.5 * self.m) + 1.0 }
    }

    /// ξ/2 = Σ h_k/(2k + 1), with h_k = (η^(2k+1) + σ^(2k+1))/(η + σ).
    fn by_series(&self, sigma: Complex) -> Node {
        let eta_square = self.eta * self.eta;
        let square = sigma * sigma;
        let (sum, product) = (square + eta_square, square * -eta_square);
        let (mut before, mut power) = (Complex::new(1.0, 0.0), sum + sigma * -self.eta);
        let mut excess = power * (1.0 / 3.0);
        for k in 2..SERIES_TERMS {
            (before, power) = (power, sum * power + product * before);
            excess = excess + power * (1.0 / f64::from(2 * k + 1));
        }
        // 1 − m (1 + excess)
        Node { sigma, xi: (excess + 1.0) * 2.0, deficit: excess * -self.m + eta_square }
    }
}

impl Node {
    /// 1/(1 − σ²).
    pub(super) fn inverse_gap(&self) -> Complex {
        let square = self.sigma * self.sigma;
        // The real part is (1 − σ0)(1 + σ0) + s², not a difference: σ0 stays below 0.98.
        Complex::new(1.0, 0.0).over(square * -1.0 + 1.0)
    }
}

/// ∫ f ds from `start` to `end`, which may be infinity, in the angle u of s = scale tan(u/2).
fn panel(rule: &[(f64, f64)], scale: f64, start: f64, end: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (from, to) = ((start / scale).atan(), (end / scale).atan());
    let sum: f64 = rule
        .iter()
        .map(|&(u, weight)| {
            let tangent = (from + (to - from) * u).tan();
            weight * (1.0 + tangent * tangent) * value(scale * tangent)
        })
        .sum();
    (to - from) * scale * sum
}

/// 1 − σ0 above which one panel serves for the scales 1 − σ0 and 1.
const WIDE: f64 = 0.6;
/// Where the exponent is left out, and how far to look for it, in units of 1 − σ0.
const NEGLIGIBLE: f64 = -40.0;
const FAR: f64 = 64.0;
/// η below which the saddle is at η/2 to a relative 1e-4.
const NEARLY_CENTRAL: f64 = 0.01;
/// η and |σ| up to which the power series serves: 0.2^24 is 2e-17.
const SMALL: f64 = 0.2;
const SERIES_TERMS: u32 = 13;

/// Points on [0, 1] for one panel, and for one of two.
static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| unit_rule(64));
static SHORT_RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| unit_rule(40));

fn unit_rule(count: usize) -> Vec<(f64, f64)> {
    gauss_legendre(count).into_iter().map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w)).collect()
}

/// The zero of (1 − σ²)(atanh η + atanh σ) − (η + σ) between 0 and 1, to about 1e-3 of its distance from 1.
///
/// It need not be exact: the integral is the same along every parallel.
fn saddle_point(eta: f64, atanh_eta: f64) -> f64 {
    if eta < NEARLY_CENTRAL {
        return 0.5 * eta;
    }
    // To the right of the zero, or close; the function is concave there.
    let mut sigma = atanh_eta / (1.0 + atanh_eta);
    for _ in 0..4 {
        let sum = atanh_eta + sigma.atanh();
        let value = (1.0 - sigma) * (1.0 + sigma) * sum - (eta + sigma);
        sigma = (sigma + value / (2.0 * sigma * sum)).clamp(0.0, 1.0 - 0.5 / (1.0 + atanh_eta));
    }
    sigma
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [f64; 12] =
        [0.0, 1e-9, 1e-3, 0.00999, 0.0101, 0.15, 0.3, 0.6, 0.9, 0.99, 0.999_999, 1.0 - 1e-13];

    #[test]
    fn the_contour_leads_through_the_saddle() {
        for eta in PLACES {
            let saddle = Saddle::new(eta, 1.0 - eta);
            let slope = (saddle.at(1e-4).xi.im / 1e-4).abs();
            assert!(slope < 2e-2 * saddle.height() / saddle.sigma_gap, "{slope} at {eta}");
            // |ξ| falls along it.
            let mut before = saddle.height();
            for k in 1..60 {
                let node = saddle.at(saddle.sigma_gap * 1e-2 * 1.3_f64.powi(k));
                let modulus = node.xi.re.hypot(node.xi.im);
                assert!(modulus < before, "{modulus} at {eta}, {k}");
                before = modulus;
            }
        }
    }

    #[test]
    fn the_curvature_is_that_of_the_height() {
        for eta in PLACES {
            let saddle = Saddle::new(eta, 1.0 - eta);
            let s = 3e-3 * saddle.sigma_gap;
            let found = 2.0 * (saddle.height() - saddle.at(s).xi.re) / (s * s);
            assert!((found / saddle.curvature - 1.0).abs() < 2e-2, "{found} at {eta}");
        }
    }

    #[test]
    fn the_series_meets_the_closed_form() {
        for (eta, s) in [(0.0, 0.15), (0.1, 0.19), (0.19, 0.17), (0.15, 1e-3)] {
            let saddle = Saddle::new(eta, 1.0 - eta);
            let sigma = Complex::new(saddle.sigma, s);
            let series = saddle.by_series(sigma);
            // A larger distance from the source than the series accepts, undone.
            let atanh = |z: Complex| {
                let up = z.ln_1p();
                let down = (z * -1.0).ln_1p();
                (up + down * -1.0) * 0.5
            };
            let xi = ((atanh(sigma) + eta.atanh()) * 2.0).over(sigma + eta);
            let deficit = xi * (-0.5 * saddle.m) + 1.0;
            for (found, expected) in [(series.xi, xi), (series.deficit, deficit)] {
                let error = (found.re - expected.re).hypot(found.im - expected.im);
                assert!(error < 1e-15, "{found:?} for {expected:?}");
            }
        }
    }
}
