//! Planar primitives: origin + a·u + b·v with one of three outlines for (a, b).

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use tpb_accel::Aabb;
use tpb_optics::warp;

use super::SurfacePoint;

/// Which (a, b) belong to the primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// |a| ≤ 1, |b| ≤ 1: Mitsuba's `rectangle`, and one face of a `cube`.
    Parallelogram,
    /// a² + b² ≤ 1: Mitsuba's `disk`.
    Ellipse,
    /// a, b ≥ 0, a + b ≤ 1: a mesh's face.
    Triangle,
}

/// What the corners of a triangle say beside their places, in the order of origin, origin + u,
/// origin + v.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VertexData {
    /// Unit normals, on the side of the triangle's own.
    pub normals: Option<[DVec3; 3]>,
    /// Texture coordinates.
    pub uv: Option<[DVec2; 3]>,
}

/// A planar piece; its normal is along u × v.
#[derive(Clone, Debug)]
pub struct Planar {
    pub(crate) origin: DVec3,
    u: DVec3,
    v: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    pub(crate) dual_u: DVec3,
    pub(crate) dual_v: DVec3,
    pub(crate) outline: Outline,
    vertices: Option<Box<VertexData>>,
}

impl Planar {
    /// From its edges, which must not be parallel.
    pub fn new(origin: DVec3, u: DVec3, v: DVec3, outline: Outline) -> Self {
        let n = u.cross(v);
        let squared = n.length_squared();
        Self {
            origin,
            u,
            v,
            normal: n.normalize(),
            dual_u: v.cross(n) / squared,
            dual_v: n.cross(u) / squared,
            outline,
            vertices: None,
        }
    }

    /// The same with data of its corners.
    #[must_use]
    pub fn with_vertices(self, data: VertexData) -> Self {
        Self { vertices: (data != VertexData::default()).then(|| Box::new(data)), ..self }
    }

    /// Coordinates (a, b) of a point in the plane.
    fn coordinates(&self, position: DVec3) -> (f64, f64) {
        let local = position - self.origin;
        (local.dot(self.dual_u), local.dot(self.dual_v))
    }

    /// The interpolated normal of the corners; `None` if they have none, or it is not in front of
    /// the plane.
    #[inline]
    pub(super) fn shading_normal(&self, position: DVec3) -> Option<DVec3> {
        let [n0, n1, n2] = self.vertices.as_ref()?.normals?;
        let (a, b) = self.coordinates(position);
        let normal = ((1.0 - a - b) * n0 + a * n1 + b * n2).try_normalize()?;
        (normal.dot(self.normal) > 0.0).then_some(normal)
    }

    /// Whether its corners have texture coordinates.
    pub fn has_vertex_uv(&self) -> bool {
        self.vertices.as_ref().is_some_and(|data| data.uv.is_some())
    }

    /// Interpolated texture coordinates of the corners, if they have any.
    pub fn vertex_uv(&self, position: DVec3) -> Option<DVec2> {
        let [t0, t1, t2] = self.vertices.as_ref()?.uv?;
        let (a, b) = self.coordinates(position);
        Some((1.0 - a - b) * t0 + a * t1 + b * t2)
    }

    /// The corners in order, if it is a parallelogram.
    pub fn parallelogram(&self) -> Option<[DVec3; 4]> {
        let (o, u, v) = (self.origin, self.u, self.v);
        (self.outline == Outline::Parallelogram)
            .then(|| [o - u - v, o + u - v, o + u + v, o - u + v])
    }

    #[inline]
    pub(super) fn intersect(&self, origin: DVec3, direction: DVec3, t_max: f64) -> Option<f64> {
        let to_plane = self.origin - origin;
        let t = to_plane.dot(self.normal) / direction.dot(self.normal);
        // False for NaN too: a ray within the plane does not meet it.
        if !(t > 0.0 && t < t_max) {
            return None;
        }
        let local = t * direction - to_plane;
        let (a, b) = (local.dot(self.dual_u), local.dot(self.dual_v));
        let inside = match self.outline {
            Outline::Parallelogram => a.abs() <= 1.0 && b.abs() <= 1.0,
            Outline::Ellipse => a * a + b * b <= 1.0,
            Outline::Triangle => a >= 0.0 && b >= 0.0 && a + b <= 1.0,
        };
        inside.then_some(t)
    }

    pub(super) fn area(&self) -> f64 {
        let scale = match self.outline {
            Outline::Parallelogram => 4.0,
            Outline::Ellipse => PI,
            Outline::Triangle => 0.5,
        };
        scale * self.u.cross(self.v).length()
    }

    #[inline]
    pub(super) fn sample(&self, u1: f64, u2: f64) -> SurfacePoint {
        let (a, b) = match self.outline {
            Outline::Parallelogram => (2.0 * u1 - 1.0, 2.0 * u2 - 1.0),
            Outline::Ellipse => warp::uniform_disc(u1, u2).into(),
            Outline::Triangle => warp::uniform_triangle(u1, u2),
        };
        SurfacePoint { position: self.origin + a * self.u + b * self.v, normal: self.normal }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let (o, u, v) = (self.origin, self.u, self.v);
        match self.outline {
            Outline::Triangle => Aabb::around([o, o + u, o + v]),
            Outline::Parallelogram => Aabb::around([o + u + v, o + u - v, o - u + v, o - u - v]),
            Outline::Ellipse => {
                let half = (u * u + v * v).map(f64::sqrt);
                Aabb { min: o - half, max: o + half }
            }
        }
    }
}
