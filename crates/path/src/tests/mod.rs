//! Tests against closed forms, quadratures and the tracer's own other strategies.
//!
//! Seeds are fixed: a test that passes keeps passing. Statistical verdicts say how likely they
//! would be false for a random seed (see [`stats`]). Every render asserts that the ledger closes to
//! 1e-9 and that nothing was non-finite.

mod boundaries;
mod cornell;
mod depths;
mod diffuse_sphere;
mod glass;
mod rough;
mod single_scattering;
mod stats;
mod strategies;
mod worlds;
