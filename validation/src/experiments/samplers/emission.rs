//! Photons as they leave emitters of every kind.
//!
//! * Direction: uniform over the sphere (point), uniform over the cone with a weight (spot), along
//!   the axis (laser, directional), cosine around the normal (area).
//! * Position: uniform over each kind of emitting primitive, over primitives of unequal area by
//!   area, over the disc of a laser, over the disc that covers all shapes (directional).
//! * Weight: the spot's power per angle against intensity · falloff · solid angle, in batches.
//! * Choice: one of several emitters, by power; points to connect to, by power and area, and the
//!   density that is stated for them.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};
use tpb_optics::{Rgb, Stream};
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, Emission, EmitterKind, EmitterPart, FovAxis, Hit, IntegratorSpec, Primitive, Reflector,
    Scene, Sensor, ShapePart,
};

use super::Draws;
use super::histogram::{Grid, Tested, test};
use super::surfaces::{Case, cases, unit_square};
use super::{axes, polar};
use crate::error::Result;
use crate::scenes::View;
use crate::statistics::{Batches, Criterion, Target, judge};

pub(super) fn tests(samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let mut tests = points(samples, seed)?;
    tests.extend(spot(samples, seed)?);
    tests.extend(laser(samples, seed)?);
    tests.extend(directional(samples, seed)?);
    for case in cases() {
        tests.extend(area(case, samples, seed)?);
    }
    tests.extend(choice(samples, seed)?);
    Ok(tests)
}

fn scene(emitters: Vec<EmitterKind>, lamps: Vec<(Vec<Primitive>, f64)>) -> Result<Scene> {
    let view = View { pixels: 1, fov: 10.0, time: None, integrator: IntegratorSpec::default() };
    let mut parts = view.parts();
    // Nobody looks; but a camera may not stand on a lamp.
    parts.sensor = Sensor::perspective(
        DAffine3::from_translation(DVec3::splat(1e3)),
        view.fov,
        FovAxis::X,
        view.pixels,
        view.pixels,
    );
    let part = |kind| EmitterPart { name: "lamp".into(), kind, stated_medium: None };
    parts.emitters = emitters.into_iter().map(part).collect();
    parts.shapes = lamps
        .into_iter()
        .map(|(primitives, radiance)| ShapePart {
            name: "shape".into(),
            primitives,
            bsdf: Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black },
            boundary: None,
            radiance: Some(Rgb::splat(radiance)),
        })
        .collect();
    Ok(Scene::assemble(parts)?)
}

/// A photon of a scene that has light.
fn photon(scene: &Scene, rng: &mut Stream) -> Emission<1> {
    scene.emit::<1>(rng).expect("the scene has light")
}

const AXIS: DVec3 = DVec3::new(0.48, -0.6, 0.64);

fn points(samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let position = DVec3::new(1.0, 2.0, 3.0);
    let scene = scene(vec![EmitterKind::Point { position, intensity: Rgb::ONE }], vec![])?;
    let sample = |rng: &mut Stream| polar(photon(&scene, rng).direction, axes(DVec3::Z));
    let directions =
        test("point: direction", Grid::SPHERE, samples, seed, sample, |_, _| 0.25 / PI);
    let mut rng = Stream::new(seed.seed, 2, 0);
    let sound = (0..1000).all(|_| {
        let p = photon(&scene, &mut rng);
        p.position == position && (p.power[0] / (4.0 * PI) - 1.0).abs() < 1e-14
    });
    Ok(vec![directions, Tested::exact("point: position and power", sound)])
}

fn spot(samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let (cutoff, beam) = (35.0_f64.to_radians(), 20.0_f64.to_radians());
    let kind = EmitterKind::Spot {
        position: DVec3::ZERO,
        axis: AXIS,
        intensity: Rgb::splat(3.0),
        cos_cutoff: cutoff.cos(),
        cos_beam: beam.cos(),
    };
    let scene = scene(vec![kind], vec![])?;
    let around = axes(AXIS);
    let range = [cutoff.cos() - 1e-12, 1.0];
    let density = |_: f64, _: f64| 1.0 / (2.0 * PI * (range[1] - range[0]));
    let sample = |rng: &mut Stream| polar(photon(&scene, rng).direction, around);
    let directions = test("spot: direction", Grid::band(range), samples, seed, sample, density);
    // Power in rings of equal solid angle, midpoint rule for the expectation.
    let rings = 10;
    let falloff = |theta: f64| ((cutoff - theta) / (cutoff - beam)).clamp(0.0, 1.0);
    let expected = |ring: usize| {
        let n = 20_000;
        let width = (1.0 - range[0]) / (rings * n) as f64;
        let cosine = |i: usize| range[0] + ((ring * n + i) as f64 + 0.5) * width;
        (0..n).map(|i| 3.0 * falloff(cosine(i).acos()) * 2.0 * PI * width).sum::<f64>()
    };
    let targets: Vec<Target> = (0..rings)
        .map(|ring| {
            let expected = expected(ring);
            Target { name: format!("ring {ring}"), expected, error: 1e-6 * expected }
        })
        .collect();
    let mut batches = Batches::new();
    let per_batch = samples / 32;
    for batch in 0..32 {
        let mut rng = Stream::new(seed.seed, batch, 3);
        let mut power = vec![0.0; rings];
        for _ in 0..per_batch {
            let p = photon(&scene, &mut rng);
            let ring = (p.direction.dot(AXIS) - range[0]) / (range[1] - range[0]);
            power[((ring * rings as f64) as usize).min(rings - 1)] += p.power[0] / per_batch as f64;
        }
        batches.push(power);
    }
    // The group's Holm correction judges the p value.
    let criterion = Criterion { margin: 0.005, confidence: 0.99, level: 1.0 };
    let judgement = judge(&targets, &batches, &criterion);
    let detail = format!("interval {:?}", judgement.interval);
    let weights = Tested { name: "spot: power per angle".into(), detail, p: judgement.worst_p };
    Ok(vec![directions, weights])
}

fn laser(samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let (position, radius) = (DVec3::new(0.3, 0.0, -1.0), 0.25);
    let kind = EmitterKind::Laser { position, axis: AXIS, radius, power: Rgb::splat(2.0) };
    let scene = scene(vec![kind], vec![])?;
    let [x, y, _] = axes(AXIS);
    let grid = Grid { x: [0.0, 1.0], y: [-PI, PI], cells: [21, 31] };
    let sample = |rng: &mut Stream| {
        let d = photon(&scene, rng).position - position;
        [(d.length() / radius).min(1.0), d.dot(y).atan2(d.dot(x))]
    };
    let positions = test("laser: position", grid, samples, seed, sample, |r, _| r / PI);
    let mut rng = Stream::new(seed.seed, 4, 0);
    let sound = (0..1000).all(|_| {
        let p = photon(&scene, &mut rng);
        p.direction == AXIS && p.power[0] == 2.0 && (p.position - position).dot(AXIS).abs() < 1e-14
    });
    Ok(vec![positions, Tested::exact("laser: direction and power", sound)])
}

/// The disc of directional light around a plate of 6 m × 2 m about (1, 0, 0): the box's half
/// diagonal is √10 m, and 0.1 % more.
fn directional(samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let plate = Planar::new(DVec3::X, 3.0 * DVec3::X, DVec3::Y, Outline::Parallelogram);
    let (position, radius, irradiance) = (DVec3::ZERO, 0.0, Rgb::splat(2.0));
    let kind = EmitterKind::Directional { axis: AXIS, irradiance, position, radius };
    let scene = scene(vec![kind], vec![(vec![Primitive::Planar(plate)], 0.0)])?;
    let radius = 1.001 * 10.0_f64.sqrt();
    let centre = DVec3::X - radius * AXIS;
    let [x, y, _] = axes(AXIS);
    let grid = Grid { x: [0.0, 1.0], y: [-PI, PI], cells: [21, 31] };
    let sample = |rng: &mut Stream| {
        let d = photon(&scene, rng).position - centre;
        [(d.length() / radius).min(1.0), d.dot(y).atan2(d.dot(x))]
    };
    let positions = test("directional: position", grid, samples, seed, sample, |r, _| r / PI);
    let mut rng = Stream::new(seed.seed, 8, 0);
    let power = 2.0 * PI * radius * radius;
    let sound = (0..1000).all(|_| {
        let p = photon(&scene, &mut rng);
        let in_plane = (p.position - centre).dot(AXIS).abs() < 1e-12;
        // What is connected to is what photons bring: the irradiance, from the point of the disc.
        let receiver = p.position + (1.0 + 4.0 * rng.uniform()) * AXIS;
        let light = scene.sample_light(&mut rng).expect("the scene has light");
        let incident = scene.incident::<1>(&light, receiver).expect("it is lit");
        let from = receiver + incident.distance * incident.direction;
        let beside = receiver + 2.001 * radius * x;
        p.direction == AXIS
            && (p.power[0] / power - 1.0).abs() < 1e-12
            && in_plane
            && (from - p.position).length() < 1e-12
            && (incident.flux[0] / light.pdf - 2.0).abs() < 1e-12
            && scene.incident::<1>(&light, beside).is_none()
            && scene.incident::<1>(&light, p.position - AXIS).is_none()
    });
    Ok(vec![positions, Tested::exact("directional: direction, power and connections", sound)])
}

/// One emitting primitive: positions, directions, and points to connect to.
fn area(case: Case, samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let Case { name, primitive, grid, natural, density, .. } = case;
    let normal = {
        let primitive = primitive.clone();
        move |position| primitive.normal(position)
    };
    let power = PI * primitive.area() * 5.0;
    let scene = scene(vec![], vec![(vec![primitive], 5.0)])?;
    let positions = test(
        format!("{name} lamp: position"),
        grid,
        samples,
        seed,
        |rng| natural(photon(&scene, rng).position),
        density,
    );
    let sample = |rng: &mut Stream| {
        let p = photon(&scene, rng);
        polar(p.direction, axes(normal(p.position)))
    };
    let directions = test(
        format!("{name} lamp: direction"),
        Grid::band([0.0, 1.0]),
        samples,
        seed,
        sample,
        |c, _| c / PI,
    );
    let connections = test(
        format!("{name} lamp: point to connect to"),
        grid,
        samples,
        seed,
        |rng| natural(scene.sample_light(rng).expect("it can be connected to").position),
        density,
    );
    let mut rng = Stream::new(seed.seed, 5, 0);
    let sound = (0..1000).all(|_| {
        let p = photon(&scene, &mut rng);
        (p.power[0] / power - 1.0).abs() < 1e-12 && p.primitive == Some(0)
    });
    Ok(vec![
        positions,
        directions,
        connections,
        Tested::exact(format!("{name} lamp: power"), sound),
    ])
}

/// Several emitters, one of them two triangles of unequal area.
fn choice(samples: u64, seed: Draws) -> Result<Vec<Tested>> {
    let triangle = |x: f64, size: f64| {
        let origin = DVec3::new(x, 0.0, 0.0);
        let (u, v) = (size * DVec3::X, size * DVec3::Y);
        Primitive::Planar(Planar::new(origin, u, v, Outline::Triangle))
    };
    let point = EmitterKind::Point { position: DVec3::Z, intensity: Rgb::ONE };
    let (position, axis) = (DVec3::NEG_X, DVec3::Z);
    let laser = EmitterKind::Laser { position, axis, radius: 0.1, power: Rgb::splat(7.0) };
    let scene =
        scene(vec![point, laser], vec![(vec![triangle(0.0, 1.0), triangle(3.0, 2.0)], 2.0)])?;
    let powers = [4.0 * PI, 7.0, 2.0 * PI * 2.5];
    let total: f64 = powers.iter().sum();
    let connectable = total - powers[1];
    let (mut emitted, mut connected, mut triangles) = ([0_u64; 3], [0_u64; 3], [0_u64; 2]);
    let mut rng = Stream::new(seed.seed, 6, 0);
    let (mut power, mut stated) = (true, true);
    for _ in 0..samples {
        let p = photon(&scene, &mut rng);
        emitted[p.emitter] += 1;
        power &= (p.power[0] / total - 1.0).abs() < 1e-12;
        if let Some(primitive) = p.primitive {
            triangles[primitive as usize] += 1;
        }
        let Some(light) = scene.sample_light(&mut rng) else { continue };
        connected[light.emitter] += 1;
        if let (Some(primitive), Some(normal)) = (light.primitive, light.normal) {
            let hit = Hit { distance: 1.0, primitive, position: light.position, normal };
            let density = powers[2] / connectable / 2.5;
            stated &= (scene.light_pdf(&hit) / density - 1.0).abs() < 1e-12
                && (light.pdf / density - 1.0).abs() < 1e-12;
        }
    }
    let shares = |powers: [f64; 3], total: f64| powers.map(|p| p / total);
    let (grid, uniform) = unit_square();
    let within = test(
        "mesh lamp: position within its triangles",
        grid,
        samples,
        seed,
        |rng| loop {
            let p = photon(&scene, rng);
            let Some(primitive) = p.primitive else { continue };
            let size = f64::from(primitive + 1);
            let d = (p.position - DVec3::new(3.0 * f64::from(primitive), 0.0, 0.0)) / size;
            // Uniform over the triangle, made uniform over the square.
            break [1.0 - (1.0 - d.x) * (1.0 - d.x), (d.y / (1.0 - d.x)).clamp(0.0, 1.0)];
        },
        uniform,
    );
    Ok(vec![
        Tested::discrete("choice of an emitter", &emitted, &shares(powers, total)),
        Tested::discrete(
            "choice of an emitter to connect to",
            &connected,
            &shares([powers[0], 0.0, powers[2]], connectable),
        ),
        Tested::discrete("choice of a triangle", &triangles, &[0.2, 0.8]),
        Tested::exact("power of a chosen emitter's photon", power),
        Tested::exact("stated density of points on lamps", stated),
        within,
    ])
}
