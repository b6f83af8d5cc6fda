//! Diffusion: approximate solutions, labelled so. They never decide to better than some per cent.
//!
//! All take D = v/(3 μs') with the reduced scattering coefficient μs' = σs (1 − g), and no
//! absorption in D. Light needs several transport lengths 1/μs' of path before it diffuses.

mod boundary;
mod half_space;
mod infinite;
mod slab;

pub use boundary::{BoundaryParameter, diffusion_boundary_parameter};
pub use half_space::{DiffusionSemiInfinite, diffusion_semi_infinite};
pub use infinite::{DiffusionInfinite, diffusion_infinite};
pub use slab::{
    DiffusionSlab, DiffusionSlabTotal, diffusion_slab_reflectance,
    diffusion_slab_total_reflectance, diffusion_slab_total_transmittance,
    diffusion_slab_transmittance,
};

use crate::registry::Solution;
use crate::registry::ToleranceClass::Diffusion;
use crate::registry::solution;

/// Measured with 1e6 photons in a slab of 20 mean free paths, g = 0, matched, summed over rho.
const SLAB_VALIDITY: &str = "R within 5 % for v*t >= 8/mu_s', T within 3 % for \
    v*t >= 3*thickness, summed over rho (thickness 20/mu_s', g = 0, eta = 1); a single rho is \
    worse, and T before 1.5*thickness/v is acausal (v = speed/eta)";

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("diffusion_infinite", Diffusion, diffusion_infinite)
        .describe("fluence rate of a point pulse in an infinite medium, by diffusion", "W/(m^2 J)")
        .approximate(
            "v*t well above r and several 1/mu_s'; mu_a far below mu_s'; acausal before r/v",
        ),
    solution!("diffusion_semi_infinite", Diffusion, diffusion_semi_infinite)
        .describe("reflectance of a pencil pulse on a half-space, zero boundary", "1/(m^2 s)")
        .approximate(
            "v*t >= 8/mu_s' and rho of several 1/mu_s'; matched indices; mu_a far below mu_s'",
        ),
    solution!("diffusion_slab", Diffusion,
        "R" => diffusion_slab_reflectance, "T" => diffusion_slab_transmittance)
    .describe("reflectance and transmittance of a pencil pulse on a slab", "1/(m^2 s)")
    .defaults(&[("speed", "1")])
    .approximate(SLAB_VALIDITY),
    solution!("diffusion_slab_total", Diffusion,
        "R" => diffusion_slab_total_reflectance, "T" => diffusion_slab_total_transmittance)
    .describe("the same over the whole face of the slab", "1/s")
    .defaults(&[("speed", "1")])
    .approximate(SLAB_VALIDITY),
    solution!("diffusion_boundary_parameter", Diffusion, diffusion_boundary_parameter)
        .describe("A of the extrapolated boundary at 2 A D/v, for an index eta inside", "1")
        .approximate(
            "exact integrals, but the partial-current boundary condition that uses it is \
            one of diffusion: percents near the boundary",
        ),
];
