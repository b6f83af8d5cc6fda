//! What spreading a pair's energy evenly in time costs, as the renderer measures it.
//!
//! A thin laser crosses a camera ray at the distance h in fog; the 2D kernel of radius R makes it
//! arrive over T* ± κA, A = √(R² − h²)/sinψ, κ = 1 + w_r·w_b. Marco et al. 2017 spread the energy
//! evenly over that interval; transmittance makes it decay. With X = sigma_t·κ·A the
//! bias of the even distribution is predicted (`even_vs_exact_spread` of the reference):
//!
//! * the first quarter of the interval misses the share (1 − e^(−X/2))/(1 − e^(−2X)) − 1/4;
//! * light arrives (coth X − 1/X)·κA too late on average;
//! * a total with the transmittance of the middle is too small by X/sinh X.
//!
//! Two renders of the same photons, even and exact, measure the first two as their difference; the
//! exact total over C/(πR²)·2A·exp(−sigma_t T*) measures the third; and both totals must be equal.
//! Geometries run from almost against the light (κ = 0.2) to along it (κ = 1.6). The laser's own
//! radius, R/1000, gives the batches what noise they have.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use tpb_beams::{BeamOptions, KernelChoice, Temporal};
use tpb_optics::Rgb;
use tpb_plot::{Axis, Chart, Mark, Series};
use tpb_reference::beams::even_spread::{
    EvenSpread, first_quarter_share, mean_shift, midpoint_total,
};
use tpb_scene::{EmitterKind, EmitterPart, MediumId, TimeSpec};

use crate::artefacts::leave_chart;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{Fog, View, only_depth};
use crate::statistics::{Batches, Target, judge};

/// Radius of the kernel and distance of laser and ray \[m\].
const RADIUS: f64 = 0.2;
const HEIGHT: f64 = 0.1;
/// From camera and laser to where they come closest \[m\].
const WAY: f64 = 0.6;
/// Bins of the interval of arrival, and bins before and after it.
const BINS: usize = 256;
const MARGIN: usize = 32;
const ALBEDO: f64 = 0.5;
/// The bins' discretisation, (2X/256)/12 of a bin, and the laser's width, relative.
const ERROR: f64 = 2e-4;
/// κ with the values of X.
const CASES: [(f64, [f64; 3]); 3] =
    [(0.2, [0.1, 0.3, 1.0]), (1.0, [0.3, 1.0, 3.0]), (1.6, [1.0, 3.0, 6.0])];

/// The experiment.
#[derive(Clone, Copy, Debug)]
pub struct EvenSpreading;

/// The one.
pub fn all() -> Experiments {
    vec![Arc::new(EvenSpreading)]
}

/// One geometry in one fog.
#[derive(Clone, Copy, Debug)]
struct Case {
    kappa: f64,
    /// X.
    optical: f64,
}

/// What a render says: the share of the first quarter, the mean arrival in half lengths of the
/// interval from its middle, and the total.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    share: f64,
    mean: f64,
    total: f64,
}

impl Case {
    fn sine(self) -> f64 {
        (self.kappa * (2.0 - self.kappa)).sqrt()
    }

    /// A.
    fn half_length(self) -> f64 {
        ((RADIUS - HEIGHT) * (RADIUS + HEIGHT)).sqrt() / self.sine()
    }

    fn fog(self) -> Fog {
        let sigma_t = self.optical / (self.kappa * self.half_length());
        Fog { sigma_s: ALBEDO * sigma_t, sigma_a: (1.0 - ALBEDO) * sigma_t, g: 0.0 }
    }

    fn time(self) -> TimeSpec {
        let half = self.kappa * self.half_length();
        let bin_width_opl = 2.0 * half / BINS as f64;
        let start_opl = 2.0 * WAY - half - MARGIN as f64 * bin_width_opl;
        TimeSpec { start_opl, bin_width_opl, bins: BINS + 2 * MARGIN }
    }

    /// Batches of one way of spreading.
    fn render(self, temporal: Temporal, plan: &BatchPlan, context: &Context) -> Result<Vec<Seen>> {
        let integrator = only_depth(2);
        let view = View { pixels: 1, fov: 1e-4, time: Some(self.time()), integrator };
        let mut parts = view.parts();
        parts.media = vec![self.fog().medium()];
        parts.background = Some(MediumId(0));
        let axis = DVec3::new(self.sine(), 0.0, self.kappa - 1.0);
        let position = DVec3::new(0.0, HEIGHT, WAY) - WAY * axis;
        parts.emitters = vec![EmitterPart {
            name: "laser".into(),
            kind: EmitterKind::Laser { position, axis, radius: 1e-3 * RADIUS, power: Rgb::ONE },
            stated_medium: None,
        }];
        let scene = context.assemble(parts)?;
        let estimator = Estimator::Beams(BeamOptions {
            kernel: Some(KernelChoice::TwoD),
            temporal: Some(temporal),
            radius: Some(RADIUS),
            radius_exponent: Some(0.0),
            photons_per_pass: Some(200),
            gather_samples: Some(1),
            ..BeamOptions::default()
        });
        let mut seen = Vec::new();
        batches(&scene, &estimator, context.layout(&scene.film)?, plan, |cube| {
            seen.push(Seen::of(cube.pixel_bins(0)));
        })?;
        Ok(seen)
    }

    /// C/(πR²)·2A·exp(−sigma_t T*).
    fn midpoint_total(self) -> f64 {
        let fog = self.fog();
        let left = (-fog.sigma_t() * 2.0 * WAY).exp();
        fog.sigma_s / (4.0 * PI) / (PI * RADIUS * RADIUS) * 2.0 * self.half_length() * left
    }

    fn targets(self) -> Result<Vec<Target>> {
        let of = EvenSpread { optical_half_width: self.optical };
        let share = first_quarter_share(&of)? - 0.25;
        let target = |what: &str, expected: f64| Target {
            name: format!("{what}, {}", self.label()),
            expected,
            error: ERROR * expected,
        };
        Ok(vec![
            target("share that the first quarter misses", share),
            target("delay of the mean", -mean_shift(&of)?),
            target("total over that of the middle", 1.0 / midpoint_total(&of)?),
            target("even total over exact total", 1.0),
        ])
    }

    fn label(self) -> String {
        format!("kappa {} X {}", self.kappa, self.optical)
    }

    fn values(self, exact: Seen, even: Seen) -> Vec<f64> {
        vec![
            exact.share - even.share,
            even.mean - exact.mean,
            exact.total / self.midpoint_total(),
            even.total / exact.total,
        ]
    }
}

impl Seen {
    fn of(bins: &[f64]) -> Self {
        let total: f64 = bins.iter().sum();
        let early: f64 = bins[..MARGIN + BINS / 4].iter().sum();
        let middle = |bin: usize| (bin as f64 + 0.5 - MARGIN as f64) / (0.5 * BINS as f64) - 1.0;
        let moment: f64 = bins.iter().enumerate().map(|(bin, v)| middle(bin) * v).sum();
        Self { share: early / total, mean: moment / total, total }
    }
}

impl Experiment for EvenSpreading {
    fn name(&self) -> String {
        "even-spread/laser".into()
    }

    fn description(&self) -> String {
        "even spreading in time against exact: its bias as a function of X = sigma_t kappa A, \
         against the predicted curves"
            .into()
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        effort.pick(vec![Sabotage::TRANSMITTANCE], vec![Sabotage::TRANSMITTANCE, Sabotage::SIGMA_S])
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let plan = BatchPlan { batches: 32, passes: 1, seed: context.seed };
        let per_kappa = context.effort.pick(2, 3);
        let cases: Vec<Case> = CASES
            .iter()
            .flat_map(|&(kappa, optical)| {
                optical.map(|optical| Case { kappa, optical }).into_iter().take(per_kappa)
            })
            .collect();
        let mut rows = vec![Vec::new(); plan.batches as usize];
        let mut targets = Vec::new();
        for case in &cases {
            let exact = case.render(Temporal::Exact, &plan, context)?;
            let even = case.render(Temporal::Even, &plan, context)?;
            for (row, (exact, even)) in rows.iter_mut().zip(exact.into_iter().zip(even)) {
                row.extend(case.values(exact, even));
            }
            targets.extend(case.targets()?);
        }
        let mut values = Batches::new();
        for row in rows {
            values.push(row);
        }
        let outcome: Outcome = judge(&targets, &values, &context.unbiased()).into();
        if context.sabotage.is_none() {
            draw(&cases, &outcome, context)?;
        }
        Ok(outcome)
    }
}

/// Points, or intervals.
type Pairs = Vec<(f64, f64)>;

/// Measured biases on the predicted curves.
fn draw(cases: &[Case], outcome: &Outcome, context: &Context) -> Result<()> {
    let measured = |which: usize| -> (Pairs, Pairs) {
        let contrasts = outcome.contrasts.chunks(4).map(|of_case| &of_case[which]);
        let at = cases.iter().zip(contrasts);
        at.map(|(case, c)| {
            let bar = 2.576 * c.standard_error;
            ((case.optical, c.mean), (c.mean - bar, c.mean + bar))
        })
        .unzip()
    };
    let curve =
        |value: fn(&EvenSpread) -> std::result::Result<f64, tpb_reference::ReferenceError>| {
            (0..=120)
                .map(|i| {
                    let optical_half_width = 0.05 * 200.0_f64.powf(f64::from(i) / 120.0);
                    Ok((optical_half_width, value(&EvenSpread { optical_half_width })?))
                })
                .collect::<Result<Vec<_>>>()
        };
    let (shares, share_bars) = measured(0);
    let (delays, delay_bars) = measured(1);
    let chart = Chart {
        title: "bias of even spreading in time".into(),
        x: Axis::logarithmic("X = sigma_t kappa A"),
        y: Axis::linear("share, or part of half the interval"),
        series: vec![
            Series::new(
                "first quarter, predicted",
                Mark::Dashes,
                curve(|of| Ok(first_quarter_share(of)? - 0.25))?,
            ),
            Series::new("first quarter, measured", Mark::Points, shares).with_band(share_bars),
            Series::new(
                "delay of the mean, predicted",
                Mark::Dashes,
                curve(|of| Ok(-mean_shift(of)?))?,
            ),
            Series::new("delay of the mean, measured", Mark::Points, delays).with_band(delay_bars),
        ],
    };
    leave_chart(context, "even-spread-laser", "even-spread.svg", &chart)
}
