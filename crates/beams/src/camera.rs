//! The camera's side: rays from the eye that gather beams, and what they see on surfaces.
//!
//! A camera path follows null boundaries (within a flight), mirrors and glass (one choice by the
//! Fresnel reflectance; radiance changes by (η before/η behind)² where it crosses) and rough
//! surfaces ([`crate::rough`]) to the first diffuse one. On each span of a medium it gathers beams.
//! At the end it adds
//!
//! * emission, exact in time: unbiased;
//! * direct light by next-event estimation through null boundaries: unbiased;
//! * all other light by the density of surface photons: blurred over their disc
//!   ([`crate::surface_map`]).
//!
//! Light whose last scattering is in a medium comes from the beams alone, blurred by their kernel.
//! Each light path thus belongs to exactly one part, by its last scattering event that is neither
//! specular nor rough: none (emission), a medium (beams), a diffuse surface lit straight by an
//! emitter that can be connected to (next-event estimation), a diffuse surface lit otherwise
//! (photons).
//!
//! The parts differ in cost and variance, so a pass may start more paths for one than for another:
//! path i gathers beams if i < `gather_samples`, and ends on a surface if i < `surface_samples`.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_film::{Arrival, Ledger, Strip};
use tpb_optics::{Spectrum, Stream};
use tpb_scene::{Flight, Hit, IntegratorSpec, Plan, Scene, Vertex};
use tpb_transport::{Carrier, DiffuseLobe, Encounter, Response, Turn, roulette};

use crate::Settings;
use crate::beam::{Beam, CameraRay};
use crate::beam_map::{BeamMap, Pairs};
use crate::kernel::RayBeamKernel;
use crate::surface_map::SurfaceMap;
use crate::tiles::Tiles;

/// Steps of the additive recurrence that spreads a pixel's paths evenly over it, from a random
/// start (Roberts 2018, the R2 sequence: 1/φ and 1/φ² of the plastic number φ).
const PLASTIC: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// All that a pixel's estimate reads.
pub(crate) struct Camera<'a, const C: usize, K> {
    pub(crate) scene: &'a Scene,
    pub(crate) plan: &'a Plan,
    pub(crate) integrator: IntegratorSpec,
    pub(crate) settings: &'a Settings,
    pub(crate) tiles: &'a Tiles<'a, C>,
    /// For rays that mirrors, glass or rough surfaces have turned; `None` in scenes without.
    pub(crate) hierarchy: Option<&'a BeamMap<'a, C>>,
    pub(crate) photons: &'a SurfaceMap<C>,
    pub(crate) kernel: K,
}

/// A camera path under way, and where it deposits.
pub(crate) struct Path<'s, 'f, const C: usize> {
    strip: &'s mut Strip<'f, C>,
    pixel: usize,
    /// Column and row of the pixel.
    at: (usize, usize),
    unwarp_opl: f64,
    pub(crate) vertex: Vertex,
    pub(crate) direction: DVec3,
    pub(crate) throughput: Spectrum<C>,
    pub(crate) opl: f64,
    /// Specular and rough events so far.
    pub(crate) events: u32,
    /// Density of the direction \[1/sr\], if the last event was a rough one.
    pub(crate) drawn_with: Option<f64>,
}

impl<const C: usize, K: RayBeamKernel> Camera<'_, C, K> {
    /// All camera paths of one pixel.
    pub(crate) fn render(&self, strip: &mut Strip<'_, C>, pixel: usize, rng: &mut Stream) -> Pairs {
        let Settings { gather_samples, surface_samples, .. } = *self.settings;
        let gather_samples = if self.plan.beams { gather_samples } else { 0 };
        let mut pairs = Pairs::default();
        let shift = [rng.uniform(), rng.uniform()];
        for sample in 0..gather_samples.max(surface_samples) {
            let width = self.scene.film.width;
            let (x, y) = (pixel % width, pixel / width);
            let [a, b] = PLASTIC.map(|step| f64::from(sample) * step);
            let (a, b) = (x as f64 + (shift[0] + a).fract(), y as f64 + (shift[1] + b).fract());
            let direction = self.scene.sensor.direction(a, b);
            let share = |samples: u32| (sample < samples).then(|| 1.0 / f64::from(samples));
            let mut path = Path {
                strip: &mut *strip,
                pixel,
                at: (x, y),
                unwarp_opl: 0.0,
                vertex: self.scene.eye(),
                direction,
                throughput: Spectrum::ONE,
                opl: 0.0,
                events: 0,
                drawn_with: None,
            };
            let shares = (share(gather_samples), share(surface_samples));
            while self.step(&mut path, shares, rng, &mut pairs) && self.survives(&mut path, rng) {}
        }
        pairs
    }

    /// One flight and the surface at its end; whether the path goes on.
    fn step(
        &self,
        path: &mut Path<'_, '_, C>,
        (gather, surface): (Option<f64>, Option<f64>),
        rng: &mut Stream,
        pairs: &mut Pairs,
    ) -> bool {
        let flight = self.scene.fly(&path.vertex, path.direction);
        if let (0, Some(hit)) = (path.events, &flight.hit) {
            path.unwarp_opl = flight.opl(hit.distance);
        }
        if let Some(share) = gather {
            self.gather(path, &flight, share, pairs);
        }
        let Some(hit) = flight.hit else { return false };
        path.arrive(self.scene, &flight, &hit);
        if path.throughput.is_zero() {
            return false;
        }
        if let Some(share) = surface {
            self.emission(path, &hit, share);
        }
        let encounter = Encounter::new(self.scene, &flight, &hit, Carrier::Importance);
        let goes_on = match encounter.respond(rng) {
            Response::Absorbed => false,
            Response::Turned(turn) => {
                path.turn(&turn);
                true
            }
            Response::Diffuse(lobe) => {
                if let (Some(share), false) = (surface, lobe.reflectance.is_zero()) {
                    self.direct(path, &lobe, share, rng);
                    self.indirect(path, &hit, &lobe, share);
                }
                false
            }
            Response::Rough(lobe) => self.meet_rough(path, &lobe, surface, rng),
        };
        path.events += 1;
        goes_on && self.integrator.reaches(path.events + 1) && !path.throughput.is_zero()
    }

    /// Beams seen along a flight.
    fn gather(&self, path: &mut Path<'_, '_, C>, flight: &Flight, share: f64, pairs: &mut Pairs) {
        let temporal = self.settings.temporal;
        for span in &flight.spans {
            let Some(id) = span.region.medium else { continue };
            let medium = self.scene.medium(id);
            if !medium.coefficients.scatters() {
                continue;
            }
            let ray = CameraRay {
                origin: flight.at(span.start),
                direction: flight.direction,
                length: span.end - span.start,
                opl: path.opl + flight.opl(span.start),
                throughput: path.throughput * flight.transmittance(self.scene, span.start),
                coefficients: medium.coefficients.channels(),
                phase: medium.phase,
                eta: span.region.eta,
            };
            let events = path.events;
            let add = |beam: &Beam<C>, meeting: &K::Meeting| {
                if self.integrator.counts(beam.depth + events) {
                    let contribution = self.kernel.contribution(meeting, beam, &ray);
                    let target = (&mut *path.strip, path.pixel, path.unwarp_opl);
                    contribution.deposit(temporal, share, target);
                }
            };
            pairs.add(if events == 0 {
                self.tiles.query(self.kernel, id, path.at, &ray, add)
            } else {
                let map =
                    self.hierarchy.expect("scenes with shapes that turn rays have a hierarchy");
                map.query(self.kernel, id, &ray, add)
            });
        }
    }

    /// Light of an emitter that is seen.
    fn emission(&self, path: &mut Path<'_, '_, C>, hit: &Hit, share: f64) {
        if !self.integrator.counts(path.events + 1) {
            return;
        }
        if let Some(radiance) = self.scene.emitted::<C>(hit, path.direction) {
            let share = share * self.hit_weight(path, hit);
            let energy = path.throughput * radiance * share;
            path.deposit(path.opl, energy);
        }
    }

    /// Next-event estimation at a diffuse surface.
    fn direct(&self, path: &mut Path<'_, '_, C>, lobe: &DiffuseLobe, share: f64, rng: &mut Stream) {
        if !self.plan.next_event_estimation || !self.integrator.counts(path.events + 2) {
            return;
        }
        let samples = self.settings.light_samples;
        let rho = lobe.reflectance.channels();
        let reflected = path.throughput * rho * (share / (PI * f64::from(samples)));
        for _ in 0..samples {
            let Some(point) = self.scene.sample_light(rng) else { return };
            let Some(light) = self.scene.incident::<C>(&point, path.vertex.position) else {
                continue;
            };
            let cosine = light.direction.dot(lobe.normal);
            if cosine <= 0.0 || !lobe.allows(light.direction) {
                continue;
            }
            let way =
                self.scene.connect(&path.vertex, light.direction, light.distance, point.primitive);
            if let Some(flight) = way {
                let left = flight.transmittance(self.scene, light.distance);
                let energy = reflected * light.flux * left * (cosine / point.pdf);
                path.deposit(path.opl + flight.opl(light.distance), energy);
            }
        }
    }

    /// The density of surface photons.
    fn indirect(&self, path: &mut Path<'_, '_, C>, hit: &Hit, lobe: &DiffuseLobe, share: f64) {
        if !self.plan.surface_photons {
            return;
        }
        let area = self.photons.area(self.scene, hit);
        let reflected = path.throughput * lobe.reflectance.channels() * (share / (PI * area));
        let eta = path.vertex.region.eta;
        // Photons lie on the faces.
        let face = lobe.guard.unwrap_or(lobe.normal);
        self.photons.query(self.scene, hit, face, |photon| {
            if self.integrator.counts(photon.depth + path.events) {
                let lag = eta * photon.direction.dot(hit.position - photon.position);
                path.deposit(path.opl + photon.opl + lag, reflected * photon.power);
            }
        });
    }

    /// Russian roulette between mirrors.
    fn survives(&self, path: &mut Path<'_, '_, C>, rng: &mut Stream) -> bool {
        if path.events < self.integrator.rr_depth {
            return true;
        }
        // The ledger of this method is the photons'.
        roulette(&mut path.throughput, 1.0, rng, &mut Ledger::default())
    }
}

impl<const C: usize> Path<'_, '_, C> {
    /// Moves to the end of a flight.
    fn arrive(&mut self, scene: &Scene, flight: &Flight, hit: &Hit) {
        self.throughput *= flight.transmittance(scene, hit.distance);
        self.opl += flight.opl(hit.distance);
        self.vertex = Vertex {
            position: hit.position,
            primitive: Some(hit.primitive),
            region: flight.last_region(),
        };
    }

    /// A mirror or smooth glass.
    fn turn(&mut self, turn: &Turn) {
        self.vertex.region = turn.region;
        let radiance = turn.eta_ratio * turn.eta_ratio;
        self.throughput *= turn.factor.channels() * radiance;
        self.direction = turn.direction;
        self.drawn_with = None;
    }

    pub(crate) fn deposit(&mut self, opl: f64, energy: Spectrum<C>) {
        self.strip.deposit(self.pixel, self.unwarp_opl, &Arrival::Instant(opl), energy);
    }
}
