//! Floor 0: the optics that every crate shares, and nothing else.
//!
//! * [`opl`]: time is optical path length in metres; seconds exist only at the edges.
//! * [`spectrum`]: one or three channels, fixed at compile time.
//! * [`phase`]: isotropic and Henyey-Greenstein phase functions.
//! * [`fresnel`]: unpolarised Fresnel reflectance, reflection and refraction.
//! * [`microfacet`]: rough metal and rough glass.
//! * [`medium`]: transmittance and free flights in a homogeneous medium, mono or coloured.
//! * [`warp`]: uniform numbers to directions, discs and distances, each with its pdf.
//! * [`frame`]: orthonormal bases.
//! * [`rng`]: one stream of random numbers per (seed, pass, item); seeds of runs that belong together.
//!
//! Directions are unit vectors along the propagation of light or of the camera ray, as each
//! function says; angles are given by their cosines.

pub mod frame;
pub mod fresnel;
pub mod medium;
pub mod microfacet;
pub mod opl;
pub mod phase;
pub mod quasi;
pub mod rng;
pub mod spectrum;
pub mod warp;

pub use frame::Frame;
pub use medium::Coefficients;
pub use phase::Phase;
pub use rng::{Stream, seed_of};
pub use spectrum::{Rgb, Spectrum};
