//! Where light scattered once is: its energy within a spherical shell.
//!
//! An isotropic point pulse of energy 1 in an infinite medium that scatters isotropically. At the
//! path length x = v t, the once-scattered energy between the radii r0 and r1 ≤ x is
//!
//! > E = σs x e^(−σt x) · \[G(r1/x) − G(r0/x)\],   G(ρ) = ρ − (1 − ρ²) atanh ρ,
//!
//! a share of the pulse; no light is beyond x, and all of it is σs x e^(−σt x), as G(1) = 1.
//! Source: the fluence of Ganapol (2001, first collision) times 4π r²/v, integrated.
//! [`once_scattered_shell_energy_bins`] \[s\] integrates E over t0 ≤ t < t1.
//!
//! # Stable form
//!
//! G′ = 2ρ atanh ρ, so that the bracket is an integral of one sign; one panel gives it to the last
//! digit if the shell is thinner than its distance to the wavefront. Otherwise, with δ = 1 − ρ
//! rounded once, it is the difference of H(δ) = 1 − G = δ + δ (2 − δ)/2 · ln((2 − δ)/δ), which has
//! no cancellation there.
//!
//! Domain: 0 ≤ r0 ≤ r1, t ≥ 0.

use super::radiance::check_medium;
use crate::error::{Result, finite_result, non_negative, path_bin, path_length, require};
use crate::numerics::front::{BehindFront, offset};
use crate::numerics::path_integral::behind_front;
use crate::numerics::quadrature::single_panel;
use serde::Deserialize;

/// Inputs of [`once_scattered_shell_energy`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnceScatteredShell {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Speed of light in the medium \[m/s\].
    pub speed: f64,
    /// Inner radius \[m\].
    pub r0: f64,
    /// Outer radius \[m\].
    pub r1: f64,
    /// Time since the emission \[s\].
    pub time: f64,
}

/// Inputs of [`once_scattered_shell_energy_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of OnceScatteredShell, except for the bin")]
pub struct OnceScatteredShellBin {
    pub sigma_s: f64,
    pub sigma_t: f64,
    pub speed: f64,
    pub r0: f64,
    pub r1: f64,
    /// Start of the bin \[s\].
    pub t0: f64,
    /// End of the bin \[s\].
    pub t1: f64,
}

/// The share of a pulse that has been scattered once and is in the shell from r0 to r1.
pub fn once_scattered_shell_energy(input: &OnceScatteredShell) -> Result<f64> {
    let &OnceScatteredShell { sigma_s, sigma_t, speed, r0, r1, time } = input;
    let shell = Shell::new(r0, r1)?;
    check_medium(1.0, sigma_s, sigma_t, 0.0)?;
    let path = path_length(speed, non_negative("time", time)?)?;
    let share = shell.share(path, offset(speed, time, r0), offset(speed, time, r1))?;
    let energy = sigma_s * path * (-sigma_t * path).exp() * share;
    finite_result("once_scattered_shell_energy", energy)
}

/// The integral over a bin of [`once_scattered_shell_energy`] \[s\].
pub fn once_scattered_shell_energy_bins(input: &OnceScatteredShellBin) -> Result<f64> {
    let &OnceScatteredShellBin { sigma_s, sigma_t, speed, r0, r1, t0, t1 } = input;
    let shell = Shell::new(r0, r1)?;
    check_medium(1.0, sigma_s, sigma_t, 0.0)?;
    path_bin(speed, t0, t1)?;
    let Some(bin) = BehindFront::of_bin(speed, t0, t1, r0) else { return Ok(0.0) };
    let transmittance = (-sigma_t * (r0 + bin.start)).exp();
    if shell.thickness == 0.0 || transmittance == 0.0 {
        return Ok(0.0);
    }
    // The last path length of the bin, so that no product exceeds the range.
    let unit = r0 + bin.start + bin.width;
    let integral = shell.within(sigma_t, bin, unit)?;
    let value = sigma_s * transmittance * (integral / speed) * unit;
    finite_result("once_scattered_shell_energy_bins", value)
}

/// A shell and its thickness.
#[derive(Debug, Clone, Copy)]
struct Shell {
    r0: f64,
    r1: f64,
    thickness: f64,
}

impl Shell {
    fn new(r0: f64, r1: f64) -> Result<Self> {
        non_negative("r0", r0)?;
        require(r1.is_finite() && r1 >= r0, "r1", r1, "finite and not below r0")?;
        Ok(Self { r0, r1, thickness: r1 - r0 })
    }

    /// The share of the once-scattered light that is in the shell; x is `inner` behind r0 and
    /// `outer` behind r1.
    fn share(&self, x: f64, inner: f64, outer: f64) -> Result<f64> {
        if inner <= 0.0 {
            return Ok(0.0);
        }
        let width = self.thickness.min(inner) / x;
        let (delta0, delta1) = (inner / x, outer.max(0.0) / x);
        if width <= delta1 {
            let rho = self.r0 / x;
            return single_panel(|step| 2.0 * (rho + step) * (rho + step).atanh(), 0.0, width);
        }
        Ok(outside(delta0) - outside(delta1))
    }

    /// ∫ x/unit · e^(−σt (x − x0)) share dx over a bin behind r0 that starts at x0.
    fn within(&self, sigma_t: f64, bin: BehindFront, unit: f64) -> Result<f64> {
        let at = |x: f64, inner: f64, outer: f64| {
            self.share(x, inner, outer).map_or(f64::NAN, |share| x / unit * share)
        };
        // While the front crosses the shell.
        let crossing = bin.before(self.thickness);
        let (first, crossed) = match crossing {
            None => (0.0, 0.0),
            Some(part) => {
                let integrand = |inner: f64| at(self.r0 + inner, inner, inner - self.thickness);
                let scales = [self.r0, self.thickness];
                let scales = if self.r0 > 0.0 { &scales[..] } else { &scales[1..] };
                let value = behind_front(part.start, part.width, sigma_t, scales, integrand)?;
                (value, part.width)
            }
        };
        if bin.width <= crossed {
            return Ok(first);
        }
        // And after.
        let integrand = |outer: f64| at(self.r1 + outer, self.thickness + outer, outer);
        let start = (bin.start + crossed - self.thickness).max(0.0);
        let scales = [self.thickness, self.r1];
        let rest = behind_front(start, bin.width - crossed, sigma_t, &scales, integrand)?;
        Ok(first + (-sigma_t * crossed).exp() * rest)
    }
}

/// H(δ): the share of the once-scattered light outside the radius (1 − δ) x.
fn outside(delta: f64) -> f64 {
    if delta <= 0.0 {
        return 0.0;
    }
    delta + 0.5 * delta * (2.0 - delta) * ((2.0 - delta).ln() - delta.ln())
}

#[cfg(test)]
#[path = "shell_tests.rs"]
mod tests;
