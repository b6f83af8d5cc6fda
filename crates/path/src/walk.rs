//! One camera path, from the eye on; read [`Walk::run`] first.

use glam::DVec3;
use tpb_film::{Arrival, Ledger, Tile};
use tpb_optics::{Spectrum, Stream};
use tpb_scene::{Flight, Vertex};
use tpb_transport::{FreeFlight, Outcome, Part, Towards, roulette};

use crate::path::{Found, Path, SeenFrom};
use crate::world::World;

/// A camera path on its way: what it needs, and where it leaves its results.
pub(crate) struct Walk<'a, 'f, const C: usize> {
    pub(crate) world: &'a World<'a>,
    pub(crate) rng: &'a mut Stream,
    pub(crate) ledger: &'a mut Ledger,
    pub(crate) path: Path<C>,
    tile: &'a mut Tile<'f, C>,
    pixel: usize,
    /// OPL from the eye to the first surface that is not null.
    unwarp_opl: f64,
}

impl<'a, 'f, const C: usize> Walk<'a, 'f, C> {
    /// A path that leaves the eye in this direction, for a pixel of this tile.
    #[inline]
    pub(crate) fn new(
        world: &'a World<'a>,
        direction: DVec3,
        rng: &'a mut Stream,
        ledger: &'a mut Ledger,
        (tile, pixel): (&'a mut Tile<'f, C>, usize),
    ) -> Self {
        let path = Path {
            vertex: world.scene.eye(),
            direction,
            weight: Spectrum::ONE,
            radiance_factor: 1.0,
            opl: 0.0,
            depth: 1,
            found: Found::FromEye,
        };
        Self { world, rng, ledger, path, tile, pixel, unwarp_opl: 0.0 }
    }

    /// Follows the path to its end.
    pub(crate) fn run(mut self) {
        self.ledger.emitted += self.path.weight.luminance();
        while !self.path.weight.is_zero() {
            if self.world.is_beyond(self.path.opl, 0.0) {
                self.ledger.cut_by_window += self.path.weight.luminance();
                return;
            }
            let flight = self.world.scene.fly(&self.path.vertex, self.path.direction);
            if self.path.depth == 1 {
                self.unwarp_opl = flight.hit.map_or(0.0, |hit| flight.opl(hit.distance));
            }
            let free = FreeFlight::new(self.world.scene, &flight, self.path.weight);
            self.see_emission(&flight, &free);
            if !self.world.integrator.reaches(self.path.depth + 1) {
                self.ledger.cut_by_depth += self.path.weight.luminance();
                return;
            }
            let seen =
                self.world.strategies.equiangular && matches!(self.path.found, Found::FromEye);
            if seen && self.world.integrator.counts(self.path.depth + 1) {
                self.equiangular(&flight, &free);
            }
            match free.sample(self.rng) {
                Outcome::Collision { distance, part, weight } => {
                    let seen = if seen { SeenFrom::new(&flight, &free, distance) } else { None };
                    weight.apply(&mut self.path.weight, self.ledger);
                    self.scatter_in_medium(&flight, distance, &part, seen);
                }
                Outcome::Survival { weight } => {
                    weight.apply(&mut self.path.weight, self.ledger);
                    let Some(hit) = &flight.hit else {
                        self.ledger.escaped += self.path.weight.luminance();
                        return;
                    };
                    self.scatter_at_surface(&flight, hit);
                }
            }
            self.path.depth += 1;
            // On importance: Mitsuba's throughput·η² is this weight.
            if self.path.depth > self.world.integrator.rr_depth
                && !roulette(&mut self.path.weight, 1.0, self.rng, self.ledger)
            {
                return;
            }
        }
    }

    /// The path scatters at a point of a medium.
    #[inline]
    fn scatter_in_medium(
        &mut self,
        flight: &Flight,
        distance: f64,
        part: &Part<'_, C>,
        seen: Option<SeenFrom>,
    ) {
        self.path.opl += flight.opl(distance);
        let position = flight.at(distance);
        self.path.vertex = Vertex { position, primitive: None, region: part.region };
        let (vertex, opl, phase) = (self.path.vertex, self.path.opl, part.medium.phase);
        self.next_event(&vertex, opl, seen.as_ref(), |direction| {
            Towards::proportional(phase.value(flight.direction.dot(direction)), vertex.region)
        });
        self.path.direction = phase.sample(flight.direction, self.rng);
        let density = phase.value(flight.direction.dot(self.path.direction));
        self.path.found = Found::ByScattering { density, seen };
    }

    /// Leaves time-integrated radiance of this path in the film.
    #[inline]
    pub(crate) fn deposit(&mut self, opl: f64, energy: Spectrum<C>) {
        let share = energy * self.world.share;
        self.tile.deposit(self.pixel, self.unwarp_opl, &Arrival::Instant(opl), share);
    }
}
