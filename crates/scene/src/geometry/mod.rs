//! Shapes as the intersector sees them: planar pieces, spheres and open cylinders, all in f64.
//!
//! No epsilon moves a ray's start. A ray that leaves a surface names the primitive that it stands
//! on: a plane is not met again by its own ray, and of the two roots of a quadric the one at the
//! start is known and dropped.

mod cylinder;
mod planar;
mod sphere;

use glam::DVec3;
use tpb_accel::Aabb;

pub use cylinder::Cylinder;
pub use planar::{Outline, Planar, VertexData};
pub use sphere::Sphere;

/// One intersectable piece of a shape.
#[derive(Clone, Debug)]
pub enum Primitive {
    /// A parallelogram, ellipse or triangle.
    Planar(Planar),
    /// A full sphere.
    Sphere(Sphere),
    /// The side of a cylinder, without caps.
    Cylinder(Cylinder),
}

/// A point drawn on a primitive, uniform over its area.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position \[m\].
    pub position: DVec3,
    /// Unit normal; `exterior` lies on its side.
    pub normal: DVec3,
}

impl Primitive {
    /// The smallest distance in (0, `t_max`) at which the ray meets the primitive.
    /// `stands_on` tells that `origin` lies on this very primitive.
    #[inline]
    pub fn intersect(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        stands_on: bool,
    ) -> Option<f64> {
        match self {
            Self::Planar(_) if stands_on => None,
            Self::Planar(p) => p.intersect(origin, direction, t_max),
            Self::Sphere(s) => s.intersect(origin, direction, t_max, stands_on),
            Self::Cylinder(c) => c.intersect(origin, direction, t_max, stands_on),
        }
    }

    /// Unit normal at a point of the primitive.
    #[inline]
    pub fn normal(&self, position: DVec3) -> DVec3 {
        match self {
            Self::Planar(p) => p.normal,
            Self::Sphere(s) => s.normal(position),
            Self::Cylinder(c) => c.normal(position),
        }
    }

    /// The normal that shading uses at a point of the primitive, where it is not
    /// [`Primitive::normal`]: that of a mesh's vertices. It is on the same side.
    #[inline]
    pub fn shading_normal(&self, position: DVec3) -> Option<DVec3> {
        match self {
            Self::Planar(p) => p.shading_normal(position),
            Self::Sphere(_) | Self::Cylinder(_) => None,
        }
    }

    /// Area \[m²\].
    pub fn area(&self) -> f64 {
        match self {
            Self::Planar(p) => p.area(),
            Self::Sphere(s) => s.area(),
            Self::Cylinder(c) => c.area(),
        }
    }

    /// A point uniform over the area.
    #[inline]
    pub fn sample(&self, u1: f64, u2: f64) -> SurfacePoint {
        match self {
            Self::Planar(p) => p.sample(u1, u2),
            Self::Sphere(s) => s.sample(u1, u2),
            Self::Cylinder(c) => c.sample(u1, u2),
        }
    }

    /// The box around the primitive.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Planar(p) => p.bounds(),
            Self::Sphere(s) => s.bounds(),
            Self::Cylinder(c) => c.bounds(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn primitives() -> Vec<Primitive> {
        let u = DVec3::new(1.0, 0.2, 0.0);
        let v = DVec3::new(-0.1, 0.5, 0.4);
        let plane = |outline| Primitive::Planar(Planar::new(DVec3::ONE, u, v, outline));
        vec![
            plane(Outline::Parallelogram),
            plane(Outline::Ellipse),
            plane(Outline::Triangle),
            Primitive::Sphere(Sphere { centre: DVec3::ONE, radius: 0.7, flipped: false }),
            Primitive::Cylinder(Cylinder::new(DVec3::ZERO, DVec3::new(0.3, 0.5, 2.0), 0.4, true)),
        ]
    }

    #[test]
    fn a_sampled_point_is_met_by_a_ray_aimed_at_it() {
        let eye = DVec3::new(5.0, 7.0, -11.0);
        for primitive in primitives() {
            for i in 0..100 {
                let u1 = (f64::from(i) + 0.5) / 100.0;
                let u2 = (f64::from(i) * 0.618 + 0.3).fract();
                let p = primitive.sample(u1, u2);
                let distance = (p.position - eye).length();
                let direction = (p.position - eye) / distance;
                let t = primitive.intersect(eye, direction, f64::INFINITY, false).unwrap();
                assert!(t <= distance * (1.0 + 1e-9), "{primitive:?}");
                let seen = primitive.normal(eye + t * direction);
                assert!((seen.length() - 1.0).abs() < 1e-12);
                let b = primitive.bounds().grown(1e-12);
                assert!(p.position.cmpge(b.min).all() && p.position.cmple(b.max).all());
            }
        }
    }

    #[test]
    fn a_ray_does_not_meet_the_point_that_it_leaves() {
        for primitive in primitives() {
            for i in 0..100 {
                let p = primitive.sample((f64::from(i) * 0.377).fract(), f64::from(i) / 100.0);
                for direction in [p.normal, -p.normal] {
                    let again = primitive.intersect(p.position, direction, f64::INFINITY, true);
                    assert!(again.is_none_or(|t| t > 0.1), "{primitive:?} met again at {again:?}");
                }
            }
        }
    }
}
