//! The methods of the matrix with the options that matter: one line each.

use std::num::NonZeroU32;

use tpb_beams::{BeamLength, BeamOptions, KernelChoice, Temporal};
use tpb_light::LightOptions;
use tpb_path::PathOptions;

use super::cases::Case;
use super::medium::MatrixMedium;
use crate::measure::Estimator;

/// Blur of a beam estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blur {
    /// Across beam and ray.
    OneD,
    /// A disc across the beam.
    TwoD,
    /// A sphere swept along the beam.
    ThreeD,
}

/// How much a player may do in a batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Camera paths of each pixel.
    pub paths: u32,
    /// Photons that are followed to surfaces and, as beams, through media.
    pub photons: u64,
    /// Camera rays of each pixel that gather beams.
    pub rays: u32,
    /// Passes of all that into which a batch is divided.
    pub passes: u64,
    /// Radius of beams and of the discs around surface photons \[m\].
    pub radius: f64,
}

/// Which budget and which cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Paths from the camera.
    Path,
    /// Photons, connected to the eye.
    Light,
    /// Photon beams.
    Beams {
        /// The kernel.
        blur: Blur,
        /// Where beams end.
        length: BeamLength,
        /// How a pair's energy is spread in time.
        temporal: Temporal,
    },
}

/// A method with options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Player {
    /// Its name in the names of rows.
    pub name: &'static str,
    /// What it is.
    pub family: Family,
}

/// Which kernels of beams play in a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernels {
    /// One speaks for all: what is seen is no kernel's work.
    Alike,
    /// 1D in every medium, 2D in two of them, 3D in one.
    Plain,
    /// 1D and 2D in every medium, 3D in two of them; short beams and even spreading, which share
    /// all but their last step with others, in two (of 3D, in one).
    All,
}

/// All players.
pub const PLAYERS: [Player; 10] = [
    Player { name: "path", family: Family::Path },
    Player { name: "light", family: Family::Light },
    beams("beams-1d", Blur::OneD, BeamLength::Long, Temporal::Exact),
    beams("beams-1d-short", Blur::OneD, BeamLength::Short, Temporal::Exact),
    beams("beams-2d", Blur::TwoD, BeamLength::Long, Temporal::Exact),
    beams("beams-2d-short", Blur::TwoD, BeamLength::Short, Temporal::Exact),
    beams("beams-2d-even", Blur::TwoD, BeamLength::Long, Temporal::Even),
    beams("beams-3d", Blur::ThreeD, BeamLength::Long, Temporal::Exact),
    beams("beams-3d-short", Blur::ThreeD, BeamLength::Short, Temporal::Exact),
    beams("beams-3d-even", Blur::ThreeD, BeamLength::Long, Temporal::Even),
];

const fn beams(name: &'static str, blur: Blur, length: BeamLength, temporal: Temporal) -> Player {
    Player { name, family: Family::Beams { blur, length, temporal } }
}

impl Player {
    /// The method that others are compared with where there is no exact value.
    pub fn is_baseline(&self) -> bool {
        self.family == Family::Path
    }

    /// The baseline.
    pub fn baseline() -> &'static Self {
        PLAYERS.iter().find(|player| player.is_baseline()).expect("path is a player")
    }

    /// Whether it is a variant of another player.
    pub(super) fn is_variant(&self) -> bool {
        let plain = |length, temporal| length == BeamLength::Long && temporal == Temporal::Exact;
        matches!(self.family, Family::Beams { length, temporal, .. } if !plain(length, temporal))
    }

    /// Whether there is a row of this case and medium.
    pub fn plays(&self, case: &dyn Case, medium: &MatrixMedium) -> bool {
        let several = ["isotropic", "coloured"].contains(&medium.name);
        let simple = !self.is_variant() && self.blur().is_none_or(|blur| blur == Blur::OneD);
        let in_turn = match case.kernels() {
            Kernels::Alike => simple,
            Kernels::Plain => simple || several && !self.is_variant(),
            Kernels::All => several || !self.is_variant(),
        };
        // A minute for each channel of an expected blur of spheres, a quadrature for each pair.
        let in_turn = in_turn
            && match (self.blur(), medium.name) {
                (Some(Blur::ThreeD), "coloured") => {
                    case.kernels() == Kernels::All && !self.is_variant()
                }
                (Some(Blur::ThreeD), name) => name == "isotropic",
                _ => true,
            };
        case.admits(self.family) && in_turn
    }

    /// How it blurs what is scattered in media.
    pub fn blur(&self) -> Option<Blur> {
        match self.family {
            Family::Path | Family::Light => None,
            Family::Beams { blur, .. } => Some(blur),
        }
    }

    /// Whether its time bins, not only their sum, have the expected values.
    pub fn is_right_in_time(&self) -> bool {
        !matches!(self.family, Family::Beams { temporal: Temporal::Even, .. })
    }

    /// The method that a pass of this budget is made with.
    pub fn estimator(&self, budget: &Budget) -> Estimator {
        match self.family {
            Family::Path => {
                Estimator::Path(PathOptions { samples_per_pass: NonZeroU32::new(budget.paths) })
            }
            Family::Light => {
                Estimator::Light(LightOptions { photons_per_pass: Some(budget.photons) })
            }
            Family::Beams { blur, length, temporal } => Estimator::Beams(BeamOptions {
                kernel: Some(match blur {
                    Blur::OneD => KernelChoice::OneD,
                    Blur::TwoD => KernelChoice::TwoD,
                    Blur::ThreeD => KernelChoice::ThreeD,
                }),
                length: Some(length),
                temporal: Some(temporal),
                radius: Some(budget.radius),
                surface_radius: Some(budget.radius),
                radius_exponent: Some(0.0),
                surface_radius_exponent: Some(0.0),
                photons_per_pass: Some(budget.photons),
                beam_photons: Some(budget.photons),
                gather_samples: Some(budget.rays),
                surface_samples: Some(budget.paths),
                ..BeamOptions::default()
            }),
        }
    }
}
