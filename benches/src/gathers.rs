//! The gather of cornell-blocks by itself: one sample of the image against the beams of one pass.

use std::hint::black_box;

use tpb_beams::beam::{Beam, CameraRay};
use tpb_beams::beam_map::BeamMap;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::photons::PhotonTracer;
use tpb_beams::scan::Lattice;
use tpb_beams::sight::Sights;
use tpb_beams::splat::{Splat, TileRays};
use tpb_beams::{BeamLength, Sampling, Temporal};
use tpb_film::{Grain, TransientFilm};
use tpb_lanes::Instructions;
use tpb_render::PassId;
use tpb_scene::{MediumId, Plan, Scene};

use crate::{film_of, sized_scene};

/// Beams, and rays that meet them.
pub struct Gathers {
    scene: Scene,
    beams: Vec<Beam<1>>,
    rays: Vec<(MediumId, CameraRay<1>)>,
    film: TransientFilm<1>,
}

impl Gathers {
    /// With the beams of so many photons, 128 × 128 pixels, 200 bins.
    ///
    /// # Panics
    /// If the scene does not load: a broken checkout.
    pub fn new(photons: u64) -> Self {
        let scene = sized_scene("cornell-blocks", Some(128));
        let integrator = scene.integrator;
        let plan = Plan::new(&scene, &integrator);
        let length = BeamLength::Long;
        let tracer = PhotonTracer {
            scene: &scene,
            plan: &plan,
            integrator,
            length,
            sampling: Sampling::default(),
        };
        let beams = tracer.trace::<1>(PassId { seed: 1, index: 0 }, photons, photons).beams;
        let (rays, film) = (rays(&scene), film_of(&scene));
        Self { scene, beams, rays, film }
    }

    /// How many beams there are.
    pub fn beams(&self) -> usize {
        self.beams.len()
    }

    /// All beams drawn over the image; returns how many pairs were accepted.
    pub fn drawn<K: RayBeamKernel>(&mut self, kernel: K) -> u64 {
        let Self { scene, beams, film, .. } = self;
        let edge = film.tile_edge(Grain::Coarse);
        let sights =
            Sights::new(&scene.sensor, beams, (kernel.radius(), None), (scene.film.height, edge));
        let pairs = film.add_pass_by(Grain::Coarse, |tile| {
            let lattice = Lattice::new(&scene.sensor, tile, [0.5, 0.5]);
            let flights: Vec<_> =
                lattice.directions().map(|direction| scene.fly(&scene.eye(), direction)).collect();
            let rays = TileRays::new(scene, lattice, &flights);
            let splat = Splat {
                kernel,
                beams,
                sights: &sights,
                rays: &rays,
                temporal: Temporal::Exact,
                share: 1.0,
                instructions: Instructions::widest(),
            };
            splat.draw(|_| true, tile)
        });
        pairs.iter().map(|pairs| pairs.accepted).sum()
    }

    /// What [`Gathers::drawn`] prepares.
    pub fn seen<K: RayBeamKernel>(&self, kernel: K) {
        let rows = (self.scene.film.height, self.film.tile_edge(Grain::Coarse));
        black_box(Sights::new(&self.scene.sensor, &self.beams, (kernel.radius(), None), rows));
    }

    /// All beams found by bundles of rays, as if these had been turned, and evaluated.
    pub fn bundled<K: RayBeamKernel>(&self, kernel: K) -> u64 {
        let map = BeamMap::new(kernel, &self.beams);
        let found = |number: usize, beam: &Beam<1>, meeting: &_| {
            black_box(kernel.contribution(meeting, beam, &self.rays[number].1));
        };
        map.query(kernel, &self.rays, found).accepted
    }

    /// What [`Gathers::bundled`] prepares.
    pub fn listed<K: RayBeamKernel>(&self, kernel: K) {
        black_box(BeamMap::new(kernel, &self.beams));
    }
}

/// The rays through all pixel centres, within the fog; neighbours together.
fn rays(scene: &Scene) -> Vec<(MediumId, CameraRay<1>)> {
    let (width, height) = (scene.film.width, scene.film.height);
    let mut pixels: Vec<_> = (0..width * height).map(|i| (i % width, i / width)).collect();
    pixels.sort_by_key(|&(x, y)| [32, 8, 4].map(|block| (y / block, x / block)));
    let rays = pixels.into_iter().filter_map(|(x, y)| {
        let direction = scene.sensor.direction(x as f64 + 0.5, y as f64 + 0.5);
        let flight = scene.fly(&scene.eye(), direction);
        flight.spans.iter().find_map(|span| CameraRay::of_span(scene, &flight, span))
    });
    rays.collect()
}
