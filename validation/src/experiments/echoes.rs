//! A lamp seen through a glass slab: every echo in its own bin.
//!
//! Between the two faces of the slab light goes to and fro; echo m has crossed it 2m + 1 times and
//! arrives with (1 − R)² R^2m of the lamp's radiance (`tpb_reference::interfaces`; the renderers
//! take light as unpolarised at each interface), 2mηd/cosθ_t after the first. The factors η² of the
//! way in and out cancel.
//!
//! *Filled*, the slab holds two absorbing media of its index with a null boundary between them,
//! which takes T = exp(−(σ₁ + σ₂)d/(2cosθ_t)) at each crossing, and no time.
//!
//! Path tracer and beams choose at each face between reflection and refraction. Photons that are
//! connected to the camera are no use here: behind a slab nothing can be connected.

use std::sync::Arc;

use glam::DVec3;
use tpb_beams::BeamOptions;
use tpb_path::PathOptions;
use tpb_reference::interfaces::{SlabEcho, slab_echo_time, slab_echo_weight_unpolarised};
use tpb_scene::{Bsdf, IntegratorSpec, MediumBoundary, MediumId, Scene, TimeSpec};

use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::experiments::sights::{Instant, Sight, Sights, across, between, glass, lamp, narrow};
use crate::experiments::sphere::absorber;
use crate::measure::{BatchPlan, Estimator};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;

const TIME: TimeSpec = TimeSpec { start_opl: -0.05, bin_width_opl: 0.25, bins: 120 };

/// Roulette would only add noise; what more crossings than these leave is below 1e-9.
const DEPTHS: IntegratorSpec =
    IntegratorSpec { method: None, max_depth: Some(60), min_depth: 1, rr_depth: 60 };

/// The slab begins 1 m before the camera, the lamp is 1 m behind it.
const THICKNESS: f64 = 0.5;

/// Index and angle of incidence in degrees. All but the first two echoes are too rare.
const CLEAR: [(f64, f64); 3] = [(1.5, 80.0), (4.0, 0.0), (1.5, 45.0)];
const FILLED: [(f64, f64); 2] = [(1.5, 80.0), (2.5, 30.0)];

/// Absorption of the two fillings \[1/m\].
const SIGMA_A: [f64; 2] = [0.6, 1.4];

/// Echoes with less than this are not judged by themselves.
const FAINTEST: f64 = 0.02;

/// A method that follows specular chains from the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follower {
    /// The path tracer.
    Path,
    /// The camera's side of photon beams.
    Beams,
}

impl Follower {
    /// With this many camera paths per pixel and pass.
    pub(super) fn estimator(self, samples: u32) -> Estimator {
        match self {
            Self::Path => {
                Estimator::Path(PathOptions { samples_per_pass: samples.try_into().ok() })
            }
            Self::Beams => Estimator::Beams(BeamOptions {
                surface_samples: Some(samples),
                ..BeamOptions::default()
            }),
        }
    }
}

/// Echoes of a slab, clear or filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlabEchoes {
    /// Who looks.
    pub who: Follower,
    /// Whether the slab is filled with absorbing media.
    pub filled: bool,
}

/// Each method and slab.
pub fn all(effort: Effort) -> Experiments {
    let case = |who, filled| Arc::new(SlabEchoes { who, filled }) as _;
    let mut list: Experiments = vec![case(Follower::Path, false), case(Follower::Beams, true)];
    if effort == Effort::Full {
        list.extend([case(Follower::Path, true), case(Follower::Beams, false)]);
    }
    list
}

impl SlabEchoes {
    fn sights(self, context: &Context) -> Result<Vec<Sight>> {
        let cases = if self.filled { &FILLED[..] } else { &CLEAR[..] };
        let kept = &cases[..context.effort.pick(1, cases.len())];
        kept.iter().map(|&(eta, angle)| self.sight(context, eta, angle)).collect()
    }

    fn sight(self, context: &Context, eta: f64, angle: f64) -> Result<Sight> {
        let cos_incidence = angle.to_radians().cos();
        let slab = |echo| SlabEcho { eta, cos_incidence, echo, thickness: THICKNESS, speed: 1.0 };
        let crossing = slab_echo_time(&slab(0))? / eta;
        let taken = if self.filled { 0.5 * SIGMA_A.iter().sum::<f64>() } else { 0.0 };
        let left = (-taken * crossing).exp();
        let instant = |echo: u32| -> Result<Instant> {
            let opl = 2.0 / cos_incidence + slab_echo_time(&slab(echo))?;
            let weight = slab_echo_weight_unpolarised(&slab(echo))?;
            let crossings = 2 * echo.cast_signed() + 1;
            let radiance = weight * left.powi(crossings);
            Ok(Instant { name: format!("echo {echo}"), opl, radiance })
        };
        let mut instants = (0..2).map(instant).collect::<Result<Vec<_>>>()?;
        let ratio = instants[1].radiance / instants[0].radiance;
        let total = instants[0].radiance / (1.0 - ratio);
        instants.retain(|instant| instant.radiance > FAINTEST);
        let name = format!("index {eta} at {angle} degrees");
        let scene = self.scene(context, eta, angle)?;
        // At 80 degrees a pixel's weight changes by 1e-3 per hundredth of a degree, of which the
        // part that is even about the axis is left.
        Ok(Sight { name, scene, instants, total, error: 1e-6 })
    }

    fn scene(self, context: &Context, eta: f64, angle: f64) -> Result<Scene> {
        let (sin, cos) = angle.to_radians().sin_cos();
        let mut parts = narrow(DVec3::ZERO, DVec3::new(sin, 0.0, cos), TIME, DEPTHS);
        let front = across("front", 1.0, -1.0, glass(eta));
        let back = across("back", 1.0 + THICKNESS, 1.0, glass(eta));
        let lamp = lamp(across("lamp", 2.0 + THICKNESS, -1.0, Bsdf::Null), 1.0);
        parts.shapes = vec![front, back, lamp];
        if self.filled {
            parts.media = SIGMA_A.map(absorber).to_vec();
            let [first, second] = [Some(MediumId(0)), Some(MediumId(1))];
            let sides = |interior, exterior| MediumBoundary { interior, exterior };
            parts.shapes[0].boundary = Some(sides(first, None));
            parts.shapes[1].boundary = Some(sides(second, None));
            let middle = across("middle", 1.0 + 0.5 * THICKNESS, 1.0, Bsdf::Null);
            parts.shapes.push(between(middle, sides(first, second)));
        }
        context.assemble(parts)
    }
}

impl Experiment for SlabEchoes {
    fn name(&self) -> String {
        let slab = if self.filled { "filled" } else { "clear" };
        format!("slab-echoes/{slab}/{}", self.who.estimator(1).name())
    }

    fn description(&self) -> String {
        let slab = if self.filled { "slab of two absorbing layers" } else { "glass slab" };
        format!("a lamp through a {slab}: each echo in its bin, against its exact weight")
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        // Half of the slab at the first angle: what lies behind the null boundary.
        let segment = Sabotage::NullSegment(0.5);
        match (self.filled, effort) {
            (true, Effort::Full) => vec![segment, Sabotage::TRANSMITTANCE],
            (false, Effort::Full) => vec![Sabotage::LATE],
            (_, Effort::Quick) => vec![],
        }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let sights = self.sights(context)?;
        let plan = BatchPlan { batches: 80, passes: 1, seed: context.seed };
        // The weak echoes are rare: 1 %.
        let criterion = context.blurred();
        Sights { estimator: self.who.estimator(2500), plan, criterion, at: &sights }.run(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn all_sights() -> Vec<Sight> {
        let context = Context::new(Effort::Full, 1, PathBuf::new());
        let sights = |filled| SlabEchoes { who: Follower::Path, filled }.sights(&context).unwrap();
        sights(false).into_iter().chain(sights(true)).collect()
    }

    #[test]
    fn instants_lie_within_bins_of_their_own_and_some_in_a_later_half() {
        let sights = all_sights();
        let places: Vec<f64> =
            sights.iter().flat_map(|s| s.instants.iter().map(|i| s.place(i))).collect();
        assert!(places.iter().all(|p| p.fract() > 0.02 && p.fract() < 0.98), "{places:?}");
        assert!(places.iter().any(|p| p.fract() > 0.55), "{places:?}");
        assert!(places.iter().all(|&p| p < TIME.bins as f64));
        for sight in &sights {
            let bins: Vec<_> = sight.instants.iter().map(|i| sight.place(i).floor()).collect();
            assert!(bins.windows(2).all(|pair| pair[1] > pair[0]), "{bins:?}");
        }
    }

    #[test]
    fn echoes_of_a_clear_slab_add_up_to_its_transmittance() {
        // (1 − R)/(1 + R) with R = ((η − 1)/(η + 1))² at normal incidence.
        let sight = all_sights().remove(1);
        let r: f64 = 0.36;
        assert!((sight.total / ((1.0 - r) / (1.0 + r)) - 1.0).abs() < 1e-12, "{}", sight.total);
    }
}
