//! What becomes of a carrier (a photon's power, or a camera path's importance) at a surface.
//!
//! An [`Encounter`] is the meeting of one carrier with one surface; its [`Response`] is what may
//! follow: nothing, one direction (mirrors and smooth glass), or a [`Lobe`] of many. All methods
//! ask here, so that a material is written once.
//!
//! **Conventions.** Fluxes and importance are carried alike: a lobe's value f |cosθ| says what part
//! of the carrier goes on per steradian. *Radiance* along a camera's ray changes by (η before/η
//! behind)² besides where it crosses an interface, because L/η² is what refraction conserves; each
//! direction tells the ratio.
//!
//! **Shading normals.** Meshes may have normals n_s that are not those of their faces, n_g. The
//! faces' decide which side is which; n_s takes the place of the normal in the BSDF. That makes the
//! BSDF asymmetric, and a photon from k that goes to w needs the factor (Veach 1997, eq. 5.19, over
//! that of the camera's side)
//!
//! ```text
//! |k·n_s| |w·n_g| / (|k·n_g| |w·n_s|)
//! ```
//!
//! for the camera's paths and photons to see the same image. Guards against light that leaks
//! through the surface: what arrives in front of n_g but behind n_s is absorbed, and so is what
//! would go on on one side for n_g but on the other for n_s. Surfaces look black where they are
//! seen so, at the silhouettes of coarse meshes. Energy is not kept exactly by shading normals;
//! what the photons' factors add or take is in the ledger, as (negative) absorption.

mod glass;
mod lobe;
#[cfg(test)]
mod tests;

use glam::DVec3;
use tpb_optics::{Frame, Rgb, Stream, fresnel};
use tpb_scene::{Bsdf, Flight, Hit, Reflector, Region, Scene};

use self::glass::Crossing;
pub use self::lobe::{DiffuseLobe, Drawn, Lobe, RoughLobe, Towards};

/// A carrier's meeting with the surface at the end of its flight.
#[derive(Clone, Copy)]
pub struct Encounter<'a> {
    scene: &'a Scene,
    hit: &'a Hit,
    /// Unit direction of arrival.
    direction: DVec3,
    /// The region that it arrives in.
    before: Region,
    /// Whether it comes from the side of the shape's normal.
    front: bool,
    /// Unit normal on the side that it comes from.
    normal: DVec3,
    /// The shading normal on that side, where it is another.
    bent: Option<DVec3>,
    carrier: Carrier,
}

/// What is carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Power, by photons.
    Light,
    /// Importance, by the camera's paths.
    Importance,
}

/// What may become of a carrier.
#[derive(Clone, Copy, Debug)]
pub enum Response {
    /// Nothing: all is absorbed.
    Absorbed,
    /// It goes on in one direction.
    Turned(Turn),
    /// Lambertian reflection.
    Diffuse(DiffuseLobe),
    /// Reflection or refraction by microfacets.
    Rough(RoughLobe),
}

/// The one way on from a mirror or smooth glass.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// New unit direction of propagation.
    pub direction: DVec3,
    /// Factor on the carrier.
    pub factor: Rgb,
    /// Refractive index before the surface over that behind it; 1 after a reflection.
    pub eta_ratio: f64,
    /// The region that it goes on in.
    pub region: Region,
}

impl<'a> Encounter<'a> {
    /// Of a carrier that flew to `hit`, the end of `flight`.
    #[inline]
    pub fn new(scene: &'a Scene, flight: &Flight, hit: &'a Hit, carrier: Carrier) -> Self {
        let direction = flight.direction;
        let front = direction.dot(hit.normal) < 0.0;
        let facing = |normal: DVec3| if front { normal } else { -normal };
        let normal = facing(hit.normal);
        let bent = scene.shading_normal(hit).map(facing);
        Self { scene, hit, direction, before: flight.last_region(), front, normal, bent, carrier }
    }

    /// What may follow. Smooth glass (an interface or a thin slab) chooses between its two ways
    /// here, with the probability of the Fresnel reflectance; total internal reflection draws no
    /// random number, nor does anything else.
    #[inline]
    pub fn respond(&self, rng: &mut Stream) -> Response {
        if self.bent.is_some_and(|bent| self.direction.dot(bent) >= 0.0) {
            return Response::Absorbed;
        }
        let normal = self.bent.unwrap_or(self.normal);
        match &self.scene.shape(self.hit.primitive).bsdf {
            Bsdf::Null => unreachable!("flights cross null boundaries"),
            Bsdf::Dielectric(glass) => {
                let outward = if self.front { normal } else { -normal };
                let way = Crossing::choose(glass, self.direction, outward, rng);
                let Crossing { direction, factor, eta_ratio, transmitted } = way;
                let region = if transmitted { self.beyond() } else { self.before };
                self.turned(Turn { direction, factor, eta_ratio, region }, transmitted)
            }
            Bsdf::ThinDielectric(glass) => {
                let way = Crossing::through_slab(glass, self.direction, normal, rng);
                let Crossing { direction, factor, eta_ratio, transmitted } = way;
                let region = if transmitted { self.beyond() } else { self.before };
                self.turned(Turn { direction, factor, eta_ratio, region }, transmitted)
            }
            Bsdf::RoughDielectric(glass, ggx) => {
                Response::Rough(RoughLobe::glass(self, glass, *ggx))
            }
            Bsdf::Opaque { front, back } => match if self.front { front } else { back } {
                Reflector::Black => Response::Absorbed,
                Reflector::Mirror(factor) => {
                    let turn = Turn {
                        direction: fresnel::reflect(self.direction, normal),
                        factor: *factor,
                        eta_ratio: 1.0,
                        region: self.before,
                    };
                    self.turned(turn, false)
                }
                Reflector::Diffuse(factor) => Response::Diffuse(DiffuseLobe::new(self, *factor)),
                Reflector::Textured(texture) => {
                    let factor = self.scene.textured(*texture, self.hit);
                    Response::Diffuse(DiffuseLobe::new(self, factor))
                }
                Reflector::Rough(metal) => Response::Rough(RoughLobe::metal(self, metal)),
            },
        }
    }

    /// One way on, if it leads where it should by the faces' normal too.
    #[inline]
    fn turned(&self, turn: Turn, transmitted: bool) -> Response {
        let Some(bent) = self.bent else { return Response::Turned(turn) };
        let (w, k) = (turn.direction, self.direction);
        if (w.dot(self.normal) < 0.0) != transmitted {
            return Response::Absorbed;
        }
        let factor = match self.carrier {
            Carrier::Importance => turn.factor,
            Carrier::Light => {
                let arriving = k.dot(bent) / k.dot(self.normal);
                turn.factor * (arriving * w.dot(self.normal) / w.dot(bent)).abs()
            }
        };
        Response::Turned(Turn { factor, ..turn })
    }

    /// |k·n_s|/|k·n_g| of an arriving photon.
    fn arriving(&self) -> f64 {
        match (self.carrier, self.bent) {
            (Carrier::Light, Some(bent)) => {
                (self.direction.dot(bent) / self.direction.dot(self.normal)).abs()
            }
            _ => 1.0,
        }
    }

    /// The region on the other side.
    fn beyond(&self) -> Region {
        let shape = self.scene.shape(self.hit.primitive);
        self.scene.region_beyond(shape, !self.front, self.before)
    }

    /// Axes around the (shading) normal on the side of arrival, and the unit direction back
    /// along the arrival in them.
    fn local(&self) -> (Frame, DVec3) {
        let frame = Frame::from_z(self.bent.unwrap_or(self.normal));
        (frame, frame.to_local(-self.direction))
    }
}
