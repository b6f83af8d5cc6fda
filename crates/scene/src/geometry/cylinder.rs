//! Open cylinders (no caps), as Mitsuba's `cylinder`.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_accel::Aabb;

use super::SurfacePoint;

/// The side of a cylinder; its normal points away from the axis unless `flipped`.
#[derive(Clone, Debug)]
pub struct Cylinder {
    base: DVec3,
    axis: DVec3,
    across: DVec3,
    length: f64,
    radius: f64,
    flipped: bool,
}

impl Cylinder {
    /// From the ends of its axis, which must differ, and a positive radius \[m\].
    pub fn new(p0: DVec3, p1: DVec3, radius: f64, flipped: bool) -> Self {
        let length = (p1 - p0).length();
        let axis = (p1 - p0) / length;
        Self { base: p0, axis, across: axis.any_orthonormal_vector(), length, radius, flipped }
    }

    #[inline]
    pub(super) fn intersect(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        stands_on: bool,
    ) -> Option<f64> {
        let offset = origin - self.base;
        let o = offset - offset.dot(self.axis) * self.axis;
        let d = direction - direction.dot(self.axis) * self.axis;
        let a = d.length_squared();
        let b = o.dot(d);
        let along = |t: f64| (offset + t * direction).dot(self.axis);
        let valid = |t: f64| t > 0.0 && t < t_max && (0.0..=self.length).contains(&along(t));
        if a == 0.0 {
            return None;
        }
        if stands_on {
            let t = -2.0 * b / a;
            return valid(t).then_some(t);
        }
        let nearest = (o - (b / a) * d).length();
        let discriminant = a * (self.radius - nearest) * (self.radius + nearest);
        if discriminant < 0.0 || discriminant.is_nan() {
            return None;
        }
        let q = -b - discriminant.sqrt().copysign(b);
        let c = (o.length() - self.radius) * (o.length() + self.radius);
        let (first, second) = if b > 0.0 { (q / a, c / q) } else { (c / q, q / a) };
        [first, second].into_iter().find(|&t| valid(t))
    }

    #[inline]
    pub(super) fn normal(&self, position: DVec3) -> DVec3 {
        let offset = position - self.base;
        let outward = (offset - offset.dot(self.axis) * self.axis).normalize();
        if self.flipped { -outward } else { outward }
    }

    pub(super) fn area(&self) -> f64 {
        2.0 * PI * self.radius * self.length
    }

    #[inline]
    pub(super) fn sample(&self, u1: f64, u2: f64) -> SurfacePoint {
        let (sin, cos) = (2.0 * PI * u2).sin_cos();
        let outward = cos * self.across + sin * self.axis.cross(self.across);
        SurfacePoint {
            position: self.base + u1 * self.length * self.axis + self.radius * outward,
            normal: if self.flipped { -outward } else { outward },
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let half = (DVec3::ONE - self.axis * self.axis).max(DVec3::ZERO).map(f64::sqrt);
        let ends = Aabb::around([self.base, self.base + self.length * self.axis]);
        Aabb { min: ends.min - self.radius * half, max: ends.max + self.radius * half }
    }
}
