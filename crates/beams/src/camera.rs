//! The camera's side: rays from the eye that gather beams, and what they see on surfaces.
//!
//! A camera path follows null boundaries (within a flight), mirrors and glass (one choice by the
//! Fresnel reflectance; radiance changes by (η before/η behind)² where it crosses) and rough
//! surfaces ([`crate::rough`]) to the first diffuse one. On each span of a medium it gathers beams.
//! At the end it adds
//!
//! * emission, exact in time: unbiased; pixels that see lamps have more rays for it ([`crate::lamps`]);
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
use tpb_film::{Arrival, Ledger, Tile};
use tpb_lanes::Instructions;
use tpb_optics::quasi::{self, Points};
use tpb_optics::{Spectrum, Stream, seed_of};
use tpb_render::PassId;
use tpb_scene::{Flight, Hit, IntegratorSpec, LightPoint, Plan, Scene, Vertex};
use tpb_transport::{Carrier, DiffuseLobe, Encounter, Horizon, Response, Sampler, Turn, roulette};

use crate::beam::{Beam, CameraRay};
use crate::beam_map::{BeamMap, Pairs};
use crate::kernel::RayBeamKernel;
use crate::lamps::LampPixels;
use crate::scan::Lattice;
use crate::sight::Sights;
use crate::splat::{Splat, TileRays};
use crate::surface_map::SurfaceMap;
use crate::{Settings, stream_item};

/// Steps of the additive recurrence that spreads a pixel's paths evenly over it, from a random
/// start (Roberts 2018, the R2 sequence: 1/φ and 1/φ² of the plastic number φ).
const PLASTIC: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// Where in their pixels the paths of a sample start, from a tile's random `shift`. Every second sample
/// is the mirror image of the one before in the pixel's middle: as all pixels of a tile share the place,
/// one alone moves what the tile shows, to first order, and sums over the image are noisier.
fn sub_pixel(shift: [f64; 2], sample: u32) -> [f64; 2] {
    let pair = f64::from(sample / 2);
    let place = [0, 1].map(|axis| (shift[axis] + pair * PLASTIC[axis]).fract());
    if sample.is_multiple_of(2) { place } else { place.map(|x| 1.0 - x) }
}

/// All that a pixel's estimate reads.
pub(crate) struct Camera<'a, const C: usize, K> {
    pub(crate) scene: &'a Scene,
    pub(crate) plan: &'a Plan,
    pub(crate) integrator: IntegratorSpec,
    pub(crate) settings: &'a Settings,
    pub(crate) beams: &'a [Beam<C>],
    /// What rays straight from the eye may meet.
    pub(crate) sights: &'a Sights,
    /// For rays that mirrors, glass or rough surfaces have turned; `None` in scenes without.
    pub(crate) turned: Option<&'a BeamMap<'a, C>>,
    /// What can still arrive in time; `None`: all counts.
    pub(crate) horizon: Option<Horizon>,
    /// Those of caustics have a map of their own.
    pub(crate) photons: &'a [SurfaceMap<C>],
    pub(crate) kernel: K,
    /// Which pixels get more rays that look for lamps.
    pub(crate) lamps: &'a LampPixels,
    /// For the gather.
    pub(crate) instructions: Instructions,
}

/// A camera path under way.
pub(crate) struct Path<const C: usize> {
    /// The pixel's place in the tile.
    place: usize,
    /// Its number among the pixel's paths of the pass, and where these look for light.
    sample: u32,
    lights: Points,
    unwarp_opl: f64,
    pub(crate) vertex: Vertex,
    pub(crate) direction: DVec3,
    pub(crate) throughput: Spectrum<C>,
    pub(crate) opl: f64,
    /// Specular and rough events so far.
    pub(crate) events: u32,
    /// Density of the direction \[1/sr\], if the last event was a rough one.
    pub(crate) drawn_with: Option<f64>,
    /// Its part in the light of a lamp that it meets: rays that look for lamps bring the rest, but for what
    /// rough surfaces show.
    pub(crate) lamp_part: f64,
}

impl<const C: usize, K: RayBeamKernel> Camera<'_, C, K> {
    /// All camera paths of a tile's pixels.
    pub(crate) fn render(&self, id: PassId, tile: &mut Tile<'_, C>) -> Pairs {
        let Settings { gather_samples, surface_samples, .. } = *self.settings;
        let gather_samples = if self.plan.beams { gather_samples } else { 0 };
        let mut streams: Vec<_> = tile
            .pixels()
            .map(|pixel| Stream::new(id.seed, id.index, stream_item::pixel(pixel)))
            .collect();
        let lights: Vec<_> = tile
            .pixels()
            .map(|pixel| {
                Points::new(seed_of(seed_of(id.seed, id.index), stream_item::pixel(pixel)))
            })
            .collect();
        let lamp_parts: Vec<_> =
            tile.pixels().map(|pixel| self.lamps.part_of_others(pixel, surface_samples)).collect();
        let first = tile.pixels().next().unwrap_or_default();
        let mut of_tile = Stream::new(id.seed, id.index, stream_item::tile(first));
        let shift = [of_tile.uniform(), of_tile.uniform()];
        let mut pairs = Pairs::default();
        self.look_for_lamps(id, tile);
        for sample in 0..gather_samples.max(surface_samples) {
            let offset = sub_pixel(shift, sample);
            let lattice = Lattice::new(&self.scene.sensor, tile, offset);
            let flights: Vec<_> = lattice
                .directions()
                .map(|direction| self.scene.fly(&self.scene.eye(), direction))
                .collect();
            let share = |samples: u32| (sample < samples).then(|| 1.0 / f64::from(samples));
            let shares = (share(gather_samples), share(surface_samples));
            if let Some(share) = shares.0 {
                pairs.add(self.splat(lattice, &flights, share, tile));
            }
            let mut wave: Vec<_> = (0..)
                .zip(flights)
                .map(|(place, flight)| {
                    let at = (place, sample);
                    let mut path = Path::new(self.scene.eye(), at, lights[place], &flight);
                    path.lamp_part = lamp_parts[place];
                    (path, flight)
                })
                .collect();
            while !wave.is_empty() {
                let next = wave.into_iter().filter_map(|(mut path, flight)| {
                    let rng = &mut streams[path.place];
                    let goes_on = self.arrive(&mut path, &flight, shares.1, rng, tile)
                        && self.survives(&mut path, rng);
                    goes_on.then(|| {
                        let flight = self.scene.fly(&path.vertex, path.direction);
                        (path, flight)
                    })
                });
                wave = next.collect();
                if let Some(share) = shares.0 {
                    pairs.add(self.gather(&wave, share, tile));
                }
            }
        }
        pairs
    }

    /// Beams seen straight from the eye.
    fn splat(
        &self,
        lattice: Lattice,
        flights: &[Flight],
        share: f64,
        tile: &mut Tile<'_, C>,
    ) -> Pairs {
        let rays = TileRays::new(self.scene, lattice, flights);
        let splat = Splat {
            kernel: self.kernel,
            beams: self.beams,
            sights: self.sights,
            rays: &rays,
            temporal: self.settings.temporal,
            share,
            instructions: self.instructions,
        };
        splat.draw(|depth| self.integrator.counts(depth), tile)
    }

    /// The surface at the end of a flight; whether the path goes on.
    fn arrive(
        &self,
        path: &mut Path<C>,
        flight: &Flight,
        surface: Option<f64>,
        rng: &mut Stream,
        tile: &mut Tile<'_, C>,
    ) -> bool {
        let Some(hit) = flight.hit else { return false };
        path.arrive(self.scene, flight, &hit);
        if path.throughput.is_zero() || self.is_beyond(path.opl, 0.0) {
            return false;
        }
        if let Some(share) = surface {
            self.emission(path, &hit, share * path.lamp_part, tile);
        }
        let encounter = Encounter::new(self.scene, flight, &hit, Carrier::Importance);
        let goes_on = match encounter.respond(rng) {
            Response::Absorbed => false,
            Response::Turned(turn) => {
                path.turn(&turn);
                true
            }
            Response::Diffuse(lobe) => {
                if let (Some(share), false) = (surface, lobe.reflectance.is_zero()) {
                    self.direct(path, &lobe, share, (rng, tile));
                    self.indirect(path, &hit, &lobe, (share, tile));
                }
                false
            }
            Response::Rough(lobe) => self.meet_rough(path, &lobe, surface, (rng, tile)),
        };
        path.events += 1;
        goes_on && self.integrator.reaches(path.events + 1) && !path.throughput.is_zero()
    }

    /// Beams seen along flights that surfaces have turned.
    fn gather(&self, wave: &[(Path<C>, Flight)], share: f64, tile: &mut Tile<'_, C>) -> Pairs {
        let Some(map) = self.turned else { return Pairs::default() };
        let columns = tile.columns().len();
        let mut turned = Vec::with_capacity(wave.len());
        for (path, flight) in wave {
            for span in &flight.spans {
                let Some((id, mut ray)) = CameraRay::of_span(self.scene, flight, span) else {
                    continue;
                };
                ray.opl += path.opl;
                ray.throughput = path.throughput * ray.throughput;
                turned.push((path, (id, ray)));
            }
        }
        // Neighbours in the image that go the same way see much the same.
        turned.sort_by_cached_key(|(path, (_, ray))| {
            let octant = ray.direction.to_array().map(|component| component < 0.0);
            (octant, morton(path.place % columns, path.place / columns))
        });
        let (paths, rays): (Vec<_>, Vec<_>) = turned.into_iter().unzip();
        map.query(self.kernel, &rays, |number, beam, meeting| {
            let (path, (_, ray)) = (paths[number], &rays[number]);
            if self.integrator.counts(beam.depth + path.events) {
                let contribution = self.kernel.contribution(meeting, beam, ray);
                let target = (&mut *tile, path.place, path.unwarp_opl);
                contribution.deposit(self.settings.temporal, share, target);
            }
        })
    }

    /// Light of an emitter that is seen.
    pub(crate) fn emission(
        &self,
        path: &mut Path<C>,
        hit: &Hit,
        share: f64,
        tile: &mut Tile<'_, C>,
    ) {
        if !self.integrator.counts(path.events + 1) {
            return;
        }
        if let Some(radiance) = self.scene.emitted::<C>(hit, path.direction) {
            let share = share * self.hit_weight(path, hit);
            let energy = path.throughput * radiance * share;
            path.deposit(path.opl, energy, tile);
        }
    }

    /// One of the path's points on light sources. All of a pixel's in a pass, and those of each path,
    /// are spread evenly.
    pub(crate) fn sample_light(
        &self,
        path: &Path<C>,
        nth: u32,
        rng: &mut Stream,
    ) -> Option<LightPoint> {
        if self.settings.sampler == Sampler::Sobol {
            let index = u64::from(path.sample) * u64::from(self.settings.light_samples);
            let set = path.events.min(quasi::SETS - 1);
            let lead = path.lights.at(index + u64::from(nth), set, rng);
            rng.lead(&lead);
        }
        let point = self.scene.sample_light(rng);
        rng.lead(&[]);
        point
    }

    /// Next-event estimation at a diffuse surface.
    fn direct(
        &self,
        path: &mut Path<C>,
        lobe: &DiffuseLobe,
        share: f64,
        (rng, tile): (&mut Stream, &mut Tile<'_, C>),
    ) {
        if !self.plan.next_event_estimation || !self.integrator.counts(path.events + 2) {
            return;
        }
        let samples = self.settings.light_samples;
        let rho = lobe.reflectance.channels();
        let reflected = path.throughput * rho * (share / (PI * f64::from(samples)));
        for nth in 0..samples {
            let Some(point) = self.sample_light(path, nth, rng) else { return };
            let Some(light) = self.scene.incident::<C>(&point, path.vertex.position) else {
                continue;
            };
            let cosine = light.direction.dot(lobe.normal);
            let beyond = self.is_beyond(path.opl, light.distance);
            if cosine <= 0.0 || !lobe.allows(light.direction) || beyond {
                continue;
            }
            let way =
                self.scene.connect(&path.vertex, light.direction, light.distance, point.primitive);
            if let Some(way) = way {
                let left = way.transmittance();
                let energy = reflected * light.flux * left * (cosine / point.pdf);
                path.deposit(path.opl + way.opl, energy, tile);
            }
        }
    }

    /// The density of surface photons.
    fn indirect(
        &self,
        path: &mut Path<C>,
        hit: &Hit,
        lobe: &DiffuseLobe,
        (share, tile): (f64, &mut Tile<'_, C>),
    ) {
        if !self.plan.surface_photons {
            return;
        }
        let eta = path.vertex.region.eta;
        // Photons lie on the faces.
        let face = lobe.guard.unwrap_or(lobe.normal);
        for map in self.photons {
            let area = map.area(self.scene, hit);
            let reflected = path.throughput * lobe.reflectance.channels() * (share / (PI * area));
            map.query(self.scene, hit, face, |photon| {
                if self.integrator.counts(photon.depth + path.events) {
                    let lag = eta * photon.direction.dot(hit.position - photon.position);
                    path.deposit(path.opl + photon.opl + lag, reflected * photon.power, tile);
                }
            });
        }
    }

    /// Whether light that comes from so far away \[m\] to a path arrives too late.
    #[inline]
    pub(crate) fn is_beyond(&self, opl: f64, distance: f64) -> bool {
        self.horizon.as_ref().is_some_and(|horizon| horizon.is_beyond(opl, distance))
    }

    /// Russian roulette between mirrors.
    pub(crate) fn survives(&self, path: &mut Path<C>, rng: &mut Stream) -> bool {
        if path.events < self.integrator.rr_depth {
            return true;
        }
        // The ledger of this method is the photons'.
        roulette(&mut path.throughput, 1.0, rng, &mut Ledger::default())
    }
}

impl<const C: usize> Path<C> {
    /// Before its first flight.
    pub(crate) fn new(
        eye: Vertex,
        (place, sample): (usize, u32),
        lights: Points,
        flight: &Flight,
    ) -> Self {
        Self {
            place,
            sample,
            lights,
            unwarp_opl: flight.hit.as_ref().map_or(0.0, |hit| flight.opl(hit.distance)),
            vertex: eye,
            direction: flight.direction,
            throughput: Spectrum::ONE,
            opl: 0.0,
            events: 0,
            drawn_with: None,
            lamp_part: 1.0,
        }
    }

    /// Moves to the end of a flight.
    pub(crate) fn arrive(&mut self, scene: &Scene, flight: &Flight, hit: &Hit) {
        self.throughput *= flight.transmittance(scene, hit.distance);
        self.opl += flight.opl(hit.distance);
        self.vertex = Vertex {
            position: hit.position,
            primitive: Some(hit.primitive),
            region: flight.last_region(),
        };
    }

    /// A mirror or smooth glass.
    pub(crate) fn turn(&mut self, turn: &Turn) {
        self.vertex.region = turn.region;
        let radiance = turn.eta_ratio * turn.eta_ratio;
        self.throughput *= turn.factor.channels() * radiance;
        self.direction = turn.direction;
        self.drawn_with = None;
    }

    pub(crate) fn deposit(&self, opl: f64, energy: Spectrum<C>, tile: &mut Tile<'_, C>) {
        tile.deposit_at(self.place, self.unwarp_opl, &Arrival::Instant(opl), energy);
    }
}

/// Number of a point on the curve that keeps neighbours together (Morton 1966): the bits of both
/// coordinates in turn.
fn morton(x: usize, y: usize) -> u64 {
    let spread = |v: usize| (0..32).map(|bit| (v as u64 >> bit & 1) << (2 * bit)).sum::<u64>();
    spread(x) | spread(y) << 1
}
