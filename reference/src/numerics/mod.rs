//! What solutions are computed with; no physics.

pub(crate) mod bernstein;
pub(crate) mod complex;
pub(crate) mod front;
pub(crate) mod gauss_legendre;
pub(crate) mod path_integral;
pub(crate) mod poisson;
pub mod quadrature;
pub(crate) mod vector;
