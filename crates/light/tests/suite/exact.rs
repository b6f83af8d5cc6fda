//! Light on surfaces, and lamps seen directly: exact values, pixel by pixel.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_light::{LightOptions, LightTracer};
use tpb_optics::{Phase, Rgb, Spectrum};
use tpb_scene::{
    EmitterKind, EmitterPart, IntegratorSpec, Medium, MediumId, Plan, Scene, SceneParts,
};

use crate::scenes;
use crate::statistics::{estimate, image_and_blocks, steady};

const LAMP: DVec3 = DVec3::new(0.5, 0.3, 1.0);
const RHO: f64 = 0.6;

/// A diffuse wall at z = 0 seen obliquely at a wide angle, within `medium` everywhere.
fn wall(emitter: EmitterKind, medium: Option<Medium>, fov: f64, bins: usize) -> SceneParts {
    let plate = scenes::rectangle([0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0]);
    let eye = DVec3::new(-0.4, 0.2, 1.5);
    SceneParts {
        shapes: vec![scenes::shape("wall", vec![plate], scenes::diffuse(RHO))],
        background: medium.is_some().then_some(MediumId(0)),
        media: medium.into_iter().collect(),
        textures: vec![],
        emitters: vec![EmitterPart { name: "e".into(), kind: emitter, stated_medium: None }],
        sensor: scenes::camera(eye, DVec3::new(0.3, 0.1, -1.0), fov, (6, 4)),
        film: scenes::film(6, 4, 8.0 / bins as f64, bins),
        integrator: IntegratorSpec { max_depth: Some(2), ..IntegratorSpec::default() },
    }
}

fn options(photons: u64) -> LightOptions {
    LightOptions { photons_per_pass: Some(photons) }
}

/// The mean over each pixel's area of `radiance`, a function of the point on the wall.
fn over_pixels(scene: &Scene, radiance: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let fine = 24;
    let of = |pixel: usize| {
        let mut sum = 0.0;
        for i in 0..fine * fine {
            let offset = |i: usize| (i as f64 + 0.5) / fine as f64;
            let (x, y) = (pixel % 6, pixel / 6);
            let (x, y) = (x as f64 + offset(i % fine), y as f64 + offset(i / fine));
            let direction = scene.sensor.direction(x, y);
            let eye = scene.sensor.position;
            sum += radiance(eye - direction * (eye.z / direction.z));
        }
        sum / (fine * fine) as f64
    };
    (0..24).map(of).collect()
}

/// E = I cosθ/d², L = ρ E/π in every pixel. Midpoint rule of 24² points: 1e-4 relative, far below
/// the standard error of 2 % a pixel at most.
#[test]
fn a_diffuse_wall_shows_the_irradiance_of_a_point() {
    let intensity = 3.0;
    let kind = EmitterKind::Point { position: LAMP, intensity: Rgb::splat(intensity) };
    let scene = Scene::assemble(wall(kind, None, 75.0, 4)).expect("a scene");
    let expected = over_pixels(&scene, |point| {
        let to_lamp = LAMP - point;
        RHO / PI * intensity * to_lamp.z / to_lamp.length().powi(3)
    });
    let plan = Plan::new(&scene, &scene.integrator);
    let method = LightTracer::<1>::new(&scene, &plan, scene.integrator, &options(60_000));
    let found = estimate(&method.expect("options"), &scene.film, (1, 64), steady);
    found.assert_are(&expected, 0.02, "wall");
}

/// In an absorbing medium of index 1.5: L as in vacuum but for the transmittance of both legs, each
/// arrival 1.5 times as late.
#[test]
fn absorption_and_index_act_on_both_legs() {
    let (sigma_t, eta) = (0.4, 1.5);
    let medium = Medium {
        name: "oil".into(),
        coefficients: tpb_optics::Coefficients { sigma_s: Rgb::ZERO, sigma_t: Rgb::splat(sigma_t) },
        phase: Phase::Isotropic,
        eta: Some(eta),
    };
    let kind = EmitterKind::Point { position: LAMP, intensity: Rgb::ONE };
    let scene = Scene::assemble(wall(kind, Some(medium), 75.0, 16)).expect("a scene");
    let eye = scene.sensor.position;
    assert!(scene.sensor.region.eta == eta);
    let legs = |point: DVec3| ((LAMP - point).length(), (eye - point).length());
    let radiance = |point: DVec3| {
        let (a, b) = legs(point);
        RHO / PI * (LAMP - point).z / a.powi(3) * (-sigma_t * (a + b)).exp()
    };
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
    let mut expected = vec![mean(over_pixels(&scene, radiance))];
    for bin in 0..16 {
        let edges = (0.5 * f64::from(bin), 0.5 * f64::from(bin + 1));
        expected.push(mean(over_pixels(&scene, |point| {
            let opl = eta * (legs(point).0 + legs(point).1);
            if (edges.0..edges.1).contains(&opl) { radiance(point) } else { 0.0 }
        })));
    }
    assert!(expected[1..].iter().filter(|&&bin| bin > 0.1 * expected[0]).count() > 1);
    let plan = Plan::new(&scene, &scene.integrator);
    let method = LightTracer::<1>::new(&scene, &plan, scene.integrator, &options(40_000));
    let method = method.expect("options");
    let found = estimate(&method, &scene.film, (2, 64), image_and_blocks(16));
    // The edge between bins makes the quadrature of each rough: below 1 % of the image.
    for (i, (&mean, &expected_here)) in found.means.iter().zip(&expected).enumerate() {
        let off = (mean - expected_here).abs();
        let rough = if i == 0 { 1e-4 } else { 0.01 };
        let allowed = 6.5 * found.errors[i] + rough * expected[0];
        assert!(off <= allowed, "{i}: {mean} {expected_here}");
    }
    assert!(found.errors[0] < 2e-3 * expected[0]);
}

/// A lamp that fills some pixels: radiance exactly in the mean, in an order of its own.
#[test]
fn a_lamp_seen_directly_has_its_radiance() {
    let radiance = 7.0;
    let mut lamp = scenes::shape(
        "lamp",
        vec![scenes::rectangle([0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0])],
        scenes::diffuse(0.5),
    );
    lamp.radiance = Some(Rgb::splat(radiance));
    let integrator = IntegratorSpec { max_depth: Some(1), ..IntegratorSpec::default() };
    let scene = Scene::assemble(SceneParts {
        shapes: vec![lamp],
        media: vec![],
        textures: vec![],
        emitters: vec![],
        background: None,
        sensor: scenes::camera(
            DVec3::new(0.3, -0.2, 2.0),
            DVec3::new(0.4, 0.2, -1.0),
            70.0,
            (3, 2),
        ),
        film: scenes::film(3, 2, 10.0, 1),
        integrator,
    })
    .expect("a scene");
    let plan = Plan::new(&scene, &integrator);
    let method =
        LightTracer::<1>::new(&scene, &plan, integrator, &options(40_000)).expect("options");
    let found = estimate(&method, &scene.film, (3, 64), steady);
    found.assert_are(&[radiance; 6], 0.02, "lamp");
    let deeper = IntegratorSpec { min_depth: 2, max_depth: Some(9), ..integrator };
    let plan = Plan::new(&scene, &deeper);
    let method = LightTracer::<1>::new(&scene, &plan, deeper, &options(1000)).expect("options");
    let found = estimate(&method, &scene.film, (4, 2), steady);
    assert_eq!(found.means, [0.0; 6], "nothing is lit");
}

/// A laser's spot, which the path tracer cannot find: ρ/π · Φ/(π a²) all over it. The narrow view
/// stays within the spot.
#[test]
fn a_laser_lights_a_wall() {
    let (power, radius) = (2.0, 0.5);
    let target = DVec3::new(0.05, 0.35, 0.0);
    let kind = EmitterKind::Laser {
        position: target + DVec3::Z,
        axis: -DVec3::Z,
        radius,
        power: Rgb::splat(power),
    };
    let scene = Scene::assemble(wall(kind, None, 8.0, 4)).expect("a scene");
    let expected = over_pixels(&scene, |point| {
        assert!((point - target).length() < radius, "{point}");
        RHO * power / (PI * radius).powi(2)
    });
    let plan = Plan::new(&scene, &scene.integrator);
    let method = LightTracer::<1>::new(&scene, &plan, scene.integrator, &options(20_000));
    let found = estimate(&method.expect("options"), &scene.film, (5, 64), steady);
    found.assert_are(&expected, 0.03, "laser");
}

/// Three channels of a coloured wall under coloured light, where every photon sees all three: the
/// channels are to each other as the factors are.
#[test]
fn colours_multiply() {
    let kind = EmitterKind::Point { position: LAMP, intensity: Spectrum([1.0, 2.0, 0.5]) };
    let mut parts = wall(kind, None, 60.0, 4);
    parts.shapes[0].bsdf = tpb_scene::Bsdf::Opaque {
        front: tpb_scene::Reflector::Diffuse(Spectrum([0.5, 0.1, 0.8])),
        back: tpb_scene::Reflector::Black,
    };
    let scene = Scene::assemble(parts).expect("a scene");
    let plan = Plan::new(&scene, &scene.integrator);
    let method = LightTracer::<3>::new(&scene, &plan, scene.integrator, &options(5000));
    let found = estimate(&method.expect("options"), &scene.film, (6, 2), steady);
    for rgb in found.means.chunks(3) {
        assert!((rgb[1] / rgb[0] - 0.4).abs() < 1e-9 && (rgb[2] / rgb[0] - 0.8).abs() < 1e-9);
    }
}
