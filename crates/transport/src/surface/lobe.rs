//! Spread directions: what goes where, and a direction drawn.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use tpb_optics::microfacet::{Ggx, RoughConductor, RoughDielectric};
use tpb_optics::{Frame, Rgb, Spectrum, Stream, warp};
use tpb_scene::{Dielectric, Region, RoughMetal};

use super::{Carrier, Encounter};

/// What a surface spreads a carrier into.
pub trait Lobe<const C: usize> {
    /// Factor on the carrier, whatever its direction.
    fn factor(&self) -> Spectrum<C>;

    /// Scattering into a unit direction.
    fn towards(&self, direction: DVec3) -> Towards<C>;

    /// A drawn direction; `None` if nothing goes on from it.
    fn sample(&self, rng: &mut Stream) -> Option<Drawn<C>>;
}

/// Scattering into a given direction, at a surface or in a medium.
#[derive(Clone, Copy, Debug)]
pub struct Towards<const C: usize> {
    /// Part of the carrier that goes there, [`Lobe::factor`] apart \[1/sr\].
    pub value: Spectrum<C>,
    /// Density with which the lobe draws it \[1/sr\].
    pub density: f64,
    /// Refractive index before the surface over that where the direction leads.
    pub eta_ratio: f64,
    /// The region that it leads into.
    pub region: Region,
}

/// A drawn direction.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<const C: usize> {
    /// Unit direction of propagation.
    pub direction: DVec3,
    /// Value over density.
    pub weight: Spectrum<C>,
    /// Density of the direction \[1/sr\].
    pub density: f64,
    /// Refractive index before the surface over that where the direction leads.
    pub eta_ratio: f64,
    /// The region that it leads into.
    pub region: Region,
}

impl<const C: usize> Towards<C> {
    /// Of scattering that changes no region and is drawn in proportion to itself.
    #[inline]
    pub fn proportional(value: f64, region: Region) -> Self {
        Self { value: Spectrum::splat(value), density: value, eta_ratio: 1.0, region }
    }

    /// What crossing makes of a camera ray's radiance.
    #[inline]
    pub fn radiance_factor(&self) -> f64 {
        self.eta_ratio * self.eta_ratio
    }
}

/// Lambert's law: cosθ/π.
///
/// The cosine is that of the shading normal for importance, and, by the photons' factor, that of
/// the face for light.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseLobe {
    /// Reflectance, times the photons' factor for their arrival.
    pub factor: Rgb,
    /// Unit normal whose cosine counts, on the side that the carrier came from.
    pub normal: DVec3,
    /// Nothing goes behind this normal either.
    pub guard: Option<DVec3>,
    /// Reflectance alone.
    pub reflectance: Rgb,
    /// The photons' factor for their arrival: 1 but for shading normals.
    pub arriving: f64,
    region: Region,
}

impl DiffuseLobe {
    #[inline]
    pub(super) fn new(encounter: &Encounter, reflectance: Rgb) -> Self {
        let arriving = encounter.arriving();
        let (normal, guard) = match (encounter.carrier, encounter.bent) {
            (_, None) => (encounter.normal, None),
            (Carrier::Light, bent) => (encounter.normal, bent),
            (Carrier::Importance, Some(bent)) => (bent, Some(encounter.normal)),
        };
        let factor = reflectance * arriving;
        Self { factor, normal, guard, reflectance, arriving, region: encounter.before }
    }

    /// Whether light may go there.
    #[inline]
    pub fn allows(&self, direction: DVec3) -> bool {
        self.guard.is_none_or(|guard| guard.dot(direction) > 0.0)
    }
}

impl<const C: usize> Lobe<C> for DiffuseLobe {
    #[inline]
    fn factor(&self) -> Spectrum<C> {
        self.factor.channels()
    }

    #[inline]
    fn towards(&self, direction: DVec3) -> Towards<C> {
        let cosine = if self.allows(direction) { self.normal.dot(direction).max(0.0) } else { 0.0 };
        Towards::proportional(cosine * FRAC_1_PI, self.region)
    }

    #[inline]
    fn sample(&self, rng: &mut Stream) -> Option<Drawn<C>> {
        let local = warp::cosine_hemisphere(rng.uniform(), rng.uniform());
        let direction = Frame::from_z(self.normal).to_world(local);
        self.allows(direction).then(|| Drawn {
            direction,
            weight: Spectrum::ONE,
            density: warp::cosine_hemisphere_pdf(local.z),
            eta_ratio: 1.0,
            region: self.region,
        })
    }
}

/// Microfacets.
#[derive(Clone, Copy, Debug)]
pub struct RoughLobe {
    material: Material,
    /// Axes around the normal on the side of arrival.
    frame: Frame,
    /// Unit direction back along the arrival, in these axes.
    from: DVec3,
    before: Region,
    bent: Option<Bent>,
}

/// What a shading normal asks for.
#[derive(Clone, Copy, Debug)]
struct Bent {
    /// The face's normal on the side of arrival.
    face: DVec3,
    /// For photons |k·n_s|/|k·n_g|.
    arriving: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
enum Material {
    Metal { surface: RoughConductor, reflectance: Rgb },
    Glass { surface: RoughDielectric, reflectance: Rgb, transmittance: Rgb, beyond: Region },
}

impl RoughLobe {
    pub(super) fn metal(encounter: &Encounter, metal: &RoughMetal) -> Self {
        let RoughMetal { surface, reflectance } = *metal;
        Self::new(encounter, Material::Metal { surface, reflectance })
    }

    pub(super) fn glass(encounter: &Encounter, glass: &Dielectric, ggx: Ggx) -> Self {
        let &Dielectric { interior_eta, exterior_eta, reflectance, transmittance } = glass;
        let (eta_before, eta_beyond) = if encounter.front {
            (exterior_eta, interior_eta)
        } else {
            (interior_eta, exterior_eta)
        };
        let surface = RoughDielectric { ggx, eta_before, eta_beyond };
        let beyond = encounter.beyond();
        Self::new(encounter, Material::Glass { surface, reflectance, transmittance, beyond })
    }

    fn new(encounter: &Encounter, material: Material) -> Self {
        let (frame, from) = encounter.local();
        let light = encounter.carrier == Carrier::Light;
        let bent = encounter.bent.map(|_| Bent {
            face: encounter.normal,
            arriving: light.then(|| encounter.arriving()),
        });
        Self { material, frame, from, before: encounter.before, bent }
    }

    /// Factor of a shading normal on what goes to a direction, given in the world's axes and in
    /// those of the surface; `None` if nothing may.
    #[inline]
    fn correction(&self, direction: DVec3, local: DVec3) -> Option<f64> {
        let Some(Bent { face, arriving }) = self.bent else { return Some(1.0) };
        let cosine = face.dot(direction);
        let same_side = (cosine > 0.0) == (local.z > 0.0);
        same_side.then(|| arriving.map_or(1.0, |arriving| arriving * (cosine / local.z).abs()))
    }

    /// The way through (or back) of a direction in the frame: region and ratio of indices.
    #[inline]
    fn way(&self, local: DVec3) -> (Region, f64) {
        match self.material {
            Material::Glass { surface, beyond, .. } if local.z < 0.0 => {
                (beyond, surface.eta_before / surface.eta_beyond)
            }
            _ => (self.before, 1.0),
        }
    }
}

impl<const C: usize> Lobe<C> for RoughLobe {
    #[inline]
    fn factor(&self) -> Spectrum<C> {
        match self.material {
            Material::Metal { reflectance, .. } => reflectance.channels(),
            Material::Glass { .. } => Spectrum::ONE,
        }
    }

    fn towards(&self, direction: DVec3) -> Towards<C> {
        let to = self.frame.to_local(direction);
        let (value, density) = match self.material {
            Material::Metal { surface, .. } => {
                let towards = surface.towards(self.from, to);
                (towards.value.channels(), towards.density)
            }
            Material::Glass { surface, reflectance, transmittance, .. } => {
                let towards = surface.towards(self.from, to);
                let tint = if to.z > 0.0 { reflectance } else { transmittance };
                (tint.channels() * towards.value, towards.density)
            }
        };
        let (region, eta_ratio) = self.way(to);
        let value = value * self.correction(direction, to).unwrap_or(0.0);
        Towards { value, density, eta_ratio, region }
    }

    fn sample(&self, rng: &mut Stream) -> Option<Drawn<C>> {
        let u = [rng.uniform(), rng.uniform()];
        let (local, weight, density) = match self.material {
            Material::Metal { surface, .. } => {
                let drawn = surface.sample(self.from, u)?;
                (drawn.direction, drawn.weight.channels(), drawn.density)
            }
            Material::Glass { surface, reflectance, transmittance, .. } => {
                let drawn = surface.sample(self.from, u, rng.uniform())?;
                let tint = if drawn.direction.z > 0.0 { reflectance } else { transmittance };
                (drawn.direction, tint.channels() * drawn.weight, drawn.density)
            }
        };
        let (region, eta_ratio) = self.way(local);
        let direction = self.frame.to_world(local).normalize();
        let weight = weight * self.correction(direction, local)?;
        Some(Drawn { direction, weight, density, eta_ratio, region })
    }
}
