//! Optical path length, spectra, phase functions, Fresnel, warps and RNG streams.
