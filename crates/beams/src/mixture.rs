//! One distance for all channels: the mixture over channels that a coloured medium's free flights
//! are drawn from.
//!
//! The channel that draws the distance has probability p_c ∝ power; whatever channel it was, every
//! channel's power is multiplied by f_c/Σ_j p_j f_j, f being the density (or probability) with
//! which that channel alone would have ended the flight so. No weighted power exceeds the sum of
//! powers. f may be scaled by a common factor, so optical depths count from the least one: deep
//! flights do not underflow to 0/0.

use tpb_optics::Spectrum;

/// exp(−depth) relative to the least depth among the channels that are drawn at all; channels that
/// are not have no power, and get 1.
pub(crate) fn relative_transmittance<const C: usize>(
    depth: Spectrum<C>,
    mixture: Spectrum<C>,
) -> Spectrum<C> {
    let drawn = (0..C).filter(|&c| mixture[c] > 0.0);
    let least = drawn.map(|c| depth[c]).fold(f64::INFINITY, f64::min);
    // Equal depths, infinite ones too, are no difference.
    Spectrum(std::array::from_fn(|c| {
        if depth[c] == least || mixture[c] == 0.0 { 1.0 } else { (least - depth[c]).exp() }
    }))
}

/// f_c/Σ_j p_j f_j.
pub(crate) fn weight<const C: usize>(density: Spectrum<C>, mixture: Spectrum<C>) -> Spectrum<C> {
    density / (mixture * density).0.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weighted_power_is_bounded_and_deep_flights_are_finite() {
        let power = Spectrum([3.0, 0.0, 1.0]);
        let mixture = power / 4.0;
        for depth in [[1.0, 0.0, 2.0], [2000.0, 1.0, 3000.0], [f64::INFINITY, 0.0, f64::INFINITY]] {
            let left = relative_transmittance(Spectrum(depth), mixture);
            let weighted = power * weight(left, mixture);
            assert!(weighted.is_finite() && weighted.max_channel() <= 4.0 + 1e-12, "{weighted:?}");
        }
    }
}
