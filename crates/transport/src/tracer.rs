//! Photons from the emitters to their ends.
//!
//! A photon flies through null boundaries to the next surface, unless its free flight
//! ([`FreeFlight`]) ends in a collision on the way. A collision leaves the albedo's share, a diffuse
//! surface its reflectance's; smooth glass reflects with the probability of the Fresnel
//! reflectance; rough surfaces draw one of their microfacets as they are seen. Fluxes do not scale
//! with η² on refraction. Media that only absorb weigh photons, and end none.
//!
//! **Depth.** After n scattering events (of any kind but null crossings) a photon's next flight
//! adds paths of depth n + 2. It goes on while [`IntegratorSpec::reaches`] allows that depth;
//! `min_depth` is the visitor's business. Roulette ends photons from `rr_depth` events on.
//!
//! **Ledger.** Every photon's power is booked to rounding: see [`FlightWeight::apply`] for colour.
//! Spot lights sample directions uniformly; what they emit is what the photons carry.
//!
//! **Determinism.** A photon has a random stream of its own, (seed, pass, number), and photons are
//! divided into chunks by their number alone: threads do not matter.
//!
//! [`FlightWeight::apply`]: crate::FlightWeight::apply

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use tpb_film::Ledger;
use tpb_optics::quasi::Points;
use tpb_optics::{Spectrum, Stream, seed_of};
use tpb_scene::{Flight, Hit, IntegratorSpec, Scene, Vertex};

use crate::carrier::absorb_on_surface;
use crate::{
    Carrier, Encounter, FreeFlight, Horizon, Lobe, Outcome, Part, Photon, Response, RoughLobe,
    SurfaceArrival,
};

/// Photons per parallel task; the division does not depend on threads.
const CHUNK: u64 = 512;

/// What a method takes from photons on their way. A visitor that draws from `rng` moves the
/// photon's later random numbers: its photons differ from those that another visitor sees.
pub trait PhotonVisitor<const C: usize> {
    /// A photon leaves its emitter.
    #[inline]
    fn emission(&mut self, photon: &Photon<C>, rng: &mut Stream) {
        let _ = (photon, rng);
    }

    /// A photon starts along a flight, with its power at the start; `outcome` is where this flight
    /// will end.
    ///
    /// Beyond its collision the flight goes on to the next surface, so that it can be used with its
    /// expectation (transmittance) or as drawn: at a distance before the collision, or any if there
    /// is none, an analog photon has power × [`FreeFlight::passing`]`(distance).total()`.
    #[inline]
    fn flight(
        &mut self,
        photon: &Photon<C>,
        free: &FreeFlight<'_, C>,
        outcome: &Outcome<'_, C>,
        rng: &mut Stream,
    ) {
        let _ = (photon, free, outcome, rng);
    }

    /// A photon has collided in a medium, at its vertex: power after absorption, direction of
    /// arrival.
    #[inline]
    fn collision(&mut self, photon: &Photon<C>, part: &Part<'_, C>, rng: &mut Stream) {
        let _ = (photon, part, rng);
    }

    /// A photon has reached a surface that scatters diffusely, at its vertex: power and direction of
    /// arrival.
    #[inline]
    fn surface(&mut self, photon: &Photon<C>, arrival: &SurfaceArrival, rng: &mut Stream) {
        let _ = (photon, arrival, rng);
    }

    /// A photon has reached a rough surface, at its vertex: power and direction of arrival.
    #[inline]
    fn rough_surface(&mut self, photon: &Photon<C>, lobe: &RoughLobe, rng: &mut Stream) {
        let _ = (photon, lobe, rng);
    }
}

/// Which photons: all of a pass, each standing for 1/`count` of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhotonBatch {
    /// Seed of the run.
    pub seed: u64,
    /// Index of the pass.
    pub pass: u64,
    /// Number of photons.
    pub count: u64,
}

/// Traces photons through a scene.
#[derive(Clone, Copy)]
pub struct PhotonTracer<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Depths.
    pub integrator: IntegratorSpec,
    /// How photons are drawn.
    pub sampling: Sampling,
}

/// Where photons start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sampler {
    /// Independent of one another.
    #[default]
    Independent,
    /// Spread evenly over emitters, directions and flights: their first numbers are those of a
    /// scrambled Sobol sequence.
    Sobol,
}

/// How photons are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Where they start.
    pub sampler: Sampler,
    /// From so many events on, photons that have lost power are thinned out, so that those left carry
    /// what they began with; `u32::MAX`: roulette alone, from `rr_depth` on.
    pub thin_from: u32,
    /// Photons end once nothing of them can arrive in time; `None`: all are followed.
    pub horizon: Option<Horizon>,
}

impl Default for Sampling {
    /// Independent photons and roulette alone.
    fn default() -> Self {
        Self { sampler: Sampler::default(), thin_from: u32::MAX, horizon: None }
    }
}

impl PhotonTracer<'_> {
    /// Traces a batch of photons on the current threads. Each chunk of consecutive photons has a
    /// visitor of its own, which `visitor` makes from their numbers; all are returned in the
    /// photons' order, with the ledger of all light.
    pub fn trace<const C: usize, V: PhotonVisitor<C> + Send>(
        &self,
        batch: PhotonBatch,
        visitor: impl Fn(Range<u64>) -> V + Sync,
    ) -> (Vec<V>, Ledger) {
        let PhotonBatch { seed, pass, count } = batch;
        let chunks: Vec<(V, Ledger)> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let photons = chunk * CHUNK..(chunk * CHUNK + CHUNK).min(count);
                let mut walk = Walk {
                    tracer: *self,
                    visitor: visitor(photons.clone()),
                    ledger: Ledger::default(),
                };
                let points = Points::new(seed_of(seed, pass));
                for index in photons {
                    let mut rng = Stream::new(seed, pass, index);
                    if self.sampling.sampler == Sampler::Sobol {
                        points.lead(index, &mut rng);
                    }
                    walk.photon::<C>(index, 1.0 / count as f64, &mut rng);
                }
                (walk.visitor, walk.ledger)
            })
            .collect();
        let mut ledger = Ledger::default();
        let visitors = chunks.into_iter().map(|(visitor, of_chunk)| {
            ledger.add(&of_chunk);
            visitor
        });
        (visitors.collect(), ledger)
    }
}

/// One chunk's walk.
struct Walk<'a, V> {
    tracer: PhotonTracer<'a>,
    visitor: V,
    ledger: Ledger,
}

impl<V> Walk<'_, V> {
    /// One photon that stands for `share` of the light.
    fn photon<const C: usize>(&mut self, index: u64, share: f64, rng: &mut Stream)
    where
        V: PhotonVisitor<C>,
    {
        let PhotonTracer { scene, integrator, sampling } = self.tracer;
        let Some(emission) = scene.emit::<C>(rng) else { return };
        let mut photon = Photon::new(scene, &emission, index, share);
        if photon.power.is_zero() {
            return;
        }
        self.ledger.emitted += photon.power.luminance();
        self.visitor.emission(&photon, rng);
        while self.is_in_time(&photon)
            && self.step(&mut photon, rng)
            && photon.survives(&integrator, sampling.thin_from, rng, &mut self.ledger)
        {}
    }

    /// Whether anything of a photon may still arrive within the window; what may not is booked.
    #[inline]
    fn is_in_time<const C: usize>(&mut self, photon: &Photon<C>) -> bool {
        let Some(horizon) = &self.tracer.sampling.horizon else { return true };
        let late = horizon.is_late(photon.vertex.position, photon.opl);
        if late {
            self.ledger.cut_by_window += photon.power.luminance();
        }
        !late
    }

    /// One flight and the event at its end; whether there is light left to go on.
    fn step<const C: usize>(&mut self, photon: &mut Photon<C>, rng: &mut Stream) -> bool
    where
        V: PhotonVisitor<C>,
    {
        let scene = self.tracer.scene;
        let flight = scene.fly(&photon.vertex, photon.direction);
        let free = FreeFlight::new(scene, &flight, photon.power);
        let outcome = free.sample(rng);
        self.visitor.flight(photon, &free, &outcome, rng);
        match outcome {
            Outcome::Collision { distance, part, weight } => {
                weight.apply(&mut photon.power, &mut self.ledger);
                photon.opl += flight.opl(distance);
                let (position, region) = (flight.at(distance), part.region);
                photon.vertex = Vertex { position, primitive: None, region };
                if !photon.power.is_zero() {
                    self.visitor.collision(photon, &part, rng);
                }
                photon.specular = false;
                photon.direction = part.medium.phase.sample(photon.direction, rng);
            }
            Outcome::Survival { weight } => {
                weight.apply(&mut photon.power, &mut self.ledger);
                let Some(hit) = flight.hit else {
                    self.ledger.escaped += photon.power.luminance();
                    return false;
                };
                self.arrive(photon, &flight, &hit, rng);
            }
        }
        photon.goes_on(&self.tracer.integrator, &mut self.ledger)
    }

    /// The surface at the end of a flight.
    fn arrive<const C: usize>(
        &mut self,
        photon: &mut Photon<C>,
        flight: &Flight,
        hit: &Hit,
        rng: &mut Stream,
    ) where
        V: PhotonVisitor<C>,
    {
        let scene = self.tracer.scene;
        photon.opl += flight.opl(hit.distance);
        let (position, primitive) = (hit.position, Some(hit.primitive));
        photon.vertex = Vertex { position, primitive, region: flight.last_region() };
        match Encounter::new(scene, flight, hit, Carrier::Light).respond(rng) {
            Response::Absorbed => self.absorb(photon, Spectrum::ZERO),
            Response::Turned(turn) => {
                self.absorb(photon, turn.factor.channels());
                (photon.vertex.region, photon.direction) = (turn.region, turn.direction);
            }
            Response::Diffuse(lobe) => {
                if !(lobe.factor.is_zero() || photon.power.is_zero()) {
                    self.visitor.surface(photon, &SurfaceArrival { hit: *hit, lobe }, rng);
                }
                self.spread(photon, &lobe, rng);
            }
            Response::Rough(lobe) => {
                if !photon.power.is_zero() {
                    self.visitor.rough_surface(photon, &lobe, rng);
                }
                self.spread(photon, &lobe, rng);
            }
        }
    }

    /// A direction drawn from a lobe.
    #[inline]
    fn spread<const C: usize>(
        &mut self,
        photon: &mut Photon<C>,
        lobe: &impl Lobe<C>,
        rng: &mut Stream,
    ) {
        photon.specular = false;
        let Some(drawn) = lobe.sample(rng) else { return self.absorb(photon, Spectrum::ZERO) };
        self.absorb(photon, lobe.factor() * drawn.weight);
        (photon.vertex.region, photon.direction) = (drawn.region, drawn.direction);
    }

    #[inline]
    fn absorb<const C: usize>(&mut self, photon: &mut Photon<C>, factor: Spectrum<C>) {
        absorb_on_surface(&mut photon.power, factor, &mut self.ledger);
    }
}

#[cfg(test)]
mod tests;
