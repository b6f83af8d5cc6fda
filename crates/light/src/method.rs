//! The method: one pass traces photons, sorts what they add by pixel, and deposits it.

use tpb_film::{Arrival, TransientFilm};
use tpb_render::{Counts, Method, PassId, PassReport};
use tpb_scene::{IntegratorSpec, Plan, Scene, Transport};
use tpb_transport::{PhotonBatch, PhotonTracer};

use crate::connect::Connections;
use crate::sorted::Sorted;
use crate::{LightOptions, OptionError, Settings};

/// The transient light tracer of one scene, on `C` transported channels.
pub struct LightTracer<'a, const C: usize> {
    scene: &'a Scene,
    integrator: IntegratorSpec,
    settings: Settings,
}

impl<'a, const C: usize> LightTracer<'a, C> {
    /// For a scene and the plan that was made with these depths.
    ///
    /// # Errors
    /// [`OptionError`] for a number of photons out of its range.
    ///
    /// # Panics
    /// If `C` is neither 1 nor 3, or 1 for a plan that needs three channels.
    pub fn new(
        scene: &'a Scene,
        plan: &Plan,
        integrator: IntegratorSpec,
        options: &LightOptions,
    ) -> Result<Self, OptionError> {
        assert!(C == 3 || C == 1 && plan.transport == Transport::Mono, "channels as planned");
        let settings = Settings::new(&scene.film, plan, options)?;
        Ok(Self { scene, integrator, settings })
    }

    /// All options, defaults filled in.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }
}

impl<const C: usize> Method<C> for LightTracer<'_, C> {
    fn name(&self) -> &'static str {
        "light"
    }

    fn options(&self) -> serde_json::Value {
        serde_json::to_value(self.settings).expect("settings are plain data")
    }

    fn pass(&self, id: PassId, film: &mut TransientFilm<C>) -> PassReport {
        let Self { scene, integrator, settings } = *self;
        let (pixels, unwarp) = (film.layout().pixels(), film.options().unwarp);
        let photons = PhotonTracer { scene, integrator };
        let count = settings.photons_per_pass;
        let batch = PhotonBatch { seed: id.seed, pass: id.index, count };
        let (chunks, ledger) =
            photons.trace(batch, |_| Connections::<C>::new(scene, integrator, unwarp));
        let connections = chunks.iter().map(|chunk| chunk.tested).sum();
        let chunks = chunks.into_iter().map(|chunk| chunk.contributions).collect();
        let sorted = Sorted::new(chunks, pixels);
        film.add_pass(|strip| {
            for pixel in strip.pixels() {
                for &(opl, energy) in sorted.of(pixel) {
                    // Unwarped already.
                    strip.deposit(pixel, 0.0, &Arrival::Instant(opl), energy);
                }
            }
        });
        let counts = Counts { photon_paths: count, connections, ..Counts::default() };
        PassReport { ledger, counts }
    }
}
