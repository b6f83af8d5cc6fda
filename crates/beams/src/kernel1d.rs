//! The 1D kernel: a segment of width 2R across beam and ray; no spread in time.
//!
//! Let d be the beam's direction, ω the ray's (away from the camera), w = ray origin − beam
//! origin, n = d × ω and sinψ = |n|. The closest approach lies at
//!
//! ```text
//! s_b = (w × ω)·n/|n|²,   s_r = (w × d)·n/|n|²,   distance |w·n|/|n|,
//! ```
//!
//! forms that hold for perpendicular pairs as for any (those that divide by cosψ do not). With
//! C = β Φ sigma_s p(cosθ), cosθ = −ω·d, the pair adds
//!
//! ```text
//! C exp(−sigma_t (s_b + s_r)) / (2 R sinψ)   at OPL τ_b + τ_r + η (s_b + s_r)
//! ```
//!
//! if the distance is below R, s_b in [0, l_b) and s_r in [0, l_r). An exactly parallel pair adds
//! 0: among spread directions it has probability 0, and its neighbours carry its share; the
//! variance of 1/sinψ over directions is finite. Light collimated along the view needs the 2D
//! kernel. (Jarosz et al. 2011, "A comprehensive theory of volumetric radiance estimation using
//! photon points and beams", section 5; Marco et al. 2017 with its equation 5 for time.)

use glam::DVec3;
use tpb_film::Tile;
use tpb_lanes::Simd;
use tpb_optics::Spectrum;

use crate::beam::{Beam, CameraRay};
use crate::contribution::{Contribution, Spread};
use crate::kernel::RayBeamKernel;
use crate::scan::Knot;
use crate::shade::{Shade1d, shade};
use crate::splat::{Drawn, TileRays};

/// The kernel with its radius.
#[derive(Clone, Copy, Debug)]
pub struct Kernel1d {
    /// Half the width \[m\].
    pub radius: f64,
}

/// Where a beam and a ray come closest.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Distance along the beam \[m\].
    pub along_beam: f64,
    /// Distance along the ray \[m\].
    pub along_ray: f64,
    /// Sine of the angle between the two.
    pub sine: f64,
}

impl RayBeamKernel for Kernel1d {
    type Meeting = Closest;

    fn radius(self) -> f64 {
        self.radius
    }

    #[inline]
    fn meet(
        self,
        origin: DVec3,
        direction: DVec3,
        length: f64,
        ray_origin: DVec3,
        ray_direction: DVec3,
        ray_length: f64,
    ) -> Option<Closest> {
        let n = direction.cross(ray_direction);
        let w = ray_origin - origin;
        let squared = n.length_squared();
        let across = w.dot(n);
        // True for parallel pairs too: n = 0.
        if across * across >= self.radius * self.radius * squared {
            return None;
        }
        let along_beam = w.cross(ray_direction).dot(n) / squared;
        let along_ray = w.cross(direction).dot(n) / squared;
        let within = (0.0..length).contains(&along_beam) && (0.0..ray_length).contains(&along_ray);
        within.then(|| Closest { along_beam, along_ray, sine: squared.sqrt() })
    }

    #[inline]
    fn contribution<const C: usize>(
        self,
        closest: &Closest,
        beam: &Beam<C>,
        ray: &CameraRay<C>,
    ) -> Contribution<C> {
        let &Closest { along_beam, along_ray, sine } = closest;
        let phase = ray.phase.value(-ray.direction.dot(beam.direction));
        let left = beam.attenuation.at(ray.coefficients.sigma_t, along_beam, along_ray);
        let scattered = ray.throughput * beam.power * ray.coefficients.sigma_s;
        let opl = beam.opl + ray.opl + ray.eta * (along_beam + along_ray);
        Contribution {
            start: opl,
            end: opl,
            energy: scattered * left * (phase / (2.0 * self.radius * sine)),
            spread: Spread::Exponential { depth: Spectrum::ZERO },
        }
    }

    #[inline(always)]
    fn draw<S: Simd, const C: usize>(
        self,
        simd: S,
        drawn: &Drawn<'_, C>,
        rays: &TileRays<'_, C>,
        knots: &[Knot],
        tile: &mut Tile<'_, C>,
    ) -> u64 {
        shade(simd, (self, Shade1d { radius: self.radius }), drawn, rays, knots, tile)
    }
}
