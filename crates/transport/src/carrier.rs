//! What changes a carrier (a photon's power \[W\], or a camera path's importance) without moving
//! it, and how the ledger books the change.

use tpb_film::Ledger;
use tpb_optics::{Spectrum, Stream};

/// Largest probability to survive roulette, so that what loses nothing ends too.
const LARGEST_SURVIVAL: f64 = 0.95;

/// Weights of a free flight's outcome, channel by channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightWeight<const C: usize> {
    /// Of the choice of one distance for all channels: 1 in the mean over the outcomes, and 1 in
    /// one channel.
    pub choice: Spectrum<C>,
    /// What absorption left, 0 to 1: the albedo of a collision, and the transmittance of media that
    /// only absorb.
    pub absorption: Spectrum<C>,
}

impl<const C: usize> FlightWeight<C> {
    /// Both factors.
    #[inline]
    pub fn total(&self) -> Spectrum<C> {
        if C == 1 { self.absorption } else { self.choice * self.absorption }
    }

    /// Applies both factors. A jump of luminance by the choice is booked as roulette, which it is.
    #[inline]
    pub fn apply(&self, carried: &mut Spectrum<C>, ledger: &mut Ledger) {
        if C > 1 {
            let before = carried.luminance();
            *carried *= self.choice;
            book_choice(before, carried.luminance(), ledger);
        }
        let before = carried.luminance();
        *carried *= self.absorption;
        ledger.absorbed_in_media += before - carried.luminance();
    }
}

/// Multiplies by a surface's reflectance (or transmittance) and books the rest as absorbed.
#[inline]
pub fn absorb_on_surface<const C: usize>(
    carried: &mut Spectrum<C>,
    factor: Spectrum<C>,
    ledger: &mut Ledger,
) {
    let before = carried.luminance();
    *carried *= factor;
    ledger.absorbed_on_surfaces += before - carried.luminance();
}

/// Russian roulette: survival with the probability largest channel/`start`, at most 0.95; survivors
/// are divided by it. `start` is the largest channel that the path began with (1 for importance).
#[inline]
pub fn roulette<const C: usize>(
    carried: &mut Spectrum<C>,
    start: f64,
    rng: &mut Stream,
    ledger: &mut Ledger,
) -> bool {
    let survival = (carried.max_channel() / start).min(LARGEST_SURVIVAL);
    survive(carried, survival, rng, ledger)
}

/// Roulette of what has lost something only: survivors carry what they began with, as far as the
/// largest channel tells, and what lost nothing survives.
#[inline]
pub(crate) fn thin<const C: usize>(
    carried: &mut Spectrum<C>,
    start: f64,
    rng: &mut Stream,
    ledger: &mut Ledger,
) -> bool {
    let survival = carried.max_channel() / start;
    survival >= 1.0 || survive(carried, survival, rng, ledger)
}

#[inline]
fn survive<const C: usize>(
    carried: &mut Spectrum<C>,
    survival: f64,
    rng: &mut Stream,
    ledger: &mut Ledger,
) -> bool {
    let before = carried.luminance();
    if rng.uniform() >= survival {
        ledger.roulette_lost += before;
        return false;
    }
    *carried = *carried / survival;
    book_choice(before, carried.luminance(), ledger);
    true
}

#[inline]
fn book_choice(before: f64, after: f64, ledger: &mut Ledger) {
    if after > before {
        ledger.roulette_gained += after - before;
    } else {
        ledger.roulette_lost += before - after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_carriers_lose_and_gain_is_booked() {
        let mut ledger = Ledger { emitted: 1.0, ..Ledger::default() };
        let mut carried = Spectrum([1.0; 3]);
        let choice = Spectrum([1.5, 0.2, 0.7]);
        let weight = FlightWeight { choice, absorption: Spectrum([0.5, 1.0, 0.25]) };
        weight.apply(&mut carried, &mut ledger);
        assert_eq!(carried, weight.total());
        assert!((ledger.roulette_lost - (1.0 - choice.luminance())).abs() < 1e-15);
        absorb_on_surface(&mut carried, Spectrum([0.5; 3]), &mut ledger);
        let mut rng = Stream::new(1, 2, 3);
        while roulette(&mut carried, 1.0, &mut rng, &mut ledger) {}
        assert!(ledger.closure().abs() < 1e-15, "{ledger:?}");
    }

    /// The mean of what survives is what came: 10⁵ trials of q = 0.3, whose mean of 1/q with
    /// probability q has the standard error √((1/q − 1)/n) = 4.8e-3; 5 of them.
    #[test]
    fn roulette_keeps_the_mean_and_kills_some_of_what_loses_nothing() {
        for (start, least, most) in [(1.0 / 0.3, 0.976, 1.024), (1.0, 0.996, 1.004)] {
            let (n, mut sum, mut killed) = (100_000, 0.0, 0);
            let mut rng = Stream::new(4, 5, 6);
            for _ in 0..n {
                let mut carried = Spectrum([1.0]);
                if roulette(&mut carried, start, &mut rng, &mut Ledger::default()) {
                    sum += carried[0];
                } else {
                    killed += 1;
                }
            }
            let mean = sum / f64::from(n);
            assert!((least..most).contains(&mean) && killed > 0, "{mean} {killed}");
        }
    }
}
