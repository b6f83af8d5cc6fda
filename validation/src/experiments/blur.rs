//! What blur costs: bias against the radius, variance against radius and photons.
//!
//! A point light stands beside the camera in infinite fog, and the light is scattered once.
//!
//! * **Bias.** Measured bias is the mean estimate less the exact single scattering; predicted bias
//!   is the exact expected blur less the same ([`crate::expected`]). For several radii their ratio
//!   must be 1, and the exponent of a power law fitted to them that of the prediction, which is 2
//!   for small radii (checked without chance to 1 %). Stated margin: 10 % of bias and of exponent (20 % in quick runs and for 3D).
//! * **Variance.** Of one pass, for all light and for a bin of time: a ray meets a beam with a
//!   probability ∝ R, and the value goes as 1/R, so that binned variance is ∝ 1/(N R) for each
//!   kernel. Stated margin: 10 % of both exponents. As R is small beside the light's distance, terms
//!   of higher order are below it. The same runs with a radius that is wrong as its own power 1.25
//!   must be found different: the experiment's own control.
//!
//! Exponents are slopes of least squares in logarithms. Their interval comes from the batches
//! (groups of passes) by jackknife pseudo-values B θ − (B − 1) θ₋ᵢ (Tukey 1958), which are judged as
//! batches are.

use std::sync::Arc;

use glam::DVec3;
use tpb_beams::{BeamOptions, KernelChoice, Sampler};
use tpb_plot::{Axis, Chart, Mark, Series};
use tpb_scene::TimeSpec;

use crate::artefacts::leave_chart;
use crate::error::Result;
use crate::expected::SingleScattering;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{Fog, View, infinite_fog, only_depth};
use crate::statistics::regression::{self, jackknife, variance};
use crate::statistics::{Batches, Criterion, Finding, Target, judge};

const FOG: Fog = Fog { sigma_s: 0.4, sigma_a: 0.1, g: 0.0 };
const LIGHT: DVec3 = DVec3::new(0.6, 0.0, 0.0);
/// Of biases and exponents, relative; in full and in quick runs.
const MARGIN: f64 = 0.1;
const QUICK_MARGIN: f64 = 0.2;
/// Groups of passes.
const BATCHES: usize = 32;

const BIAS_TIME: TimeSpec = TimeSpec { start_opl: 0.0, bin_width_opl: 6.4, bins: 1 };
/// Few in a pass: each pass has camera rays of its own, whose places are half of the noise.
const BIAS_PHOTONS: u64 = 5_000;
const FULL_RADII: [f64; 4] = [0.32, 0.37, 0.43, 0.5];
const QUICK_RADII: [f64; 2] = [0.36, 0.5];

/// Bins much wider than a pair's arrival: pairs that two bins share add less to the variance.
const VARIANCE_TIME: TimeSpec = TimeSpec { start_opl: 0.0, bin_width_opl: 1.2, bins: 6 };
/// The bin that is judged apart: behind the front.
const BIN: usize = 1;
const SMALL_RADII: [f64; 4] = [0.01, 0.02, 0.04, 0.08];
const PHOTONS: [u64; 4] = [250, 500, 1000, 2000];
const MIDDLE: (f64, u64) = (0.03, 1000);
/// Power of the control's radius.
const WRONG: f64 = 1.25;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Bias against radius.
    Bias,
    /// Variance of a pass against radius and photons.
    Variance,
}

/// One kernel's blur.
#[derive(Clone, Copy, Debug)]
pub struct Blur {
    /// The kernel.
    pub kernel: KernelChoice,
    /// The question.
    pub what: What,
}

/// Each kernel; a small one in quick runs.
pub fn all(effort: Effort) -> Experiments {
    let case = |what| move |kernel| Arc::new(Blur { kernel, what }) as _;
    let kernels = [KernelChoice::OneD, KernelChoice::TwoD, KernelChoice::ThreeD];
    if effort == Effort::Quick {
        return vec![case(What::Bias)(KernelChoice::TwoD)];
    }
    kernels.map(case(What::Bias)).into_iter().chain(kernels.map(case(What::Variance))).collect()
}

impl Blur {
    fn label(self) -> &'static str {
        match self.kernel {
            KernelChoice::OneD => "1d",
            KernelChoice::TwoD => "2d",
            KernelChoice::ThreeD => "3d",
        }
    }

    fn beams(self, radius: f64, photons: u64) -> Estimator {
        Estimator::Beams(BeamOptions {
            kernel: Some(self.kernel),
            radius: Some(radius),
            radius_exponent: Some(0.0),
            photons_per_pass: Some(photons),
            gather_samples: Some(1),
            // The exponents are those of independent photons.
            sampler: Some(Sampler::Independent),
            ..BeamOptions::default()
        })
    }

    /// Wide spheres reach the ends of most beams and rays, whose pairs take a quadrature: they are
    /// judged by the quick run's radii and margin, in fewer pixels.
    fn is_quick(self, context: &Context) -> bool {
        context.effort == Effort::Quick
            || (self.what == What::Bias && self.kernel == KernelChoice::ThreeD)
    }

    fn bias(self, context: &Context) -> Result<Outcome> {
        let quick = self.is_quick(context);
        let (radii, passes) = if quick { (&QUICK_RADII[..], 30) } else { (&FULL_RADII[..], 40) };
        let side = if self.kernel == KernelChoice::ThreeD { 2 } else { 4 };
        let integrator = only_depth(2);
        let view = View { pixels: side, fov: 50.0, time: Some(BIAS_TIME), integrator };
        let scene = infinite_fog(context, &view, &FOG, LIGHT)?;
        let energy = |blur| -> Result<f64> {
            let of = SingleScattering { fog: FOG, light: LIGHT, blur };
            Ok(of.cube(&scene.sensor, side, BIAS_TIME, 4)?.values.iter().sum())
        };
        let sharp = energy(None)?;
        let predicted = |radius: f64| Ok(energy(Some((self.kernel, radius)))? / sharp - 1.0);
        let biases = radii.iter().map(|&r| predicted(r)).collect::<Result<Vec<_>>>()?;
        let small = [0.02, 0.04].map(|r| Ok((r, predicted(r)?)));
        let small = small.into_iter().collect::<Result<Vec<_>>>()?;
        let limit = regression::exponent(&small);

        let plan = BatchPlan { batches: BATCHES as u64, passes, seed: context.seed };
        let mut measured = Vec::new();
        for &radius in radii {
            let (mut column, layout) = (Vec::new(), context.layout(&scene.film)?);
            batches(&scene, &self.beams(radius, BIAS_PHOTONS), layout, &plan, |cube| {
                let mut cube = cube.clone();
                cube.scale(context.estimate_factor());
                let inside = (0..side * side).map(|pixel| cube.pixel_bins(pixel)[0]);
                column.push(inside.sum::<f64>() / sharp - 1.0);
            })?;
            measured.push(column);
        }
        let mean = |column: &[f64], without: Option<usize>| {
            let kept = column.iter().enumerate().filter(|(i, _)| Some(*i) != without);
            let count = column.len() - usize::from(without.is_some());
            kept.map(|(_, v)| v).sum::<f64>() / count as f64
        };
        let exponent = |without: Option<usize>| {
            let means = measured.iter().map(|column| mean(column, without));
            regression::exponent(&radii.iter().copied().zip(means).collect::<Vec<_>>())
        };
        let mut values = Batches::new();
        for (batch, pseudo) in jackknife(&exponent, BATCHES).into_iter().enumerate() {
            let ratios = measured.iter().zip(&biases).map(|(column, bias)| column[batch] / bias);
            values.push(ratios.chain([pseudo]).collect());
        }
        let fitted: Vec<_> = radii.iter().copied().zip(biases.iter().copied()).collect();
        let name = |radius: &f64| format!("bias over its prediction, radius {radius}");
        let mut targets: Vec<Target> = radii.iter().map(|r| target(name(r), 1.0)).collect();
        targets
            .push(target("exponent of bias in the radius".into(), regression::exponent(&fitted)));
        let judgement = judge(&targets, &values, &self.criterion(context));
        let mut outcome: Outcome = judgement.into();
        outcome.notes.push(format!(
            "predicted exponent {:.3} here, {limit:.3} for small radii; bias {:.1} % to {:.1} %",
            regression::exponent(&fitted),
            100.0 * biases[0],
            100.0 * biases[biases.len() - 1]
        ));
        if (limit / 2.0 - 1.0).abs() > 0.01 {
            return Ok(Outcome::exact(false, vec![format!("the prediction is R^{limit:.3}")]));
        }
        let means = measured.iter().map(|column| mean(column, None).abs()).collect::<Vec<_>>();
        let points = |y: &[f64]| radii.iter().copied().zip(y.iter().copied()).collect();
        let predicted: Vec<f64> = biases.iter().map(|b| b.abs()).collect();
        self.draw(
            context,
            ("radius [m]", "relative bias"),
            &[
                Series::new("predicted", Mark::Dashes, points(&predicted)),
                Series::new("measured", Mark::Points, points(&means)),
            ],
        )?;
        Ok(outcome)
    }

    fn variance(self, context: &Context) -> Result<Outcome> {
        let radii = SMALL_RADII.map(|radius| (radius, (radius, MIDDLE.1)));
        let photons = PHOTONS.map(|photons| (photons as f64, (MIDDLE.0, photons)));
        let wrong = SMALL_RADII
            .map(|radius| (radius, (MIDDLE.0 * (radius / MIDDLE.0).powf(WRONG), MIDDLE.1)));
        let of_radius = self.exponents(context, &radii)?;
        let of_photons = self.exponents(context, &photons)?;
        let of_wrong = self.exponents(context, &wrong)?;
        let mut values = Batches::new();
        for batch in 0..BATCHES {
            let kinds = [&of_radius.pseudo, &of_photons.pseudo];
            values.push(kinds.iter().flat_map(|pseudo| pseudo.map_at(batch)).collect());
        }
        let names = ["in the radius", "in the photons"].into_iter().flat_map(|by| {
            ["all light", "a bin"].map(|of| format!("exponent of variance {by}, {of}"))
        });
        let targets: Vec<Target> = names.map(|name| target(name, -1.0)).collect();
        let mut outcome: Outcome = judge(&targets, &values, &self.criterion(context)).into();
        let mut controls = Batches::new();
        (0..BATCHES).for_each(|batch| controls.push(of_wrong.pseudo.map_at(batch).to_vec()));
        let control = judge(&targets[..2], &controls, &self.criterion(context));
        outcome.notes.push(format!(
            "exponents {:.3} in the radius and {:.3} in the photons; control {:.3}, {:?}",
            outcome.contrasts[0].mean,
            outcome.contrasts[2].mean,
            control.contrasts[0].mean,
            control.finding
        ));
        if control.finding != Finding::Different {
            let mut failed = Outcome::exact(false, outcome.notes);
            failed.contrasts = control.contrasts;
            return Ok(failed);
        }
        let line =
            |name: &str, mark, points: &[(f64, f64)]| Series::new(name, mark, points.to_vec());
        self.draw(
            context,
            ("radius [m], or photons/25000", "variance of a pass"),
            &[
                line("against radius", Mark::LineAndPoints, &of_radius.variances),
                line(
                    "against photons",
                    Mark::LineAndPoints,
                    &of_photons
                        .variances
                        .iter()
                        .map(|(n, v)| (n / 25_000.0, *v))
                        .collect::<Vec<_>>(),
                ),
            ],
        )?;
        Ok(outcome)
    }

    /// Exponents of the variance of a pass against the first of each pair.
    fn exponents(self, context: &Context, runs: &[(f64, (f64, u64)); 4]) -> Result<Exponents> {
        let per_batch = 256;
        let integrator = only_depth(2);
        let view = View { pixels: 1, fov: 1e-4, time: Some(VARIANCE_TIME), integrator };
        let scene = infinite_fog(context, &view, &FOG, LIGHT)?;
        let plan =
            BatchPlan { batches: (BATCHES * per_batch) as u64, passes: 1, seed: context.seed };
        // [run][all light or a bin][pass]
        let mut passes: Vec<[Vec<f64>; 2]> = Vec::new();
        for &(_, (radius, photons)) in runs {
            let mut of_run = [Vec::new(), Vec::new()];
            let layout = context.layout(&scene.film)?;
            batches(&scene, &self.beams(radius, photons), layout, &plan, |cube| {
                let bins = cube.pixel_bins(0);
                of_run[0].push(bins.iter().sum());
                of_run[1].push(bins[BIN]);
            })?;
            passes.push(of_run);
        }
        let exponent = |which: usize, without: Option<usize>| {
            let variances = runs.iter().zip(&passes).map(|((x, _), of_run)| {
                let kept = of_run[which].iter().enumerate();
                let kept = kept.filter(|(pass, _)| Some(pass / per_batch) != without);
                (*x, variance(&kept.map(|(_, v)| *v).collect::<Vec<_>>()))
            });
            regression::exponent(&variances.collect::<Vec<_>>())
        };
        let pseudo = Pseudo([0, 1].map(|which| jackknife(&|w| exponent(which, w), BATCHES)));
        let variances = runs.iter().zip(&passes).map(|((x, _), of)| (*x, variance(&of[0])));
        Ok(Exponents { pseudo, variances: variances.collect() })
    }

    /// The stated margin.
    fn criterion(self, context: &Context) -> Criterion {
        let margin = if self.is_quick(context) { QUICK_MARGIN } else { MARGIN };
        Criterion { margin, confidence: 0.99, level: context.level }
    }

    fn draw(self, context: &Context, labels: (&str, &str), series: &[Series]) -> Result<()> {
        if context.sabotage.is_some() {
            return Ok(());
        }
        let chart = Chart {
            title: self.name(),
            x: Axis::logarithmic(labels.0),
            y: Axis::logarithmic(labels.1),
            series: series.to_vec(),
        };
        leave_chart(context, &self.name(), "blur.svg", &chart)
    }
}

/// Pseudo-values for all light and for a bin.
struct Pseudo([Vec<f64>; 2]);

impl Pseudo {
    fn map_at(&self, batch: usize) -> [f64; 2] {
        [self.0[0][batch], self.0[1][batch]]
    }
}

struct Exponents {
    pseudo: Pseudo,
    variances: Vec<(f64, f64)>,
}

fn target(name: String, expected: f64) -> Target {
    Target { name, expected, error: 1e-4 * f64::abs(expected) }
}

impl Experiment for Blur {
    fn name(&self) -> String {
        let what = if self.what == What::Bias { "bias" } else { "variance" };
        format!("blur/{what}-{}", self.label())
    }

    fn description(&self) -> String {
        match self.what {
            What::Bias => "bias of the kernel against its radius: sizes and exponent as predicted",
            What::Variance => "variance of a pass against radius and photons: exponents -1 and -1",
        }
        .into()
    }

    fn kind(&self) -> Kind {
        if self.what == What::Bias { Kind::Statistical } else { Kind::SelfControlled }
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        if self.what == What::Bias { vec![Sabotage::KERNEL] } else { vec![] }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        match self.what {
            What::Bias => self.bias(context),
            What::Variance => self.variance(context),
        }
    }
}
