//! Methods against each other at equal time, and against a reference with error bars of its own.
//!
//! Each method renders n independent replicates, in turn (path, beams, path, …), so that whatever
//! else the machine does meets all alike. A replicate's clock starts before its method is prepared.
//! Wall time, CPU time of the process and passes are measured, not assumed.
//!
//! Over the judged pixels (those within one pixel of which no emitter is seen) and over the whole
//! cube beside it: NMSE = Σ(x − r)²/Σr², less what the reference's own noise adds, split into
//! variance and squared bias ([`crate::statistics::split`]). "Times less error" compares
//! NMSE · CPU seconds: where variance dominates, that is the ratio of CPU seconds to equal error.
//!
//! Absence of bias is tested where pixels are independent (path tracing; not beams, which pixels
//! share): with e_i the residuals of pixel k in replicate i and v_k the reference's variance there,
//!
//! > b_k = (|Σ_i e_i|² − Σ_i |e_i|²)/(n(n − 1)) − v_k
//!
//! has mean 0 without bias, and z = Σb_k/√(Σb_k²) over thousands of pixels is a self-normalised sum,
//! normal far into its tail whatever the distribution of the b_k (Shao 1997).

use std::fmt::Write as _;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tpb_film::{FilmOptions, TransientFilm};
use tpb_optics::seed_of;
use tpb_render::{Budget, Counts, RunSettings, Stopwatch, run};
use tpb_scene::{Plan, Scene, Transport};

use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::measure::{Estimator, layout};
use crate::reference_cube::{Provenance, ReferenceCube};
use crate::statistics::split::Estimate;
use crate::statistics::{Gram, RatioInterval, Split, ratio_of_means, student};

/// Confidence of all intervals.
pub const CONFIDENCE: f64 = 0.95;

/// One timed render.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replicate {
    /// Seed.
    pub seed: u64,
    /// Wall time \[s\].
    pub wall_seconds: f64,
    /// CPU time of the process \[s\]; the wall time where the system does not tell.
    pub cpu_seconds: f64,
    /// Passes.
    pub passes: u64,
    /// Work done.
    pub counts: Counts,
    /// Root of the mean squared error over judged cells, the reference's noise subtracted.
    pub rmse: f64,
    /// Normalised mean squared error over judged cells, likewise.
    pub nmse: f64,
    /// The same over the whole cube.
    pub nmse_whole: f64,
}

/// The replicates of one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodResult {
    /// Its name.
    pub method: String,
    /// Its effective options.
    pub options: serde_json::Value,
    /// Each run.
    pub replicates: Vec<Replicate>,
    /// Parts of the error over judged pixels.
    pub split: Split,
    /// Parts of the error over the whole cube.
    pub split_whole: Split,
    /// Squared bias by the pixel-wise estimate, over the signal; its standard error and interval
    /// are meaningful where pixels are independent.
    pub pixel_bias: Estimate,
    /// The same if all light were [`EqualTimePlan::control`] times as strong: a negative control.
    pub control_bias: Estimate,
}

impl MethodResult {
    /// z of the pixel-wise squared bias.
    pub fn bias_z(&self) -> f64 {
        z(&self.pixel_bias)
    }

    /// The same of the negative control.
    pub fn control_z(&self) -> f64 {
        z(&self.control_bias)
    }

    /// Mean over replicates.
    pub fn mean(&self, of: impl Fn(&Replicate) -> f64) -> f64 {
        self.replicates.iter().map(of).sum::<f64>() / self.replicates.len() as f64
    }

    /// NMSE · CPU seconds of each replicate.
    pub fn work(&self) -> Vec<f64> {
        self.replicates.iter().map(|r| r.nmse * r.cpu_seconds).collect()
    }
}

fn z(estimate: &Estimate) -> f64 {
    if estimate.value == 0.0 { 0.0 } else { estimate.value / estimate.standard_error }
}

/// An equal-time comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualTime {
    /// Name of the scene.
    pub scene: String,
    /// Wall time that each run was given \[s\].
    pub seconds: f64,
    /// What it is compared with.
    pub reference: Provenance,
    /// NMSE of the reference itself, from its own variance.
    pub reference_nmse: f64,
    /// Pixels that are judged, and all.
    pub pixels: [usize; 2],
    /// All methods.
    pub methods: Vec<MethodResult>,
    /// (NMSE · CPU s of the first method)/(that of the second).
    pub factor: Option<RatioInterval>,
}

/// What to compare.
pub struct EqualTimePlan<'a> {
    /// Name of the scene.
    pub name: String,
    /// The scene.
    pub scene: &'a Scene,
    /// Its reference.
    pub reference: &'a ReferenceCube,
    /// The methods, the baseline first.
    pub methods: Vec<Estimator>,
    /// A defect that the test for bias must find: all light is this many times as strong.
    pub control: f64,
    /// Wall time of a run.
    pub time: Duration,
    /// Runs of each method, at least 3.
    pub replicates: u64,
    /// Seed: each run has one of its own ([`seed_of`]).
    pub seed: u64,
}

impl EqualTimePlan<'_> {
    /// Carries it out.
    pub fn run(&self) -> Result<EqualTime> {
        match Plan::new(self.scene, &self.scene.integrator).transport {
            Transport::Mono => self.run_with::<1>(),
            Transport::Rgb => self.run_with::<3>(),
        }
    }

    fn run_with<const C: usize>(&self) -> Result<EqualTime> {
        let mut runs: Vec<Vec<(Cube, Replicate)>> = self.methods.iter().map(|_| vec![]).collect();
        let mut options = vec![serde_json::Value::Null; self.methods.len()];
        for replicate in 0..self.replicates {
            for (index, estimator) in self.methods.iter().enumerate() {
                // No two runs share random numbers.
                let number = replicate * self.methods.len() as u64 + index as u64;
                let seed = seed_of(self.seed, number);
                let (cube, record, used) = self.timed::<C>(estimator, seed)?;
                options[index] = used;
                runs[index].push((cube, record));
            }
        }
        let methods = self
            .methods
            .iter()
            .zip(runs)
            .zip(options)
            .map(|((estimator, runs), options)| self.judge(estimator, options, runs))
            .collect::<Result<Vec<_>>>()?;
        let factor = match methods.as_slice() {
            [first, second, ..] => ratio_of_means(&first.work(), &second.work(), CONFIDENCE),
            _ => None,
        };
        let judged = self.reference.mask.iter().filter(|&&judged| judged).count();
        let noise = self.reference.noise(|pixel| self.reference.mask[pixel]);
        Ok(EqualTime {
            scene: self.name.clone(),
            seconds: self.time.as_secs_f64(),
            reference: self.reference.provenance.clone(),
            reference_nmse: noise.variance / noise.signal(),
            pixels: [judged, self.reference.cube.pixels()],
            methods,
            factor,
        })
    }

    fn timed<const C: usize>(
        &self,
        estimator: &Estimator,
        seed: u64,
    ) -> Result<(Cube, Replicate, serde_json::Value)> {
        let scene = self.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let mut film = TransientFilm::<C>::new(layout(&scene.film, 0.0)?, FilmOptions::default())?;
        let started = Stopwatch::start();
        let method = estimator.prepare::<C>(scene, &plan, scene.integrator)?;
        let settings = RunSettings { seed, budget: Budget::Time(self.time), first_pass: 0 };
        let summary = run(&*method, &mut film, &settings, &started, &mut ());
        if film.non_finite() > 0 {
            let reason = format!("{} contributions were not finite", film.non_finite());
            return Err(ValidationError::unusable(method.name(), reason));
        }
        let replicate = Replicate {
            seed,
            wall_seconds: summary.wall_seconds,
            cpu_seconds: summary.cpu_seconds.unwrap_or(summary.wall_seconds),
            passes: summary.passes,
            counts: summary.counts,
            rmse: 0.0,
            nmse: 0.0,
            nmse_whole: 0.0,
        };
        Ok((Cube::of(&film.develop()), replicate, method.options()))
    }

    fn judge(
        &self,
        estimator: &Estimator,
        options: serde_json::Value,
        runs: Vec<(Cube, Replicate)>,
    ) -> Result<MethodResult> {
        let (cubes, mut replicates): (Vec<Cube>, Vec<Replicate>) = runs.into_iter().unzip();
        let too_few = || {
            ValidationError::unusable("equal time", "needs three replicates and a lit reference")
        };
        let errors = Errors::new(&cubes, self.reference);
        let mut stronger = cubes;
        for cube in &mut stronger {
            cube.scale(self.control);
        }
        let control = Errors::new(&stronger, self.reference);
        let noise = self.reference.noise(|pixel| self.reference.mask[pixel]);
        let noise_whole = self.reference.noise(|_| true);
        let split = errors.judged.split(&noise, CONFIDENCE).ok_or_else(too_few)?;
        let split_whole = errors.whole.split(&noise_whole, CONFIDENCE).ok_or_else(too_few)?;
        let cells =
            self.reference.mask.iter().filter(|&&judged| judged).count() * self.reference.cube.bins;
        for (index, replicate) in replicates.iter_mut().enumerate() {
            replicate.nmse = split.replicates[index];
            replicate.nmse_whole = split_whole.replicates[index];
            replicate.rmse = (replicate.nmse * noise.signal() / cells as f64).max(0.0).sqrt();
        }
        Ok(MethodResult {
            method: estimator.name().into(),
            options,
            replicates,
            split,
            split_whole,
            pixel_bias: errors.pixel_bias(noise.signal()),
            control_bias: control.pixel_bias(noise.signal()),
        })
    }
}

/// Residual products of all replicates.
struct Errors {
    judged: Gram,
    whole: Gram,
    /// Σ b_k and Σ b_k².
    bias: [f64; 2],
}

impl Errors {
    fn new(cubes: &[Cube], reference: &ReferenceCube) -> Self {
        let n = cubes.len();
        let empty = Gram::of(&vec![Vec::<f64>::new(); n]);
        let (mut judged, mut whole) = (empty.clone(), empty);
        let (mut sum, mut squares) = (0.0, 0.0);
        for pixel in 0..reference.cube.pixels() {
            let r = reference.cube.pixel_bins(pixel);
            let residuals: Vec<Vec<f64>> = cubes
                .iter()
                .map(|cube| cube.pixel_bins(pixel).iter().zip(r).map(|(x, r)| x - r).collect())
                .collect();
            let gram = Gram::of(&residuals);
            whole.add(&gram);
            if reference.mask[pixel] {
                let bias = gram.cross_mean() - reference.variance_pixel[pixel];
                sum += bias;
                squares += bias * bias;
                judged.add(&gram);
            }
        }
        Self { judged, whole, bias: [sum, squares] }
    }

    fn pixel_bias(&self, signal: f64) -> Estimate {
        let [value, standard_error] = [self.bias[0] / signal, self.bias[1].sqrt() / signal];
        let half = student::quantile(0.5 * (1.0 - CONFIDENCE), 1e6) * standard_error;
        Estimate { value, standard_error, interval: [value - half, value + half] }
    }
}

impl EqualTime {
    /// P(z at least as large) of a method whose pixels are independent.
    pub fn bias_p(method: &MethodResult) -> f64 {
        student::upper_tail(method.bias_z(), 1e6)
    }

    /// The same of the negative control.
    pub fn control_p(method: &MethodResult) -> f64 {
        student::upper_tail(method.control_z(), 1e6)
    }

    /// A table for people, one line each.
    pub fn table(&self) -> Vec<String> {
        let mut lines = vec![format!(
            "{}: {} s per run; reference: {}, {} passes, {:.0} CPU s, own NMSE {:.1e}; {} of {} pixels judged",
            self.scene,
            self.seconds,
            self.reference.method,
            self.reference.passes,
            self.reference.cpu_seconds.unwrap_or(f64::NAN),
            self.reference_nmse,
            self.pixels[0],
            self.pixels[1],
        )];
        lines.push(format!(
            "  {:<6} {:>4} {:>7} {:>7} {:>7} {:>9} {:>9} {:>21} {:>23} {:>9} {:>10} {:>6}",
            "method",
            "runs",
            "wall s",
            "CPU s",
            "passes",
            "RMSE",
            "NMSE",
            "variance",
            "bias^2",
            "whole",
            "NMSE*CPU s",
            "bias z"
        ));
        for m in &self.methods {
            let mut line = String::new();
            let interval = |e: &Estimate| {
                format!("{:.2e} [{:.1e},{:.1e}]", e.value, e.interval[0], e.interval[1])
            };
            let _ = write!(
                line,
                "  {:<6} {:>4} {:>7.2} {:>7.2} {:>7.1} {:>9.2e} {:>9.2e} {:>21} {:>23} {:>9.2e} {:>10.3e} {:>6.1}",
                m.method,
                m.replicates.len(),
                m.mean(|r| r.wall_seconds),
                m.mean(|r| r.cpu_seconds),
                m.mean(|r| r.passes as f64),
                m.mean(|r| r.rmse),
                m.split.nmse.value,
                interval(&m.split.variance),
                interval(&m.split.squared_bias),
                m.split_whole.nmse.value,
                m.work().iter().sum::<f64>() / m.replicates.len() as f64,
                m.bias_z(),
            );
            lines.push(line);
        }
        lines.push(match (&self.factor, self.methods.as_slice()) {
            (Some(f), [first, second, ..]) => format!(
                "  {} has {:.2} times less NMSE*CPU s than {} (95 % interval {:.2} to {:.2}; p that it has not less: {:.1e})",
                second.method, f.ratio, first.method, f.low, f.high, f.p_at_most_one
            ),
            _ => "  no ratio: an error is not resolved above the reference's noise".into(),
        });
        lines
    }
}
