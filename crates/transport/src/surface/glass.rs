//! A smooth dielectric boundary: one choice between reflection and refraction, with the probability
//! of the Fresnel reflectance, so that the carrier is unchanged but for the material's own factors.

use glam::DVec3;
use tpb_optics::{Rgb, Stream, fresnel};
use tpb_scene::Dielectric;

/// The way taken at a boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// New unit direction of propagation.
    pub(super) direction: DVec3,
    /// The material's own factor (1 for real glass); the Fresnel factor is the probability.
    pub(super) factor: Rgb,
    /// Refractive index before the boundary over that behind it; 1 after a reflection.
    pub(super) eta_ratio: f64,
    /// Whether the boundary was crossed.
    pub(super) transmitted: bool,
}

impl Crossing {
    /// Draws reflection or refraction for a ray along `direction`; `normal` is the shape's. Total
    /// internal reflection draws no random number.
    #[inline]
    pub(super) fn choose(
        glass: &Dielectric,
        direction: DVec3,
        normal: DVec3,
        rng: &mut Stream,
    ) -> Self {
        let cosine = -direction.dot(normal);
        let (from, to, facing) = if cosine > 0.0 {
            (glass.exterior_eta, glass.interior_eta, normal)
        } else {
            (glass.interior_eta, glass.exterior_eta, -normal)
        };
        let f = fresnel::dielectric(cosine.abs().min(1.0), from, to);
        if f.reflectance >= 1.0 || rng.uniform() < f.reflectance {
            let direction = fresnel::reflect(direction, facing);
            let factor = glass.reflectance;
            return Self { direction, factor, eta_ratio: 1.0, transmitted: false };
        }
        let eta_ratio = from / to;
        let direction = fresnel::refract(direction, facing, eta_ratio, f.cos_transmitted);
        Self { direction, factor: glass.transmittance, eta_ratio, transmitted: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: Dielectric = Dielectric {
        interior_eta: 1.5,
        exterior_eta: 1.0,
        reflectance: Rgb::splat(0.5),
        transmittance: Rgb::ONE,
    };

    /// Both ways through one boundary: Snell's law, and the index ratio of the way.
    #[test]
    fn refraction_obeys_snell_both_ways() {
        let mut rng = Stream::new(7, 8, 9);
        for down in [DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.6, 0.0, 0.8)] {
            let mut crossed = 0;
            for _ in 0..200 {
                let way = Crossing::choose(&GLASS, down, DVec3::Z, &mut rng);
                let ratio = if down.z < 0.0 { 1.0 / 1.5 } else { 1.5 };
                if way.transmitted {
                    crossed += 1;
                    assert!((way.direction.x - 0.6 * ratio).abs() < 1e-14);
                    assert!(way.direction.z * down.z > 0.0);
                    assert!((way.eta_ratio - ratio).abs() < 1e-15 && way.factor == Rgb::ONE);
                } else {
                    assert!((way.direction - DVec3::new(0.6, 0.0, -down.z)).length() < 1e-15);
                    assert!(way.eta_ratio == 1.0 && way.factor == GLASS.reflectance);
                }
            }
            // R = 0.044 from outside, 0.147 from inside.
            assert!((150..200).contains(&crossed), "{crossed}");
        }
    }

    #[test]
    fn beyond_the_critical_angle_all_is_reflected_without_chance() {
        let (mut rng, mut untouched) = (Stream::new(1, 1, 1), Stream::new(1, 1, 1));
        let steep = DVec3::new(0.8, 0.0, 0.6);
        let way = Crossing::choose(&GLASS, steep, DVec3::Z, &mut rng);
        assert!(!way.transmitted && way.direction.z < 0.0);
        assert_eq!(rng.uniform(), untouched.uniform());
    }
}
