//! One render of a stress scene, checked for soundness.
//!
//! The scene goes through the loader, as a user's file does. A render is *sound* if
//!
//! * no contribution was non-finite, and all arrays are finite and nowhere negative;
//! * the arrays hold what the film holds, and in each pixel bins + before + after = the steady
//!   image, to the rounding of f32;
//! * the ledger closes to 1e-9.

use std::path::Path;

use tpb_film::{Arrays, Ledger};
use tpb_render::{Budget, FilmSetup, RenderOptions, RunSettings, Stopwatch, run};
use tpb_scene::load::parse_scene;
use tpb_scene::{Plan, Scene, Transport};

use crate::error::{Result, ValidationError};
use crate::stress::case::{Method, Work};
use crate::stress::world::World;

/// The ledger must close so well.
const CLOSURE: f64 = 1e-9;
/// Cells are f32, their sum is compared with an f64.
const SUM_TOLERANCE: f64 = 1e-6;

/// What a render gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Its arrays.
    pub arrays: Arrays,
    /// Mean ledger of a pass.
    pub ledger: Ledger,
}

/// A scene, ready to be rendered by one method.
pub struct Shot {
    scene: Scene,
    plan: Plan,
    method: Method,
    work: Work,
}

impl Shot {
    /// Loads a scene; lengths of `work` are in its unit.
    pub fn new(world: &World, method: Method, work: &Work) -> Result<Self> {
        let scene = load(world)?;
        let plan = Plan::new(&scene, &scene.integrator);
        Ok(Self { scene, plan, method, work: work.in_unit(world.unit.length) })
    }

    /// One render of so many passes, the first of which is `first`.
    pub fn render(&self, seed: u64, passes: u64) -> Result<Image> {
        let mut only = None;
        self.batches(seed, 1, passes, |image| only = Some(image))?;
        only.ok_or_else(|| ValidationError::unusable("a render", "no image"))
    }

    /// Independent renders of so many passes each.
    pub fn batches(
        &self,
        seed: u64,
        batches: u64,
        passes: u64,
        mut each: impl FnMut(Image),
    ) -> Result<()> {
        match self.plan.transport {
            Transport::Mono => self.run::<1>(seed, batches, passes, &mut each),
            Transport::Rgb => self.run::<3>(seed, batches, passes, &mut each),
        }
    }

    fn run<const C: usize>(
        &self,
        seed: u64,
        batches: u64,
        passes: u64,
        each: &mut impl FnMut(Image),
    ) -> Result<()> {
        let Self { scene, plan, method, work } = self;
        let render = |error| ValidationError::unusable("the film", error);
        let setup = FilmSetup::new(&scene.film, plan.transport, &RenderOptions::default());
        let setup = setup.map_err(render)?;
        let method = method.estimator(work).prepare::<C>(scene, plan, scene.integrator)?;
        for batch in 0..batches {
            let mut film = setup.film::<C>().map_err(render)?;
            let settings =
                RunSettings { seed, budget: Budget::Passes(passes), first_pass: batch * passes };
            let summary = run(&*method, &mut film, &settings, &Stopwatch::start(), &mut ());
            let non_finite = film.non_finite();
            let (arrays, _) = setup.develop(film).map_err(render)?;
            let image = Image { arrays, ledger: summary.ledger.mean_of_a_pass };
            image.check(non_finite)?;
            each(image);
        }
        Ok(())
    }
}

/// Loads a scene; the error is what a user would see.
pub fn load(world: &World) -> Result<Scene> {
    let loaded = parse_scene(&world.text(), "stress.json", Path::new("."), &[]);
    Ok(loaded.map_err(|error| ValidationError::unusable("refused", error))?.scene)
}

impl Image {
    /// Whether it is sound.
    fn check(&self, non_finite: u64) -> Result<()> {
        let Self { arrays, ledger } = self;
        let unsound = |reason: String| Err(ValidationError::unusable("unsound", reason));
        if non_finite > 0 {
            return unsound(format!("{non_finite} contributions were not finite"));
        }
        if let Some(reason) = arrays.out_of_range(true) {
            return unsound(reason);
        }
        let doubles = [&arrays.before, &arrays.after, &arrays.steady].into_iter().flatten();
        let singles = arrays.transient.iter().map(|&cell| f64::from(cell));
        let all = doubles.copied().chain(singles);
        if let Some(bad) = all.into_iter().find(|value| !(value.is_finite() && *value >= 0.0)) {
            return unsound(format!("the arrays hold {bad}"));
        }
        if arrays.bins > 0 {
            // What single cells lose below the range of f32 matters to dark pixels only.
            let least = f64::from(f32::MIN_POSITIVE) * arrays.bins as f64;
            for (pixel, (sum, steady)) in self.sums().into_iter().enumerate() {
                if (sum - steady).abs() > SUM_TOLERANCE * steady + least {
                    return unsound(format!(
                        "pixel {pixel}: cells add up to {sum:e}, steady {steady:e}"
                    ));
                }
            }
        }
        if ledger.closure().abs() > CLOSURE || !ledger.closure().is_finite() {
            return unsound(format!("the ledger is off by {:e}", ledger.closure()));
        }
        Ok(())
    }

    /// Per pixel and channel: sum of all cells, and the steady image.
    fn sums(&self) -> Vec<(f64, f64)> {
        let Arrays { channels, steady, .. } = &self.arrays;
        let sum = |index: usize| self.cells(index / channels, index % channels).iter().sum();
        steady.iter().enumerate().map(|(index, &steady)| (sum(index), steady)).collect()
    }

    /// Before, bins, after of one channel of a pixel.
    pub fn cells(&self, pixel: usize, channel: usize) -> Vec<f64> {
        let Arrays { channels, before, after, .. } = &self.arrays;
        let index = pixel * channels + channel;
        let bins = self.arrays.pixel(pixel).iter().skip(channel).step_by(*channels);
        let mut cells = vec![before.get(index).copied().unwrap_or(0.0)];
        cells.extend(bins.map(|&bin| f64::from(bin)));
        cells.push(after.get(index).copied().unwrap_or(0.0));
        cells
    }

    /// Sum of the steady image over pixels and channels.
    pub fn total(&self) -> f64 {
        self.arrays.steady.iter().sum()
    }

    /// Sums over all pixels and channels: before the window, in it, after it.
    pub fn parts(&self) -> [f64; 3] {
        let inside = self.arrays.transient.iter().map(|&cell| f64::from(cell)).sum();
        [self.arrays.before.iter().sum(), inside, self.arrays.after.iter().sum()]
    }
}
