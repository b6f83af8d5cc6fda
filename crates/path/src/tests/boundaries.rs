//! Null boundaries change nothing but the media.

use glam::{DMat3, DVec3};
use tpb_optics::{Rgb, Spectrum};
use tpb_scene::{Bsdf, IntegratorSpec, Scene};

use super::stats::pass;
use super::worlds::{camera, cuboid, diffuse, filled, lamp, medium, plate, shape, time, tracer};

/// A cube of fog on a floor under a lamp outside it; `split` puts null plates into the fog.
fn scene(split: bool) -> Scene {
    let mut parts = camera(DVec3::new(0.3, 1.0, -5.0), DVec3::ZERO, (35.0, 8, 8));
    parts.media.push(medium(Spectrum([0.7, 0.4, 0.9]), Spectrum([0.9, 0.5, 1.0]), 0.3));
    let turned = DMat3::from_rotation_y(0.4);
    let fog = shape("fog", cuboid(DVec3::ZERO, turned), Bsdf::Null);
    parts.shapes.push(filled(fog, None));
    if split {
        let planes = [
            plate(DVec3::new(0.1, 0.0, 0.2), DVec3::X * 0.6, DVec3::new(0.0, 0.7, 0.1)),
            plate(DVec3::new(0.0, 0.3, 0.0), DVec3::X * 0.7, DVec3::Z * 0.7),
        ];
        parts.shapes.push(shape("split", planes.to_vec(), Bsdf::Null));
    }
    let floor = plate(DVec3::Y * -1.5, DVec3::Z * 3.0, DVec3::X * 3.0);
    parts.shapes.push(shape("floor", vec![floor], diffuse(Rgb::splat(0.5))));
    parts.shapes.push(lamp(plate(DVec3::Y * 2.0, DVec3::X * 0.5, DVec3::Z * 0.5), 9.0));
    parts.film.time = Some(time(0.0, 20.0, 10));
    Scene::assemble(parts).unwrap()
}

#[test]
fn splitting_a_medium_changes_nothing() {
    // Null crossings use no random number: both renders follow the same paths, up to rounding.
    let integrator =
        IntegratorSpec { max_depth: Some(20), rr_depth: 6, ..IntegratorSpec::default() };
    let (whole, split) = (scene(false), scene(true));
    let a = pass::<3>(&tracer(&whole, integrator, 50), 41, 0);
    let b = pass::<3>(&tracer(&split, integrator, 50), 41, 0);
    for (a, b) in a.steady.iter().zip(&b.steady) {
        assert!((a - b).abs() <= 1e-9 * a, "{a} {b}");
    }
    for (a, b) in a.transient.iter().zip(&b.transient) {
        assert!((a - b).abs() <= 1e-6 * a.abs(), "{a} {b}");
    }
}
