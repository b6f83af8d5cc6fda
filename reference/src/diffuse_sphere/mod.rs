//! Light inside an empty sphere with a diffuse wall.

mod chords;

pub use chords::{
    ChordSum, MAX_CHORDS, Order, SphereCentreBin, SphereChords, sphere_centre_radiance_bins,
    sphere_chords_cdf, sphere_chords_pdf,
};

use crate::registry::Solution;
use crate::registry::ToleranceClass::{ClosedForm, Quadrature};
use crate::registry::solution;

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("sphere_chords", ClosedForm, "cdf" => sphere_chords_cdf, "pdf" => sphere_chords_pdf)
        .describe("law of the sum x of n chords, in diameters", "1"),
    solution!("sphere_centre_radiance_bins", Quadrature, sphere_centre_radiance_bins)
        .describe("radiance at the centre within a bin, for Q = R = v = 1", "J/(m^2 sr)"),
];
