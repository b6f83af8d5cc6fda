//! Taps: photons as they are at given optical path lengths, for what no camera sees.
//!
//! At a chosen OPL since the emission every photon that is still alive has a place, a direction and
//! a power. A reading is analog: a photon is on its flight until the collision that its free flight
//! drew, and only there. Sums over a batch of readings estimate fluences integrated over a region,
//! moments of the distance, and energies of one order of scattering, all without bias.

use glam::DVec3;
use tpb_optics::Stream;
use tpb_scene::{IntegratorSpec, Scene};
use tpb_transport::{
    FreeFlight, Outcome, Photon, PhotonBatch, PhotonTracer, PhotonVisitor, Sampling,
};

use crate::statistics::Batches;

/// A photon at a tap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// From where it was emitted to where it is \[m\].
    pub displacement: DVec3,
    /// Unit direction in which it was emitted.
    pub emitted: DVec3,
    /// Its power, as a share of all that is emitted in the batch.
    pub power: f64,
    /// How often it was scattered.
    pub events: u32,
}

/// A number read from each photon at one OPL, summed over photons with their powers.
pub struct Tap {
    /// OPL since the emission \[m\].
    pub opl: f64,
    /// The number.
    pub read: Box<dyn Fn(&Reading) -> f64 + Sync + Send>,
}

/// How many photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TapPlan {
    /// Independent batches.
    pub batches: u64,
    /// Photons of each.
    pub photons: u64,
    /// Seed.
    pub seed: u64,
}

/// Reads all taps of an achromatic scene whose emitters have a power of 1 W in all: one value of
/// each for every batch.
pub fn read(scene: &Scene, integrator: IntegratorSpec, taps: &[Tap], plan: &TapPlan) -> Batches {
    let mut order: Vec<usize> = (0..taps.len()).collect();
    order.sort_by(|&a, &b| taps[a].opl.total_cmp(&taps[b].opl));
    let (taps, order) = (&taps, &order);
    let tracer = PhotonTracer { scene, integrator, sampling: Sampling::default() };
    let mut batches = Batches::new();
    for pass in 0..plan.batches {
        let batch = PhotonBatch { seed: plan.seed, pass, count: plan.photons };
        let (visitors, _) = tracer.trace::<1, Reader<'_>>(batch, |_| Reader::new(taps, order));
        let mut sums = vec![0.0; taps.len()];
        for visitor in visitors {
            for (sum, more) in sums.iter_mut().zip(visitor.sums) {
                *sum += more;
            }
        }
        batches.push(sums);
    }
    batches
}

/// Reads a chunk of photons.
struct Reader<'a> {
    taps: &'a [Tap],
    /// Indices of the taps by OPL.
    order: &'a [usize],
    /// Position in `order` of the first tap that the photon has not passed.
    next: usize,
    origin: DVec3,
    emitted: DVec3,
    sums: Vec<f64>,
}

impl<'a> Reader<'a> {
    fn new(taps: &'a [Tap], order: &'a [usize]) -> Self {
        let (origin, emitted) = (DVec3::ZERO, DVec3::Z);
        Self { taps, order, next: 0, origin, emitted, sums: vec![0.0; taps.len()] }
    }
}

impl PhotonVisitor<1> for Reader<'_> {
    fn emission(&mut self, photon: &Photon<1>, _: &mut Stream) {
        (self.origin, self.emitted) = (photon.vertex.position, photon.direction);
        self.next = 0;
    }

    fn flight(
        &mut self,
        photon: &Photon<1>,
        free: &FreeFlight<'_, 1>,
        outcome: &Outcome<'_, 1>,
        _: &mut Stream,
    ) {
        let end = outcome.collision().unwrap_or(f64::INFINITY);
        for span in &free.flight().spans {
            let start_opl = photon.opl + free.flight().opl(span.start);
            let last = span.end.min(end);
            while let Some(&index) = self.order.get(self.next) {
                let tap = &self.taps[index];
                let distance = span.start + (tap.opl - start_opl) / span.region.eta;
                if distance >= last {
                    break;
                }
                let reading = Reading {
                    displacement: free.flight().at(distance) - self.origin,
                    emitted: self.emitted,
                    power: (photon.power * free.passing(distance).total())[0],
                    events: photon.events,
                };
                self.sums[index] += reading.power * (tap.read)(&reading);
                self.next += 1;
            }
        }
    }
}
