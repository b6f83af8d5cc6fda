//! Stiff and extreme cases: what could break, and whether it does.
//!
//! A [`Case`] names one danger (optical thickness 1e6, a camera on a boundary, one photon …) and
//! is run for every method that it makes sense for. It ends well in one of three ways only:
//!
//! * **an exact value**: the mean over at least 32 independent batches agrees with the analytic
//!   reference within a margin (Student's t, [`crate::statistics::agreement`]; the chance that a
//!   sound program is called different is 1e-8 for each row);
//! * **an exact law**: two renders with the same random numbers are the same to the bit (or to a
//!   stated tolerance), after the scaling that physics asks for. All lengths × 2^k with all
//!   coefficients × 2^−k, all powers × 2^k, all refractive indices × 4 (even powers of two, where roots
//!   are taken): no rounding changes, so nothing in the programs may know the size of a metre or of a
//!   watt;
//! * **a clear error**: its text names the part that is wrong and says what to do.
//!
//! Whatever a case compares, every render on the way must be sound ([`shot`]): all numbers finite,
//! none negative, bins + before + after = the steady image, and the ledger closed to 1e-9.
//!
//! Budgets are counts of passes, paths and photons, never times. The runner ([`runner`]) catches
//! panics, and gives up on a case that does not end (a guard against hangs, far above any case's
//! work).
//!
//! One line adds a case, to one of the lists in [`groups`]; one line adds a method, to
//! [`Method::ALL`].

pub mod case;
pub mod groups;
pub mod laws;
pub mod pencil;
pub mod report;
pub mod runner;
pub mod shot;
pub mod single;
pub mod world;
pub mod worlds;

#[cfg(test)]
mod tests;

pub use case::{Case, Finding, Method, Setup};
pub use runner::{Record, StressResult, Verdict, run_cases};
