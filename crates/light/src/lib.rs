//! Floor 3: the transient light tracer, an unbiased method that works from the light's side.
//!
//! **What it computes.** The same image as the path tracer: radiance through each pixel, averaged
//! over the pixel's area on the image plane, resolved in optical path length from the emitter's
//! surface to the eye. Photons leave the emitters ([`tpb_transport::PhotonTracer`]); wherever one
//! scatters, the scattered light is connected to the pinhole by a straight line through null
//! boundaries (Arvo 1986, "Backward ray tracing"; Dutré, Lafortune & Willems 1993, "Monte Carlo
//! light tracing with direct computation of pixel intensities"). A vertex at distance d that sends
//! the intensity I \[W/sr\] towards the pinhole, at the angle θ to the optical axis, adds
//!
//! ```text
//! I T / (d² A cos³θ)     at OPL τ_vertex + Σ η_j s_j
//! ```
//!
//! to the pixel that it is seen in; T is the transmittance and A the pixel's area on the plane at
//! unit distance ([`tpb_scene::Sensor::importance`]). Intensities of a photon of power Φ:
//!
//! * leaving an area emitter: Φ cosθ_y/π (the emitter seen directly, depth 1);
//! * at a diffuse surface: Φ ρ cosθ_y/π;
//! * at a rough surface: Φ f cosθ_y, on the side of rough glass from which the eye sees it;
//! * in a medium: Φ p(cos), with Φ after the albedo.
//!
//! **Two strategies in media.** Collisions alone have the variance of 1/d⁴ near the pinhole. So each
//! flight is also connected from a second point, drawn equiangularly about the pinhole (Kulla &
//! Fajardo 2012) on the part of the flight that the camera has in view, and both are weighted by the
//! balance heuristic (Veach 1997, section 9.2): with e = p_equi/p_exp,
//!
//! ```text
//! collision 1/(1 + e)      equiangular e/(1 + e)
//! ```
//!
//! **Variance.** Outside scattering media, d has a least value, and the variance is finite (except
//! where a delta-like phase function or a mirror aims light at the eye). With the eye *in* a
//! scattering medium it is still infinite: flights that pass the eye at distance h add up to ∝ 1/h,
//! flights through a pixel's narrow cone at distance d have a measure ∝ d dd, and meet the pixel
//! with a probability independent of d: the second moment is ∫ dd/d, which diverges
//! logarithmically. The estimate is unbiased and converges, as √(ln n/n); its error bars are too
//! small. The plan says so.
//!
//! **What it finds that the path tracer cannot:** light of lasers, and caustics of points and spots.
//! **What it cannot find:** whatever the eye sees in a mirror or through smooth glass, for a
//! connection cannot cross them. The plan says so. An eye within glass is fine as long as what it
//! looks at is within the same glass. Points and spots themselves have no area and no radiance;
//! like the path tracer, it does not show them.
//!
//! **Depths, roulette and ledger** are the photons'; an emitter seen directly has depth 1.
//!
//! **Determinism.** Photons have random streams of their own, and what each pixel gets is added in
//! the photons' order: the same bits for any number of threads.

mod connect;
mod method;
mod options;
mod sorted;

pub use method::LightTracer;
pub use options::{LightOptions, OptionError, Settings};
