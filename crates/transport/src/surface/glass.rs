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

    /// Draws reflection or passage for a slab without thickness; `facing` is the unit normal on the
    /// side that the ray comes from. With R and T = 1 − R of one interface, all reflections between
    /// the two sum to R + T²R/(1 − R²) = 2R/(1 + R) (Born & Wolf, section 7.6, incoherent), and the
    /// rest passes straight on. The slab takes no time.
    #[inline]
    pub(super) fn through_slab(
        glass: &Dielectric,
        direction: DVec3,
        facing: DVec3,
        rng: &mut Stream,
    ) -> Self {
        let cosine = -direction.dot(facing);
        let one = fresnel::dielectric(cosine.min(1.0), glass.exterior_eta, glass.interior_eta);
        let reflectance = 2.0 * one.reflectance / (1.0 + one.reflectance);
        let eta_ratio = 1.0;
        if reflectance >= 1.0 || rng.uniform() < reflectance {
            let direction = fresnel::reflect(direction, facing);
            let factor = glass.reflectance;
            return Self { direction, factor, eta_ratio, transmitted: false };
        }
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

    /// The sum over reflections, term by term; 2·10⁵ draws, standard error 1e-3, five of them.
    #[test]
    fn a_thin_slab_reflects_what_its_echoes_sum_to() {
        let glass = Dielectric { transmittance: Rgb::splat(0.8), ..GLASS };
        let (n, mut rng) = (200_000, Stream::new(2, 0, 0));
        for cosine in [1.0, 0.6, 0.2_f64] {
            let one = fresnel::dielectric(cosine, 1.0, 1.5).reflectance;
            let echoes: f64 = (0..60).map(|i| (1.0 - one).powi(2) * one.powi(2 * i + 1)).sum();
            let down = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, -cosine);
            let mut reflected = 0;
            for _ in 0..n {
                let way = Crossing::through_slab(&glass, down, DVec3::Z, &mut rng);
                reflected += u32::from(!way.transmitted);
                assert!(!way.transmitted || way.direction == down && way.factor[0] == 0.8);
                assert!(way.transmitted || (way.direction.z - cosine).abs() < 1e-15);
                assert!(way.eta_ratio == 1.0);
            }
            let share = f64::from(reflected) / f64::from(n);
            assert!((share - one - echoes).abs() < 5e-3, "{cosine}: {share} {one} {echoes}");
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
