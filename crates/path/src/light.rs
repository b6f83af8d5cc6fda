//! Connections to light, and the weights of the strategies that find it.
//!
//! All weights are balance heuristics. Divided by p_exp(t) p_L(y), with h = p_dir/p_L the ratio of
//! the densities per steradian of meeting the light by chance and of choosing it, and
//! e = p_equi(t|y)/p_exp(t) (0 away from flights that are seen from the eye, and for directional
//! light, which has no place y), they are
//!
//! ```text
//! next event 1/(1 + e + h)      equiangular e/(1 + e + h)      hit h/(1 + e + h)
//! ```
//!
//! Phase functions and Lambert's law are drawn in proportion to themselves; at rough surfaces value
//! and density p_dir differ.

use glam::DVec3;
use tpb_optics::Spectrum;
use tpb_optics::warp::Equiangular;
use tpb_scene::{Flight, Hit, LightPoint, Vertex};
use tpb_transport::{FreeFlight, Towards};

use crate::path::{Found, SeenFrom};
use crate::walk::Walk;
use crate::world::Strategies;

impl<const C: usize> Walk<'_, '_, C> {
    /// Adds the emission at the end of a flight, whether or not the path gets there.
    #[inline]
    pub(crate) fn see_emission(&mut self, flight: &Flight, free: &FreeFlight<'_, C>) {
        let Some(hit) = &flight.hit else { return };
        if !self.world.integrator.counts(self.path.depth) {
            return;
        }
        let Some(radiance) = self.world.scene.emitted::<C>(hit, flight.direction) else { return };
        let weight = self.hit_weight(flight, hit);
        let throughput = self.path.radiance_throughput() * free.transmittance();
        let opl = self.path.opl + flight.opl(hit.distance);
        self.deposit(opl, throughput * radiance * weight);
    }

    /// Weight of an emitter that the path met.
    #[inline]
    fn hit_weight(&self, flight: &Flight, hit: &Hit) -> f64 {
        let Strategies { next_event, hits, .. } = self.world.strategies;
        let Found::ByScattering { density, seen } = self.path.found else { return 1.0 };
        if !(next_event && hits) {
            return if hits { 1.0 } else { 0.0 };
        }
        let cos = flight.direction.dot(hit.normal).abs();
        let chosen = self.world.scene.light_pdf(hit) * hit.distance * hit.distance / cos;
        let e = seen.map_or(0.0, |seen| seen.equiangular_ratio(hit.position));
        density / (density + chosen * (1.0 + e))
    }

    /// Next-event estimation at a vertex with OPL `opl` from the eye.
    #[inline]
    pub(crate) fn next_event(
        &mut self,
        vertex: &Vertex,
        opl: f64,
        seen: Option<&SeenFrom>,
        scattering: impl Fn(DVec3) -> Towards<C>,
    ) {
        if !self.world.strategies.next_event || !self.world.integrator.counts(self.path.depth + 1) {
            return;
        }
        let Some(light) = self.world.scene.sample_light(self.rng) else { return };
        let throughput = self.path.radiance_throughput();
        self.connect(&light, vertex, opl, throughput, scattering, |h| {
            let e = match seen {
                Some(seen) if !light.collimated => seen.equiangular_ratio(light.position),
                _ => 0.0,
            };
            1.0 / (1.0 + e + h)
        });
    }

    /// On a flight seen from the eye: a light point first, then the distance towards it.
    pub(crate) fn equiangular(&mut self, flight: &Flight, free: &FreeFlight<'_, C>) {
        let Some((start, end)) = free.extent() else { return };
        let Some(light) = self.world.scene.sample_light(self.rng) else { return };
        if light.collimated {
            return;
        }
        let towards = Equiangular::new(flight.origin, flight.direction, start, end, light.position);
        if !towards.is_proper() {
            return;
        }
        let t = towards.sample(self.rng.uniform());
        // Vacuum between media, and media that only absorb, scatter nothing.
        let Some(part) = free.scattering_at(t) else { return };
        let density = towards.pdf(t);
        let e = density / free.density(t);
        let throughput = self.path.radiance_throughput()
            * flight.transmittance(self.world.scene, t)
            * part.coefficients.sigma_s
            / density;
        let vertex = Vertex { position: flight.at(t), primitive: None, region: part.region };
        let phase = part.medium.phase;
        let scattering = |direction| {
            Towards::proportional(phase.value(flight.direction.dot(direction)), part.region)
        };
        // e/(1 + e + h), with e infinite where the free flight's density underflows.
        let opl = self.path.opl + flight.opl(t);
        self.connect(&light, &vertex, opl, throughput, scattering, |h| 1.0 / (1.0 + (1.0 + h) / e));
    }

    /// Connects `vertex` to `light`; `weight` makes the strategy's weight from h.
    #[inline]
    fn connect(
        &mut self,
        light: &LightPoint,
        vertex: &Vertex,
        opl: f64,
        throughput: Spectrum<C>,
        scattering: impl Fn(DVec3) -> Towards<C>,
        weight: impl Fn(f64) -> f64,
    ) {
        let scene = self.world.scene;
        let Some(incident) = scene.incident::<C>(light, vertex.position) else { return };
        let towards = scattering(incident.direction);
        let value = towards.value / light.pdf * towards.radiance_factor();
        let throughput = throughput * incident.flux * value;
        if throughput.is_zero() || self.world.is_beyond(opl, incident.distance) {
            return;
        }
        let (direction, distance) = (incident.direction, incident.distance);
        let vertex = Vertex { region: towards.region, ..*vertex };
        let Some(way) = scene.connect::<C>(&vertex, direction, distance, light.primitive) else {
            return;
        };
        let h = if self.world.strategies.hits {
            towards.density / incident.pdf_solid_angle
        } else {
            0.0
        };
        self.deposit(opl + way.opl, throughput * way.transmittance() * weight(h));
    }
}
