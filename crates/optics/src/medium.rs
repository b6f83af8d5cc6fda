//! Homogeneous media: coefficients \[1/m\], transmittance and free flights.
//!
//! With colour, one distance serves all channels: it is sampled from a mixture over channels
//! (weights `p_c`, one-sample model) and every channel is weighted with the whole mixture's pdf,
//! so that no channel's weight is unbounded (Wilkie et al. 2014, "Hero wavelength").

use crate::{Rgb, Spectrum, Stream};

/// Coefficients of a homogeneous medium \[1/m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<const C: usize> {
    /// Scattering coefficient.
    pub sigma_s: Spectrum<C>,
    /// Extinction coefficient, sigma_s + sigma_a.
    pub sigma_t: Spectrum<C>,
}

impl Coefficients<3> {
    /// See [`Rgb::channels`].
    #[inline]
    pub fn channels<const C: usize>(self) -> Coefficients<C> {
        Coefficients { sigma_s: Rgb::channels(self.sigma_s), sigma_t: Rgb::channels(self.sigma_t) }
    }
}

impl<const C: usize> Coefficients<C> {
    /// Optical depth sigma_t·length; 0 (not NaN) where sigma_t is 0, at infinite length too.
    #[inline]
    pub fn depth(&self, length: f64) -> Spectrum<C> {
        self.sigma_t.map(|sigma_t| if sigma_t == 0.0 { 0.0 } else { sigma_t * length })
    }

    /// Whether light is scattered at all.
    #[inline]
    pub fn scatters(&self) -> bool {
        self.sigma_s.0.iter().any(|&s| s > 0.0)
    }
}

/// exp(−depth), channel by channel; an infinite depth gives 0. Nothing in the way costs nothing.
#[inline]
pub fn transmittance<const C: usize>(depth: Spectrum<C>) -> Spectrum<C> {
    if depth.is_zero() { Spectrum::ONE } else { depth.map(|d| (-d).exp()) }
}

/// Picks a channel with probability proportional to `weights` (which are not all zero); for one
/// channel no random number is used.
#[inline]
pub fn choose_channel<const C: usize>(weights: Spectrum<C>, rng: &mut Stream) -> usize {
    if C == 1 {
        return 0;
    }
    let mut rest = rng.uniform() * weights.0.iter().sum::<f64>();
    for channel in 0..C - 1 {
        if rest < weights[channel] {
            return channel;
        }
        rest -= weights[channel];
    }
    // Rounding can leave a rest behind a last weight of zero.
    (0..C).rev().find(|&c| weights[c] > 0.0).unwrap_or(C - 1)
}

/// Distance −ln(1 − u)/sigma_t of a collision; infinite where sigma_t is 0.
#[inline]
pub fn sample_exponential(sigma_t: f64, u: f64) -> f64 {
    if sigma_t == 0.0 { f64::INFINITY } else { -(-u).ln_1p() / sigma_t }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_left_at_infinity_and_vacuum_takes_nothing() {
        let fog = Coefficients { sigma_s: Spectrum([0.4]), sigma_t: Spectrum([0.5]) };
        assert_eq!(transmittance(fog.depth(f64::INFINITY)), Spectrum([0.0]));
        let vacuum = Coefficients { sigma_s: Spectrum([0.0]), sigma_t: Spectrum([0.0]) };
        assert_eq!(transmittance(vacuum.depth(f64::INFINITY)), Spectrum([1.0]));
    }

    #[test]
    fn a_channel_without_weight_is_never_chosen() {
        let mut rng = Stream::new(1, 2, 3);
        let weights = Spectrum([0.0, 2.0, 0.0]);
        assert!((0..1000).all(|_| choose_channel(weights, &mut rng) == 1));
    }
}
