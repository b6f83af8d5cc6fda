//! Analytic time-dependent radiative transfer: closed forms and quadrature, no sampling.
//!
//! This crate is the referee of the workspace. It answers what a transient renderer *should*
//! measure in configurations that have an exact solution, and it therefore shares no code with
//! the renderers that it judges: no vector type, no phase function, no random number.
//!
//! One module holds one subject; its `mod.rs` lists what there is. Every solution is an ordinary function of one struct of named
//! inputs, `name(&Inputs) -> Result<f64, ReferenceError>`; the name and the fields are those of
//! the table that the solution reproduces ([`tables`]).
//!
//! # Conventions
//!
//! * Units are the caller's, as long as they are consistent: lengths in m, coefficients in 1/m,
//!   `speed` (of light in the medium) in m/s, `energy` in J. The medium is infinite, homogeneous
//!   and absorbs and scatters with `sigma_t` in total and `sigma_s` by scattering; the two enter
//!   separately and are not compared.
//! * A pulse leaves its source at time 0 and is infinitely short.
//! * Bins are half-open, [t0, t1).
//! * Phase functions are normalised to 1 over the sphere.
//!
//! # Accuracy
//!
//! Closed forms hold a relative error of 1e-12, bins and other quadratures of 1e-9
//! ([`registry::ToleranceClass`]). The loss that an input brings along by its own rounding, close
//! to a wavefront, is not part of that. A result below the range of `f64` is 0; one above it, or
//! without a finite value, is an error and never a NaN.

pub mod ballistic;
pub mod beams;
pub mod diffuse_sphere;
pub mod diffusion;
pub mod dwell;
pub mod error;
pub mod infinite_medium;
pub mod interfaces;
pub mod numerics;
pub mod phase;
mod published;
pub mod registry;
pub mod single_scattering;
pub mod sources;
pub mod tables;

pub use error::ReferenceError;
