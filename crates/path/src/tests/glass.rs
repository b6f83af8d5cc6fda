//! Glass: radiance and η², and the delay of light within.

use glam::{DMat3, DVec3};
use tpb_optics::Rgb;
use tpb_scene::{Bsdf, Dielectric, IntegratorSpec, MediumBoundary, Reflector, Scene, ShapePart};

use super::stats::pass;
use super::worlds::{
    BLACK, FOG, ONE_RAY, ball, camera, cuboid, depths, glass, lamp, medium, plate, shape, time,
    tracer,
};

/// A glass ball (radius 1, η = 1.5) in an enclosure that emits radiance 2.
fn furnace(eye: DVec3) -> Scene {
    let mut parts = camera(eye, DVec3::new(0.1, 0.2, 0.0), (50.0, 8, 8));
    parts.shapes.push(shape("ball", vec![ball(DVec3::ZERO, 1.0, false)], glass(1.5)));
    parts.shapes.push(lamp(ball(DVec3::ZERO, 10.0, true), 2.0));
    Scene::assemble(parts).unwrap()
}

#[test]
fn glass_in_a_furnace_is_invisible_and_brighter_by_eta_squared_within() {
    // Every path ends on the enclosure with weight 1 and telescoping η²: no variance. No ray is
    // trapped: rays from outside, or from within radius 1/η, always refract sooner or later.
    let endless = IntegratorSpec { rr_depth: u32::MAX, ..IntegratorSpec::default() };
    for (eye, factor) in [(DVec3::Z * -3.0, 1.0), (DVec3::new(0.3, 0.0, -0.2), 2.25)] {
        let scene = furnace(eye);
        for value in pass::<1>(&tracer(&scene, endless, 4), 31, 0).steady {
            assert!((value / (2.0 * factor) - 1.0).abs() < 1e-12, "{eye}: {value}");
        }
    }
}

#[test]
fn roulette_ignores_eta_squared() {
    // From within, throughput·η² is the importance 1: the roulette's q stays 0.95 and its gains
    // and losses are a few percent of the paths, not the 2.25-fold of radiance.
    let scene = furnace(DVec3::new(0.3, 0.0, -0.2));
    let tracer = tracer::<1>(&scene, IntegratorSpec { rr_depth: 1, ..depths(1, 100) }, 64);
    let got =
        super::stats::estimate(&tracer, 32, 16, |a| vec![a.steady.iter().sum::<f64>() / 64.0]);
    // False-alarm probability 1e-6.
    got.assert_are(&[4.5], 1e-3, "furnace with roulette");
}

/// A plate of glass, `thickness` along z, before a lamp at distance 5.
fn slab(thickness: f64) -> Scene {
    let mut parts = camera(DVec3::ZERO, DVec3::Z, ONE_RAY);
    let half = DMat3::from_diagonal(DVec3::new(3.0, 3.0, 0.5 * thickness));
    parts.shapes.push(shape("slab", cuboid(DVec3::Z * 2.0, half), glass(1.5)));
    parts.shapes.push(lamp(plate(DVec3::Z * 5.0, DVec3::Y, DVec3::X), 4.0));
    parts.film.time = Some(time(5.0 - 5e-7, 7.0 - 5e-7, 2_000_000));
    Scene::assemble(parts).unwrap()
}

#[test]
fn a_slab_delays_by_its_index_and_takes_two_reflections() {
    // Arrival 5 + (η − 1)d in a bin of 1e-6; radiance (1 − R)²L, R = 0.04: a binomial count of
    // paths, 4 standard deviations allowed (false-alarm probability 6e-5).
    let thickness = 0.7;
    let scene = slab(thickness);
    let samples = 40_000;
    let arrays = pass::<1>(&tracer(&scene, depths(3, 3), samples), 33, 0);
    let p: f64 = 0.96 * 0.96;
    let deviation = (p * (1.0 - p) / f64::from(samples)).sqrt();
    assert!((arrays.steady[0] / 4.0 - p).abs() < 4.0 * deviation, "{}", arrays.steady[0]);
    let bin = (0.5 * thickness / 1e-6).round() as usize;
    assert!((f64::from(arrays.pixel(0)[bin]) / arrays.steady[0] - 1.0).abs() < 1e-6);
}

/// An interface across the view at distance z; its normal looks at the camera.
fn across(name: &str, z: f64, (before, behind): (f64, f64)) -> ShapePart {
    let bsdf = Bsdf::Dielectric(Dielectric {
        interior_eta: behind,
        exterior_eta: before,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    });
    shape(name, vec![plate(DVec3::Z * z, 4.0 * DVec3::Y, 4.0 * DVec3::X)], bsdf)
}

/// A lamp at distance 5 seen through liquid (1.33, thickness 0.6, absorbing) on glass (1.5, 0.4),
/// with one interface between the two.
#[test]
fn liquid_on_glass_delays_by_both_indices() {
    let mut parts = camera(DVec3::ZERO, DVec3::Z, ONE_RAY);
    parts.media.push(medium(Rgb::ZERO, Rgb::splat(0.5), 0.0));
    let between = |part: ShapePart, interior, exterior| ShapePart {
        boundary: Some(MediumBoundary { interior, exterior }),
        ..part
    };
    parts.shapes.push(between(across("air-liquid", 2.0, (1.0, 1.33)), Some(FOG), None));
    parts.shapes.push(between(across("liquid-glass", 2.6, (1.33, 1.5)), None, Some(FOG)));
    parts.shapes.push(across("glass-air", 3.0, (1.5, 1.0)));
    parts.shapes.push(lamp(plate(DVec3::Z * 5.0, DVec3::Y, DVec3::X), 4.0));
    parts.film.time = Some(time(5.0 - 5e-7, 7.0 - 5e-7, 2_000_000));
    let scene = Scene::assemble(parts).unwrap();
    let samples = 40_000;
    let arrays = pass::<1>(&tracer(&scene, depths(4, 4), samples), 36, 0);
    let r = |a: f64, b: f64| ((a - b) / (a + b)).powi(2);
    let p = (1.0 - r(1.0, 1.33)) * (1.0 - r(1.33, 1.5)) * (1.0 - r(1.5, 1.0));
    // Four standard deviations of a binomial count.
    let deviation = (p * (1.0 - p) / f64::from(samples)).sqrt();
    let seen = arrays.steady[0] / (4.0 * f64::exp(-0.5 * 0.6));
    assert!((seen - p).abs() < 4.0 * deviation, "{seen} {p}");
    let bin = ((0.33 * 0.6 + 0.5 * 0.4) / 1e-6_f64).round() as usize;
    assert!((f64::from(arrays.pixel(0)[bin]) / arrays.steady[0] - 1.0).abs() < 1e-6);
}

#[test]
fn a_thin_pane_takes_its_reflections_and_no_time() {
    let mut parts = camera(DVec3::ZERO, DVec3::Z, ONE_RAY);
    let Bsdf::Dielectric(pane) = glass(1.5) else { panic!("glass") };
    let pane = Bsdf::ThinDielectric(pane);
    parts.shapes.push(shape("pane", vec![plate(DVec3::Z * 2.0, DVec3::Y, DVec3::X)], pane));
    parts.shapes.push(lamp(plate(DVec3::Z * 5.0, DVec3::Y, DVec3::X), 4.0));
    parts.film.time = Some(time(5.0 - 5e-7, 5.0 + 5e-7, 1));
    let scene = Scene::assemble(parts).unwrap();
    let samples = 40_000;
    let arrays = pass::<1>(&tracer(&scene, depths(2, 2), samples), 37, 0);
    let p: f64 = 1.0 - 2.0 * 0.04 / 1.04;
    let deviation = (p * (1.0 - p) / f64::from(samples)).sqrt();
    assert!((arrays.steady[0] / 4.0 - p).abs() < 4.0 * deviation, "{}", arrays.steady[0]);
    assert!((f64::from(arrays.pixel(0)[0]) / arrays.steady[0] - 1.0).abs() < 1e-6);
}

#[test]
fn an_unwarping_film_counts_from_the_first_surface() {
    let scene = slab(0.7);
    let tracer = tracer::<1>(&scene, depths(3, 3), 100);
    let layout = *super::stats::film(&tracer).layout();
    let options = tpb_film::FilmOptions { unwarp: true, ..Default::default() };
    let mut film = tpb_film::TransientFilm::new(layout, options).unwrap();
    tpb_render::Method::pass(&tracer, tpb_render::PassId { seed: 34, index: 0 }, &mut film);
    let arrays = film.develop();
    // 5.35 − 1.65 = 3.7 is before the window, 5.35 was within.
    assert!(arrays.before[0] > 0.0 && arrays.before[0] == arrays.steady[0]);
}

#[test]
fn a_mirror_shows_the_lamp_at_the_unfolded_distance() {
    let mut parts = camera(DVec3::ZERO, DVec3::Z, ONE_RAY);
    let mirror = Reflector::Mirror(Rgb::splat(0.8));
    let front = plate(DVec3::Z * 3.0, DVec3::Y, DVec3::X);
    let bsdf = Bsdf::Opaque { front: mirror, back: Reflector::Black };
    parts.shapes.push(shape("mirror", vec![front], bsdf));
    parts.shapes.push(lamp(plate(DVec3::Z * -2.0, DVec3::X, DVec3::Y), 5.0));
    let hole = ball(DVec3::new(0.0, 4.0, 0.0), 0.1, false);
    parts.shapes.push(shape("elsewhere", vec![hole], BLACK));
    parts.film.time = Some(time(8.0 - 5e-7, 8.0 + 5e-7, 1));
    let scene = Scene::assemble(parts).unwrap();
    let arrays = pass::<1>(&tracer(&scene, depths(2, 2), 4), 35, 0);
    assert!((arrays.steady[0] - 4.0).abs() < 1e-12);
    assert!((arrays.pixel(0)[0] - 4.0).abs() < 1e-5, "{:?} {:?}", arrays.before, arrays.after);
}
