//! Bounding volume hierarchy: conservative f32 culling for f64 primitives.
