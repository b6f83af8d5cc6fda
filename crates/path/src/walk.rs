//! One camera path, from the eye on; read [`Walk::run`] first.

use glam::DVec3;
use tpb_film::{Arrival, Ledger, Strip};
use tpb_optics::{Spectrum, Stream};
use tpb_scene::{Flight, Vertex};

use crate::free_flight::{FreeFlight, Outcome, Part};
use crate::light::SeenFrom;
use crate::tracer::PathTracer;

/// A camera path on its way: what it needs, and where it leaves its results.
pub(crate) struct Walk<'a, 'f, const C: usize> {
    pub(crate) tracer: &'a PathTracer<'a, C>,
    pub(crate) rng: &'a mut Stream,
    pub(crate) ledger: &'a mut Ledger,
    pub(crate) path: Path<C>,
    strip: &'a mut Strip<'f, C>,
    pixel: usize,
    /// OPL from the eye to the first surface that is not null.
    unwarp_opl: f64,
}

/// The state of a path at the start of a flight.
pub(crate) struct Path<const C: usize> {
    pub(crate) vertex: Vertex,
    pub(crate) direction: DVec3,
    /// Throughput of importance: 1 at the eye.
    pub(crate) weight: Spectrum<C>,
    /// What refraction made of radiance beside: (η at the eye / η here)².
    pub(crate) radiance_factor: f64,
    /// From the eye to the vertex \[m\].
    pub(crate) opl: f64,
    /// Scattering events so far, plus 1: the depth of an emitter that is met next.
    pub(crate) depth: u32,
    pub(crate) found: Found,
}

/// How the path got its direction: which other strategies could find what it meets.
#[derive(Clone, Copy)]
pub(crate) enum Found {
    /// From the eye, through mirrors and glass at most.
    FromEye,
    /// Through mirrors or glass after some scattering.
    BySpecular,
    /// Scattered with this density per steradian, on a flight seen from the eye or not.
    ByScattering { density: f64, seen: Option<SeenFrom> },
}

impl Found {
    /// After a further mirror or glass surface.
    #[inline]
    pub(crate) fn after_specular(self) -> Self {
        if matches!(self, Self::FromEye) { Self::FromEye } else { Self::BySpecular }
    }
}

impl<const C: usize> Path<C> {
    /// Throughput of radiance.
    #[inline]
    pub(crate) fn radiance_throughput(&self) -> Spectrum<C> {
        self.weight * self.radiance_factor
    }

    /// Multiplies the importance by `factor`; returns by how much its luminance fell.
    #[inline]
    pub(crate) fn scale(&mut self, factor: Spectrum<C>) -> f64 {
        let before = self.weight.luminance();
        self.weight *= factor;
        before - self.weight.luminance()
    }
}

impl<'a, 'f, const C: usize> Walk<'a, 'f, C> {
    /// A path that leaves the eye in this direction, for a pixel of this strip.
    #[inline]
    pub(crate) fn new(
        tracer: &'a PathTracer<'a, C>,
        direction: DVec3,
        rng: &'a mut Stream,
        ledger: &'a mut Ledger,
        (strip, pixel): (&'a mut Strip<'f, C>, usize),
    ) -> Self {
        let path = Path {
            vertex: tracer.scene.eye(),
            direction,
            weight: Spectrum::ONE,
            radiance_factor: 1.0,
            opl: 0.0,
            depth: 1,
            found: Found::FromEye,
        };
        Self { tracer, rng, ledger, path, strip, pixel, unwarp_opl: 0.0 }
    }

    /// Follows the path to its end.
    pub(crate) fn run(mut self) {
        self.ledger.emitted += self.path.weight.luminance();
        while !self.path.weight.is_zero() {
            let flight = self.tracer.scene.fly(&self.path.vertex, self.path.direction);
            if self.path.depth == 1 {
                self.unwarp_opl = flight.hit.map_or(0.0, |hit| flight.opl(hit.distance));
            }
            let free = FreeFlight::new(self.tracer.scene, &flight, self.path.weight);
            self.see_emission(&flight, &free);
            if !self.tracer.integrator.reaches(self.path.depth + 1) {
                self.ledger.cut_by_depth += self.path.weight.luminance();
                return;
            }
            let seen =
                self.tracer.strategies.equiangular && matches!(self.path.found, Found::FromEye);
            if seen && self.tracer.integrator.counts(self.path.depth + 1) {
                self.equiangular(&flight, &free);
            }
            match free.sample(self.rng) {
                Outcome::Collision { distance, part, weight } => {
                    let seen = if seen { SeenFrom::new(&flight, &free, distance) } else { None };
                    self.absorb_in_media(weight);
                    self.scatter_in_medium(&flight, distance, &part, seen);
                }
                Outcome::Survival { weight } => {
                    self.absorb_in_media(weight);
                    let Some(hit) = &flight.hit else {
                        self.ledger.escaped += self.path.weight.luminance();
                        return;
                    };
                    self.scatter_at_surface(&flight, hit);
                }
            }
            self.path.depth += 1;
            if self.path.depth > self.tracer.integrator.rr_depth && !self.survives_roulette() {
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
            phase.value(flight.direction.dot(direction))
        });
        self.path.direction = phase.sample(flight.direction, self.rng);
        let density = phase.value(flight.direction.dot(self.path.direction));
        self.path.found = Found::ByScattering { density, seen };
    }

    /// Weighs the path for what media took on a flight.
    #[inline]
    fn absorb_in_media(&mut self, weight: Spectrum<C>) {
        let lost = self.path.scale(weight);
        self.ledger.absorbed_in_media += lost;
    }

    /// Mitsuba's roulette, on importance: its throughput·η² is this weight.
    #[inline]
    fn survives_roulette(&mut self) -> bool {
        let q = self.path.weight.max_channel().min(0.95);
        if self.rng.uniform() >= q {
            self.ledger.roulette_lost += self.path.weight.luminance();
            return false;
        }
        let gained = -self.path.scale(Spectrum::splat(1.0 / q));
        self.ledger.roulette_gained += gained;
        true
    }

    /// Leaves time-integrated radiance of this path in the film.
    #[inline]
    pub(crate) fn deposit(&mut self, opl: f64, energy: Spectrum<C>) {
        let share = energy * self.tracer.share;
        self.strip.deposit(self.pixel, self.unwarp_opl, &Arrival::Instant(opl), share);
    }
}
