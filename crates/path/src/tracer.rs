//! The path tracer as a rendering method: passes, pixels, samples.

use std::num::NonZeroU32;

use tpb_film::{Ledger, Tile, TransientFilm};
use tpb_optics::quasi::Points;
use tpb_optics::{Stream, seed_of};
use tpb_render::{Counts, Method, PassId, PassReport};
use tpb_scene::{IntegratorSpec, Media, Plan, Scene, Transport};
use tpb_transport::Horizon;

use crate::PathOptions;
use crate::walk::Walk;
use crate::world::{Strategies, World};

/// The transient volumetric path tracer on `C` transported channels.
pub struct PathTracer<'a, const C: usize> {
    pub(crate) world: World<'a>,
    samples: NonZeroU32,
}

impl<'a, const C: usize> PathTracer<'a, C> {
    /// For a scene and the plan that was made with these depths.
    ///
    /// # Panics
    /// If `C` is neither 1 nor 3, or 1 for a plan that needs three channels.
    pub fn new(
        scene: &'a Scene,
        plan: &Plan,
        integrator: IntegratorSpec,
        options: &PathOptions,
    ) -> Self {
        assert!(C == 3 || C == 1 && plan.transport == Transport::Mono, "channels as planned");
        let samples = options.samples(&scene.film);
        let strategies = Strategies {
            next_event: plan.next_event_estimation,
            hits: true,
            equiangular: plan.next_event_estimation && plan.media == Media::Scattering,
        };
        let share = 1.0 / f64::from(samples.get());
        Self { world: World { scene, integrator, strategies, share, horizon: None }, samples }
    }

    /// All paths of a tile's pixels; returns their ledger.
    fn render(
        &self,
        world: &World<'_>,
        id: PassId,
        width: usize,
        tile: &mut Tile<'_, C>,
    ) -> Ledger {
        let mut ledger = Ledger::default();
        for pixel in tile.pixels() {
            let mut rng = Stream::new(id.seed, id.index, pixel as u64);
            let points = Points::new(seed_of(seed_of(id.seed, id.index), pixel as u64));
            for sample in 0..self.samples.get() {
                points.lead(u64::from(sample), &mut rng);
                let x = (pixel % width) as f64 + rng.uniform();
                let y = (pixel / width) as f64 + rng.uniform();
                let direction = world.scene.sensor.direction(x, y);
                Walk::new(world, direction, &mut rng, &mut ledger, (&mut *tile, pixel)).run();
            }
        }
        ledger
    }
}

impl<const C: usize> Method<C> for PathTracer<'_, C> {
    fn name(&self) -> &'static str {
        "path"
    }

    fn options(&self) -> serde_json::Value {
        serde_json::json!({ "samples_per_pass": self.samples })
    }

    fn carrier(&self) -> &'static str {
        "importance [camera paths]"
    }

    fn pass(&self, id: PassId, film: &mut TransientFilm<C>) -> PassReport {
        let layout = *film.layout();
        let scene = self.world.scene;
        let horizon = film.only_window().map(|window| Horizon::new(scene, window, 0.0));
        let world = World { horizon, ..self.world };
        let mut report = PassReport::default();
        for ledger in film.add_pass(|tile| self.render(&world, id, layout.width, tile)) {
            report.ledger.add(&ledger);
        }
        let camera_paths = layout.pixels() as u64 * u64::from(self.samples.get());
        report.counts = Counts { camera_paths, ..Counts::default() };
        report
    }
}
