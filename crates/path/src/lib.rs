//! Transient volumetric path tracer: the unbiased baseline.
