//! Floor 1: the transient film. It alone knows bins, windows and unwarp.
//!
//! Integrators hand a [`Tile`] an [`Arrival`] (an instant or a [`TemporalProfile`], times as
//! optical path length in metres) with its time-integrated radiance \[W m^-2 sr^-1\];
//! [`TransientFilm`] averages passes. The invariant everywhere, to rounding:
//! sum over bins + before + after = steady image.

pub mod archive;
mod arrays;
mod arrival;
mod atomic;
mod develop;
mod error;
mod film;
mod layout;
mod ledger;
mod npz;
mod part;
mod picture;
mod profile;
mod pulse;
mod quadrature;
mod several;
mod stats;
mod steady_exr;
#[cfg(test)]
mod testing;
mod tile;

pub use arrays::{Arrays, Quantity};
pub use arrival::{Arrival, TemporalProfile};
pub use atomic::{atomic_path, atomic_write};
pub use error::FilmError;
pub use film::{FilmOptions, OutputChannels, TransientFilm};
pub use layout::{Layout, TimeAxis};
pub use ledger::Ledger;
pub use picture::{
    ArrivalColours, ArrivalTime, Frames, PictureOptions, Tone, ToneMap, arrival_scale,
    linear_of_srgb, srgb, white_level,
};
pub use pulse::{Pulse, PulseReport};
pub use quadrature::integrate;
pub use several::{Exponentials, Instants};
pub use tile::{Grain, Tile};
