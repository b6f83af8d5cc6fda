//! Camera paths at rough surfaces.
//!
//! A rough surface spreads too little for a density of photons, and too much for one ray: the path
//! goes on in a direction drawn from it, gathers beams on its further flights, and ends on a
//! diffuse surface as it would behind a mirror. Only light that comes straight from an emitter has
//! two ways to be found, a connection and an emitter that the drawn direction meets; the balance
//! heuristic (Veach 1997, section 9.2) weighs n connections of density p_L per steradian and one
//! direction of density p:
//!
//! ```text
//! connection n p_L/(n p_L + p)      met p/(n p_L + p)
//! ```
//!
//! Photons bounce off rough surfaces, and are not kept there: each light path still has one place,
//! by its last scattering event that is neither specular nor rough. Two kinds of light that photons
//! could bring are not found: a laser's on a rough surface, and a point's that comes there by a
//! mirror or through glass. The plan says so.

use tpb_film::Tile;
use tpb_optics::{Spectrum, Stream};
use tpb_scene::{Hit, Vertex};
use tpb_transport::{Lobe, RoughLobe, Towards};

use crate::camera::{Camera, Path};
use crate::kernel::RayBeamKernel;

impl<const C: usize, K: RayBeamKernel> Camera<'_, C, K> {
    /// The path meets a rough surface; whether it goes on. `surface` is its share of the pixel's
    /// paths that end on surfaces, if it is one of them.
    pub(crate) fn meet_rough(
        &self,
        path: &mut Path<C>,
        lobe: &RoughLobe,
        surface: Option<f64>,
        (rng, tile): (&mut Stream, &mut Tile<'_, C>),
    ) -> bool {
        path.throughput *= Lobe::<C>::factor(lobe);
        if let Some(share) = surface {
            self.connect_rough(path, lobe, share, (rng, tile));
        }
        let Some(drawn) = Lobe::<C>::sample(lobe, rng) else { return false };
        path.throughput *= drawn.weight * (drawn.eta_ratio * drawn.eta_ratio);
        path.vertex.region = drawn.region;
        path.direction = drawn.direction;
        path.drawn_with = Some(drawn.density);
        path.lamp_part = 1.0;
        true
    }

    /// Weight of an emitter that the path's direction has met.
    pub(crate) fn hit_weight(&self, path: &Path<C>, hit: &Hit) -> f64 {
        match path.drawn_with {
            Some(density) if self.plan.next_event_estimation => {
                let cosine = path.direction.dot(hit.normal).abs();
                let chosen = self.scene.light_pdf(hit) * hit.distance * hit.distance / cosine;
                density / (density + f64::from(self.settings.light_samples) * chosen)
            }
            _ => 1.0,
        }
    }

    /// Next-event estimation, on both sides of rough glass.
    fn connect_rough(
        &self,
        path: &mut Path<C>,
        lobe: &RoughLobe,
        share: f64,
        (rng, tile): (&mut Stream, &mut Tile<'_, C>),
    ) {
        if !self.plan.next_event_estimation || !self.integrator.counts(path.events + 2) {
            return;
        }
        let samples = f64::from(self.settings.light_samples);
        for nth in 0..self.settings.light_samples {
            let Some(point) = self.sample_light(path, nth, rng) else { return };
            let Some(light) = self.scene.incident::<C>(&point, path.vertex.position) else {
                continue;
            };
            let towards: Towards<C> = lobe.towards(light.direction);
            if towards.value.is_zero() {
                continue;
            }
            let vertex = Vertex { region: towards.region, ..path.vertex };
            let way = self.scene.connect(&vertex, light.direction, light.distance, point.primitive);
            if let Some(way) = way {
                let left: Spectrum<C> = way.transmittance();
                let weight = 1.0 / (1.0 + towards.density / (samples * light.pdf_solid_angle));
                let scale = towards.radiance_factor() * weight * share / (samples * point.pdf);
                let energy = path.throughput * light.flux * left * towards.value * scale;
                path.deposit(path.opl + way.opl, energy, tile);
            }
        }
    }
}
