//! A photon under way.

use glam::DVec3;
use tpb_film::Ledger;
use tpb_optics::{Spectrum, Stream};
use tpb_scene::{Emission, Hit, IntegratorSpec, Scene, Vertex};

use crate::DiffuseLobe;
use crate::carrier::{roulette, thin};

/// A photon: a share of the light, with one place, direction and time.
#[derive(Clone, Copy, Debug)]
pub struct Photon<const C: usize> {
    /// Where it is, and what surrounds it.
    pub vertex: Vertex,
    /// Unit direction in which it arrived here, or leaves.
    pub direction: DVec3,
    /// Power \[W\] (energy \[J\] for pulses).
    pub power: Spectrum<C>,
    /// OPL from the emitter's surface to the vertex \[m\].
    pub opl: f64,
    /// Scattering events so far, of any kind but null crossings.
    pub events: u32,
    /// All of them were mirrors and smooth glass: what it lights may be a caustic (Jensen 1996).
    pub specular: bool,
    /// Index of its emitter in [`Scene::emitters`].
    pub emitter: usize,
    /// Its number in the pass, from 0.
    pub index: u64,
    /// Largest channel when emitted.
    emitted: f64,
}

/// A photon's arrival at a surface that scatters diffusely, with a reflectance that is not 0.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceArrival {
    /// Where.
    pub hit: Hit,
    /// How the surface reflects; its normal is the face's.
    pub lobe: DiffuseLobe,
}

impl<const C: usize> Photon<C> {
    /// As it leaves its emitter, standing for `share` of the light.
    #[inline]
    pub(crate) fn new(scene: &Scene, emission: &Emission<C>, index: u64, share: f64) -> Self {
        let power = emission.power * share;
        let vertex = Vertex {
            position: emission.position,
            primitive: emission.primitive,
            region: scene.emitters[emission.emitter].region,
        };
        Self {
            vertex,
            direction: emission.direction,
            power,
            opl: 0.0,
            events: 0,
            specular: true,
            emitter: emission.emitter,
            index,
            emitted: power.max_channel(),
        }
    }

    /// Depth of the path that scatters once more, at the next event, and goes straight to the eye
    /// (an emitter seen directly has depth 1).
    #[inline]
    pub fn depth(&self) -> u32 {
        self.events + 2
    }

    /// Counts an event; whether paths may become deep enough for what comes after it.
    #[inline]
    pub(crate) fn goes_on(&mut self, limits: &IntegratorSpec, ledger: &mut Ledger) -> bool {
        self.events += 1;
        if self.power.is_zero() {
            return false;
        }
        let deep_enough = limits.reaches(self.depth());
        if !deep_enough {
            ledger.cut_by_depth += self.power.luminance();
        }
        deep_enough
    }

    /// Russian roulette, from `rr_depth` events on; thinning before, from `thin_from` on.
    #[inline]
    pub(crate) fn survives(
        &mut self,
        limits: &IntegratorSpec,
        thin_from: u32,
        rng: &mut Stream,
        ledger: &mut Ledger,
    ) -> bool {
        if self.events >= limits.rr_depth {
            roulette(&mut self.power, self.emitted, rng, ledger)
        } else if self.events >= thin_from {
            thin(&mut self.power, self.emitted, rng, ledger)
        } else {
            true
        }
    }
}

#[cfg(test)]
mod tests {
    use tpb_scene::Region;

    use super::*;

    /// As camera paths: from `rr_depth` events on.
    #[test]
    fn roulette_starts_after_rr_depth_events_and_thinning_before() {
        let limits = IntegratorSpec { rr_depth: 3, ..Default::default() };
        for events in 0..6 {
            let vertex = Vertex { position: DVec3::ZERO, primitive: None, region: Region::VACUUM };
            let mut photon = Photon {
                vertex,
                direction: DVec3::Z,
                power: Spectrum([1e-300]),
                opl: 0.0,
                events,
                specular: false,
                emitter: 0,
                index: 0,
                emitted: 1.0,
            };
            let mut rng = Stream::new(1, 2, 3);
            let mut ledger = Ledger::default();
            for (thin_from, first) in [(u32::MAX, 3), (2, 2), (4, 3)] {
                let survives = photon.survives(&limits, thin_from, &mut rng, &mut ledger);
                assert_eq!(survives, events < first, "{events}");
            }
        }
    }
}
