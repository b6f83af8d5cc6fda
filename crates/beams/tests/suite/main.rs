//! Tests of the method against quadrature, brute force and known scenes; all seeds are fixed.

mod defaults;
mod fog;
mod gather;
mod instructions;
mod kernel3d;
mod kernels;
mod lamps;
mod scenes;
mod transport;
