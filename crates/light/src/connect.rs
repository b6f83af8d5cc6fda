//! Connections of photons to the pinhole: a visitor of the photon tracer.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use tpb_optics::warp::Equiangular;
use tpb_optics::{Phase, Spectrum, Stream};
use tpb_scene::{EmitterKind, IntegratorSpec, Region, Scene, Vertex};
use tpb_transport::{
    DiffuseLobe, FreeFlight, Horizon, Lobe, Outcome, Photon, PhotonVisitor, RoughLobe,
    SurfaceArrival, Towards,
};

use crate::sorted::Contribution;

/// What a chunk of photons adds to the image.
pub(crate) struct Connections<'a, const C: usize> {
    scene: &'a Scene,
    integrator: IntegratorSpec,
    /// The film subtracts the time from the eye to the first surface.
    unwarp: bool,
    /// What can still arrive in time; `None`: all counts.
    horizon: Option<Horizon>,
    pub(crate) contributions: Vec<Contribution<C>>,
    /// Vertices in view whose connection was tried.
    pub(crate) tested: u64,
}

/// Light that leaves a vertex.
struct Source {
    vertex: Vertex,
    /// OPL from the emitter to the vertex \[m\].
    opl: f64,
    /// Depth of the path when it is connected.
    depth: u32,
    on_surface: bool,
}

/// What of a vertex goes on to the eye.
struct Seen {
    /// Unit direction from the vertex to the eye.
    direction: DVec3,
    distance: f64,
    pixel: u32,
    /// Radiance of the pixel per intensity \[m⁻² sr⁻¹ per W/sr\].
    importance: f64,
}

impl<'a, const C: usize> Connections<'a, C> {
    pub(crate) fn new(
        scene: &'a Scene,
        integrator: IntegratorSpec,
        (unwarp, horizon): (bool, Option<Horizon>),
    ) -> Self {
        Self { scene, integrator, unwarp, horizon, contributions: vec![], tested: 0 }
    }

    /// Where on the film a point is seen, were nothing in between.
    #[inline]
    fn see(&self, position: DVec3) -> Option<Seen> {
        let sensor = &self.scene.sensor;
        let to_eye = sensor.position - position;
        let squared = to_eye.length_squared();
        let on_film = sensor.project(-to_eye)?;
        let distance = squared.sqrt();
        let pixel = on_film.y as usize * self.scene.film.width + on_film.x as usize;
        Some(Seen {
            direction: to_eye / distance,
            distance,
            pixel: pixel as u32,
            importance: sensor.importance(on_film.cosine) / squared,
        })
    }

    /// Connects a vertex that sends `intensity` \[W/sr\] to the eye.
    #[inline]
    fn connect(&mut self, source: &Source, seen: &Seen, intensity: Spectrum<C>) {
        if !self.integrator.counts(source.depth) || intensity.is_zero() {
            return;
        }
        let position = source.vertex.position;
        let early_or_late = |horizon: &Horizon| {
            horizon.is_late(position, source.opl) || horizon.is_early(position, source.opl)
        };
        if self.horizon.as_ref().is_some_and(early_or_late) {
            return;
        }
        self.tested += 1;
        let scene = self.scene;
        let Some(way) = scene.connect::<C>(&source.vertex, seen.direction, seen.distance, None)
        else {
            return;
        };
        let opl = way.opl;
        let energy = intensity * way.transmittance() * seen.importance;
        if energy.is_zero() {
            return;
        }
        let unwarp_opl = match (self.unwarp, source.on_surface) {
            (false, _) => 0.0,
            (true, true) => opl,
            (true, false) => self.first_surface(-seen.direction),
        };
        self.contributions.push(Contribution {
            energy,
            opl: source.opl + opl - unwarp_opl,
            pixel: seen.pixel,
        });
    }

    /// OPL from the eye to the first surface that is not null; 0 where there is none.
    fn first_surface(&self, direction: DVec3) -> f64 {
        let flight = self.scene.fly(&self.scene.eye(), direction);
        flight.hit.map_or(0.0, |hit| flight.opl(hit.distance))
    }

    /// Connects a surface with Lambert's law: `power` leaves it on the side of `normal`, where it
    /// is `allowed`.
    #[inline]
    fn connect_surface(
        &mut self,
        source: &Source,
        normal: DVec3,
        power: Spectrum<C>,
        allowed: impl Fn(DVec3) -> bool,
    ) {
        let Some(seen) = self.see(source.vertex.position) else { return };
        let cosine = normal.dot(seen.direction);
        if cosine > 0.0 && allowed(seen.direction) {
            self.connect(source, &seen, power * (cosine * FRAC_1_PI));
        }
    }

    /// Connects a rough surface, on either of its sides.
    fn connect_lobe(&mut self, photon: &Photon<C>, lobe: &RoughLobe) {
        let Some(seen) = self.see(photon.vertex.position) else { return };
        let towards: Towards<C> = lobe.towards(seen.direction);
        let vertex = Vertex { region: towards.region, ..photon.vertex };
        let (opl, depth) = (photon.opl, photon.depth());
        let source = Source { vertex, opl, depth, on_surface: true };
        self.connect(&source, &seen, photon.power * lobe.factor() * towards.value);
    }

    /// Connects a point of a medium.
    #[inline]
    fn connect_medium(
        &mut self,
        photon: &Photon<C>,
        (position, opl, region): (DVec3, f64, Region),
        phase: Phase,
        power: Spectrum<C>,
    ) {
        let Some(seen) = self.see(position) else { return };
        let vertex = Vertex { position, primitive: None, region };
        let source = Source { vertex, opl, depth: photon.depth(), on_surface: false };
        let value = phase.value(photon.direction.dot(seen.direction));
        self.connect(&source, &seen, power * value);
    }
}

impl<const C: usize> PhotonVisitor<C> for Connections<'_, C> {
    /// The emitter seen directly, if it has an area.
    fn emission(&mut self, photon: &Photon<C>, _: &mut Stream) {
        let EmitterKind::Area { .. } = self.scene.emitters[photon.emitter].kind else { return };
        let Some(primitive) = photon.vertex.primitive else { return };
        let normal = self.scene.primitives[primitive as usize].normal(photon.vertex.position);
        let source = Source { vertex: photon.vertex, opl: 0.0, depth: 1, on_surface: true };
        self.connect_surface(&source, normal, photon.power, |_| true);
    }

    /// The medium along the flight: its collision, and a point drawn about the eye.
    #[inline]
    fn flight(
        &mut self,
        photon: &Photon<C>,
        free: &FreeFlight<'_, C>,
        outcome: &Outcome<'_, C>,
        rng: &mut Stream,
    ) {
        let (scene, flight) = (self.scene, free.flight());
        let Some(extent) = free.extent() else { return };
        let (origin, direction) = (flight.origin, flight.direction);
        let Some((start, end)) = scene.sensor.in_view(origin, direction, extent) else { return };
        let eye = scene.sensor.position;
        let towards = Equiangular::new(origin, direction, start, end, eye);
        if let Outcome::Collision { distance, part, weight } = outcome {
            let e = towards.pdf(*distance) / free.density(*distance);
            let power = photon.power * weight.total() / (1.0 + e);
            let place = (flight.at(*distance), photon.opl + flight.opl(*distance), part.region);
            self.connect_medium(photon, place, part.medium.phase, power);
        }
        if !towards.is_proper() {
            return;
        }
        let t = towards.sample(rng.uniform());
        // Vacuum between media, and media that only absorb, scatter nothing.
        let Some(part) = free.scattering_at(t) else { return };
        let density = towards.pdf(t) + free.density(t);
        let scattered = flight.transmittance(scene, t) * part.coefficients.sigma_s / density;
        let place = (flight.at(t), photon.opl + flight.opl(t), part.region);
        self.connect_medium(photon, place, part.medium.phase, photon.power * scattered);
    }

    #[inline]
    fn surface(&mut self, photon: &Photon<C>, arrival: &SurfaceArrival, _: &mut Stream) {
        let source = Source {
            vertex: photon.vertex,
            opl: photon.opl,
            depth: photon.depth(),
            on_surface: true,
        };
        let DiffuseLobe { factor, normal, .. } = arrival.lobe;
        let allowed = |direction| arrival.lobe.allows(direction);
        self.connect_surface(&source, normal, photon.power * factor.channels(), allowed);
    }

    #[inline]
    fn rough_surface(&mut self, photon: &Photon<C>, lobe: &RoughLobe, _: &mut Stream) {
        self.connect_lobe(photon, lobe);
    }
}
