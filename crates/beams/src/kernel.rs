//! What the gather asks of a blur kernel.

use glam::DVec3;

use crate::beam::{Beam, CameraRay};
use crate::contribution::Contribution;

/// A blur kernel for pairs of a beam and a camera ray; a pure function of the pair.
///
/// A kernel accepts a pair only if some point of the ray (within its segment) lies within the
/// radius of some point of the beam (within *its* segment). For one such pair of points, the beam's
/// is the *reporting point*: a beam may be stored in pieces, and the piece that holds the reporting
/// point is the one that counts the pair. It is the foot of the ray's point, unless the kernel has
/// [`RayBeamKernel::ROUND_ENDS`] and it is an end of the beam.
pub trait RayBeamKernel: Copy + Sync {
    /// The geometry of an accepted pair.
    type Meeting;

    /// Whether the kernel reaches beyond the ends of a beam, by its radius in all directions.
    const ROUND_ENDS: bool;

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

    /// The reporting point: distance along the beam \[m\].
    fn reporting_point(meeting: &Self::Meeting) -> f64;

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
}
