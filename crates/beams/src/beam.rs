//! What the light side leaves behind: beams in media and photons on surfaces; and what a camera
//! ray brings to them.
//!
//! A **long** beam runs to the end of its span of one medium and carries the transmittance along
//! itself explicitly. A **short** beam ends at the collision that the photon's free flight drew: it
//! reaches s with probability Σ_j q_j exp(−σ_j s) (q: the channel mixture, times what the spans
//! before let through), so that its weight per channel at s is
//!
//! ```text
//! w_c(s) = exp(−σ_c s) / Σ_j q_j exp(−σ_j s),
//! ```
//!
//! which is 1 in one channel. Both have the same expectation; long beams have less variance and
//! more pairs.

use glam::DVec3;
use tpb_optics::{Coefficients, Phase, Spectrum};
use tpb_scene::{Flight, MediumId, Scene, Span};

/// The largest x with exp(−x) > 0 in f64 is below this.
const VANISHING_DEPTH: f64 = 745.2;

/// How a beam's light decreases along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attenuation<const C: usize> {
    /// A long beam: by transmittance.
    Explicit,
    /// A short beam: by its end, which was drawn from this mixture of channels.
    Sampled {
        /// q_j of the module's equation.
        mixture: Spectrum<C>,
    },
}

/// Light along a segment of one medium.
#[derive(Clone, Copy, Debug)]
pub struct Beam<const C: usize> {
    /// Where it starts \[m\].
    pub origin: DVec3,
    /// Unit direction of the light.
    pub direction: DVec3,
    /// Length \[m\], finite (see [`visible_length`]).
    pub length: f64,
    /// OPL from the emitter to the origin \[m\].
    pub opl: f64,
    /// Power at the origin \[W\].
    pub power: Spectrum<C>,
    /// How it decreases.
    pub attenuation: Attenuation<C>,
    /// The medium that it crosses.
    pub medium: MediumId,
    /// Depth of the path that scatters once more, from the beam straight to the eye.
    pub depth: u32,
}

/// A photon on a diffuse surface, as it arrived.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePhoton<const C: usize> {
    /// Position \[m\].
    pub position: DVec3,
    /// Unit direction of the light as it arrived.
    pub direction: DVec3,
    /// Unit normal of the side that it met.
    pub normal: DVec3,
    /// OPL from the emitter \[m\].
    pub opl: f64,
    /// Power \[W\].
    pub power: Spectrum<C>,
    /// The primitive that it lies on.
    pub primitive: u32,
    /// Depth of the path that is reflected straight to the eye.
    pub depth: u32,
}

/// A segment of a camera ray within one medium.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay<const C: usize> {
    /// Where it starts \[m\].
    pub origin: DVec3,
    /// Unit direction, away from the camera.
    pub direction: DVec3,
    /// Length \[m\]; may be infinite.
    pub length: f64,
    /// OPL from the eye to the origin \[m\].
    pub opl: f64,
    /// What the way from the origin to the eye leaves of radiance.
    pub throughput: Spectrum<C>,
    /// The medium's coefficients.
    pub coefficients: Coefficients<C>,
    /// The medium's phase function.
    pub phase: Phase,
    /// The refractive index.
    pub eta: f64,
}

impl<const C: usize> CameraRay<C> {
    /// What a flight from the eye has in one of its spans, with the medium there; `None` if nothing
    /// scatters.
    #[inline]
    pub fn of_span(scene: &Scene, flight: &Flight, span: &Span) -> Option<(MediumId, Self)> {
        let id = span.region.medium?;
        let medium = scene.medium(id);
        let ray = Self {
            origin: flight.at(span.start),
            direction: flight.direction,
            length: span.end - span.start,
            opl: flight.opl(span.start),
            throughput: flight.transmittance(scene, span.start),
            coefficients: medium.coefficients.channels(),
            phase: medium.phase,
            eta: span.region.eta,
        };
        medium.coefficients.scatters().then_some((id, ray))
    }
}

impl<const C: usize> Attenuation<C> {
    /// What is left after `along_beam` metres of beam and `along_ray` metres of camera ray.
    #[inline]
    pub fn at(&self, sigma_t: Spectrum<C>, along_beam: f64, along_ray: f64) -> Spectrum<C> {
        match self {
            Self::Explicit => sigma_t.map(|s| (-s * (along_beam + along_ray)).exp()),
            Self::Sampled { mixture } => {
                // Relative to the drawn channel that reaches farthest: no 0/0. Channels that are
                // never drawn carry no power.
                let drawn = (0..C).filter(|&c| mixture[c] > 0.0);
                let least = drawn.map(|c| sigma_t[c]).fold(f64::INFINITY, f64::min);
                let reached = Spectrum(std::array::from_fn(|c| {
                    let farther = (sigma_t[c] - least) * along_beam;
                    if mixture[c] > 0.0 { (-farther).exp() } else { 0.0 }
                }));
                let survival: f64 = (0..C).map(|c| mixture[c] * reached[c]).sum();
                reached * sigma_t.map(|s| (-s * along_ray).exp()) / survival
            }
        }
    }
}

/// `length` cut where light that a medium scatters has decreased to exactly 0 in f64.
#[inline]
pub fn visible_length(coefficients: &Coefficients<3>, length: f64) -> f64 {
    let scattering = (0..3).filter(|&c| coefficients.sigma_s[c] > 0.0);
    let slowest = scattering.map(|c| coefficients.sigma_t[c]).fold(f64::INFINITY, f64::min);
    length.min(VANISHING_DEPTH / slowest)
}
