//! Runs with checkpoints.

use tpb_film::{FilmOptions, TransientFilm};
use tpb_optics::seed_of;
use tpb_render::{Budget, Method, RunSettings, Stopwatch, run};
use tpb_scene::{Plan, Scene, Transport};

use super::slope::{Resolved, slope};
use super::{CONFIDENCE, Checkpoint, Curve, ErrorAgainstTime, RunTimePlan};
use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::measure::{Estimator, layout};
use crate::reference_cube::ReferenceCube;
use crate::statistics::split::Estimate;
use crate::statistics::{Gram, ReferenceNoise};

/// Seconds since a run was started.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seconds {
    pub(crate) wall: f64,
    pub(crate) cpu: f64,
}

impl Seconds {
    /// `cpu` is `None` where the system does not tell.
    pub(crate) fn add(&mut self, wall: f64, cpu: Option<f64>) {
        self.wall += wall;
        self.cpu += cpu.unwrap_or(wall);
    }
}

/// A film as it stood at a checkpoint.
pub(crate) struct Snapshot {
    pub(crate) passes: u64,
    pub(crate) seconds: Seconds,
    /// Residuals of the judged pixels' bins, and their rounding to f32 is far below any noise.
    pub(crate) residuals: Vec<f32>,
}

/// One run.
pub(crate) struct Run {
    pub(crate) setup_seconds: f64,
    pub(crate) options: serde_json::Value,
    pub(crate) snapshots: Vec<Snapshot>,
}

impl RunTimePlan<'_> {
    /// Carries it out; `each` is told of every finished run (method, replicate).
    ///
    /// # Errors
    /// If a method cannot be prepared, adds what is not finite, or there are fewer than three
    /// replicates or no light in the reference.
    pub fn run(&self, each: impl FnMut(&str, u64)) -> Result<ErrorAgainstTime> {
        match Plan::new(self.scene, &self.scene.integrator).transport {
            Transport::Mono => self.run_with::<1>(each),
            Transport::Rgb => self.run_with::<3>(each),
        }
    }

    fn run_with<const C: usize>(
        &self,
        mut each: impl FnMut(&str, u64),
    ) -> Result<ErrorAgainstTime> {
        let noise = self.reference.noise(|pixel| self.reference.mask[pixel]);
        if self.replicates < 3 || noise.signal().is_nan() || noise.signal() <= 0.0 {
            let reason = "needs three replicates and a lit reference";
            return Err(ValidationError::unusable("error against run time", reason));
        }
        let mut runs: Vec<Vec<Run>> = self.methods.iter().map(|_| Vec::new()).collect();
        for replicate in 0..self.replicates {
            for (index, estimator) in self.methods.iter().enumerate() {
                // No two runs share random numbers.
                let number = replicate * self.methods.len() as u64 + index as u64;
                let seed = seed_of(self.seed, number);
                let checkpoints = runs[index].first().map(|first| first.snapshots.len());
                let run = self.replicate::<C>(estimator, seed, checkpoints)?;
                runs[index].push(run);
                each(estimator.label(), replicate);
            }
        }
        let judged = self.reference.mask.iter().filter(|&&judged| judged).count();
        let curves = self.methods.iter().zip(runs).map(|(estimator, runs)| {
            curve(estimator.label(), runs, &noise, judged * self.reference.cube.bins)
        });
        Ok(ErrorAgainstTime {
            scene: self.name.clone(),
            reference: self.reference.provenance.clone(),
            reference_nmse: noise.variance / noise.signal(),
            pixels: [judged, self.reference.cube.pixels()],
            replicates: self.replicates,
            seed: self.seed,
            threads: rayon::current_num_threads(),
            circumstances: self.circumstances.clone(),
            left_out: self.left_out.clone(),
            curves: curves.collect(),
        })
    }

    /// One run with as many checkpoints as given, or as fit the time.
    fn replicate<const C: usize>(
        &self,
        estimator: &Estimator,
        seed: u64,
        checkpoints: Option<usize>,
    ) -> Result<Run> {
        let scene = self.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let (mut underway, mut run) = Underway::<C>::new(scene, &plan, estimator, seed)?;
        while checkpoints.map_or_else(
            || self.time_for_another(&run.snapshots),
            |wanted| run.snapshots.len() < wanted,
        ) {
            let cube = underway.until((2 * underway.passes()).max(1))?;
            let (passes, seconds) = (underway.passes(), underway.seconds);
            let residuals = residuals(&cube, self.reference);
            run.snapshots.push(Snapshot { passes, seconds, residuals });
        }
        Ok(run)
    }

    /// Whether twice the passes are expected to fit the time.
    fn time_for_another(&self, snapshots: &[Snapshot]) -> bool {
        let last = snapshots.last().map_or(0.0, |snapshot| snapshot.seconds.wall);
        2.0 * last <= self.time.as_secs_f64()
    }
}

/// A run under way: a prepared method and the film of its passes so far.
pub(crate) struct Underway<'a, const C: usize> {
    method: Box<dyn Method<C> + 'a>,
    film: TransientFilm<C>,
    seed: u64,
    pub(crate) seconds: Seconds,
}

impl<'a, const C: usize> Underway<'a, C> {
    /// Before the first pass; what has been found so far is its set-up.
    pub(crate) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        estimator: &Estimator,
        seed: u64,
    ) -> Result<(Self, Run)> {
        let film = TransientFilm::<C>::new(layout(&scene.film, 0.0)?, FilmOptions::default())?;
        let clock = Stopwatch::start();
        let method = estimator.prepare::<C>(scene, plan, scene.integrator)?;
        let mut seconds = Seconds::default();
        seconds.add(clock.wall().as_secs_f64(), clock.cpu().map(|cpu| cpu.as_secs_f64()));
        let run =
            Run { setup_seconds: seconds.wall, options: method.options(), snapshots: Vec::new() };
        Ok((Self { method, film, seed, seconds }, run))
    }

    pub(crate) fn passes(&self) -> u64 {
        self.film.passes()
    }

    /// What is seen after so many passes in all.
    pub(crate) fn until(&mut self, passes: u64) -> Result<Cube> {
        let Self { method, film, seed, seconds } = self;
        let made = film.passes();
        let budget = Budget::Passes(passes - made);
        let settings = RunSettings { seed: *seed, budget, first_pass: made };
        let summary = run(&**method, film, &settings, &Stopwatch::start(), &mut ());
        if film.non_finite() > 0 {
            let reason = format!("{} contributions were not finite", film.non_finite());
            return Err(ValidationError::unusable(method.name(), reason));
        }
        seconds.add(summary.wall_seconds, summary.cpu_seconds);
        Ok(Cube::of(&film.develop()))
    }
}

pub(crate) fn residuals(cube: &Cube, reference: &ReferenceCube) -> Vec<f32> {
    let judged = (0..cube.pixels()).filter(|&pixel| reference.mask[pixel]);
    judged
        .flat_map(|pixel| cube.pixel_bins(pixel).iter().zip(reference.cube.pixel_bins(pixel)))
        .map(|(x, r)| (x - r) as f32)
        .collect()
}

/// Puts the replicates of one method together, checkpoint by checkpoint: all have the same.
pub(crate) fn curve(
    method: &str,
    mut runs: Vec<Run>,
    noise: &ReferenceNoise,
    cells: usize,
) -> Curve {
    let n = runs.len() as f64;
    let mut checkpoints = Vec::new();
    let (mut errors, mut variances) = (Vec::new(), Vec::new());
    for index in 0..runs[0].snapshots.len() {
        // Residuals are dropped as soon as their products are known.
        let residuals: Vec<Vec<f32>> = runs
            .iter_mut()
            .map(|run| std::mem::take(&mut run.snapshots[index].residuals))
            .collect();
        let seconds: Vec<Seconds> = runs.iter().map(|run| run.snapshots[index].seconds).collect();
        let gram = Gram::of(&residuals);
        let Some(split) = gram.split(noise, CONFIDENCE) else { continue };
        let mean = |of: fn(&Seconds) -> f64| seconds.iter().map(of).sum::<f64>() / n;
        let (wall_seconds, cpu_seconds) = (mean(|s| s.wall), mean(|s| s.cpu));
        checkpoints.push(Checkpoint {
            passes: runs[0].snapshots[index].passes,
            wall_seconds,
            cpu_seconds,
            rmse: root(split.nmse, noise.signal() / cells as f64),
            nmse: split.nmse,
            variance: split.variance,
            squared_bias: split.squared_bias,
            inverse_efficiency: scaled(split.variance, cpu_seconds),
        });
        let cpu: Vec<f64> = seconds.iter().map(|seconds| seconds.cpu).collect();
        let resolved = |estimate: Estimate, part: usize| {
            (estimate.interval[0] > 0.0).then(|| Resolved::new(&gram, noise, &cpu, part))
        };
        errors.extend(resolved(split.nmse, 0));
        variances.extend(resolved(split.variance, 1));
    }
    Curve {
        method: method.into(),
        options: runs[0].options.take(),
        setup_seconds: runs.iter().map(|run| run.setup_seconds).sum::<f64>() / n,
        checkpoints,
        slope: slope(&errors, CONFIDENCE),
        variance_slope: slope(&variances, CONFIDENCE),
    }
}

fn scaled(estimate: Estimate, factor: f64) -> Estimate {
    Estimate {
        value: estimate.value * factor,
        standard_error: estimate.standard_error * factor,
        interval: estimate.interval.map(|end| end * factor),
    }
}

/// The root of `estimate · factor`; of what is negative by chance, 0.
fn root(estimate: Estimate, factor: f64) -> Estimate {
    let of = |value: f64| (value * factor).max(0.0).sqrt();
    let value = of(estimate.value);
    let slope = if value > 0.0 { 0.5 * factor / value } else { f64::INFINITY };
    Estimate {
        value,
        standard_error: estimate.standard_error * slope,
        interval: estimate.interval.map(of),
    }
}
