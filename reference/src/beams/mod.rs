//! Ray-beam kernels, and what beam estimates are expected to give.

pub mod beam_ray;
pub mod beam_ray_sphere;
pub mod even_spread;
pub mod expected_blur;
pub mod expected_blur_disc;
pub mod expected_blur_disc_hg;
pub mod expected_blur_sphere;

use crate::registry::Solution;
use crate::registry::ToleranceClass::{ClosedForm, Quadrature};
use crate::registry::solution;
use beam_ray::{beam_ray_1d, beam_ray_2d_bins};
use beam_ray_sphere::{beam_ray_3d, beam_ray_3d_bins};
use even_spread::{first_quarter_share, mean_shift, midpoint_total};
use expected_blur::{expected_blur_1d, expected_blur_1d_bins};
use expected_blur_disc::{expected_blur_2d, expected_blur_2d_bins};
use expected_blur_disc_hg::{expected_blur_2d_hg, expected_blur_2d_hg_bins};
use expected_blur_sphere::{expected_blur_3d, expected_blur_3d_bins};

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("beam_ray_1d", ClosedForm, beam_ray_1d)
        .describe("energy that the 1D kernel carries from a beam to a ray", "J/(m^2 sr)"),
    solution!("beam_ray_2d_bins", Quadrature, beam_ray_2d_bins)
        .describe("energy that the 2D kernel carries to a ray within a bin", "J/(m^2 sr)"),
    solution!("beam_ray_3d", Quadrature, beam_ray_3d)
        .describe("energy that the 3D kernel carries from a beam to a ray", "J/(m^2 sr)"),
    solution!("beam_ray_3d_bins", Quadrature, beam_ray_3d_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
    solution!(
        "even_vs_exact_spread",
        ClosedForm,
        "first-quarter share" => first_quarter_share,
        "mean shift/A" => mean_shift,
        "uniform-with-midpoint-transmittance total / exact total" => midpoint_total
    )
    .describe("what spreading a pair's energy evenly in time costs", "1"),
    solution!("expected_blur_1d", Quadrature, expected_blur_1d)
        .describe("expected value of the 1D beam estimate of a point pulse", "W/(m^2 sr)"),
    solution!("expected_blur_1d_bins", Quadrature, expected_blur_1d_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
    solution!("expected_blur_2d", ClosedForm, expected_blur_2d)
        .describe("expected value of the 2D beam estimate of a point pulse", "W/(m^2 sr)"),
    solution!("expected_blur_2d_bins", Quadrature, expected_blur_2d_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
    solution!("expected_blur_2d_hg", Quadrature, expected_blur_2d_hg)
        .describe("expected value of the 2D beam estimate for any mean cosine g", "W/(m^2 sr)"),
    solution!("expected_blur_2d_hg_bins", Quadrature, expected_blur_2d_hg_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
    solution!("expected_blur_3d", Quadrature, expected_blur_3d)
        .describe("expected value of the 3D beam estimate of a point pulse", "W/(m^2 sr)"),
    solution!("expected_blur_3d_bins", Quadrature, expected_blur_3d_bins)
        .describe("the same within a bin of time", "J/(m^2 sr)"),
];
