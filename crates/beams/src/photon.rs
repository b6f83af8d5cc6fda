//! A photon under way, and what changes its power without moving it.

use glam::DVec3;
use tpb_film::Ledger;
use tpb_optics::{Spectrum, Stream};
use tpb_scene::{IntegratorSpec, Vertex};

/// Largest probability to survive roulette, so that light that loses nothing ends too.
pub(crate) const LARGEST_SURVIVAL: f64 = 0.95;

/// A photon under way.
pub(crate) struct Photon<const C: usize> {
    pub(crate) vertex: Vertex,
    pub(crate) direction: DVec3,
    pub(crate) power: Spectrum<C>,
    pub(crate) opl: f64,
    /// Scattering events so far.
    pub(crate) events: u32,
    /// Largest channel when emitted.
    pub(crate) emitted: f64,
    /// Whether next-event estimation can find its emitter.
    pub(crate) connectable: bool,
    /// Power of its beams over its own, if it leaves any.
    pub(crate) beam_scale: Option<f64>,
}

impl<const C: usize> Photon<C> {
    /// Applies a one-sample weight; in one channel it is 1.
    pub(crate) fn weigh(&mut self, factor: Spectrum<C>, ledger: &mut Ledger) {
        if C == 1 {
            return;
        }
        let before = self.power.luminance();
        self.power *= factor;
        let after = self.power.luminance();
        if after > before {
            ledger.roulette_gained += after - before;
        } else {
            ledger.roulette_lost += before - after;
        }
    }

    /// Counts an event; whether paths may become deep enough for what comes after it.
    pub(crate) fn goes_on(&mut self, limits: &IntegratorSpec, ledger: &mut Ledger) -> bool {
        self.events += 1;
        if self.power.is_zero() {
            return false;
        }
        let deep_enough = limits.reaches(self.events + 2);
        if !deep_enough {
            ledger.cut_by_depth += self.power.luminance();
        }
        deep_enough
    }

    /// Russian roulette.
    pub(crate) fn survives(
        &mut self,
        limits: &IntegratorSpec,
        rng: &mut Stream,
        ledger: &mut Ledger,
    ) -> bool {
        if self.events < limits.rr_depth {
            return true;
        }
        let survival = (self.power.max_channel() / self.emitted).min(LARGEST_SURVIVAL);
        let before = self.power.luminance();
        if rng.uniform() >= survival {
            ledger.roulette_lost += before;
            return false;
        }
        self.power = self.power / survival;
        ledger.roulette_gained += self.power.luminance() - before;
        true
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tpb_scene::Region;

    use super::*;

    /// As camera paths: from `rr_depth` events on.
    #[test]
    fn roulette_starts_after_rr_depth_events() {
        let limits = IntegratorSpec { rr_depth: 3, ..Default::default() };
        for events in 0..6 {
            let vertex = Vertex { position: DVec3::ZERO, primitive: None, region: Region::VACUUM };
            let mut photon = Photon {
                vertex,
                direction: DVec3::Z,
                power: Spectrum([1e-300]),
                opl: 0.0,
                events,
                emitted: 1.0,
                connectable: true,
                beam_scale: None,
            };
            let mut rng = Stream::new(1, 2, 3);
            let survives = photon.survives(&limits, &mut rng, &mut Ledger::default());
            assert_eq!(survives, events < limits.rr_depth, "{events}");
        }
    }
}
