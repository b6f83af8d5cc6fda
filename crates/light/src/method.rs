//! The method: one pass traces photons, sorts what they add by pixel, and deposits it.

use tpb_film::{Arrival, Ledger, TransientFilm};
use tpb_optics::Spectrum;
use tpb_render::{Counts, Method, PassId, PassReport};
use tpb_scene::{IntegratorSpec, Plan, Scene, Transport};
use tpb_transport::{Horizon, PhotonBatch, PhotonTracer, Sampling};

use crate::connect::Connections;
use crate::sorted::{Contribution, Sorted};
use crate::{LightOptions, OptionError, Settings};

/// Photons of the pilot run: enough to tell a dozen contributions a photon from thousands.
const PILOT: u64 = 16;

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
        let mut tracer = Self { scene, integrator, settings };
        if options.photons_per_pass.is_none() && settings.photons_per_pass > 0 {
            tracer.settings.fit(tracer.bytes_per_photon());
        }
        Ok(tracer)
    }

    /// Memory of a photon's contributions, kept and sorted, as a pilot run finds it \[bytes\]. Its
    /// random numbers are those of no pass.
    fn bytes_per_photon(&self) -> f64 {
        let pilot = PhotonBatch { seed: 0, pass: u64::MAX, count: PILOT };
        let (chunks, _) = self.trace(pilot, false, None);
        let contributions = chunks.iter().map(|chunk| chunk.contributions.len());
        let bytes = size_of::<Contribution<C>>() + size_of::<(f64, Spectrum<C>)>();
        (contributions.sum::<usize>() * bytes) as f64 / PILOT as f64
    }

    fn trace(
        &self,
        batch: PhotonBatch,
        unwarp: bool,
        horizon: Option<Horizon>,
    ) -> (Vec<Connections<'a, C>>, Ledger) {
        let Self { scene, integrator, .. } = *self;
        let sampling = Sampling { horizon, ..Sampling::default() };
        let photons = PhotonTracer { scene, integrator, sampling };
        photons.trace(batch, |_| Connections::new(scene, integrator, (unwarp, horizon)))
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
        let (pixels, unwarp) = (film.layout().pixels(), film.options().unwarp);
        let count = self.settings.photons_per_pass;
        let batch = PhotonBatch { seed: id.seed, pass: id.index, count };
        let horizon = film.only_window().map(|window| Horizon::new(self.scene, window, 0.0));
        let (chunks, ledger) = self.trace(batch, unwarp, horizon);
        let connections = chunks.iter().map(|chunk| chunk.tested).sum();
        let chunks = chunks.into_iter().map(|chunk| chunk.contributions).collect();
        let sorted = Sorted::new(chunks, pixels);
        film.add_pass(|tile| {
            for pixel in tile.pixels() {
                for &(opl, energy) in sorted.of(pixel) {
                    // Unwarped already.
                    tile.deposit(pixel, 0.0, &Arrival::Instant(opl), energy);
                }
            }
        });
        let counts = Counts { photon_paths: count, connections, ..Counts::default() };
        PassReport { ledger, counts }
    }
}
