//! Orthonormal bases around a direction (Duff et al. 2017, "Building an Orthonormal Basis,
//! Revisited", listing 3): no branch on the axis and no loss at any direction.

use glam::DVec3;

/// A right-handed orthonormal basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: DVec3,
    /// Second tangent.
    pub y: DVec3,
    /// The axis that the frame was built around.
    pub z: DVec3,
}

impl Frame {
    /// A frame whose z axis is the unit vector `z`.
    #[inline]
    pub fn from_z(z: DVec3) -> Self {
        let sign = 1.0_f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: DVec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// From coordinates in this frame to the world.
    #[inline]
    pub fn to_world(&self, local: DVec3) -> DVec3 {
        local.x * self.x + local.y * self.y + local.z * self.z
    }

    /// From the world to coordinates in this frame.
    #[inline]
    pub fn to_local(&self, world: DVec3) -> DVec3 {
        DVec3::new(world.dot(self.x), world.dot(self.y), world.dot(self.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_in_every_direction() {
        for z in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.3, -0.5, -0.81).normalize()] {
            let f = Frame::from_z(z);
            for (a, b) in [(f.x, f.y), (f.y, f.z), (f.z, f.x)] {
                assert!(a.dot(b).abs() < 1e-15 && (a.length() - 1.0).abs() < 1e-15);
            }
            assert!((f.x.cross(f.y) - f.z).length() < 1e-15, "right-handed");
            let v = DVec3::new(0.2, -1.5, 3.0);
            assert!((f.to_world(f.to_local(v)) - v).length() < 1e-14);
        }
    }
}
