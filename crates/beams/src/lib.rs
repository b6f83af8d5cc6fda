//! Transient photon beams: photon tracing, ray-beam kernels and the gather.
