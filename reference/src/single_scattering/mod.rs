//! Light scattered once in an infinite homogeneous medium.

mod fluence;
mod pencil;
mod radiance;
mod shell;

pub use fluence::{
    OnceScattered, OnceScatteredBin, OnceScatteredHg, OnceScatteredSteady, once_scattered_fluence,
    once_scattered_fluence_bins, once_scattered_fluence_hg, once_scattered_fluence_steady,
};
pub use pencil::{single_scatter_pencil_irradiance, single_scatter_pencil_irradiance_bins};
pub(crate) use radiance::{RayToSource, check_medium};
pub use radiance::{
    SingleScatter, SingleScatterBin, single_scatter_radiance, single_scatter_radiance_bins,
};
pub use shell::{
    OnceScatteredShell, OnceScatteredShellBin, once_scattered_shell_energy,
    once_scattered_shell_energy_bins,
};

use crate::registry::Solution;
use crate::registry::ToleranceClass::{ClosedForm, Quadrature};
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("single_scatter_radiance", ClosedForm, single_scatter_radiance)
        .describe("radiance of once-scattered light of a point pulse", "W/(m^2 sr)"),
    solution!("single_scatter_radiance_bins", Quadrature, single_scatter_radiance_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
    solution!("single_scatter_pencil_irradiance", ClosedForm, single_scatter_pencil_irradiance)
        .describe("irradiance of a pinhole by once-scattered light of a pencil beam", "W/m^2"),
    solution!(
        "single_scatter_pencil_irradiance_bins",
        Quadrature,
        single_scatter_pencil_irradiance_bins
    )
    .describe("the same within a bin of time", "J/m^2"),
    solution!("once_scattered_fluence", ClosedForm, once_scattered_fluence)
        .describe("fluence rate of light scattered once and isotropically", "W/m^2"),
    solution!("once_scattered_fluence_hg", Quadrature, once_scattered_fluence_hg)
        .describe("fluence rate of light scattered once by Henyey-Greenstein", "W/m^2"),
    solution!("once_scattered_fluence_bins", Quadrature, once_scattered_fluence_bins)
        .describe("fluence of light scattered once and isotropically within a bin", "J/m^2"),
    solution!("once_scattered_fluence_steady", Quadrature, once_scattered_fluence_steady)
        .describe("fluence of light scattered once and isotropically, over all times", "1/m^2"),
    solution!("once_scattered_shell_energy", ClosedForm, once_scattered_shell_energy)
        .describe("share of a pulse that is in a shell after one isotropic scattering", "1"),
    solution!("once_scattered_shell_energy_bins", Quadrature, once_scattered_shell_energy_bins)
        .describe("the same, integrated over a bin of time", "s"),
];
