//! Phase functions: isotropic and Henyey-Greenstein, normalised to 1 over the sphere \[1/sr\].
//!
//! `cos_theta` is between the incoming and the outgoing *propagation* directions: 1 is forward.
//! Henyey & Greenstein 1941; written near the peak with w = (1 − cosθ)/2 as
//! p = (1 − g²)/(4π) · ((1 − g)² + 4 g w)^(−3/2), which does not cancel for g → 1 (and its mirror
//! image for g → −1).

use std::f64::consts::PI;

use glam::DVec3;

use crate::{Frame, Stream};

/// 1/(4π): the isotropic phase function \[1/sr\].
pub const ISOTROPIC: f64 = 0.25 / PI;

/// A phase function; sampling is exact, so its pdf is its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// 1/(4π) in every direction.
    Isotropic,
    /// Henyey-Greenstein with mean cosine `g`, −1 < g < 1.
    HenyeyGreenstein {
        /// Mean cosine of the scattering angle.
        g: f64,
    },
}

impl Phase {
    /// The phase function with mean cosine `g`; exactly isotropic for 0.
    pub fn with_mean_cosine(g: f64) -> Self {
        if g == 0.0 { Self::Isotropic } else { Self::HenyeyGreenstein { g } }
    }

    /// Value, and pdf of [`Phase::sample`], at the cosine of the scattering angle \[1/sr\].
    #[inline]
    pub fn value(self, cos_theta: f64) -> f64 {
        match self {
            Self::Isotropic => ISOTROPIC,
            Self::HenyeyGreenstein { g } => {
                let half_versine = 0.5 * (1.0 - g.signum() * cos_theta);
                let a = g.abs();
                let base = (1.0 - a) * (1.0 - a) + 4.0 * a * half_versine.max(0.0);
                ISOTROPIC * (1.0 - a * a) / (base * base.sqrt())
            }
        }
    }

    /// A new propagation direction for light that travels along `forward`.
    #[inline]
    pub fn sample(self, forward: DVec3, rng: &mut Stream) -> DVec3 {
        let (u1, u2) = (rng.uniform(), rng.uniform());
        Frame::from_z(forward).to_world(polar(self.sample_cosine(u1), u2))
    }

    /// Inverse of the cumulative distribution of the cosine: `u` in [0, 1).
    #[inline]
    pub fn sample_cosine(self, u: f64) -> f64 {
        match self {
            Self::Isotropic => 1.0 - 2.0 * u,
            Self::HenyeyGreenstein { g } => {
                // From the half versine w of the angle to the peak, with a = |g| and
                // b = 1 − a: 4 a w = s² − b², s = (1 − a²)/(1 + a − 2 a u'), u' measured from
                // the back; no cancellation at the peak.
                let a = g.abs();
                let s_minus_b = (1.0 - a) * 2.0 * a * u / (1.0 + a - 2.0 * a * u);
                let w = s_minus_b * (s_minus_b + 2.0 * (1.0 - a)) / (4.0 * a);
                g.signum() * (1.0 - 2.0 * w.min(1.0))
            }
        }
    }
}

/// A unit vector at polar cosine `cos_theta` from +z and azimuth 2π `u`.
#[inline]
fn polar(cos_theta: f64, u: f64) -> DVec3 {
    let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (2.0 * PI * u).sin_cos();
    DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEAN_COSINES: [f64; 7] = [0.0, 0.5, 0.9, 0.99, -0.5, -0.9, 1e-6];

    /// Midpoint sums in the half-versine, transformed so that sharp peaks are resolved.
    fn integrate(f: impl Fn(f64) -> f64, g: f64) -> f64 {
        let n = 400_000;
        let b = (1.0 - g.abs()).powi(2);
        let log_span = (1.0 + 1.0 / b).ln();
        (0..n)
            .map(|i| {
                let x = (i as f64 + 0.5) / n as f64;
                let w = b * (x * log_span).exp_m1();
                let dw = b * log_span * (x * log_span).exp();
                f(g.signum() * (1.0 - 2.0 * w)) * 4.0 * PI * dw / n as f64
            })
            .sum()
    }

    #[test]
    fn is_normalised_and_has_its_mean_cosine() {
        for g in MEAN_COSINES {
            let phase = Phase::with_mean_cosine(g);
            assert!((integrate(|c| phase.value(c), g) - 1.0).abs() < 1e-8, "g = {g}");
            let mean = integrate(|c| c * phase.value(c), g);
            assert!((mean - g).abs() < 1e-8, "g = {g}: mean cosine {mean}");
        }
    }

    #[test]
    fn sampling_inverts_the_cumulative_distribution() {
        for g in MEAN_COSINES {
            let phase = Phase::with_mean_cosine(g);
            for i in 1..100 {
                // d(cosθ)/du · 2π p = ∓1.
                let (u, h) = (f64::from(i) / 100.0, 1e-6);
                let slope = (phase.sample_cosine(u + h) - phase.sample_cosine(u - h)) / (2.0 * h);
                let density = 2.0 * PI * phase.value(phase.sample_cosine(u));
                assert!((slope.abs() * density - 1.0).abs() < 1e-4, "g = {g}, u = {u}");
            }
        }
    }
}
