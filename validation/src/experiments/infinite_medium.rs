//! The infinite medium, all orders of scattering, read by taps against exact solutions.
//!
//! Photons of a point pulse in infinite fog are read at a few OPLs. In mean free paths, with x the
//! path length travelled, the exact expectations are those of `tpb_reference`:
//!
//! * energy alive, e^(−σa x), and of exactly n scatterings (Poisson), whatever the phase function;
//! * moments of distance and depth, and the mean of sin(kr)/(kr), for any mean cosine;
//! * energy between two spheres: of all orders (isotropic scattering: the point pulse's fluence,
//!   integrated; any mean cosine: the sine series), and of one order;
//! * energy between two planes: the plane pulse's fluence, for a plane source is a sum of points.
//!
//! One case fills space with a refractive index: only path length enters, and OPL is η times that.

use std::sync::Arc;

use glam::DVec3;
use tpb_reference::infinite_medium::{
    Alive, AliveOfOrder, EnergyWithin, Moment, PlanePulseCell, ShellEnergy, SincMoment,
    energy_alive, energy_of_order, infinite_medium_sinc_moment, mean_depth,
    mean_fourth_power_of_distance, mean_square_depth, mean_square_distance,
    plane_pulse_cells_with_ballistic, scattered_energy_within_radius, scattered_shell_energy,
};
use tpb_reference::single_scattering::{OnceScatteredShell, once_scattered_shell_energy};
use tpb_scene::{IntegratorSpec, Medium, MediumId};

use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{Fog, View, unit_point};
use crate::statistics::{Target, judge};
use crate::taps::{Reading, Tap, TapPlan, read};

/// Photons are followed to so many scatterings. Within 4 mean free paths, 4 on average, more happen
/// to 1e-6 of them (Poisson), which is what the last taps may miss.
const MOST_EVENTS: u32 = 16;
const NEGLECTED: f64 = 2e-6;

type Exact = std::result::Result<f64, tpb_reference::ReferenceError>;

/// A fog with an extinction coefficient of 1/m, so that metres are mean free paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfiniteMedium {
    /// Mean cosine of the phase function.
    pub g: f64,
    /// Albedo.
    pub albedo: f64,
    /// Refractive index.
    pub eta: f64,
}

/// All cases; one line adds one.
pub fn all(effort: Effort) -> Experiments {
    let case = |g, albedo, eta| Arc::new(InfiniteMedium { g, albedo, eta }) as _;
    match effort {
        Effort::Quick => vec![case(0.0, 0.8, 1.0)],
        Effort::Full => vec![
            case(0.0, 1.0, 1.0),
            case(0.0, 0.8, 1.0),
            case(0.0, 0.9, 1.5),
            case(0.9, 0.9, 1.0),
            case(-0.5, 0.95, 1.0),
        ],
    }
}

/// What is read at a path length, with its expectation.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    Alive,
    Order(u32),
    SquareDistance,
    FourthPower,
    Depth,
    SquareDepth,
    Sinc(f64),
    ScatteredWithin(f64),
    Within { from: f64, to: f64 },
    OnceWithin { from: f64, to: f64 },
    Between { from: f64, to: f64 },
}
use Quantity::{
    Alive as Energy, Between, Depth, FourthPower, OnceWithin, Order, ScatteredWithin, Sinc,
    SquareDepth, SquareDistance, Within,
};

/// For any mean cosine: path length and what is read there. Chosen so that the light that tells has
/// about a fifth of the energy at least.
const ANY_PHASE: [(f64, Quantity); 20] = [
    (0.5, Order(0)),
    (0.5, Order(1)),
    (0.5, Depth),
    (2.0, Energy),
    (2.0, Order(1)),
    (2.0, Order(2)),
    (2.0, Sinc(0.8)),
    (2.0, ScatteredWithin(1.8)),
    (2.0, SquareDistance),
    (2.0, FourthPower),
    (2.0, Depth),
    (2.0, SquareDepth),
    (4.0, Energy),
    (4.0, Order(4)),
    (4.0, SquareDistance),
    (4.0, FourthPower),
    (4.0, Depth),
    (4.0, SquareDepth),
    (4.0, Sinc(0.4)),
    (4.0, ScatteredWithin(3.4)),
];

/// For isotropic scattering.
const ISOTROPIC: [(f64, Quantity); 10] = [
    (2.0, Within { from: 0.0, to: 1.0 }),
    (2.0, Within { from: 1.0, to: 1.5 }),
    (2.0, Within { from: 1.5, to: 1.9 }),
    (1.0, OnceWithin { from: 0.4, to: 1.0 }),
    (4.0, Within { from: 0.0, to: 1.6 }),
    (4.0, Within { from: 1.6, to: 2.4 }),
    (4.0, Within { from: 2.4, to: 3.5 }),
    (2.0, Between { from: -0.3, to: 0.4 }),
    (2.0, Between { from: 0.4, to: 1.2 }),
    (4.0, Between { from: 0.5, to: 2.0 }),
];

impl InfiniteMedium {
    fn fog(self) -> Fog {
        Fog { sigma_s: self.albedo, sigma_a: 1.0 - self.albedo, g: self.g }
    }

    fn quantities(self) -> Vec<(f64, Quantity)> {
        let isotropic = if self.g == 0.0 { &ISOTROPIC[..] } else { &[] };
        ANY_PHASE.iter().chain(isotropic).copied().collect()
    }

    /// The exact expectation after the path length `path`.
    fn expected(self, path: f64, quantity: Quantity) -> Exact {
        let Fog { sigma_s, sigma_a, g } = self.fog();
        let alive = energy_alive(&Alive { sigma_a, speed: 1.0, time: path })?;
        let of_survivors = |moment: fn(&Moment) -> Exact| -> Exact {
            Ok(alive * moment(&Moment { time: path, sigma_s, g })?)
        };
        let of_order = |order| {
            energy_of_order(&AliveOfOrder { sigma_s, sigma_t: 1.0, speed: 1.0, time: path, order })
        };
        match quantity {
            Energy => Ok(alive),
            Order(order) => of_order(order),
            SquareDistance => of_survivors(mean_square_distance),
            FourthPower => of_survivors(mean_fourth_power_of_distance),
            Depth => of_survivors(mean_depth),
            SquareDepth => of_survivors(mean_square_depth),
            Within { from, to } => {
                let (r0, r1, time, albedo) = (from, to, path, self.albedo);
                scattered_shell_energy(&ShellEnergy { r0, r1, time, albedo })
            }
            ScatteredWithin(radius) => {
                // In mean free paths between scatterings; absorption acts on the path length.
                let (time, r) = (sigma_s * path, sigma_s * radius);
                Ok(alive * scattered_energy_within_radius(&EnergyWithin { g, time, r })?)
            }
            Sinc(k) => {
                infinite_medium_sinc_moment(&SincMoment { g, k, time: path, sigma_s, sigma_a })
            }
            OnceWithin { from, to } => once_scattered_shell_energy(&OnceScatteredShell {
                sigma_s,
                sigma_t: 1.0,
                speed: 1.0,
                r0: from,
                r1: to,
                time: path,
            }),
            Between { from, to } => {
                let (x0, x1, time) = (from, to, path);
                let cell = PlanePulseCell { x0, x1, time, albedo: self.albedo };
                Ok((to - from) * plane_pulse_cells_with_ballistic(&cell)?)
            }
        }
    }

    fn tap(self, path: f64, quantity: Quantity) -> Tap {
        let read: Box<dyn Fn(&Reading) -> f64 + Sync + Send> = match quantity {
            Energy => Box::new(|_| 1.0),
            Order(order) => Box::new(move |at| indicator(at.events == order)),
            SquareDistance => Box::new(|at| at.displacement.length_squared()),
            FourthPower => Box::new(|at| at.displacement.length_squared().powi(2)),
            Depth => Box::new(|at| at.displacement.dot(at.emitted)),
            SquareDepth => Box::new(|at| at.displacement.dot(at.emitted).powi(2)),
            Within { from, to } => {
                Box::new(move |at| indicator(at.events > 0 && is_between(at, from, to)))
            }
            ScatteredWithin(radius) => {
                Box::new(move |at| indicator(at.events > 0 && is_between(at, 0.0, radius)))
            }
            Sinc(k) => Box::new(move |at| sinc(k * at.displacement.length())),
            OnceWithin { from, to } => {
                Box::new(move |at| indicator(at.events == 1 && is_between(at, from, to)))
            }
            Between { from, to } => {
                Box::new(move |at| indicator((from..to).contains(&at.displacement.z)))
            }
        };
        Tap { opl: self.eta * path, read }
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

fn indicator(inside: bool) -> f64 {
    f64::from(u8::from(inside))
}

fn is_between(at: &Reading, from: f64, to: f64) -> bool {
    (from..to).contains(&at.displacement.length())
}

impl Experiment for InfiniteMedium {
    fn name(&self) -> String {
        let Self { g, albedo, eta } = self;
        let eta = if *eta == 1.0 { String::new() } else { format!("-eta{eta}") };
        format!("infinite-medium/hg{g}-albedo{albedo}{eta}")
    }

    fn description(&self) -> String {
        "photons tapped at given OPLs: energies, orders, moments, shells, plane cells, exact".into()
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        effort.pick(vec![Sabotage::SIGMA_S], vec![Sabotage::SIGMA_S, Sabotage::TRANSMITTANCE])
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let integrator = IntegratorSpec {
            method: None,
            max_depth: Some(MOST_EVENTS + 2),
            min_depth: 1,
            rr_depth: u32::MAX,
        };
        let view = View { pixels: 1, fov: 10.0, time: None, integrator };
        let mut parts = view.parts();
        parts.media = vec![Medium { eta: Some(self.eta), ..self.fog().medium() }];
        parts.background = Some(MediumId(0));
        parts.emitters = vec![unit_point(100.0 * DVec3::X)];
        let scene = context.assemble(parts)?;
        let quantities = self.quantities();
        let mut targets = Vec::new();
        for &(path, quantity) in &quantities {
            let expected = self.expected(path, quantity)?;
            let name = format!("{quantity:?} after {path} m");
            targets.push(Target { name, expected, error: NEGLECTED * expected.abs() });
        }
        let taps: Vec<Tap> = quantities.iter().map(|&(path, q)| self.tap(path, q)).collect();
        let plan = TapPlan {
            batches: 64,
            photons: context.effort.pick(80_000, 100_000),
            seed: context.seed,
        };
        let batches = read(&scene, integrator, &taps, &plan);
        Ok(judge(&targets, &batches, &context.unbiased()).into())
    }
}
