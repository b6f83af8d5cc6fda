//! Warps of uniform numbers, each with its probability density.
//!
//! Solid-angle densities are per steradian, areal ones per square metre, distances per metre.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Uniform over the unit sphere; density 1/(4π).
#[inline]
pub fn uniform_sphere(u1: f64, u2: f64) -> DVec3 {
    let z = 1.0 - 2.0 * u1;
    let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * u2).sin_cos();
    DVec3::new(r * cos, r * sin, z)
}

/// Uniform over the unit disc; density 1/π. (Polar mapping: continuous but for one radius.)
#[inline]
pub fn uniform_disc(u1: f64, u2: f64) -> DVec2 {
    let r = u1.sqrt();
    let (sin, cos) = (2.0 * PI * u2).sin_cos();
    DVec2::new(r * cos, r * sin)
}

/// Cosine-weighted over the hemisphere around +z; density cosθ/π.
#[inline]
pub fn cosine_hemisphere(u1: f64, u2: f64) -> DVec3 {
    let d = uniform_disc(u1, u2);
    DVec3::new(d.x, d.y, (1.0 - u1).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] at polar cosine `cos_theta`.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f64) -> f64 {
    cos_theta.max(0.0) / PI
}

/// Uniform over the cone around +z whose half angle has the cosine `cos_cutoff`.
#[inline]
pub fn uniform_cone(u1: f64, u2: f64, cos_cutoff: f64) -> DVec3 {
    let versine = u1 * (1.0 - cos_cutoff);
    let r = (versine * (2.0 - versine)).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * u2).sin_cos();
    DVec3::new(r * cos, r * sin, 1.0 - versine)
}

/// Density of [`uniform_cone`] inside the cone.
#[inline]
pub fn uniform_cone_pdf(cos_cutoff: f64) -> f64 {
    1.0 / (2.0 * PI * (1.0 - cos_cutoff))
}

/// Barycentric coordinates (b1, b2) uniform over a triangle; areal density 1/area.
#[inline]
pub fn uniform_triangle(u1: f64, u2: f64) -> (f64, f64) {
    let s = u1.sqrt();
    (1.0 - s, s * u2)
}

/// Equiangular sampling of a distance along a ray (Kulla & Fajardo 2012, eq. 3 to 5): density
/// proportional to the inverse squared distance from a point light.
#[derive(Clone, Copy, Debug)]
pub struct Equiangular {
    /// Distance along the ray of the point nearest to the light.
    centre: f64,
    /// Distance of the light from the ray's line.
    height: f64,
    theta_a: f64,
    theta_b: f64,
    start: f64,
    end: f64,
}

impl Equiangular {
    /// For the part `start..end` (end may be infinite) of the ray, and a light at `light`.
    #[inline]
    pub fn new(origin: DVec3, direction: DVec3, start: f64, end: f64, light: DVec3) -> Self {
        let to_light = light - origin;
        let centre = to_light.dot(direction);
        let height = to_light.cross(direction).length();
        let theta = |t: f64| (t - centre).atan2(height);
        Self { centre, height, theta_a: theta(start), theta_b: theta(end), start, end }
    }

    /// Whether the density exists: the light is off the line, the part not empty.
    #[inline]
    pub fn is_proper(&self) -> bool {
        self.height > 0.0 && self.theta_b > self.theta_a
    }

    /// A distance in `start..=end`.
    #[inline]
    pub fn sample(&self, u: f64) -> f64 {
        let theta = self.theta_a + u * (self.theta_b - self.theta_a);
        (self.centre + self.height * theta.tan()).clamp(self.start, self.end)
    }

    /// Density at distance `t` \[1/m\]; 0 outside the part.
    #[inline]
    pub fn pdf(&self, t: f64) -> f64 {
        if !self.is_proper() || t < self.start || t > self.end {
            return 0.0;
        }
        let x = t - self.centre;
        self.height / ((self.theta_b - self.theta_a) * (self.height * self.height + x * x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equiangular_density_integrates_to_one_and_inverts_its_sampler() {
        for (end, light) in [(5.0, DVec3::new(0.3, 0.1, 2.0)), (f64::INFINITY, DVec3::Y)] {
            let e = Equiangular::new(DVec3::ZERO, DVec3::Z, 0.5, end, light);
            for i in 1..100 {
                let (u, h) = (f64::from(i) / 100.0, 1e-7);
                let slope = (e.sample(u + h) - e.sample(u - h)) / (2.0 * h);
                assert!((slope * e.pdf(e.sample(u)) - 1.0).abs() < 1e-5, "u = {u}");
            }
            assert!((e.sample(0.0) - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn directions_are_unit_vectors_within_their_domains() {
        for i in 0..100 {
            for j in 0..10 {
                let (u1, u2) = (f64::from(i) / 99.9, f64::from(j) / 10.0);
                let cone = uniform_cone(u1, u2, 0.8);
                assert!(cone.z >= 0.8 - 1e-15 && (cone.length() - 1.0).abs() < 1e-14);
                let hemisphere = cosine_hemisphere(u1.min(1.0), u2);
                assert!(hemisphere.z >= 0.0 && (hemisphere.length() - 1.0).abs() < 1e-7);
                assert!((uniform_sphere(u1.min(1.0), u2).length() - 1.0).abs() < 1e-14);
                let (b1, b2) = uniform_triangle(u1.min(1.0), u2);
                assert!(b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0 + 1e-15);
            }
        }
    }
}
