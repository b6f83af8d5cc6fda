//! Scattering at surfaces.
//!
//! Where a surface turns the path (mirrors, smooth glass) nothing connects to it; where it spreads
//! light, a point on a light is connected to and a direction is drawn. *Radiance* changes by
//! (η_i/η_t)² when the camera's ray refracts from η_i to η_t.

use tpb_optics::Spectrum;
use tpb_scene::{Flight, Hit, Vertex};
use tpb_transport::{Carrier, Encounter, Lobe, Response, absorb_on_surface};

use crate::path::Found;
use crate::walk::Walk;

impl<const C: usize> Walk<'_, '_, C> {
    /// The path reaches the surface at the end of its flight; afterwards its direction is a new
    /// one, or its weight is zero.
    #[inline]
    pub(crate) fn scatter_at_surface(&mut self, flight: &Flight, hit: &Hit) {
        self.path.opl += flight.opl(hit.distance);
        self.path.vertex = Vertex {
            position: hit.position,
            primitive: Some(hit.primitive),
            region: flight.last_region(),
        };
        let encounter = Encounter::new(self.world.scene, flight, hit, Carrier::Importance);
        match encounter.respond(self.rng) {
            Response::Absorbed => self.absorb_on_surface(Spectrum::ZERO),
            Response::Turned(turn) => {
                self.absorb_on_surface(turn.factor.channels());
                self.path.vertex.region = turn.region;
                self.path.direction = turn.direction;
                self.path.radiance_factor *= turn.eta_ratio * turn.eta_ratio;
                self.path.found = self.path.found.after_specular();
            }
            Response::Diffuse(lobe) => self.spread(&lobe),
            Response::Rough(lobe) => self.spread(&lobe),
        }
    }

    #[inline]
    fn spread(&mut self, lobe: &impl Lobe<C>) {
        self.absorb_on_surface(lobe.factor());
        if self.path.weight.is_zero() {
            return;
        }
        let vertex = self.path.vertex;
        let opl = self.path.opl;
        self.next_event(&vertex, opl, None, |direction| lobe.towards(direction));
        let Some(drawn) = lobe.sample(self.rng) else {
            return self.absorb_on_surface(Spectrum::ZERO);
        };
        self.absorb_on_surface(drawn.weight);
        self.path.vertex.region = drawn.region;
        self.path.direction = drawn.direction;
        self.path.radiance_factor *= drawn.eta_ratio * drawn.eta_ratio;
        self.path.found = Found::ByScattering { density: drawn.density, seen: None };
    }

    /// Weighs the path by a reflectance.
    #[inline]
    fn absorb_on_surface(&mut self, factor: Spectrum<C>) {
        absorb_on_surface(&mut self.path.weight, factor, self.ledger);
    }
}
