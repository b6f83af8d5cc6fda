//! Scattering at surfaces: diffuse reflectors, mirrors and smooth glass.
//!
//! At glass one of reflection and refraction is chosen with Fresnel's probability, so that the
//! importance is unchanged; *radiance* changes by (η_i/η_t)² when the camera's ray refracts from
//! η_i to η_t, because L/η² is what refraction conserves.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use tpb_optics::{Frame, Rgb, Spectrum, fresnel, warp};
use tpb_scene::{Bsdf, Dielectric, Flight, Hit, Reflector, Shape, Vertex};

use crate::walk::{Found, Walk};

impl<const C: usize> Walk<'_, '_, C> {
    /// The path reaches the surface at the end of its flight; afterwards its direction is a new
    /// one, or its weight is zero.
    #[inline]
    pub(crate) fn scatter_at_surface(&mut self, flight: &Flight, hit: &Hit) {
        let shape = self.tracer.scene.shape(hit.primitive);
        let from_front = flight.direction.dot(hit.normal) < 0.0;
        self.path.opl += flight.opl(hit.distance);
        self.path.vertex = Vertex {
            position: hit.position,
            primitive: Some(hit.primitive),
            region: flight.last_region(),
        };
        let normal = if from_front { hit.normal } else { -hit.normal };
        match (shape.bsdf, shape.bsdf.reflector(from_front)) {
            (Bsdf::Dielectric(glass), _) => self.meet_glass(shape, &glass, from_front, normal),
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

    /// `normal` is on the side that the path comes from.
    fn meet_glass(&mut self, shape: &Shape, glass: &Dielectric, from_front: bool, normal: DVec3) {
        let (eta_i, eta_t) = if from_front {
            (glass.exterior_eta, glass.interior_eta)
        } else {
            (glass.interior_eta, glass.exterior_eta)
        };
        let direction = self.path.direction;
        let cos_incident = (-direction.dot(normal)).min(1.0);
        let f = fresnel::dielectric(cos_incident, eta_i, eta_t);
        if f.reflectance >= 1.0 || self.rng.uniform() < f.reflectance {
            return self.reflect(glass.reflectance, normal);
        }
        self.absorb_on_surface(glass.transmittance.channels());
        let ratio = eta_i / eta_t;
        let to_front = !from_front;
        self.path.direction = fresnel::refract(direction, normal, ratio, f.cos_transmitted);
        let before = self.path.vertex.region;
        self.path.vertex.region = self.tracer.scene.region_beyond(shape, to_front, before);
        self.path.radiance_factor *= ratio * ratio;
        self.path.found = self.path.found.after_specular();
    }

    /// Weighs the path by a reflectance and enters the difference into the ledger.
    #[inline]
    fn absorb_on_surface(&mut self, factor: Spectrum<C>) {
        let lost = self.path.scale(factor);
        self.ledger.absorbed_on_surfaces += lost;
    }
}
