//! Transient volumetric path tracer: the unbiased baseline.
//!
//! **What it computes.** The radiance that reaches the eye through each pixel, resolved in optical
//! path length τ = Σ η_j s_j from the emitter's surface to the eye. Every light path has one
//! arrival time, so a transient path tracer is a steady one that remembers τ: with throughput β and
//! OPL τ_r from the eye to a vertex, each contribution is an instant at τ_r plus the OPL of its
//! connection (Jarabo et al. 2014, "A Framework for Transient Rendering", section 4).
//!
//! **How.** A camera path advances flight by flight; a flight is a straight line through null
//! boundaries to the first surface that acts on light. Along a flight of length ℓ
//!
//! ```text
//! L = T(ℓ) (L_e + ∫ f L cosθ dω) + ∫_0^ℓ T(t) σ_s(t) ∫ p L dω dt,     T(t) = exp(−∫_0^t σ_t)
//! ```
//!
//! * T(ℓ) L_e is added as it stands, never by chance: lamps are seen without noise.
//! * Either the surface or one point of the medium is chosen by a free flight
//!   (with colour: a mixture over channels, weighted by the path's own throughput).
//! * There a point on a light is connected to (next-event estimation; through rough glass too), and
//!   a direction is drawn from phase function or BSDF; where that direction meets an emitter, both
//!   strategies are weighted by the balance heuristic (Veach 1997, section 9.2).
//! * On flights seen from the eye, directly or through mirrors and glass, a third strategy draws
//!   the distance t by equiangular sampling towards a light point y that is chosen first (Kulla &
//!   Fajardo 2012). In the common measure (t, y) the three densities are
//!
//! ```text
//! p_1 = p_exp(t) p_L(y)      p_2 = p_equi(t|y) p_L(y)      p_3 = p_exp(t) p(θ) cosθ_y / d²
//! ```
//!
//! * Radiance changes by (η_i/η_t)² where the camera's ray passes from η_i to η_t; the throughput
//!   that decides Russian roulette, and the ledger, leave this factor out, for it is no energy.
//!
//! **Depths** count scattering events as in Mitsuba: an emitter seen directly has depth 1; each
//! scattering in a medium, reflection or refraction adds 1; null boundaries add nothing.
//!
//! **Ledger.** It follows importance: each camera path starts with 1. What a flight, a surface,
//! roulette or the depth limit takes is the difference of the throughput's luminance, so that it
//! closes to rounding, path by path; jumps of colour weights are booked as roulette.
//!
//! **What it cannot do.** Collimated emitters (lasers) are points in position and direction: no
//! path connects to them or meets them. Point and spot emitters cannot be met through mirrors and
//! glass, so that their caustics are missing. The plan says both; photon beams render them.

mod light;
mod options;
mod path;
mod surface;
#[cfg(test)]
mod tests;
mod tracer;
mod walk;
mod world;

pub use options::PathOptions;
pub use tracer::PathTracer;
