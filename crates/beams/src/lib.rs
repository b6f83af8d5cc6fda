//! Floor 3: transient photon beams (Marco et al. 2017; Jarosz et al. 2011), the method that
//! connects light and camera by density estimation instead of by chance.
//!
//! A pass of [`PhotonBeams`] has three steps.
//!
//! 1. [`photons`]: photons leave the emitters, scatter in media and on surfaces, and leave a
//!    [`beam::Beam`] in each span of a scattering medium and a [`beam::SurfacePhoton`] at each
//!    diffuse surface.
//! 2. [`sight`], [`beam_map`] and [`surface_map`] sort what they left.
//! 3. The camera's rays gather it: in media by a ray-beam kernel ([`kernel1d`], [`kernel2d`],
//!    [`kernel3d`]), on surfaces by a disc. Emission seen and direct light on surfaces are computed without blur.
//!
//! **What is biased by what.** Light last scattered in a medium is blurred by the beams' radius;
//! light last scattered on a diffuse surface, except straight from an emitter, by the disc's. Where
//! light is smooth the bias is O(R²). Near borders it is O(R): within a radius of a medium's end,
//! kernels reach out of it, and light blurred out is lost, not put back, so that media look darker
//! along their borders and in all by O(R/chord); likewise discs on open meshes and along the feet
//! of other objects ([`surface_map`]), and both at borders of shadows, where light is blurred but
//! not lost. Everything else is unbiased. Each light path
//! is counted once: by its last scattering event that is neither specular nor rough it belongs to
//! exactly one of emission, beams, direct light and surface photons.
//!
//! **Consistency.** Radii shrink with the pass ([`Settings::radii`]). Ray and beam meet with
//! probability ∝ R and add ∝ 1/R, so that variance after n passes is ∝ 1/(nR) and bias² is ∝ R⁴
//! away from borders: R ∝ i^(−1/5) makes the mean square error there fall as n^(−4/5); for discs,
//! ∝ 1/(nR²), it is R ∝ i^(−1/6) and n^(−2/3). Along borders, with bias² ∝ R², it falls as n^(−2/5)
//! and n^(−1/3) at least: slower, but to 0. A bin is no blur: it is what the sensor measures.
//!
//! **Time** is optical path length from the emitter to the eye: τ_b + τ_r + η (s_b + s_r), the
//! source's equation 5 with the camera's leg.
//!
//! **Determinism.** A pass depends on scene, plan, options, seed and pass index only. Photons and
//! pixels have random streams of their own; beams are stored in the order of photons.

pub mod beam;
pub mod beam_map;
mod bundle;
mod camera;
pub mod contribution;
mod defaults;
pub mod kernel;
pub mod kernel1d;
pub mod kernel2d;
pub mod kernel3d;
mod lamps;
mod method;
mod options;
pub mod photons;
mod rough;
pub mod scan;
mod shade;
pub mod sight;
pub mod splat;
pub mod surface_map;
pub mod sweep;

pub use method::PhotonBeams;
pub use options::{BeamLength, BeamOptions, KernelChoice, OptionError, Radii, Settings, Temporal};
pub use tpb_transport::{Sampler, Sampling};

/// Items of the random streams: photons count from 0, pixels from 2⁶³, their rays to lamps from 5·2⁶¹, tiles
/// from 3·2⁶².
pub(crate) mod stream_item {
    /// The stream of the tile whose first pixel this is.
    pub(crate) const fn tile(first: usize) -> u64 {
        (3 << 62) | first as u64
    }

    /// The stream of a pixel's rays to lamps.
    pub(crate) const fn lamp(pixel: usize) -> u64 {
        (5 << 61) | pixel as u64
    }

    /// The stream of a pixel.
    pub(crate) const fn pixel(index: usize) -> u64 {
        (1 << 63) | index as u64
    }
}
