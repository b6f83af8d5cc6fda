//! What the gather asks of a blur kernel.

use glam::DVec3;
use tpb_film::Tile;
use tpb_lanes::Simd;

use crate::beam::{Beam, CameraRay};
use crate::contribution::Contribution;
use crate::scan::Knot;
use crate::splat::{Drawn, TileRays};

/// A blur kernel for pairs of a beam and a camera ray; a pure function of the pair.
///
/// A kernel accepts a pair only if some point of the ray (within its segment) lies within the
/// radius of some point of the beam (within *its* segment).
pub trait RayBeamKernel: Copy + Sync {
    /// The geometry of an accepted pair.
    type Meeting;

    /// How far it reaches \[m\].
    fn radius(self) -> f64;

    /// The geometry, if the kernel joins beam and ray.
    fn meet(
        self,
        origin: DVec3,
        direction: DVec3,
        length: f64,
        ray_origin: DVec3,
        ray_direction: DVec3,
        ray_length: f64,
    ) -> Option<Self::Meeting>;

    /// The energy and its arrival.
    fn contribution<const C: usize>(
        self,
        meeting: &Self::Meeting,
        beam: &Beam<C>,
        ray: &CameraRay<C>,
    ) -> Contribution<C>;

    /// [`RayBeamKernel::meet`] and [`RayBeamKernel::contribution`] of one pair.
    fn evaluate<const C: usize>(
        self,
        beam: &Beam<C>,
        ray: &CameraRay<C>,
    ) -> Option<Contribution<C>> {
        let meeting = self.meet(
            beam.origin,
            beam.direction,
            beam.length,
            ray.origin,
            ray.direction,
            ray.length,
        )?;
        Some(self.contribution(&meeting, beam, ray))
    }

    /// Adds what a beam sends to the rays at `knots` of a tile; returns how many pairs were
    /// accepted.
    #[inline]
    fn draw<S: Simd, const C: usize>(
        self,
        _: S,
        drawn: &Drawn<'_, C>,
        rays: &TileRays<'_, C>,
        knots: &[Knot],
        tile: &mut Tile<'_, C>,
    ) -> u64 {
        drawn.one_by_one(self, rays, knots.iter().map(|&knot| rays.lattice.place(knot)), tile)
    }
}
