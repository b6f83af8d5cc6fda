//! What solutions are computed with; no physics.

pub(crate) mod bernstein;
pub(crate) mod front;
pub(crate) mod path_integral;
pub(crate) mod poisson;
pub mod quadrature;
pub(crate) mod vector;
