//! Progressive runs: how fast the mean square error falls with the passes, variance and bias apart.
//!
//! A point light stands beside the camera in infinite fog, and the light is scattered once. Radii
//! shrink from pass to pass with the exponent that is best:
//!
//! * **binned**: a pass's variance in a bin is ∝ 1/R and bias ∝ R², so that R ∝ i^(−1/5) makes both
//!   variance of the mean and squared bias fall as n^(−4/5), for each kernel;
//! * **pointwise** in time, in bins much shorter than R: the 2D and 3D kernels spread a pair's light
//!   over a time ∝ R, variance is ∝ 1/R², and R ∝ i^(−1/6) makes both fall as n^(−2/3). (The 1D
//!   kernel has no width in time.)
//!
//! **Variance** is measured, of the bins of one thin ray in a run of 32768 passes: these are
//! independent, and the sum of their variances is estimated in blocks between powers of 2. Its
//! exponent in n, from n = 2048 on, is a slope of least squares in logarithms; 32 batches (every 32nd
//! pass) give its interval by jackknife. Stated margin: 0.08. Photons are independent: a quasi-random
//! sequence makes the variance of once scattered light fall faster.
//!
//! **Bias** is that of the exact expected blur ([`crate::expected`]), which the experiments of
//! [`super::blur`] hold the renderer to: the exponent of its square in n must be the same within
//! 0.01 for small radii, without chance.

use std::sync::Arc;

use glam::DVec3;
use tpb_beams::{BeamOptions, KernelChoice, Sampler};
use tpb_plot::{Axis, Chart, Mark, Series};
use tpb_scene::{Scene, TimeSpec};

use crate::artefacts::leave_chart;
use crate::error::Result;
use crate::expected::SingleScattering;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::registry::Experiments;
use crate::scenes::{Fog, View, infinite_fog, only_depth};
use crate::statistics::regression::{self, jackknife, variance};
use crate::statistics::{Batches, Criterion, Finding, Target, judge};

const FOG: Fog = Fog { sigma_s: 0.4, sigma_a: 0.1, g: 0.0 };
const LIGHT: DVec3 = DVec3::new(0.6, 0.0, 0.0);
/// Of the variance's exponent.
const MARGIN: f64 = 0.08;
/// Of the bias's, which is found without chance, at these radii \[m\].
const BIAS_MARGIN: f64 = 0.01;
const SMALL_RADII: [f64; 2] = [0.02, 0.04];
const BATCHES: usize = 32;
/// The first and the last number of passes that the slope sees.
const FIRST: usize = 2048;
const LAST: usize = 32_768;
const PHOTONS: u64 = 1000;
/// Radius of the first pass \[m\]: small against the light's distance.
const RADIUS: f64 = 0.08;

/// Of what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    /// Bins that are wide against R.
    Binned,
    /// Bins that are short against R.
    Pointwise,
}

/// One kernel's progress.
#[derive(Clone, Copy, Debug)]
struct Progressive {
    kernel: KernelChoice,
    what: What,
}

/// Full runs only.
pub fn all(effort: Effort) -> Experiments {
    use KernelChoice::{OneD, ThreeD, TwoD};
    let case = |what| move |kernel| Arc::new(Progressive { kernel, what }) as _;
    match effort {
        Effort::Quick => vec![],
        Effort::Full => [OneD, TwoD, ThreeD]
            .map(case(What::Binned))
            .into_iter()
            .chain([TwoD, ThreeD].map(case(What::Pointwise)))
            .collect(),
    }
}

/// Passes between two powers of 2: of each batch its passes' values, by bin.
struct Block {
    /// First pass and the one past the last.
    passes: [usize; 2],
    batches: Vec<Vec<Vec<f64>>>,
}

impl Block {
    /// All values of one bin, by all batches or all but one.
    fn values(&self, bin: usize, without: Option<usize>) -> Vec<f64> {
        let kept = self.batches.iter().enumerate().filter(|(batch, _)| Some(*batch) != without);
        kept.flat_map(|(_, bins)| &bins[bin]).copied().collect()
    }
}

/// Numbers of passes, and the variance of the mean after them.
type Variances = Vec<(f64, f64)>;

/// Variance of the mean after each block, mean over the bins, by all batches or all but one.
fn variances(blocks: &[Block], without: Option<usize>) -> Variances {
    let mut of_sum = 0.0;
    let after = blocks.iter().map(|block| {
        let [start, end] = block.passes;
        let bins = block.batches[0].len();
        let of_bin = |bin| variance(&block.values(bin, without));
        of_sum += (end - start) as f64 * (0..bins).map(of_bin).sum::<f64>() / bins as f64;
        (end as f64, of_sum / (end as f64).powi(2))
    });
    after.collect()
}

impl Progressive {
    fn time(self) -> TimeSpec {
        match self.what {
            What::Binned => TimeSpec { start_opl: 0.0, bin_width_opl: 1.2, bins: 6 },
            What::Pointwise => TimeSpec { start_opl: 1.2, bin_width_opl: 0.002, bins: 64 },
        }
    }

    /// Of the radius.
    fn exponent(self) -> f64 {
        if self.what == What::Binned { 0.2 } else { 1.0 / 6.0 }
    }

    /// What variance of the mean and squared bias are proportional to, as a power of n.
    fn expected(self) -> f64 {
        if self.what == What::Binned { -0.8 } else { -2.0 / 3.0 }
    }

    fn scene(self, context: &Context, (pixels, fov): (usize, f64)) -> Result<Scene> {
        let view = View { pixels, fov, time: Some(self.time()), integrator: only_depth(2) };
        infinite_fog(context, &view, &FOG, LIGHT)
    }

    /// The run, in blocks.
    fn blocks(self, context: &Context) -> Result<Vec<Block>> {
        let scene = self.scene(context, (1, 1e-4))?;
        let ends =
            || std::iter::successors(Some(FIRST), |n| Some(2 * n)).take_while(|&n| n <= LAST);
        let empty = vec![vec![vec![]; self.time().bins]; BATCHES];
        let mut blocks: Vec<_> = std::iter::once(0)
            .chain(ends())
            .zip(ends())
            .map(|(start, end)| Block { passes: [start, end], batches: empty.clone() })
            .collect();
        let estimator = Estimator::Beams(BeamOptions {
            kernel: Some(self.kernel),
            radius: Some(RADIUS),
            radius_exponent: Some(self.exponent()),
            photons_per_pass: Some(PHOTONS),
            gather_samples: Some(1),
            sampler: Some(Sampler::Independent),
            ..BeamOptions::default()
        });
        let plan = BatchPlan { batches: LAST as u64, passes: 1, seed: context.seed };
        let (mut pass, mut block) = (0, 0);
        batches(&scene, &estimator, context.layout(&scene.film)?, &plan, |cube| {
            if pass == blocks[block].passes[1] {
                block += 1;
            }
            let bins = &mut blocks[block].batches[pass % BATCHES];
            bins.iter_mut().zip(cube.pixel_bins(0)).for_each(|(bin, &value)| bin.push(value));
            pass += 1;
        })?;
        Ok(blocks)
    }

    /// The exponent of the squared bias in n for small radii: that of the bias in the radius, times
    /// twice that of the radius in n.
    fn of_bias(self, context: &Context) -> Result<f64> {
        let (side, points) = (2, 4);
        let scene = self.scene(context, (side, 50.0))?;
        let energy = |blur| -> Result<f64> {
            let of = SingleScattering { fog: FOG, light: LIGHT, blur };
            Ok(of.cube(&scene.sensor, side, self.time(), points)?.values.iter().sum())
        };
        let sharp = energy(None)?;
        let biases = SMALL_RADII
            .iter()
            .map(|&radius| Ok((radius, energy(Some((self.kernel, radius)))? / sharp - 1.0)))
            .collect::<Result<Vec<_>>>()?;
        Ok(-2.0 * self.exponent() * regression::exponent(&biases))
    }

    fn draw(self, context: &Context, variances: Variances) -> Result<()> {
        if context.sabotage.is_some() {
            return Ok(());
        }
        let chart = Chart {
            title: self.name(),
            x: Axis::logarithmic("passes"),
            y: Axis::logarithmic("variance of the mean, of a ray's bins [W² m⁻⁴ sr⁻²]"),
            series: vec![Series::new("measured", Mark::LineAndPoints, variances)],
        };
        leave_chart(context, &self.name(), "progressive.svg", &chart)
    }
}

impl Experiment for Progressive {
    fn name(&self) -> String {
        let kernel = match self.kernel {
            KernelChoice::OneD => "1d",
            KernelChoice::TwoD => "2d",
            KernelChoice::ThreeD => "3d",
        };
        let what = if self.what == What::Binned { "binned" } else { "pointwise" };
        format!("progressive/{what}-{kernel}")
    }

    fn description(&self) -> String {
        "how fast variance and squared bias fall with the passes, radii shrinking".into()
    }

    fn kind(&self) -> Kind {
        Kind::SelfControlled
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (expected, of_bias) = (self.expected(), self.of_bias(context)?);
        let blocks = self.blocks(context)?;
        let all = variances(&blocks, None);
        let note = format!(
            "exponents: variance {:.3}, squared bias {of_bias:.3} (exact, small radii)",
            regression::exponent(&all)
        );
        if (of_bias - expected).abs() > BIAS_MARGIN {
            return Ok(Outcome::exact(false, vec![note]));
        }
        let pseudo =
            jackknife(&|without| regression::exponent(&variances(&blocks, without)), BATCHES);
        let (mut values, mut above) = (Batches::new(), Batches::new());
        for exponent in pseudo {
            values.push(vec![exponent]);
            above.push(vec![1.0 + exponent]);
        }
        let target = |name: &str, expected| Target { name: name.into(), expected, error: 1e-4 };
        let margin = MARGIN / expected.abs();
        let criterion = Criterion { margin, confidence: 0.99, level: context.level };
        let of_variance = target("exponent of the variance", expected);
        let mut outcome: Outcome = judge(&[of_variance], &values, &criterion).into();
        outcome.notes.push(note);
        // The control: a variance that stayed, n^0, would be noticed. (Margins are relative: 1 + the
        // exponent is compared with 1.)
        let control = judge(&[target("a variance that stays", 1.0)], &above, &criterion);
        if control.finding != Finding::Different {
            return Ok(Outcome::exact(false, outcome.notes));
        }
        self.draw(context, all)?;
        Ok(outcome)
    }
}
