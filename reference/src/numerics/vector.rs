//! The few operations on three-vectors that the beam geometry needs.

use crate::error::{Result, require};

pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Vector, factor: f64) -> Vector {
    a.map(|component| component * factor)
}

/// The length, without overflow or underflow on the way.
pub(crate) fn length(a: Vector) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// The vector of length 1 along `a`.
pub(crate) fn unit(name: &'static str, a: Vector) -> Result<Vector> {
    let length = length(a);
    require(length.is_finite() && length > 0.0, name, length, "a finite vector other than 0")?;
    Ok(a.map(|component| component / length))
}

/// `a` if all its components are finite.
pub(crate) fn finite(name: &'static str, a: Vector) -> Result<Vector> {
    let length = length(a);
    require(length.is_finite(), name, length, "a finite vector")?;
    Ok(a)
}

/// The direction `index` of `count` that cover the sphere evenly, on a spiral of golden angles.
#[cfg(test)]
pub(crate) fn fibonacci_direction(index: u32, count: u32) -> Vector {
    let cosine = (2.0 * f64::from(index) + 1.0) / f64::from(count) - 1.0;
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let angle = std::f64::consts::PI * (5.0_f64.sqrt() - 1.0) * f64::from(index);
    [sine * angle.cos(), sine * angle.sin(), cosine]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cross_product_is_right_handed_and_orthogonal() {
        assert_eq!(cross([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        let (a, b) = ([1.0, 2.0, -3.0], [0.5, -4.0, 2.0]);
        assert!(dot(cross(a, b), a).abs() < 1e-14);
        assert!(dot(cross(a, b), b).abs() < 1e-14);
    }

    #[test]
    fn extreme_vectors_are_normalised() {
        for size in [1e-300, 1.0, 1e300] {
            let d = unit("direction", [size, -2.0 * size, 2.0 * size]).unwrap();
            assert!((length(d) - 1.0).abs() < 4e-16);
        }
        assert!(unit("direction", [0.0; 3]).is_err());
        assert!(unit("direction", [f64::NAN, 0.0, 1.0]).is_err());
    }
}
