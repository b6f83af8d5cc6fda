//! What one beam adds to one camera ray: an energy, and when it arrives.

use tpb_film::{Arrival, TemporalProfile, Tile};
use tpb_optics::Spectrum;

use crate::Temporal;
use crate::beam::Attenuation;
use crate::kernel3d::Swept;
use crate::sweep::MOST_BREAKS;

/// One ray-beam pair's share of the image.
#[derive(Clone, Copy, Debug)]
pub struct Contribution<const C: usize> {
    /// First arrival: OPL from the emitter to the eye \[m\].
    pub start: f64,
    /// Last arrival \[m\]; equal to `start` for an instant.
    pub end: f64,
    /// Time-integrated radiance \[W m⁻² sr⁻¹\].
    pub energy: Spectrum<C>,
    /// How it is spread between the two.
    pub spread: Spread<C>,
}

/// Distribution of energy over the arrival interval.
#[derive(Clone, Copy, Debug)]
pub enum Spread<const C: usize> {
    /// ∝ exp(−depth·x), x from 0 to 1 over the interval.
    Exponential {
        /// Optical depth between start and end.
        depth: Spectrum<C>,
    },
    /// ∝ the attenuation of a short beam in a coloured medium.
    Mixture {
        /// The beam's.
        attenuation: Attenuation<C>,
        /// Extinction \[1/m\].
        sigma_t: Spectrum<C>,
        /// Distances along the beam at start and end \[m\].
        along_beam: [f64; 2],
        /// Distances along the ray at start and end \[m\].
        along_ray: [f64; 2],
    },
    /// As a swept sphere.
    Swept(Swept<C>),
}

impl<const C: usize> Contribution<C> {
    /// Adds it, times `weight`, to the pixel at `place` of a tile.
    #[inline]
    pub fn deposit(
        &self,
        temporal: Temporal,
        weight: f64,
        (tile, place, unwarp_opl): (&mut Tile<'_, C>, usize, f64),
    ) {
        let &Self { start, end, energy, .. } = self;
        let energy = energy * weight;
        if end == start {
            tile.deposit_at(place, unwarp_opl, &Arrival::Instant(start), energy);
            return;
        }
        let profile = match (temporal, self.spread) {
            (Temporal::Even, _) => TemporalProfile::Uniform { start, end },
            (Temporal::Exact, Spread::Exponential { depth }) => {
                TemporalProfile::Exponential { start, end, depth }
            }
            (Temporal::Exact, Spread::Mixture { attenuation, sigma_t, along_beam, along_ray }) => {
                let density = |opl: f64| {
                    let x = (opl - start) / (end - start);
                    let between = |[a, b]: [f64; 2]| a + (b - a) * x;
                    attenuation.at(sigma_t, between(along_beam), between(along_ray))
                };
                let density: &(dyn Fn(f64) -> Spectrum<C> + Sync) = &density;
                let profile = TemporalProfile::General { start, end, breaks: &[], density };
                tile.deposit_at(place, unwarp_opl, &Arrival::Profile(profile), energy);
                return;
            }
            (Temporal::Exact, Spread::Swept(swept)) => {
                let ([first, last], kinks) = swept.span_and_breaks();
                let metres = (end - start) / (last - first);
                let density = |opl: f64| swept.at(first + (opl - start) / metres);
                let density: &(dyn Fn(f64) -> Spectrum<C> + Sync) = &density;
                let mut breaks = [0.0; MOST_BREAKS];
                let breaks = &mut breaks[..kinks.len()];
                for (opl, tau) in breaks.iter_mut().zip(kinks) {
                    *opl = start + metres * (tau - first);
                }
                let profile = TemporalProfile::General { start, end, breaks, density };
                tile.deposit_at(place, unwarp_opl, &Arrival::Profile(profile), energy);
                return;
            }
        };
        tile.deposit_at(place, unwarp_opl, &Arrival::Profile(profile), energy);
    }
}
