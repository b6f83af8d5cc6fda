//! Spheres. The discriminant comes from the component of the centre's offset across the ray, which
//! does not cancel for small or far spheres (Haines et al. 2019, Ray Tracing Gems, chapter 7).

use std::f64::consts::PI;

use glam::DVec3;
use tpb_accel::Aabb;
use tpb_optics::warp;

use super::SurfacePoint;

/// A sphere; its normal points outwards unless `flipped`.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Centre \[m\].
    pub centre: DVec3,
    /// Radius \[m\], positive.
    pub radius: f64,
    /// Normal points to the centre (`flip_normals`).
    pub flipped: bool,
}

impl Sphere {
    #[inline]
    pub(super) fn intersect(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        stands_on: bool,
    ) -> Option<f64> {
        let offset = origin - self.centre;
        let b = offset.dot(direction);
        if stands_on {
            let t = -2.0 * b;
            return (t > 0.0 && t < t_max).then_some(t);
        }
        let across = offset - b * direction;
        let discriminant = (self.radius - across.length()) * (self.radius + across.length());
        if discriminant < 0.0 || discriminant.is_nan() {
            return None;
        }
        let q = -b - discriminant.sqrt().copysign(b);
        let c = (offset.length() - self.radius) * (offset.length() + self.radius);
        let (first, second) = if b > 0.0 { (q, c / q) } else { (c / q, q) };
        [first, second].into_iter().find(|&t| t > 0.0 && t < t_max)
    }

    #[inline]
    pub(super) fn normal(&self, position: DVec3) -> DVec3 {
        let outward = (position - self.centre).normalize();
        if self.flipped { -outward } else { outward }
    }

    pub(super) fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    #[inline]
    pub(super) fn sample(&self, u1: f64, u2: f64) -> SurfacePoint {
        let outward = warp::uniform_sphere(u1, u2);
        SurfacePoint {
            position: self.centre + self.radius * outward,
            normal: if self.flipped { -outward } else { outward },
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let r = DVec3::splat(self.radius);
        Aabb { min: self.centre - r, max: self.centre + r }
    }
}
