//! What photons leave for the camera: beams in media, and photons on diffuse surfaces.
//!
//! Every span of a photon's flight that lies in a scattering medium leaves a beam; every arrival at
//! a diffuse surface leaves a surface photon. How photons move is [`tpb_transport::PhotonTracer`]'s.
//! After n scattering events both add paths of depth n + 2 (plus the camera's specular events).
//!
//! **Counted once.** Surface photons that came from the emitter through null boundaries only are
//! not kept: next-event estimation at the camera's end owns direct light. It cannot connect to
//! lasers; their unscattered photons are kept. Light through glass or off mirrors has n ≥ 1 and is
//! kept: caustics. These, and spots of lasers, are sharp and bright where others are smooth and dim; they
//! are kept apart, for a disc of their own (caustic and global photon map: Jensen 1996).

use tpb_film::Ledger;
use tpb_optics::{Stream, medium};
use tpb_render::PassId;
use tpb_scene::{IntegratorSpec, Plan, Scene, Span};
use tpb_transport::{
    FreeFlight, Outcome, Photon, PhotonBatch, PhotonVisitor, Sampling, SurfaceArrival,
};

use crate::BeamLength;
use crate::beam::{Attenuation, Beam, SurfacePhoton, visible_length};
use crate::method::turns_rays;

/// All that one pass's photons left.
#[derive(Clone, Debug, Default)]
pub struct Photons<const C: usize> {
    /// Beams in media.
    pub beams: Vec<Beam<C>>,
    /// Photons on diffuse surfaces, but for the next.
    pub surface: Vec<SurfacePhoton<C>>,
    /// Those that lights, mirrors and smooth glass alone have sent there.
    pub caustic: Vec<SurfacePhoton<C>>,
    /// Where the light went.
    pub ledger: Ledger,
}

/// Traces photons through a scene, and keeps what they leave.
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
    /// How photons are drawn.
    pub sampling: Sampling,
}

impl PhotonTracer<'_> {
    /// Traces `count` photons of a pass, the first `beam_photons` of which leave beams; what they
    /// leave is ordered by photon. Photons are cheap on surfaces, where each is met by the pixels
    /// around it only, and dear as beams, which cross the image.
    pub fn trace<const C: usize>(&self, id: PassId, count: u64, beam_photons: u64) -> Photons<C> {
        let photons = tpb_transport::PhotonTracer {
            scene: self.scene,
            integrator: self.integrator,
            sampling: self.sampling,
        };
        let batch = PhotonBatch { seed: id.seed, pass: id.index, count };
        let beam_photons = if self.plan.beams { beam_photons } else { 0 };
        // What beams of fewer photons carry more.
        let beam_scale = count as f64 / beam_photons as f64;
        let (traces, ledger) = photons.trace(batch, |_| Traces {
            tracer: *self,
            beam_photons,
            beam_scale,
            beams: vec![],
            surface: vec![],
            caustic: vec![],
        });
        let mut all = Photons { ledger, ..Photons::default() };
        all.beams.reserve_exact(traces.iter().map(|t| t.beams.len()).sum());
        all.surface.reserve_exact(traces.iter().map(|t| t.surface.len()).sum());
        all.caustic.reserve_exact(traces.iter().map(|t| t.caustic.len()).sum());
        // Each chunk is freed as soon as it is merged.
        for chunk in traces {
            all.beams.extend(chunk.beams);
            all.surface.extend(chunk.surface);
            all.caustic.extend(chunk.caustic);
        }
        all
    }
}

/// What a chunk of photons leaves.
struct Traces<'a, const C: usize> {
    tracer: PhotonTracer<'a>,
    beam_photons: u64,
    beam_scale: f64,
    beams: Vec<Beam<C>>,
    surface: Vec<SurfacePhoton<C>>,
    caustic: Vec<SurfacePhoton<C>>,
}

impl<const C: usize> PhotonVisitor<C> for Traces<'_, C> {
    #[inline]
    fn flight(
        &mut self,
        photon: &Photon<C>,
        free: &FreeFlight<'_, C>,
        outcome: &Outcome<'_, C>,
        _: &mut Stream,
    ) {
        if photon.index < self.beam_photons && self.tracer.integrator.reaches(photon.depth()) {
            let end = outcome.collision().unwrap_or(f64::INFINITY);
            for span in &free.flight().spans {
                self.leave_beam(photon, free, span, end);
            }
        }
    }

    #[inline]
    fn surface(&mut self, photon: &Photon<C>, arrival: &SurfaceArrival, _: &mut Stream) {
        let PhotonTracer { scene, plan, integrator, .. } = self.tracer;
        let connectable = || scene.emitters[photon.emitter].kind.can_be_connected();
        let owned_by_connections = photon.events == 0 && connectable();
        let (position, opl) = (photon.vertex.position, photon.opl);
        let in_time = self.tracer.sampling.horizon.as_ref().is_none_or(|horizon| {
            !horizon.is_late(position, opl)
                && (turns_rays(plan) || !horizon.is_early(position, opl))
        });
        let wanted = plan.surface_photons && !owned_by_connections && in_time;
        if wanted && integrator.reaches(photon.depth()) {
            let caustic = photon.specular && plan.caustic_photons;
            let kept = if caustic { &mut self.caustic } else { &mut self.surface };
            kept.push(SurfacePhoton {
                position: photon.vertex.position,
                direction: photon.direction,
                normal: arrival.lobe.normal,
                opl: photon.opl,
                power: photon.power * arrival.lobe.arriving,
                primitive: arrival.hit.primitive,
                depth: photon.depth(),
            });
        }
    }
}

impl<const C: usize> Traces<'_, C> {
    /// Leaves a beam in a span of a scattering medium; a short one up to `end`.
    fn leave_beam(&mut self, photon: &Photon<C>, free: &FreeFlight<'_, C>, span: &Span, end: f64) {
        let scene = self.tracer.scene;
        let Some(medium) = span.region.medium else { return };
        let coefficients = &scene.medium(medium).coefficients;
        if !coefficients.scatters() {
            return;
        }
        let flight = free.flight();
        let power = photon.power * self.beam_scale;
        let (span_end, power, attenuation) = match self.tracer.length {
            BeamLength::Long => {
                let left = medium::transmittance(flight.depth::<C>(scene, span.start));
                (span.end, power * left, Attenuation::Explicit)
            }
            BeamLength::Short => {
                // Both relative to the channel that reaches farthest.
                let (left, absorption) = free.left(span.start);
                let attenuation = Attenuation::Sampled { mixture: free.mixture() * left };
                (span.end.min(end), power * left * absorption, attenuation)
            }
        };
        let length = visible_length(coefficients, span_end - span.start);
        let (origin, direction) = (flight.at(span.start), flight.direction);
        let opl = photon.opl + flight.opl(span.start);
        let in_time = self.tracer.sampling.horizon.as_ref().is_none_or(|horizon| {
            if turns_rays(self.tracer.plan) {
                !horizon.is_late(origin, opl)
            } else {
                horizon.seen((origin, direction), length, opl).is_some()
            }
        });
        if length > 0.0 && !power.is_zero() && in_time {
            self.beams.push(Beam {
                origin,
                direction,
                length,
                opl,
                power,
                attenuation,
                medium,
                depth: photon.depth(),
            });
        }
    }
}
