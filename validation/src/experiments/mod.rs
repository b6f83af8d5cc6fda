//! The questions, one module for each subject.

pub mod calibration;
pub mod energy;
pub mod equal_time;
pub mod fresnel;
pub mod kernels;
mod marching;
pub mod samplers;
pub mod single_scatter;
pub mod sphere;
pub mod tables;
