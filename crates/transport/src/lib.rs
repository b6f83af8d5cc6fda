//! Floor 2: how light and importance move through a scene, once for all methods.
//!
//! * [`FreeFlight`]: where along a flight a path scatters, with bounded weights and the densities
//!   that multiple importance sampling asks for.
//! * [`Encounter`]: what becomes of a carrier at a surface; [`Lobe`]s where it is spread.
//! * [`roulette`]: when a path may end by chance.
//! * [`FlightWeight`] and [`absorb_on_surface`]: what a carrier loses, and how the ledger books it.
//! * [`Horizon`]: what can still arrive within the film's window.
//! * [`PhotonTracer`]: photons from the emitters to their ends; a [`PhotonVisitor`] takes from them
//!   what its method needs.
//!
//! Camera paths and photons use the same four: media, surfaces and roulette treat light and
//! importance alike. What differs stays with the methods: radiance scales with η² on refraction,
//! fluxes do not.

mod carrier;
mod free_flight;
mod horizon;
mod photon;
mod surface;
mod tracer;

pub use carrier::{FlightWeight, absorb_on_surface, roulette};
pub use free_flight::{FreeFlight, Outcome, Part};
pub use horizon::Horizon;
pub use photon::{Photon, SurfaceArrival};
pub use surface::{
    Carrier, DiffuseLobe, Drawn, Encounter, Lobe, Response, RoughLobe, Towards, Turn,
};
pub use tracer::{PhotonBatch, PhotonTracer, PhotonVisitor, Sampler, Sampling};
