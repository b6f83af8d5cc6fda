//! Light inside an empty sphere with a diffuse wall.

mod absorbing;
mod chords;
mod decay;
mod spot;
mod two_hops;

pub use absorbing::{
    AbsorbingCentreBin, AbsorbingChords, sphere_centre_radiance_absorbing_bins,
    sphere_chords_absorbing,
};
pub use chords::{
    ChordSum, MAX_CHORDS, Order, SphereCentreBin, SphereChords, sphere_centre_radiance_bins,
    sphere_chords_cdf, sphere_chords_pdf,
};

pub use decay::{SphereDecay, chord_transform, sphere_decay_rate};
pub use spot::{
    SpotBin, SpotMeanBin, sphere_spot_irradiance_bins, sphere_spot_mean_irradiance_bins,
};
pub use two_hops::{TwoHops, sphere_two_hop_density, sphere_two_hop_local, two_hop_probability};

use crate::registry::Solution;
use crate::registry::ToleranceClass::{ClosedForm, Quadrature};
use crate::registry::solution;
use crate::sources::{DIAMETERS, RADII};

pub(crate) static SOLUTIONS: &[Solution] = &[
    solution!("sphere_chords", ClosedForm, "cdf" => sphere_chords_cdf, "pdf" => sphere_chords_pdf)
        .describe("law of the sum x of n chords, in diameters", "1")
        .inputs(DIAMETERS),
    solution!("sphere_centre_radiance_bins", Quadrature, sphere_centre_radiance_bins)
        .describe("radiance at the centre within a bin, for Q = R = v = 1", "J/(m^2 sr)")
        .inputs(RADII),
    solution!("sphere_chords_absorbing", Quadrature, sphere_chords_absorbing)
        .describe("what absorption leaves of n chords of together at most x diameters", "1")
        .inputs(DIAMETERS),
    solution!(
        "sphere_centre_radiance_absorbing_bins",
        Quadrature,
        sphere_centre_radiance_absorbing_bins
    )
    .describe(
        "radiance at the centre of a sphere with an absorbing filling within a bin",
        "J/(m^2 sr)",
    ),
    solution!("sphere_decay_rate", ClosedForm, sphere_decay_rate)
        .describe("rate of decay of late light, in v/(2R)", "1"),
    solution!("sphere_two_hop_local", ClosedForm, sphere_two_hop_local)
        .describe(
            "sphere_two_hop_density with the continuation of its table below the support \
            (negative: no light)",
            "1",
        )
        .inputs(DIAMETERS),
    solution!("sphere_two_hop_density", ClosedForm, sphere_two_hop_density)
        .describe("density of the sum x of two chords between wall points at the angle gamma", "1")
        .inputs(DIAMETERS),
    solution!("sphere_spot_irradiance_bins", Quadrature, sphere_spot_irradiance_bins)
        .describe("irradiance of a wall point within a bin, where a pulse lights a spot", "J/m^2"),
    solution!("sphere_spot_mean_irradiance_bins", ClosedForm, sphere_spot_mean_irradiance_bins)
        .describe("the same as the mean over the wall, for any order", "J/m^2"),
];
