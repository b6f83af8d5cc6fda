//! Emitters, seen from both ends: photons leave them, and cameras' paths connect to them.
//!
//! Powers and intensities follow Mitsuba: `point` and `spot` in W/sr, `area` in W m⁻² sr⁻¹ from the
//! side of the normal only, `directional` in W/m², our `laser` in W. With pulses, read J for W.
//! Every pulse leaves the emitter's surface at OPL 0.
//!
//! **Directional light** has no surface: it starts, at OPL 0, on the disc that touches the sphere
//! around all shapes from the side that the light comes from. The sphere is about the middle of the
//! shapes' common box, through its corners, and 0.1 % larger. What is outside of the cylinder that
//! the disc sweeps, fog without end for example, has none of it.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::{Frame, Rgb, Spectrum, Stream, warp};

use crate::{Primitive, Region};

/// A source of light.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// Its id in the scene file.
    pub name: String,
    /// What it is.
    pub kind: EmitterKind,
    /// What surrounds it; found when the scene is assembled.
    pub region: Region,
}

/// The kinds of emitters.
#[derive(Clone, Debug)]
pub enum EmitterKind {
    /// Isotropic point: `intensity` W/sr.
    Point {
        /// Position \[m\].
        position: DVec3,
        /// Radiant intensity \[W/sr\].
        intensity: Rgb,
    },
    /// Point with a cone of light around `axis`.
    Spot {
        /// Position \[m\].
        position: DVec3,
        /// Unit axis.
        axis: DVec3,
        /// Radiant intensity on the axis \[W/sr\].
        intensity: Rgb,
        /// Cosine of the half angle beyond which nothing is emitted.
        cos_cutoff: f64,
        /// Cosine of the half angle within which the intensity is full.
        cos_beam: f64,
    },
    /// A diffusely emitting shape.
    Area {
        /// Index of the shape in [`crate::Scene::shapes`].
        shape: usize,
        /// Radiance on the side of the normal \[W m⁻² sr⁻¹\].
        radiance: Rgb,
        /// Area \[m²\].
        area: f64,
    },
    /// Parallel light that covers all shapes.
    Directional {
        /// Unit direction of the light.
        axis: DVec3,
        /// Irradiance across it \[W/m²\].
        irradiance: Rgb,
        /// Centre of the disc that the light starts on \[m\]; found when the scene is assembled.
        position: DVec3,
        /// Radius of that disc \[m\]; likewise.
        radius: f64,
    },
    /// A collimated round beam of uniform irradiance (extension).
    Laser {
        /// Centre of the disc that the light leaves \[m\].
        position: DVec3,
        /// Unit direction of the light.
        axis: DVec3,
        /// Radius of the disc \[m\].
        radius: f64,
        /// Total power \[W\].
        power: Rgb,
    },
}

/// A point on an emitter, chosen to connect to.
#[derive(Clone, Copy, Debug)]
pub struct LightPoint {
    /// Index into [`crate::Scene::emitters`].
    pub emitter: usize,
    /// Position \[m\].
    pub position: DVec3,
    /// The primitive it lies on (area emitters).
    pub primitive: Option<u32>,
    /// Normal there (area emitters).
    pub normal: Option<DVec3>,
    /// Whether its light comes along one direction, so that its position means nothing.
    pub collimated: bool,
    /// Density of the choice: per m² on area emitters, else a probability.
    pub pdf: f64,
}

/// Light that a [`LightPoint`] sends towards a point, were nothing in between.
#[derive(Clone, Copy, Debug)]
pub struct Incident<const C: usize> {
    /// Unit direction from the receiving point to the light.
    pub direction: DVec3,
    /// Distance \[m\].
    pub distance: f64,
    /// What arrives per unit of the measure that [`LightPoint::pdf`] is a density of: divided by
    /// it, irradiance across the direction. Area emitters: L·cosθ/d² \[W m⁻² per m² of emitter\];
    /// points: I/d² \[W/m²\]; directional light: its irradiance.
    pub flux: Spectrum<C>,
    /// Density of the choice per steradian at the receiving point; infinite for points.
    pub pdf_solid_angle: f64,
}

/// A photon as it leaves its emitter.
#[derive(Clone, Copy, Debug)]
pub struct Emission<const C: usize> {
    /// Index into [`crate::Scene::emitters`].
    pub emitter: usize,
    /// Where it starts \[m\].
    pub position: DVec3,
    /// The primitive it leaves.
    pub primitive: Option<u32>,
    /// Unit propagation direction.
    pub direction: DVec3,
    /// Power carried if one photon stood for the whole light of the scene \[W\].
    pub power: Spectrum<C>,
}

impl EmitterKind {
    /// Total power \[W\].
    pub fn power(&self) -> Rgb {
        match *self {
            Self::Point { intensity, .. } => intensity * (4.0 * PI),
            Self::Spot { intensity, cos_cutoff, cos_beam, .. } => {
                intensity * (2.0 * PI * spot_integral(cos_cutoff, cos_beam))
            }
            Self::Area { radiance, area, .. } => radiance * (PI * area),
            Self::Directional { irradiance, radius, .. } => irradiance * (PI * radius * radius),
            Self::Laser { power, .. } => power,
        }
    }

    /// Where it stands, if it is no shape.
    pub(crate) fn position(&self) -> Option<DVec3> {
        match *self {
            Self::Point { position, .. }
            | Self::Spot { position, .. }
            | Self::Laser { position, .. } => Some(position),
            Self::Area { .. } | Self::Directional { .. } => None,
        }
    }

    /// Whether a camera's path can connect to it: not where both its position and its direction
    /// leave no choice.
    pub fn can_be_connected(&self) -> bool {
        !matches!(self, Self::Laser { .. })
    }

    /// The quantity in the scene file that may carry colour.
    pub(crate) fn color(&self) -> Rgb {
        match *self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => intensity,
            Self::Area { radiance, .. } => radiance,
            Self::Directional { irradiance, .. } => irradiance,
            Self::Laser { power, .. } => power,
        }
    }

    /// Light from `point` towards `receiver`; `None` where it sends none there.
    #[inline]
    pub(crate) fn incident<const C: usize>(
        &self,
        point: &LightPoint,
        receiver: DVec3,
    ) -> Option<Incident<C>> {
        if let Self::Directional { axis, irradiance, position, radius } = *self {
            let from_disc = receiver - position;
            let distance = from_disc.dot(axis);
            let across = from_disc - distance * axis;
            let lit = distance > 0.0 && across.length_squared() <= radius * radius;
            let flux = irradiance.channels();
            let pdf_solid_angle = f64::INFINITY;
            return lit.then_some(Incident { direction: -axis, distance, flux, pdf_solid_angle });
        }
        let to_light = point.position - receiver;
        let squared = to_light.length_squared();
        if squared == 0.0 {
            return None;
        }
        let distance = squared.sqrt();
        let direction = to_light / distance;
        let (flux, pdf_solid_angle) = match *self {
            Self::Point { intensity, .. } => (intensity / squared, f64::INFINITY),
            Self::Spot { intensity, axis, cos_cutoff, cos_beam, .. } => {
                let falloff = spot_falloff(-direction.dot(axis), cos_cutoff, cos_beam);
                (intensity * (falloff / squared), f64::INFINITY)
            }
            Self::Area { radiance, .. } => {
                let cos = -direction.dot(point.normal?);
                if cos <= 0.0 {
                    return None;
                }
                (radiance * (cos / squared), point.pdf * squared / cos)
            }
            Self::Directional { .. } | Self::Laser { .. } => return None,
        };
        let flux = flux.channels();
        (!flux.is_zero()).then_some(Incident { direction, distance, flux, pdf_solid_angle })
    }

    /// A photon with power [`EmitterKind::power`]/`probability`, or with a weight around it where
    /// the sampling is not proportional to the emission (spots). `pick` draws a point of the
    /// emitting shape.
    pub(crate) fn emit<const C: usize>(
        &self,
        emitter: usize,
        probability: f64,
        rng: &mut Stream,
        pick: impl FnOnce(&mut Stream) -> (u32, crate::geometry::SurfacePoint),
    ) -> Emission<C> {
        let power = self.power() / probability;
        let (position, primitive, direction, power) = match *self {
            Self::Point { position, .. } => {
                let direction = warp::uniform_sphere(rng.uniform(), rng.uniform());
                (position, None, direction, power)
            }
            Self::Spot { position, axis, intensity, cos_cutoff, cos_beam } => {
                let local = warp::uniform_cone(rng.uniform(), rng.uniform(), cos_cutoff);
                let falloff = spot_falloff(local.z, cos_cutoff, cos_beam);
                let weight = falloff / (warp::uniform_cone_pdf(cos_cutoff) * probability);
                (position, None, Frame::from_z(axis).to_world(local), intensity * weight)
            }
            Self::Area { .. } => {
                let (primitive, p) = pick(rng);
                let local = warp::cosine_hemisphere(rng.uniform(), rng.uniform());
                (p.position, Some(primitive), Frame::from_z(p.normal).to_world(local), power)
            }
            Self::Laser { position, axis, radius, .. }
            | Self::Directional { position, axis, radius, .. } => {
                let disc = radius * warp::uniform_disc(rng.uniform(), rng.uniform());
                let frame = Frame::from_z(axis);
                (position + disc.x * frame.x + disc.y * frame.y, None, axis, power)
            }
        };
        Emission { emitter, position, primitive, direction, power: power.channels() }
    }
}

/// Mitsuba's spot profile: 1 within the beam angle, 0 beyond the cutoff angle, linear in the angle
/// in between.
fn spot_falloff(cos: f64, cos_cutoff: f64, cos_beam: f64) -> f64 {
    if cos >= cos_beam {
        1.0
    } else if cos <= cos_cutoff {
        0.0
    } else {
        let (cutoff, beam) = (cos_cutoff.acos(), cos_beam.acos());
        (cutoff - cos.acos()) / (cutoff - beam)
    }
}

/// ∫ falloff(θ) sinθ dθ. On the ramp from b to c: ∫(c − θ) sinθ dθ/(c − b)
/// = cos b − (sin c − sin b)/(c − b); with the full part 1 − cos b the sum is below.
fn spot_integral(cos_cutoff: f64, cos_beam: f64) -> f64 {
    let (c, b) = (cos_cutoff.acos(), cos_beam.acos());
    if c <= b {
        return 1.0 - cos_cutoff;
    }
    1.0 - (c.sin() - b.sin()) / (c - b)
}

/// An emitter's surface: its primitives with the running sum of their areas.
#[derive(Clone, Debug)]
pub(crate) struct EmittingSurface {
    pub(crate) first_primitive: u32,
    pub(crate) cumulative_area: Vec<f64>,
}

impl EmittingSurface {
    pub(crate) fn new(first_primitive: u32, primitives: &[Primitive]) -> Self {
        let mut sum = 0.0;
        let cumulative_area = primitives
            .iter()
            .map(|p| {
                sum += p.area();
                sum
            })
            .collect();
        Self { first_primitive, cumulative_area }
    }

    pub(crate) fn area(&self) -> f64 {
        self.cumulative_area.last().copied().unwrap_or(0.0)
    }

    /// A primitive with probability proportional to its area.
    pub(crate) fn pick(&self, rng: &mut Stream) -> u32 {
        if self.cumulative_area.len() == 1 {
            return self.first_primitive;
        }
        let target = rng.uniform() * self.area();
        let index = self.cumulative_area.partition_point(|&sum| sum <= target);
        self.first_primitive + index.min(self.cumulative_area.len() - 1) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spot_integral_is_that_of_its_falloff() {
        for (cutoff, beam) in [(20.0_f64, 15.0_f64), (60.0, 10.0), (89.0, 88.0), (30.0, 30.0)] {
            let (cos_c, cos_b) = (cutoff.to_radians().cos(), beam.to_radians().cos());
            let n = 200_000;
            let h = cutoff.to_radians() / f64::from(n);
            let sum: f64 = (0..n)
                .map(|i| {
                    let theta = (f64::from(i) + 0.5) * h;
                    spot_falloff(theta.cos(), cos_c, cos_b) * theta.sin() * h
                })
                .sum();
            assert!((sum / spot_integral(cos_c, cos_b) - 1.0).abs() < 1e-5, "{cutoff} {beam}");
        }
    }
}
