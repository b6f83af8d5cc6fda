//! What the cases of all orders share: a box of fog with a null boundary, a floor in it, and where
//! the camera looks.

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, EmitterKind, EmitterPart, MediumBoundary, MediumId, Primitive, ShapePart, TimeSpec,
};

use crate::matrix::view::Frame;

/// Centre of the box, whose half-width is 1.
pub(super) const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 2.5);

/// Centre of the floor, whose half-width is 0.9.
pub(super) const FLOOR: DVec3 = DVec3::new(0.0, -0.8, 2.5);

const LAMP: DVec3 = DVec3::new(0.4, 1.8, 2.2);

/// Pixels and bins: the whole box, and most of its light.
pub(super) fn frame() -> Frame {
    let time = TimeSpec { start_opl: 2.0, bin_width_opl: 0.25, bins: 40 };
    Frame { side: 4, fov: 36.0, time }
}

/// A spot above the box, turned to its centre; half angles in degrees.
pub(super) fn spot(cutoff: f64, beam: f64) -> EmitterPart {
    let kind = EmitterKind::Spot {
        position: LAMP,
        axis: (CENTRE - LAMP).normalize(),
        intensity: Rgb::ONE,
        cos_cutoff: cutoff.to_radians().cos(),
        cos_beam: beam.to_radians().cos(),
    };
    EmitterPart { name: "spot".into(), kind, stated_medium: None }
}

/// A shape that emits nothing.
pub(super) fn part(
    name: &str,
    primitives: Vec<Primitive>,
    bsdf: Bsdf,
    boundary: Option<MediumBoundary>,
) -> ShapePart {
    ShapePart { name: name.into(), primitives, bsdf, boundary, radiance: None }
}

/// The box, filled with the first medium.
pub(super) fn walls() -> ShapePart {
    let faces = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let fog = MediumBoundary { interior: Some(MediumId(0)), exterior: None };
    part("box", faces.map(|n| square(CENTRE + n, n, 1.0)).into(), Bsdf::Null, Some(fog))
}

/// The floor, its front up.
pub(super) fn floor(bsdf: Bsdf) -> ShapePart {
    part("floor", vec![square(FLOOR, DVec3::Y, 0.9)], bsdf, None)
}

/// A square of half-width `half`, its normal along `towards`.
fn square(centre: DVec3, towards: DVec3, half: f64) -> Primitive {
    let u = if towards.x.abs() > 0.5 { DVec3::Y } else { DVec3::X };
    let v = towards.cross(u);
    Primitive::Planar(Planar::new(centre, half * u, half * v, Outline::Parallelogram))
}
