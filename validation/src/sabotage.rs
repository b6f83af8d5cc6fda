//! Deliberate defects, and the twins that must be rejected because of them.
//!
//! A [`Twin`] is an experiment at its own budget on programs with one defect. It passes if and only
//! if the defect is found to be a significant *difference*; being unable to tell is not enough.
//! Without twins, a suite that cannot fail would look like one that never has to.
//!
//! The programs are not recompiled. A defect is brought about where it acts in the same way as the
//! real one would: on the media of the scene ([`Sabotage::spoil`]), on the film's window
//! ([`Sabotage::window_shift`]) or on the finished estimate ([`Sabotage::estimate_factor`]).
//!
//! | defect | brought about by | why that is the defect |
//! | --- | --- | --- |
//! | sigma_s off | sigma_s of the scene times 1 + x, sigma_a unchanged | it is the defect |
//! | transmittance of a ray shortened to a share f | sigma_t of the scene times f, sigma_s unchanged | exp(−sigma_t f s) is the transmittance of the length f s, and the density of scattering, sigma_s per length, stays |
//! | 1/4π missing | estimate times 4π | an order with one isotropic scattering is linear in the phase function |
//! | kernel off | estimate times 1 + x | each pair is linear in its kernel |
//! | cosine dropped | each pixel's estimate over the cosine at its vertex | linear too; done by experiments in which all light of a pixel has that cosine |
//! | eta² missing | estimate over the factor (η_e/η_l)² of the crossings | linear; done where all light (or all light of a bin) makes the same crossings |
//! | half a bin late | window half a bin *earlier* | an arrival at t + w/2 is in the bin \[e, e + w) exactly if t is in \[e − w/2, e + w/2) |
//! | null boundary's segment left out of the OPL | window *later* by the segment's OPL | likewise, for experiments in which all light crosses that segment with one length (a null sphere around the lamp or the camera) |
//! | light lost | estimate times 1 − x | it is the defect, wherever it is lost |
//! | sampler's warp | a sample at the share u of its range moved to u^x | it is the defect |
//!
//! An experiment names its twins by [`Experiment::twins`]; the [`Context`] of a twin's run carries
//! the defect, which [`Context::assemble`], [`Context::layout`] and [`crate::comparison`] bring
//! about. A defect that an experiment forgets to bring about is no danger: its twin is not
//! rejected, and fails.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use tpb_scene::SceneParts;

use crate::error::Result;
use crate::experiment::{Context, Experiment, Kind, Outcome, Verdict};
use crate::statistics::Finding;

/// A deliberate defect of size given by its variant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sabotage {
    /// The scattering coefficient times this factor, absorption unchanged.
    SigmaS(f64),
    /// Transmittance of rays whose length is multiplied by this factor.
    Transmittance(f64),
    /// 1/4π of the phase function is missing in one scattering event.
    PhaseNormalisation,
    /// The estimate of a kernel times this factor.
    KernelNormalisation(f64),
    /// A cosine is dropped; the experiment knows which.
    Cosine,
    /// The radiance's factor (η_e/η_l)² is missing; the experiment knows which value it has.
    EtaSquared,
    /// Light is entered late by this share of a bin.
    Late(f64),
    /// A segment of this OPL \[m\] that ends at a null boundary is left out.
    NullSegment(f64),
    /// This share of the light is lost on its way into the bins.
    Loss(f64),
    /// The warp of a sampler has an additional power of this exponent.
    Warp(f64),
}

impl Sabotage {
    /// Scattering coefficient 1.5 % off: three times the margin of unbiased estimates.
    pub const SIGMA_S: Self = Self::SigmaS(1.015);
    /// Transmittance over rays that are 2 % too short.
    pub const TRANSMITTANCE: Self = Self::Transmittance(0.98);
    /// A kernel that is 2 % too strong.
    pub const KERNEL: Self = Self::KernelNormalisation(1.02);
    /// Half a bin late.
    pub const LATE: Self = Self::Late(0.5);
    /// 2 % of the light in bins is lost.
    pub const LOSS: Self = Self::Loss(0.02);
    /// A sampler's warp with a power of 1.02 too many.
    pub const WARP: Self = Self::Warp(1.02);

    /// The labels of all kinds, by which names of twins begin.
    pub const LABELS: [&'static str; 10] = [
        "sigma-s",
        "transmittance",
        "phase-normalisation",
        "kernel-normalisation",
        "cosine",
        "eta-squared",
        "late",
        "null-segment",
        "loss",
        "warp",
    ];

    /// The kind.
    pub fn label(self) -> &'static str {
        let index = match self {
            Self::SigmaS(_) => 0,
            Self::Transmittance(_) => 1,
            Self::PhaseNormalisation => 2,
            Self::KernelNormalisation(_) => 3,
            Self::Cosine => 4,
            Self::EtaSquared => 5,
            Self::Late(_) => 6,
            Self::NullSegment(_) => 7,
            Self::Loss(_) => 8,
            Self::Warp(_) => 9,
        };
        Self::LABELS[index]
    }

    /// Brings the defect about in the media of a scene, if that is where it acts.
    pub fn spoil(self, parts: &mut SceneParts) {
        for medium in &mut parts.media {
            let c = &mut medium.coefficients;
            match self {
                Self::SigmaS(factor) => {
                    let added = c.sigma_s * (factor - 1.0);
                    c.sigma_s += added;
                    c.sigma_t += added;
                }
                Self::Transmittance(factor) => c.sigma_t *= factor,
                _ => {}
            }
        }
    }

    /// Whether it changes what is rendered, window apart.
    pub fn acts_on_the_scene(self) -> bool {
        matches!(self, Self::SigmaS(_) | Self::Transmittance(_))
    }

    /// How much later the film's window must be, for bins of this width \[m\].
    pub fn window_shift(self, bin_width_opl: f64) -> f64 {
        match self {
            Self::Late(bins) => -bins * bin_width_opl,
            Self::NullSegment(opl) => opl,
            _ => 0.0,
        }
    }

    /// Factor on every estimate; what [`Sabotage::Cosine`] and [`Sabotage::EtaSquared`] drop is
    /// known to the experiment ([`Sabotage::drops_a_factor`]).
    pub fn estimate_factor(self) -> f64 {
        match self {
            Self::PhaseNormalisation => 4.0 * std::f64::consts::PI,
            Self::KernelNormalisation(factor) => factor,
            Self::Loss(share) => 1.0 - share,
            _ => 1.0,
        }
    }

    /// Whether a factor that only the experiment knows must be divided out of its estimate.
    pub fn drops_a_factor(self) -> bool {
        matches!(self, Self::Cosine | Self::EtaSquared)
    }
}

/// An experiment on sabotaged programs, which must be rejected.
pub struct Twin {
    sabotage: Sabotage,
    inner: Arc<dyn Experiment>,
}

impl Twin {
    /// Of an experiment that brings this defect about.
    pub fn new(sabotage: Sabotage, inner: Arc<dyn Experiment>) -> Self {
        Self { sabotage, inner }
    }
}

impl Experiment for Twin {
    fn name(&self) -> String {
        format!("control/{}/{}", self.sabotage.label(), self.inner.name())
    }

    fn description(&self) -> String {
        format!("must be rejected: {:?} in {}", self.sabotage, self.inner.name())
    }

    fn kind(&self) -> Kind {
        Kind::Twin
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let sabotaged = Context { sabotage: Some(self.sabotage), ..context.clone() };
        let mut outcome = self.inner.run(&sabotaged)?;
        let rejected = outcome.finding == Finding::Different;
        outcome.verdict = if rejected { Verdict::Passed } else { Verdict::Failed };
        (outcome.false_alarm, outcome.unresolved) = (0.0, outcome.miss);
        let by = outcome
            .most_significant()
            .map_or(String::new(), |c| format!(", by \"{}\" (z = {:.1})", c.name, c.z));
        outcome.notes = vec![if rejected {
            format!("rejected, as it must be{by}")
        } else {
            format!("NOT rejected: {:?}", outcome.finding)
        }];
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::experiment::Effort;
    use crate::scenes::{Fog, View, only_depth};

    struct Fixed(Finding);

    impl Experiment for Fixed {
        fn name(&self) -> String {
            "fixed".into()
        }

        fn description(&self) -> String {
            String::new()
        }

        fn run(&self, context: &Context) -> Result<Outcome> {
            assert_eq!(context.sabotage, Some(Sabotage::SIGMA_S));
            Ok(Outcome { finding: self.0, ..Outcome::exact(true, vec![]) })
        }
    }

    #[test]
    fn a_twin_passes_only_when_the_sabotage_is_found() {
        let context = Context::new(Effort::Quick, 1, PathBuf::new());
        for (finding, verdict) in [
            (Finding::Different, Verdict::Passed),
            (Finding::Unresolved, Verdict::Failed),
            (Finding::Equivalent, Verdict::Failed),
        ] {
            let twin = Twin::new(Sabotage::SIGMA_S, Arc::new(Fixed(finding)));
            assert_eq!(twin.run(&context).unwrap().verdict, verdict, "{finding:?}");
        }
    }

    #[test]
    fn media_are_spoiled_as_the_table_says() {
        let view = View { pixels: 1, fov: 10.0, time: None, integrator: only_depth(2) };
        let fog = Fog { sigma_s: 2.0, sigma_a: 1.0, g: 0.0 };
        let spoiled = |sabotage: Sabotage| {
            let mut parts = view.parts();
            parts.media = vec![fog.medium()];
            sabotage.spoil(&mut parts);
            let c = parts.media[0].coefficients;
            (c.sigma_s[1], c.sigma_t[1])
        };
        assert_eq!(spoiled(Sabotage::SigmaS(1.5)), (3.0, 4.0));
        assert_eq!(spoiled(Sabotage::Transmittance(0.5)), (2.0, 1.5));
        assert_eq!(spoiled(Sabotage::Cosine), (2.0, 3.0));
    }

    #[test]
    fn late_light_is_seen_by_an_earlier_window() {
        assert_eq!(Sabotage::LATE.window_shift(0.2), -0.1);
        assert_eq!(Sabotage::NullSegment(0.3).window_shift(0.2), 0.3);
        assert_eq!(Sabotage::KERNEL.estimate_factor(), 1.02);
    }
}
