//! Scattering at surfaces: diffuse reflectors, mirrors and smooth glass.
//!
//! At glass one of reflection and refraction is chosen with Fresnel's probability, so that the
//! importance is unchanged; *radiance* changes by (η_i/η_t)² when the camera's ray refracts from
//! η_i to η_t, because L/η² is what refraction conserves.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use tpb_optics::{Frame, Rgb, Spectrum, fresnel, warp};
use tpb_scene::{Bsdf, Dielectric, Flight, Hit, Reflector, Vertex};
use tpb_transport::{Crossing, absorb_on_surface};

use crate::path::Found;
use crate::walk::Walk;

impl<const C: usize> Walk<'_, '_, C> {
    /// The path reaches the surface at the end of its flight; afterwards its direction is a new
    /// one, or its weight is zero.
    #[inline]
    pub(crate) fn scatter_at_surface(&mut self, flight: &Flight, hit: &Hit) {
        let shape = self.world.scene.shape(hit.primitive);
        let from_front = flight.direction.dot(hit.normal) < 0.0;
        self.path.opl += flight.opl(hit.distance);
        self.path.vertex = Vertex {
            position: hit.position,
            primitive: Some(hit.primitive),
            region: flight.last_region(),
        };
        let normal = if from_front { hit.normal } else { -hit.normal };
        match (shape.bsdf, shape.bsdf.reflector(from_front)) {
            (Bsdf::Dielectric(glass), _) => self.meet_glass(&glass, hit),
            (_, Some(Reflector::Diffuse(reflectance))) => {
                self.reflect_diffusely(reflectance, normal);
            }
            (_, Some(Reflector::Mirror(reflectance))) => self.reflect(reflectance, normal),
            (_, Some(Reflector::Black) | None) => self.absorb_on_surface(Spectrum::ZERO),
        }
    }

    #[inline]
    fn reflect_diffusely(&mut self, reflectance: Rgb, normal: DVec3) {
        self.absorb_on_surface(reflectance.channels());
        if self.path.weight.is_zero() {
            return;
        }
        let vertex = self.path.vertex;
        let opl = self.path.opl;
        let density = |direction: DVec3| normal.dot(direction).max(0.0) * FRAC_1_PI;
        self.next_event(&vertex, opl, None, density);
        let local = warp::cosine_hemisphere(self.rng.uniform(), self.rng.uniform());
        self.path.direction = Frame::from_z(normal).to_world(local);
        let density = warp::cosine_hemisphere_pdf(local.z);
        self.path.found = Found::ByScattering { density, seen: None };
    }

    #[inline]
    fn reflect(&mut self, reflectance: Rgb, normal: DVec3) {
        self.absorb_on_surface(reflectance.channels());
        self.path.direction = fresnel::reflect(self.path.direction, normal);
        self.path.found = self.path.found.after_specular();
    }

    fn meet_glass(&mut self, glass: &Dielectric, hit: &Hit) {
        let crossing = Crossing::choose(glass, self.path.direction, hit.normal, self.rng);
        self.absorb_on_surface(crossing.factor.channels());
        let before = self.path.vertex.region;
        self.path.vertex.region = crossing.region(self.world.scene, hit, before);
        self.path.direction = crossing.direction;
        self.path.radiance_factor *= crossing.eta_ratio * crossing.eta_ratio;
        self.path.found = self.path.found.after_specular();
    }

    /// Weighs the path by a reflectance.
    #[inline]
    fn absorb_on_surface(&mut self, factor: Spectrum<C>) {
        absorb_on_surface(&mut self.path.weight, factor, self.ledger);
    }
}
