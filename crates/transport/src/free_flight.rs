//! Free flights: where along a flight a path scatters next, or that it reaches the end.
//!
//! Only media that scatter take part in the choice; media that only absorb weigh the path by their
//! transmittance, which costs no path its life. With D_c(t) the optical depth of the scattering
//! media before t in channel c, A_c(t) that of the media that only absorb, and mixture weights m_c
//! (what the path carries, normalised),
//!
//! ```text
//! density of t:   p(t) = Σ_j m_j σ_t,j(t) exp(−D_j(t))
//! the end:        P(ℓ) = Σ_j m_j exp(−D_j(ℓ))
//! weights:        choice σ_t,c exp(−D_c)/p, or exp(−D_c)/P;   absorption σ_s,c/σ_t,c exp(−A_c), or exp(−A_c)
//! ```
//!
//! A channel's exponential is in the denominator with the channel's own share, so m_c times its
//! weight stays below 1 (Wilkie et al. 2014). Exponentials are taken relative to the farthest
//! channel: no 0/0. For one channel they cancel by hand.

use tpb_optics::medium::{choose_channel, transmittance};
use tpb_optics::{Coefficients, Spectrum, Stream};
use tpb_scene::{Flight, Medium, Region, Scene};

use crate::FlightWeight;

/// A flight, ready for choosing a distance.
pub struct FreeFlight<'a, const C: usize> {
    scene: &'a Scene,
    flight: &'a Flight,
    /// Channel weights m_c, of sum 1.
    mixture: Spectrum<C>,
    /// From the start of the first to the end of the last part that scatters.
    extent: Option<(f64, f64)>,
}

/// A part of a flight within a medium.
pub struct Part<'a, const C: usize> {
    /// Distance where it begins \[m\].
    pub start: f64,
    /// Distance where it ends \[m\]; may be infinite.
    pub end: f64,
    /// What surrounds it.
    pub region: Region,
    /// The medium.
    pub medium: &'a Medium,
    /// Its coefficients \[1/m\].
    pub coefficients: Coefficients<C>,
}

/// What a free flight comes to.
pub enum Outcome<'a, const C: usize> {
    /// A scattering event in a medium.
    Collision {
        /// Where \[m\].
        distance: f64,
        /// In what.
        part: Part<'a, C>,
        /// The path's weight.
        weight: FlightWeight<C>,
    },
    /// The flight's end.
    Survival {
        /// The path's weight.
        weight: FlightWeight<C>,
    },
}

impl<const C: usize> Outcome<'_, C> {
    /// Distance of the collision, if there is one \[m\].
    #[inline]
    pub fn collision(&self) -> Option<f64> {
        match *self {
            Self::Collision { distance, .. } => Some(distance),
            Self::Survival { .. } => None,
        }
    }
}

impl<'a, const C: usize> FreeFlight<'a, C> {
    /// For a path that carries this, which is not zero.
    #[inline]
    pub fn new(scene: &'a Scene, flight: &'a Flight, carried: Spectrum<C>) -> Self {
        let mut extent = None;
        for span in &flight.spans {
            if span.region.medium.is_some_and(|id| scene.medium(id).coefficients.scatters()) {
                extent = Some((extent.map_or(span.start, |(start, _)| start), span.end));
            }
        }
        let mixture = if C == 1 { Spectrum::ONE } else { carried / carried.0.iter().sum::<f64>() };
        Self { scene, flight, mixture, extent }
    }

    /// The straight line it is on.
    #[inline]
    pub fn flight(&self) -> &'a Flight {
        self.flight
    }

    /// Channel weights m_c of the choice, of sum 1.
    #[inline]
    pub fn mixture(&self) -> Spectrum<C> {
        self.mixture
    }

    /// The part of the flight outside which nothing scatters; `None` if nothing does.
    #[inline]
    pub fn extent(&self) -> Option<(f64, f64)> {
        self.extent
    }

    /// Chooses where the flight ends. Draws no random number where nothing scatters.
    #[inline]
    pub fn sample(&self, rng: &mut Stream) -> Outcome<'a, C> {
        if self.extent.is_none() {
            return Outcome::Survival { weight: self.passing(f64::INFINITY) };
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
                let weight = self.colliding(distance, &part.coefficients);
                return Outcome::Collision { distance, part, weight };
            }
            depth -= sigma_t * (part.end - part.start);
        }
        Outcome::Survival { weight: self.passing(f64::INFINITY) }
    }

    /// Density p(t) of a collision at a distance \[1/m\]; 0 where nothing scatters.
    #[inline]
    pub fn density(&self, distance: f64) -> f64 {
        self.scattering_at(distance).map_or(0.0, |part| {
            let (scattering, _) = self.depths(distance);
            self.mix(part.coefficients.sigma_t * transmittance(scattering))
        })
    }

    /// The part that scatters at a distance, if one does.
    #[inline]
    pub fn scattering_at(&self, distance: f64) -> Option<Part<'a, C>> {
        self.parts()
            .find(|part| part.start <= distance && distance < part.end)
            .filter(|part| part.coefficients.scatters())
    }

    /// Transmittance of all media to the flight's end.
    #[inline]
    pub fn transmittance(&self) -> Spectrum<C> {
        let (scattering, absorbing) = self.depths(f64::INFINITY);
        transmittance(scattering + absorbing)
    }

    /// Weights of a path that got past `distance` without a collision.
    #[inline]
    pub fn passing(&self, distance: f64) -> FlightWeight<C> {
        let (left, absorption) = self.left(distance);
        FlightWeight { choice: self.choice(left), absorption }
    }

    /// exp(−D_c) before `distance`, up to a factor common to all channels (1 in one channel), and
    /// exp(−A_c): how the chances of getting there compare, and what absorption leaves.
    #[inline]
    pub fn left(&self, distance: f64) -> (Spectrum<C>, Spectrum<C>) {
        let (scattering, absorbing) = self.depths(distance);
        (relative_transmittance(scattering, self.mixture), transmittance(absorbing))
    }

    /// Weights of a path that collides at `distance`.
    #[inline]
    fn colliding(&self, distance: f64, c: &Coefficients<C>) -> FlightWeight<C> {
        let (left, absorption) = self.left(distance);
        FlightWeight { choice: self.choice(left * c.sigma_t), absorption: absorption * albedo(c) }
    }

    /// f_c/Σ_j m_j f_j.
    #[inline]
    fn choice(&self, density: Spectrum<C>) -> Spectrum<C> {
        if C == 1 { Spectrum::ONE } else { density / self.mix(density) }
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

/// exp(−depth) relative to the least depth among the channels that are drawn at all; channels that
/// are not have no power, and get 1.
#[inline]
fn relative_transmittance<const C: usize>(depth: Spectrum<C>, mixture: Spectrum<C>) -> Spectrum<C> {
    if C == 1 {
        return Spectrum::ONE;
    }
    let drawn = (0..C).filter(|&c| mixture[c] > 0.0);
    let least = drawn.map(|c| depth[c]).fold(f64::INFINITY, f64::min);
    // Equal depths, infinite ones too, are no difference.
    Spectrum(std::array::from_fn(|c| {
        if depth[c] == least || mixture[c] == 0.0 { 1.0 } else { (least - depth[c]).exp() }
    }))
}

/// σ_s/σ_t; 0 where a channel does not interact.
#[inline]
fn albedo<const C: usize>(c: &Coefficients<C>) -> Spectrum<C> {
    Spectrum(std::array::from_fn(|i| {
        if c.sigma_t[i] == 0.0 { 0.0 } else { c.sigma_s[i] / c.sigma_t[i] }
    }))
}

#[cfg(test)]
mod tests;
