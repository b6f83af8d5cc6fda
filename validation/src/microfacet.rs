//! Rough surfaces once more, in the forms of the textbooks, apart from the programs' own.
//!
//! Walter et al. 2007 (eq. 20, 21, 33, 34), Heitz 2018 (eq. 3), masking and shadowing correlated by
//! height (Heitz 2014, Heitz et al. 2016). Directions are unit vectors that point away from the
//! surface, whose normal is +z; `before` and `beyond` are refractive indices.

use std::f64::consts::PI;

use glam::DVec3;
use statrs::function::beta::beta;

fn tan2(w: DVec3) -> f64 {
    (1.0 - w.z * w.z).max(0.0) / (w.z * w.z)
}

/// Λ of Smith's masking for the Trowbridge-Reitz distribution.
fn lambda(alpha: f64, w: DVec3) -> f64 {
    0.5 * ((1.0 + alpha * alpha * tan2(w)).sqrt() - 1.0)
}

/// D: Trowbridge-Reitz.
fn distribution(alpha: f64, half: DVec3) -> f64 {
    alpha * alpha / (PI * half.z.powi(4) * (alpha * alpha + tan2(half)).powi(2))
}

/// Density of normals as seen from `from`: G1 D (from·h)/cosθ.
pub fn visible(alpha: f64, from: DVec3, half: DVec3) -> f64 {
    let g1 = 1.0 / (1.0 + lambda(alpha, from));
    g1 * distribution(alpha, half) * from.dot(half).max(0.0) / from.z
}

/// Fresnel's reflectance, in sines and tangents of the two angles.
pub fn reflectance(cosine: f64, [before, beyond]: [f64; 2]) -> f64 {
    let incident = cosine.min(1.0).acos();
    let sine = before / beyond * incident.sin();
    if sine >= 1.0 {
        return 1.0;
    }
    if incident < 1e-6 {
        return ((before - beyond) / (before + beyond)).powi(2);
    }
    let refracted = sine.asin();
    let s = ((incident - refracted).sin() / (incident + refracted).sin()).powi(2);
    let p = ((incident - refracted).tan() / (incident + refracted).tan()).powi(2);
    0.5 * (s + p)
}

/// The normal that refracts `from` (z > 0) into `to` (z < 0), and its steradians per steradian of
/// `to`; `None` if there is none.
pub fn refracting(from: DVec3, to: DVec3, [before, beyond]: [f64; 2]) -> Option<(DVec3, f64)> {
    let sum = before * from + beyond * to;
    let half = sum.normalize() * sum.z.signum();
    let (a, b) = (from.dot(half), to.dot(half));
    let jacobian = beyond * beyond * -b / (before * a + beyond * b).powi(2);
    (a > 0.0 && b < 0.0).then_some((half, jacobian))
}

/// Walter's BTDF for light that comes from `from` (z > 0) and leaves to `to` (z < 0): radiance
/// there per irradiance.
pub fn transmission(alpha: f64, from: DVec3, to: DVec3, eta: [f64; 2]) -> f64 {
    let Some((half, jacobian)) = refracting(from, to, eta) else { return 0.0 };
    let cosine = from.dot(half);
    let both = beta(1.0 + lambda(alpha, from), 1.0 + lambda(alpha, -to));
    let part = 1.0 - reflectance(cosine, eta);
    part * both * distribution(alpha, half) * cosine * jacobian / (from.z * -to.z)
}
