//! Free flights: where along a flight a camera path scatters next, or that it reaches the end.
//!
//! Only media that scatter take part in the choice; media that only absorb weigh the path by their
//! transmittance, which costs no path its life. With D_c(t) the optical depth of the scattering
//! media before t in channel c, and mixture weights m_c (the path's own throughput, normalised),
//!
//! ```text
//! density of t:   p(t) = Σ_c m_c σ_t,c(t) exp(−D_c(t))      weight of channel c:  T_c(t) σ_s,c(t) / p(t)
//! the end:        P    = Σ_c m_c exp(−D_c(ℓ))               weight of channel c:  T_c(ℓ) / P
//! ```
//!
//! A channel's exponential is in the denominator with the channel's own share, so m_c times its
//! weight stays below 1 (Wilkie et al. 2014). For one channel the exponentials cancel by hand.

use tpb_optics::medium::{choose_channel, transmittance};
use tpb_optics::{Coefficients, Spectrum, Stream};
use tpb_scene::{Flight, Medium, Region, Scene};

/// A flight, ready for choosing a distance.
pub(crate) struct FreeFlight<'a, const C: usize> {
    scene: &'a Scene,
    flight: &'a Flight,
    /// Channel weights m_c, of sum 1.
    mixture: Spectrum<C>,
    /// From the start of the first to the end of the last part that scatters.
    extent: Option<(f64, f64)>,
}

/// A part of a flight within a medium.
pub(crate) struct Part<'a, const C: usize> {
    start: f64,
    end: f64,
    /// What surrounds it.
    pub(crate) region: Region,
    pub(crate) medium: &'a Medium,
    pub(crate) coefficients: Coefficients<C>,
}

/// What a free flight comes to.
pub(crate) enum Outcome<'a, const C: usize> {
    /// A scattering event in a medium, at a distance.
    Collision { distance: f64, part: Part<'a, C>, weight: Spectrum<C> },
    /// The flight's end.
    Survival { weight: Spectrum<C> },
}

impl<'a, const C: usize> FreeFlight<'a, C> {
    /// For a path of this throughput, which is not zero.
    #[inline]
    pub(crate) fn new(scene: &'a Scene, flight: &'a Flight, throughput: Spectrum<C>) -> Self {
        let mut extent = None;
        for span in &flight.spans {
            if span.region.medium.is_some_and(|id| scene.medium(id).coefficients.scatters()) {
                extent = Some((extent.map_or(span.start, |(start, _)| start), span.end));
            }
        }
        let mixture =
            if C == 1 { Spectrum::ONE } else { throughput / throughput.0.iter().sum::<f64>() };
        Self { scene, flight, mixture, extent }
    }

    /// The part of the flight outside which nothing scatters; `None` if nothing does.
    #[inline]
    pub(crate) fn extent(&self) -> Option<(f64, f64)> {
        self.extent
    }

    /// Chooses where the flight ends. Draws no random number where nothing scatters.
    #[inline]
    pub(crate) fn sample(&self, rng: &mut Stream) -> Outcome<'a, C> {
        if self.extent.is_none() {
            return Outcome::Survival { weight: self.transmittance() };
        }
        let channel = choose_channel(self.mixture, rng);
        // 1 − u is exact for u a multiple of 2⁻⁵³, and never 0.
        let mut depth = -(1.0 - rng.uniform()).ln();
        for part in self.parts().filter(|part| part.coefficients.scatters()) {
            let sigma_t = part.coefficients.sigma_t[channel];
            if sigma_t == 0.0 {
                continue;
            }
            let distance = part.start + depth / sigma_t;
            if distance < part.end {
                let weight = self.collision_weight(distance, &part.coefficients);
                return Outcome::Collision { distance, part, weight };
            }
            depth -= sigma_t * (part.end - part.start);
        }
        Outcome::Survival { weight: self.survival_weight() }
    }

    /// Density p(t) of a collision at a distance \[1/m\]; 0 where nothing scatters.
    #[inline]
    pub(crate) fn density(&self, distance: f64) -> f64 {
        self.scattering_at(distance).map_or(0.0, |part| {
            let (scattering, _) = self.depths(distance);
            self.mix(part.coefficients.sigma_t * transmittance(scattering))
        })
    }

    /// The part that scatters at a distance, if one does.
    #[inline]
    pub(crate) fn scattering_at(&self, distance: f64) -> Option<Part<'a, C>> {
        self.parts()
            .find(|part| part.start <= distance && distance < part.end)
            .filter(|part| part.coefficients.scatters())
    }

    /// Transmittance of all media to the flight's end.
    #[inline]
    pub(crate) fn transmittance(&self) -> Spectrum<C> {
        let (scattering, absorbing) = self.depths(f64::INFINITY);
        transmittance(scattering + absorbing)
    }

    #[inline]
    fn collision_weight(&self, distance: f64, c: &Coefficients<C>) -> Spectrum<C> {
        let (scattering, absorbing) = self.depths(distance);
        if C == 1 {
            return c.sigma_s / c.sigma_t * absorption(absorbing);
        }
        let density = self.mix(c.sigma_t * transmittance(scattering));
        c.sigma_s * transmittance(scattering + absorbing) / density
    }

    #[inline]
    fn survival_weight(&self) -> Spectrum<C> {
        let (scattering, absorbing) = self.depths(f64::INFINITY);
        if C == 1 {
            return absorption(absorbing);
        }
        transmittance(scattering + absorbing) / self.mix(transmittance(scattering))
    }

    /// The mixture's value of what each channel has.
    #[inline]
    fn mix(&self, channels: Spectrum<C>) -> f64 {
        (self.mixture * channels).0.iter().sum()
    }

    /// Optical depths before a distance: of media that scatter, and of those that only absorb.
    #[inline]
    fn depths(&self, distance: f64) -> (Spectrum<C>, Spectrum<C>) {
        let (mut scattering, mut absorbing) = (Spectrum::ZERO, Spectrum::ZERO);
        for part in self.parts().take_while(|part| part.start < distance) {
            let depth = part.coefficients.depth(part.end.min(distance) - part.start);
            if part.coefficients.scatters() {
                scattering += depth;
            } else {
                absorbing += depth;
            }
        }
        (scattering, absorbing)
    }

    #[inline]
    fn parts(&self) -> impl Iterator<Item = Part<'a, C>> + use<'a, C> {
        let scene = self.scene;
        self.flight.spans.iter().filter_map(move |span| {
            let medium = scene.medium(span.region.medium?);
            let coefficients = medium.coefficients.channels();
            Some(Part {
                start: span.start,
                end: span.end,
                region: span.region,
                medium,
                coefficients,
            })
        })
    }
}

/// Transmittance of media that only absorb: nearly always there are none on the way.
#[inline]
fn absorption<const C: usize>(depth: Spectrum<C>) -> Spectrum<C> {
    if depth.is_zero() { Spectrum::ONE } else { transmittance(depth) }
}
