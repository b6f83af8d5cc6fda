//! The method: one pass traces photons, sorts what they left, and gathers it pixel by pixel.

use tpb_film::{Grain, TransientFilm};
use tpb_lanes::Instructions;
use tpb_render::{Counts, Method, PassId, PassReport};
use tpb_scene::{IntegratorSpec, Plan, Scene};
use tpb_transport::{Horizon, Sampling};

use crate::beam::Beam;
use crate::beam_map::{BeamMap, Pairs};
use crate::camera::Camera;
use crate::kernel::RayBeamKernel;
use crate::kernel1d::Kernel1d;
use crate::kernel2d::Kernel2d;
use crate::kernel3d::Kernel3d;
use crate::lamps::LampPixels;
use crate::options::Radii;
use crate::photons::PhotonTracer;
use crate::sight::Sights;
use crate::surface_map::SurfaceMap;
use crate::{BeamOptions, KernelChoice, OptionError, Settings};

/// The transient photon beams renderer of one scene.
pub struct PhotonBeams<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    integrator: IntegratorSpec,
    settings: Settings,
    lamps: LampPixels,
    instructions: Instructions,
}

impl<'a> PhotonBeams<'a> {
    /// For a scene, its plan, and the depths of this run. Defaults are chosen for the scene's film.
    ///
    /// # Errors
    /// [`OptionError`] for options out of their range.
    pub fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        integrator: IntegratorSpec,
        options: &BeamOptions,
    ) -> Result<Self, OptionError> {
        let settings = Settings::new(scene, plan, options)?;
        let Settings { lamp_samples, surface_samples, .. } = settings;
        let lamps = LampPixels::new(scene, plan, lamp_samples, surface_samples);
        let instructions = Instructions::widest();
        Ok(Self { scene, plan, integrator, settings, lamps, instructions })
    }

    /// With these vector instructions instead of the widest that the machine has: the same bits.
    #[must_use]
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { instructions, ..self }
    }

    /// All options, defaults filled in.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Sorts what photons left, and gathers it pixel by pixel.
    fn gather<const C: usize, K: RayBeamKernel>(
        &self,
        (id, horizon): (PassId, Option<Horizon>),
        film: &mut TransientFilm<C>,
        kernel: K,
        beams: &[Beam<C>],
        photons: &[SurfaceMap<C>],
    ) -> Pairs {
        let &Self { scene, plan, integrator, ref settings, ref lamps, instructions } = self;
        let radius = kernel.radius();
        let rows = (scene.film.height, film.tile_edge(Grain::Coarse));
        let sights = &Sights::new(&scene.sensor, beams, (radius, horizon), rows);
        let turned =
            turns_rays(plan).then(|| BeamMap::new(kernel, beams).with_instructions(instructions));
        let camera = Camera {
            scene,
            plan,
            integrator,
            settings,
            beams,
            sights,
            turned: turned.as_ref(),
            horizon,
            photons,
            kernel,
            lamps,
            instructions,
        };
        let found = film.add_pass_by(Grain::Coarse, |tile| camera.render(id, tile));
        let mut pairs = Pairs::default();
        for more in found {
            pairs.add(more);
        }
        pairs
    }
}

/// Whether mirrors, glass or rough surfaces turn rays from the eye.
pub(crate) fn turns_rays(plan: &Plan) -> bool {
    [&plan.refracting, &plan.mirrors, &plan.rough].iter().any(|shapes| !shapes.is_empty())
}

impl<const C: usize> Method<C> for PhotonBeams<'_> {
    fn name(&self) -> &'static str {
        "beams"
    }

    fn options(&self) -> serde_json::Value {
        serde_json::to_value(&self.settings).expect("settings are plain data")
    }

    fn pass(&self, id: PassId, film: &mut TransientFilm<C>) -> PassReport {
        let Self { scene, plan, integrator, settings, .. } = self;
        let Radii { beams: radius, surface, caustic } = settings.radii(id.index);
        let Settings { photons_per_pass, beam_photons, .. } = *settings;
        let Settings { length, sampler, thin_from, .. } = *settings;
        let reach = radius.max(surface).max(caustic);
        let horizon = film.only_window().map(|window| Horizon::new(scene, window, reach));
        let sampling = Sampling { sampler, thin_from, horizon };
        let tracer = PhotonTracer { scene, plan, integrator: *integrator, length, sampling };
        let traced = tracer.trace::<C>(id, photons_per_pass, beam_photons);
        let surface_photons = (traced.surface.len() + traced.caustic.len()) as u64;
        let mut photons = vec![SurfaceMap::new(traced.surface, surface)];
        if plan.caustic_photons {
            photons.push(SurfaceMap::new(traced.caustic, caustic));
        }
        let (beams, at) = (&traced.beams, (id, horizon));
        let pairs = match settings.kernel {
            KernelChoice::OneD => self.gather(at, film, Kernel1d { radius }, beams, &photons),
            KernelChoice::TwoD => self.gather(at, film, Kernel2d { radius }, beams, &photons),
            KernelChoice::ThreeD => self.gather(at, film, Kernel3d { radius }, beams, &photons),
        };
        let samples = settings.gather_samples.max(settings.surface_samples);
        let counts = Counts {
            camera_paths: film.layout().pixels() as u64 * u64::from(samples),
            photon_paths: photons_per_pass,
            beams: traced.beams.len() as u64,
            surface_photons,
            pairs_tested: pairs.tested,
            pairs_accepted: pairs.accepted,
            ..Counts::default()
        };
        PassReport { ledger: traced.ledger, counts }
    }
}
