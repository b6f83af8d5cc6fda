//! The questions, one module for each subject.

pub mod blur;
pub mod calibration;
pub mod echoes;
pub mod energy;
pub mod equal_time;
pub mod even_spread;
pub mod fresnel;
pub mod furnace;
pub mod glass;
pub mod infinite_medium;
pub mod kernels;
pub mod lens;
mod marching;
pub mod mirrors;
pub mod progressive;
pub mod refraction;
pub mod samplers;
mod screen;
mod sights;
pub mod slab;
pub mod sphere;
pub mod spot;
pub mod standard_error;
pub mod tables;
