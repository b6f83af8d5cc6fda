//! Diffuse reflectance and transmittance of a slab.
//!
//! A pencil pulse enters a slab of the thickness s at ρ = 0; its light is taken to start at the depth
//! z0 = 1/μs'. The fluence is zero on planes z_e = 2 A D/v outside both faces
//! ([`diffusion_boundary_parameter`]), which image sources of alternate sign bring about. The flux
//! out of the faces is (Contini, Martelli and Zaccanti, Appl. Opt. 36, 4587 (1997), equations 36, 39),
//! with v = c/η for the speed c *outside*, x = v t, a = 4 D t = 4x/(3 μs') and the distance
//! P = s + 2 z_e of those planes,
//!
//! > R(ρ, t) = C [Θ(z0) + Θ(z0 + 2 z_e)],   T(ρ, t) = C [Θ(P − z0) + Θ(P − z0 − 2 z_e)],
//! > C = v e^(−μa x − ρ²/a) / (2 (π a)^(3/2) x),   Θ(z) = Σ_m (z + 2mP) e^(−(z + 2mP)²/a)
//!
//! \[1/(m² s)\]. [`DiffusionSlabTotal`] leaves out ρ: a factor π a \[1/s\]. Without absorption,
//! ∫ (R + T) dt = 1 and ∫ T dt = (z0 + z_e)/P.
//!
//! # Stable form
//!
//! Late, the images cancel: the sum is far smaller than its terms. Θ is a theta function, and
//! by Poisson's sum also
//!
//! > Θ(z) = (a √(π a) π / (2P²)) Σ_n n e^(−n² π² a/(4P²)) sin(n π z/P),
//!
//! the eigenmodes. Images serve up to a = 4P²/π, where both converge alike (e^(−π n²)), modes beyond.
//! The images are taken in pairs around multiples of P,
//!
//! > B_n(y) = e^(−(nP − y)²/a) [−nP expm1(−4nPy/a) − y (1 + e^(−4nPy/a))],
//! > Θ(y) = y e^(−y²/a) − Σ_{n even} B_n(y),   Θ(P − y) = Σ_{n odd} B_n(y),
//!
//! which keep their digits however close to a face the light starts; and the exponent of the
//! first arrival is taken out, so that early light neither underflows nor overflows on the way.
//!
//! Approximate; domain z0 < s, as the light must start inside. Nothing before t = 0.

use super::boundary::{BoundaryParameter, diffusion_boundary_parameter};
use super::infinite::{check_medium, exponential, spread};
use crate::error::{Result, finite_result, non_negative, positive, require};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`diffusion_slab_reflectance`] and [`diffusion_slab_transmittance`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiffusionSlab {
    /// Distance ρ from the pencil, on the face \[m\].
    pub rho: f64,
    /// Time since the pencil met the slab \[s\].
    pub time: f64,
    /// Absorption coefficient \[1/m\].
    pub mu_a: f64,
    /// Reduced scattering coefficient \[1/m\]; above 1/thickness.
    pub mu_s_prime: f64,
    /// Thickness s of the slab \[m\].
    pub thickness: f64,
    /// Index of the slab, relative to the outside.
    pub eta: f64,
    /// Speed of light *outside* \[m/s\]; inside it is v = speed/eta.
    pub speed: f64,
}

/// Inputs of [`diffusion_slab_total_reflectance`] and [`diffusion_slab_total_transmittance`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields of DiffusionSlab without rho")]
pub struct DiffusionSlabTotal {
    pub time: f64,
    pub mu_a: f64,
    pub mu_s_prime: f64,
    pub thickness: f64,
    pub eta: f64,
    pub speed: f64,
}

/// The reflectance \[1/(m² s)\] by diffusion.
pub fn diffusion_slab_reflectance(input: &DiffusionSlab) -> Result<f64> {
    at_distance(input, Face::Front)
}

/// The transmittance \[1/(m² s)\] by diffusion.
pub fn diffusion_slab_transmittance(input: &DiffusionSlab) -> Result<f64> {
    at_distance(input, Face::Back)
}

/// The reflectance \[1/s\] of the whole face by diffusion.
pub fn diffusion_slab_total_reflectance(input: &DiffusionSlabTotal) -> Result<f64> {
    in_total(input, Face::Front)
}

/// The transmittance \[1/s\] of the whole face by diffusion.
pub fn diffusion_slab_total_transmittance(input: &DiffusionSlabTotal) -> Result<f64> {
    in_total(input, Face::Back)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Face {
    Front,
    Back,
}

fn at_distance(input: &DiffusionSlab, face: Face) -> Result<f64> {
    let &DiffusionSlab { rho, time, mu_a, mu_s_prime, thickness, eta, speed } = input;
    non_negative("rho", rho)?;
    let total = DiffusionSlabTotal { time, mu_a, mu_s_prime, thickness, eta, speed };
    let Some(flux) = Flux::new(&total, face)? else { return Ok(0.0) };
    let logarithm = flux.logarithm - (PI * flux.a).ln();
    let decay = flux.decay + spread(rho, mu_s_prime, flux.path);
    finite_result("diffusion_slab", exponential(logarithm, decay))
}

fn in_total(input: &DiffusionSlabTotal, face: Face) -> Result<f64> {
    let Some(flux) = Flux::new(input, face)? else { return Ok(0.0) };
    finite_result("diffusion_slab_total", exponential(flux.logarithm, flux.decay))
}

/// The flux through a face, e^(logarithm − decay).
#[derive(Debug, Clone, Copy)]
struct Flux {
    /// v t.
    path: f64,
    a: f64,
    logarithm: f64,
    decay: f64,
}

impl Flux {
    /// `None` where there is no light, before time 0 or below the smallest numbers.
    fn new(input: &DiffusionSlabTotal, face: Face) -> Result<Option<Self>> {
        let &DiffusionSlabTotal { time, mu_a, mu_s_prime, thickness, eta, speed } = input;
        positive("eta", eta)?;
        let speed = speed / eta;
        let path = check_medium(time, mu_a, mu_s_prime, speed)?;
        positive("thickness", thickness)?;
        let depth = 1.0 / mu_s_prime;
        require(depth < thickness, "mu_s_prime", mu_s_prime, "above 1 / thickness")?;
        let boundary = diffusion_boundary_parameter(&BoundaryParameter { eta })?;
        if path <= 0.0 {
            return Ok(None);
        }
        let a = 4.0 / 3.0 * path * depth;
        require(a >= f64::MIN_POSITIVE, "4 D t", a, "above the smallest normal number")?;
        let images = Images {
            a,
            period: thickness + boundary * depth * (4.0 / 3.0),
            near: depth,
            far: depth * (1.0 + 4.0 / 3.0 * boundary),
            to_back: thickness - depth,
        };
        let (sum, exponent) = images.both(face);
        // Not a number where the exponents themselves overflow.
        if sum <= 0.0 || sum.is_nan() {
            return Ok(None);
        }
        let logarithm = speed.ln() + sum.ln() - (2.0 * path).ln() - 0.5 * (PI * a).ln();
        Ok(Some(Self { path, a, logarithm, decay: exponent + mu_a * path }))
    }
}

/// Where the light starts and where its images are.
#[derive(Debug, Clone, Copy)]
struct Images {
    /// a = 4 D t.
    a: f64,
    /// P.
    period: f64,
    /// z0.
    near: f64,
    /// z0 + 2 z_e.
    far: f64,
    /// s − z0 = P − far.
    to_back: f64,
}

impl Images {
    /// The two terms of R or T, as a factor and an exponent e^(−exponent).
    fn both(&self, face: Face) -> (f64, f64) {
        if self.a <= 4.0 / PI * self.period * self.period {
            self.by_images(face)
        } else {
            self.by_modes(face)
        }
    }

    fn by_images(&self, face: Face) -> (f64, f64) {
        let first = match face {
            Face::Front => self.near,
            Face::Back => self.to_back,
        };
        let exponent = first * (first / self.a);
        let terms = |y: f64, complement: f64| {
            // e^(−distance²/a) relative to the first arrival.
            let gauss = |distance: f64| (-(distance - first) * ((distance + first) / self.a)).exp();
            // The sum over n = start, start + 2, …; what n P − y is for n = 1 is known better.
            let pairs = |start: u32| -> f64 {
                let pair = |n: u32| {
                    let shift = f64::from(n) * self.period;
                    let distance = shift - self.period + complement;
                    let decay = (-4.0 * shift * (y / self.a)).exp_m1();
                    gauss(distance) * (-shift * decay - y * (2.0 + decay))
                };
                (start..start + 2 * PAIRS).step_by(2).map(pair).sum()
            };
            match face {
                Face::Front => y * gauss(y) - pairs(2),
                Face::Back => pairs(1),
            }
        };
        let near = terms(self.near, self.period - self.near);
        (near + terms(self.far, self.to_back), exponent)
    }

    fn by_modes(&self, face: Face) -> (f64, f64) {
        let angle = PI / self.period;
        let rate = 0.25 * angle * self.a * angle;
        let mode = |n: u32| {
            let order = f64::from(n);
            let sign = if face == Face::Back && n.is_multiple_of(2) { -1.0 } else { 1.0 };
            let sines = (order * angle * self.near).sin() + (order * angle * self.far).sin();
            // The first mode's decay is taken out.
            sign * order * (-(order - 1.0) * (order + 1.0) * rate).exp() * sines
        };
        let sum: f64 = (1..=MODES).map(mode).sum();
        // ln of a √(π a) π / (2P²).
        let scale = 1.5 * self.a.ln() + (0.5 / PI.sqrt()).ln() + 2.0 * angle.ln();
        (sum, rate - scale)
    }
}

/// Pairs of images; where images serve, the next one is below e^(−100) of the first.
const PAIRS: u32 = 6;
/// Modes; where modes serve, the next one is below e^(−190) of the first.
const MODES: u32 = 7;

#[cfg(test)]
#[path = "slab_tests.rs"]
mod tests;
