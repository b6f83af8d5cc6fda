//! Tracing photons: from the emitters through media and surfaces, leaving beams and surface
//! photons.
//!
//! A photon flies through null boundaries to the next surface. Every span of the flight that lies
//! in a scattering medium leaves a beam. Then the free flight decides whether the photon collides
//! on the way or reaches the surface. A coloured medium's distance is drawn from a
//! mixture over channels, with bounded weights. A collision leaves the albedo's share, a diffuse
//! surface its reflectance's; smooth glass reflects with the probability of the Fresnel
//! reflectance. Fluxes do not scale with η² on refraction.
//!
//! **Depth.** After n scattering events (of any kind but null crossings) a beam or a surface photon
//! adds paths of depth n + 2 (plus the camera's specular events). Roulette ends photons from
//! `rr_depth` events on: survival with the probability power now/power emitted, the largest
//! channels compared, but never quite 1.
//!
//! **Counted once.** Surface photons that came from the emitter through null boundaries only are
//! not kept: next-event estimation at the camera's end owns direct light. It cannot connect to
//! lasers; their unscattered photons are kept. Light through glass or off mirrors has n ≥ 1 and is
//! kept: caustics.
//!
//! **Ledger.** One-sample weights of the colour mixture make a photon's luminance jump; the jumps
//! are booked as roulette, which they are. Spot lights sample directions uniformly; what they emit
//! is what the photons carry.

use glam::DVec3;
use rayon::prelude::*;
use tpb_film::Ledger;
use tpb_optics::{Frame, Rgb, Spectrum, Stream, fresnel, medium, warp};
use tpb_render::PassId;
use tpb_scene::{
    Bsdf, Dielectric, Flight, Hit, IntegratorSpec, MediumId, Plan, Reflector, Region, Scene, Vertex,
};

use crate::beam::{Attenuation, Beam, SurfacePhoton, visible_length};
use crate::mixture::{relative_transmittance, weight};
use crate::photon::Photon;
use crate::specular::Crossing;
use crate::{BeamLength, stream_item};

/// Photons per parallel task; the division does not depend on threads.
const CHUNK: u64 = 512;

/// All that one pass's photons left.
#[derive(Clone, Debug, Default)]
pub struct Photons<const C: usize> {
    /// Beams in media.
    pub beams: Vec<Beam<C>>,
    /// Photons on diffuse surfaces.
    pub surface: Vec<SurfacePhoton<C>>,
    /// Where the light went.
    pub ledger: Ledger,
}

/// Traces photons through a scene.
#[derive(Clone, Copy)]
pub struct PhotonTracer<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What to keep.
    pub plan: &'a Plan,
    /// Depths.
    pub integrator: IntegratorSpec,
    /// Where beams end.
    pub length: BeamLength,
}

/// A free flight's end: where, and in which medium and region.
struct Collision {
    distance: f64,
    medium: MediumId,
    region: Region,
}

impl PhotonTracer<'_> {
    /// Traces `count` photons of a pass, the first `beam_photons` of which leave beams; what they
    /// leave is ordered by photon. Photons are cheap on surfaces, where each is met by the pixels
    /// around it only, and dear as beams, which cross the image.
    pub fn trace<const C: usize>(&self, id: PassId, count: u64, beam_photons: u64) -> Photons<C> {
        let chunks: Vec<Photons<C>> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut out = Photons::default();
                for item in chunk * CHUNK..(chunk * CHUNK + CHUNK).min(count) {
                    let mut rng = Stream::new(id.seed, id.index, stream_item::photon(item));
                    let share = 1.0 / count as f64;
                    let leaves_beams = self.plan.beams && item < beam_photons;
                    let scale = leaves_beams.then(|| count as f64 / beam_photons as f64);
                    self.photon(share, scale, &mut rng, &mut out);
                }
                out
            })
            .collect();
        let mut all = Photons::default();
        all.beams.reserve_exact(chunks.iter().map(|c| c.beams.len()).sum());
        all.surface.reserve_exact(chunks.iter().map(|c| c.surface.len()).sum());
        // Each chunk is freed as soon as it is merged.
        for chunk in chunks {
            all.beams.extend(chunk.beams);
            all.surface.extend(chunk.surface);
            all.ledger.add(&chunk.ledger);
        }
        all
    }

    /// One photon that stands for `share` of the light; its beams, if it leaves any, for
    /// `beam_scale` times as much.
    fn photon<const C: usize>(
        &self,
        share: f64,
        beam_scale: Option<f64>,
        rng: &mut Stream,
        out: &mut Photons<C>,
    ) {
        let Some(emission) = self.scene.emit::<C>(rng) else { return };
        let emitter = &self.scene.emitters[emission.emitter];
        let power = emission.power * share;
        if power.is_zero() {
            return;
        }
        out.ledger.emitted += power.luminance();
        let mut photon = Photon {
            vertex: Vertex {
                position: emission.position,
                primitive: emission.primitive,
                region: emitter.region,
            },
            direction: emission.direction,
            power,
            opl: 0.0,
            events: 0,
            emitted: power.max_channel(),
            connectable: emitter.kind.can_be_connected(),
            beam_scale,
        };
        while self.step(&mut photon, rng, out)
            && photon.survives(&self.integrator, rng, &mut out.ledger)
        {}
    }

    /// One flight and the event at its end; whether there is light left to go on.
    fn step<const C: usize>(
        &self,
        photon: &mut Photon<C>,
        rng: &mut Stream,
        out: &mut Photons<C>,
    ) -> bool {
        let flight = self.scene.fly(&photon.vertex, photon.direction);
        let mixture = photon.power / photon.power.0.iter().sum::<f64>();
        let collision = self.free_flight(&flight, mixture, rng);
        if let (Some(scale), true) = (photon.beam_scale, self.integrator.reaches(photon.events + 2))
        {
            let end = collision.as_ref().map_or(f64::INFINITY, |c| c.distance);
            self.leave_beams(photon, photon.power * scale, &flight, (mixture, end), &mut out.beams);
        }
        match collision {
            Some(collision) => {
                self.collide(photon, &flight, &collision, mixture, rng, &mut out.ledger)
            }
            None => self.arrive(photon, &flight, mixture, rng, out),
        }
    }

    /// Where the photon collides; `None` if it reaches the end of the flight.
    fn free_flight<const C: usize>(
        &self,
        flight: &Flight,
        mixture: Spectrum<C>,
        rng: &mut Stream,
    ) -> Option<Collision> {
        if flight.spans.iter().all(|s| s.region.medium.is_none()) {
            return None;
        }
        let channel = medium::choose_channel(mixture, rng);
        let mut depth = medium::sample_exponential(1.0, rng.uniform());
        for span in &flight.spans {
            let Some(id) = span.region.medium else { continue };
            let sigma_t = self.scene.medium(id).coefficients.channels::<C>().sigma_t[channel];
            if sigma_t == 0.0 {
                continue;
            }
            let distance = span.start + depth / sigma_t;
            if distance < span.end {
                return Some(Collision { distance, medium: id, region: span.region });
            }
            depth -= sigma_t * (span.end - span.start);
        }
        None
    }

    /// Leaves a beam in each span of a scattering medium; short ones up to `end`.
    fn leave_beams<const C: usize>(
        &self,
        photon: &Photon<C>,
        power: Spectrum<C>,
        flight: &Flight,
        (mixture, end): (Spectrum<C>, f64),
        beams: &mut Vec<Beam<C>>,
    ) {
        for span in &flight.spans {
            let Some(medium) = span.region.medium else { continue };
            let coefficients = &self.scene.medium(medium).coefficients;
            if !coefficients.scatters() {
                continue;
            }
            let depth = flight.depth::<C>(self.scene, span.start);
            let (span_end, power, attenuation) = match self.length {
                BeamLength::Long => {
                    (span.end, power * medium::transmittance(depth), Attenuation::Explicit)
                }
                BeamLength::Short => {
                    // Both relative to the channel that reaches farthest.
                    let left = relative_transmittance(depth, mixture);
                    let attenuation = Attenuation::Sampled { mixture: mixture * left };
                    (span.end.min(end), power * left, attenuation)
                }
            };
            let length = visible_length(coefficients, span_end - span.start);
            if length > 0.0 && !power.is_zero() {
                beams.push(Beam {
                    origin: flight.at(span.start),
                    direction: flight.direction,
                    length,
                    opl: photon.opl + flight.opl(span.start),
                    power,
                    attenuation,
                    medium,
                    depth: photon.events + 2,
                });
            }
        }
    }

    /// A collision in a medium: absorption by weight, then a new direction.
    fn collide<const C: usize>(
        &self,
        photon: &mut Photon<C>,
        flight: &Flight,
        collision: &Collision,
        mixture: Spectrum<C>,
        rng: &mut Stream,
        ledger: &mut Ledger,
    ) -> bool {
        let medium = self.scene.medium(collision.medium);
        let coefficients = medium.coefficients.channels::<C>();
        let depth = flight.depth::<C>(self.scene, collision.distance);
        let left = relative_transmittance(depth, mixture);
        photon.weigh(weight(left * coefficients.sigma_t, mixture), ledger);
        let albedo = Spectrum(std::array::from_fn(|c| {
            let sigma_t = coefficients.sigma_t[c];
            if sigma_t == 0.0 { 0.0 } else { coefficients.sigma_s[c] / sigma_t }
        }));
        let survived = photon.power * albedo;
        ledger.absorbed_in_media += (photon.power - survived).luminance();
        photon.power = survived;
        if !photon.goes_on(&self.integrator, ledger) {
            return false;
        }
        photon.opl += flight.opl(collision.distance);
        photon.vertex = Vertex {
            position: flight.at(collision.distance),
            primitive: None,
            region: collision.region,
        };
        photon.direction = medium.phase.sample(photon.direction, rng);
        true
    }

    /// The end of a flight without a collision.
    fn arrive<const C: usize>(
        &self,
        photon: &mut Photon<C>,
        flight: &Flight,
        mixture: Spectrum<C>,
        rng: &mut Stream,
        out: &mut Photons<C>,
    ) -> bool {
        let depth = flight.depth::<C>(self.scene, flight.length());
        photon.weigh(weight(relative_transmittance(depth, mixture), mixture), &mut out.ledger);
        let Some(hit) = flight.hit else {
            out.ledger.escaped += photon.power.luminance();
            return false;
        };
        photon.opl += flight.opl(hit.distance);
        photon.vertex = Vertex {
            position: hit.position,
            primitive: Some(hit.primitive),
            region: flight.last_region(),
        };
        let front = photon.direction.dot(hit.normal) < 0.0;
        let normal = if front { hit.normal } else { -hit.normal };
        let bsdf = self.scene.shape(hit.primitive).bsdf;
        let (factor, direction) = match bsdf {
            Bsdf::Null => unreachable!("flights cross null boundaries"),
            Bsdf::Dielectric(glass) => self.cross_glass(photon, &hit, &glass, rng),
            Bsdf::Opaque { front: on_front, back } => match if front { on_front } else { back } {
                Reflector::Black => (Rgb::ZERO, normal),
                Reflector::Mirror(rho) => (rho, fresnel::reflect(photon.direction, normal)),
                Reflector::Diffuse(rho) => {
                    if !rho.is_zero() {
                        self.leave_surface_photon(photon, &hit, normal, &mut out.surface);
                    }
                    let local = warp::cosine_hemisphere(rng.uniform(), rng.uniform());
                    (rho, Frame::from_z(normal).to_world(local))
                }
            },
        };
        let survived = photon.power * factor.channels();
        out.ledger.absorbed_on_surfaces += (photon.power - survived).luminance();
        photon.power = survived;
        photon.direction = direction;
        photon.goes_on(&self.integrator, &mut out.ledger)
    }

    /// Reflection or refraction, chosen by the Fresnel reflectance: factor and new direction.
    fn cross_glass<const C: usize>(
        &self,
        photon: &mut Photon<C>,
        hit: &Hit,
        glass: &Dielectric,
        rng: &mut Stream,
    ) -> (Rgb, DVec3) {
        let crossing = Crossing::choose(glass, photon.direction, hit.normal, rng);
        photon.vertex.region = crossing.region(self.scene, hit, photon.vertex.region);
        (crossing.factor, crossing.direction)
    }

    fn leave_surface_photon<const C: usize>(
        &self,
        photon: &Photon<C>,
        hit: &Hit,
        normal: DVec3,
        surface: &mut Vec<SurfacePhoton<C>>,
    ) {
        let owned_by_connections = photon.events == 0 && photon.connectable;
        let depth = photon.events + 2;
        if self.plan.surface_photons && !owned_by_connections && self.integrator.reaches(depth) {
            surface.push(SurfacePhoton {
                position: hit.position,
                direction: photon.direction,
                normal,
                opl: photon.opl,
                power: photon.power,
                primitive: hit.primitive,
                depth,
            });
        }
    }
}
