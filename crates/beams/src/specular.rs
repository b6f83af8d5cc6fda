//! A smooth dielectric boundary, from the light's side or the camera's: the same choice between
//! reflection and refraction, by the Fresnel reflectance.

use glam::DVec3;
use tpb_optics::{Rgb, Stream, fresnel};
use tpb_scene::{Dielectric, Hit, Region, Scene};

/// The way taken at a boundary.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// New propagation direction.
    pub(crate) direction: DVec3,
    /// Whether the boundary was crossed.
    transmitted: bool,
    /// The material's own factor (1 for real glass); the Fresnel factor is the probability.
    pub(crate) factor: Rgb,
    /// Refractive index before the boundary over that behind it; 1 after a reflection.
    pub(crate) eta_ratio: f64,
}

impl Crossing {
    /// Draws reflection or refraction for a ray along `direction`; `normal` is the shape's.
    pub(crate) fn choose(
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
        let f = fresnel::dielectric(cosine.abs(), from, to);
        if rng.uniform() < f.reflectance {
            let direction = fresnel::reflect(direction, facing);
            return Self {
                direction,
                transmitted: false,
                factor: glass.reflectance,
                eta_ratio: 1.0,
            };
        }
        let ratio = from / to;
        let direction = fresnel::refract(direction, facing, ratio, f.cos_transmitted);
        Self { direction, transmitted: true, factor: glass.transmittance, eta_ratio: ratio }
    }

    /// The region that the way leads into, from `before` at `hit`.
    pub(crate) fn region(&self, scene: &Scene, hit: &Hit, before: Region) -> Region {
        if !self.transmitted {
            return before;
        }
        let to_front = self.direction.dot(hit.normal) > 0.0;
        scene.region_beyond(scene.shape(hit.primitive), to_front, before)
    }
}
