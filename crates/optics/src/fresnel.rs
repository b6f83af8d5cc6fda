//! Fresnel reflectance of smooth dielectrics and metals (unpolarised), reflection and refraction.
//!
//! Born & Wolf, Principles of Optics, section 1.5.2: R = (R_s + R_p)/2. Fluxes do not scale on
//! refraction; radiance does, by (η_transmitted/η_incident)², which the camera side accounts for.

use glam::DVec3;

/// What a ray meets at a smooth dielectric boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresnel {
    /// Unpolarised reflectance, 0 to 1; exactly 1 for total internal reflection.
    pub reflectance: f64,
    /// Cosine of the angle of refraction (0 for total internal reflection).
    pub cos_transmitted: f64,
}

/// Reflectance at incidence cosine `cos_incident` (0 to 1) from index `eta_incident` into
/// `eta_transmitted`.
#[inline]
pub fn dielectric(cos_incident: f64, eta_incident: f64, eta_transmitted: f64) -> Fresnel {
    if eta_incident == eta_transmitted {
        return Fresnel { reflectance: 0.0, cos_transmitted: cos_incident };
    }
    let ratio = eta_incident / eta_transmitted;
    let cos_squared = 1.0 - ratio * ratio * (1.0 - cos_incident) * (1.0 + cos_incident);
    if cos_squared <= 0.0 {
        return Fresnel { reflectance: 1.0, cos_transmitted: 0.0 };
    }
    let cos_transmitted = cos_squared.sqrt();
    let s = (ratio * cos_incident - cos_transmitted) / (ratio * cos_incident + cos_transmitted);
    let p = (cos_incident - ratio * cos_transmitted) / (cos_incident + ratio * cos_transmitted);
    Fresnel { reflectance: 0.5 * (s * s + p * p), cos_transmitted }
}

/// Reflectance of a metal with the complex index `eta` − i `k` (relative to what is outside) at
/// incidence cosine `cos_incident` (0 to 1), unpolarised (Born & Wolf, section 14.4.1): with
/// a + ib = √(η² − k² − sin²θ − 2iηk), R_s = |(cosθ − a − ib)/(cosθ + a + ib)|² and
/// R_p = R_s |(a + ib − sinθ tanθ)/(a + ib + sinθ tanθ)|², here multiplied by cos²θ.
#[inline]
pub fn conductor(cos_incident: f64, eta: f64, k: f64) -> f64 {
    if cos_incident == 0.0 {
        return 1.0;
    }
    let cos2 = cos_incident * cos_incident;
    let sin2 = (1.0 - cos2).max(0.0);
    let real = eta * eta - k * k - sin2;
    let modulus = real.hypot(2.0 * eta * k);
    // a² + b² is the modulus.
    let a = (0.5 * (modulus + real)).max(0.0).sqrt();
    let (even, odd) = (modulus + cos2, 2.0 * a * cos_incident);
    let s = (even - odd) / (even + odd);
    let (even, odd) = (modulus * cos2 + sin2 * sin2, odd * sin2);
    let p = s * (even - odd) / (even + odd);
    0.5 * (s + p)
}

/// Mirror image of the propagation direction `direction` at a surface with unit `normal`.
#[inline]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// The refracted propagation direction. `normal` points against `direction`; `ratio` is
/// η_incident/η_transmitted and `cos_transmitted` comes from [`dielectric`].
#[inline]
pub fn refract(direction: DVec3, normal: DVec3, ratio: f64, cos_transmitted: f64) -> DVec3 {
    let cos_incident = -direction.dot(normal);
    (ratio * direction + (ratio * cos_incident - cos_transmitted) * normal).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_incidence_on_glass_reflects_four_percent() {
        assert!((dielectric(1.0, 1.0, 1.5).reflectance - 0.04).abs() < 1e-15);
        assert!((dielectric(1.0, 1.5, 1.0).reflectance - 0.04).abs() < 1e-15);
    }

    #[test]
    fn both_sides_reflect_alike_at_conjugate_angles_and_matched_media_nothing() {
        for i in 1..50 {
            let cos = f64::from(i) / 50.0;
            let outside = dielectric(cos, 1.0, 1.5);
            let inside = dielectric(outside.cos_transmitted, 1.5, 1.0);
            assert!((outside.reflectance - inside.reflectance).abs() < 1e-13);
            assert!(dielectric(cos, 1.33, 1.33).reflectance == 0.0);
        }
    }

    #[test]
    fn refraction_obeys_snell_and_beyond_the_critical_angle_all_is_reflected() {
        let normal = DVec3::Z;
        let direction = DVec3::new(0.6, 0.0, -0.8);
        let f = dielectric(0.8, 1.0, 1.5);
        let refracted = refract(direction, normal, 1.0 / 1.5, f.cos_transmitted);
        assert!((refracted.x - 0.4).abs() < 1e-15 && refracted.z < 0.0);
        let brewster = 1.5_f64.atan().cos();
        let f = dielectric(brewster, 1.0, 1.5);
        let s = ((1.0 - 2.25) / (1.0 + 2.25_f64)).powi(2);
        assert!((f.reflectance - 0.5 * s).abs() < 1e-14, "only s-polarised light at Brewster");
        assert!((dielectric(0.6, 1.5, 1.0).reflectance - 1.0).abs() < f64::EPSILON);
    }
}
