//! Scattering media: against the path tracer, which works from the other end.

use std::num::NonZeroU32;

use glam::DVec3;
use tpb_light::{LightOptions, LightTracer};
use tpb_optics::Rgb;
use tpb_path::{PathOptions, PathTracer};
use tpb_scene::{Bsdf, IntegratorSpec, Medium, MediumBoundary, MediumId, Plan, Scene, SceneParts};

use crate::scenes;
use crate::statistics::{Estimates, estimate, image_and_blocks};

const BLOCKS: usize = 4;

/// A ball of fog with a round lamp in it (a point would make the path tracer's variance infinite),
/// before a diffuse floor, within a medium that only
/// absorbs; the eye is outside of the fog.
fn ball(fog: Medium, integrator: IntegratorSpec) -> Scene {
    let mut ball = scenes::shape("fog", vec![scenes::sphere(DVec3::ZERO, 1.0, false)], Bsdf::Null);
    let haze = Some(MediumId(1));
    ball.boundary = Some(MediumBoundary { interior: Some(MediumId(0)), exterior: haze });
    let floor = scenes::rectangle([0.0, -1.2, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]);
    let mut absorber = scenes::fog(0.0, 0.1, 0.0);
    absorber.name = "haze".into();
    let at = DVec3::new(0.3, 0.4, -0.1);
    let black = scenes::diffuse(0.0);
    let mut lamp = scenes::shape("lamp", vec![scenes::sphere(at, 0.2, false)], black);
    lamp.radiance = Some(Rgb::splat(9.0));
    Scene::assemble(SceneParts {
        shapes: vec![ball, lamp, scenes::shape("floor", vec![floor], scenes::diffuse(0.7))],
        media: vec![fog, absorber],
        textures: vec![],
        emitters: vec![],
        background: haze,
        sensor: scenes::camera(
            DVec3::new(0.2, 0.6, 3.0),
            DVec3::new(-0.2, -0.6, -3.0),
            50.0,
            (4, 4),
        ),
        film: scenes::film(4, 4, 0.5, 4 * BLOCKS),
        integrator,
    })
    .expect("a scene")
}

fn light<const C: usize>(scene: &Scene, seed: u64, photons: u64, batches: u64) -> Estimates {
    let plan = Plan::new(scene, &scene.integrator);
    let options = LightOptions { photons_per_pass: Some(photons) };
    let method = LightTracer::<C>::new(scene, &plan, scene.integrator, &options);
    let method = method.expect("options");
    estimate(&method, &scene.film, (seed, batches), image_and_blocks(BLOCKS))
}

fn path<const C: usize>(scene: &Scene, seed: u64, samples: u32, batches: u64) -> Estimates {
    let plan = Plan::new(scene, &scene.integrator);
    let options = PathOptions { samples_per_pass: NonZeroU32::new(samples) };
    let method = PathTracer::<C>::new(scene, &plan, scene.integrator, &options);
    estimate(&method, &scene.film, (seed, batches), image_and_blocks(BLOCKS))
}

/// Single scattering, double, and the rest; isotropic and forward. The first is cheap to know well:
/// weights that are wrong by a few percent show there.
#[test]
fn orders_of_scattering_agree_with_the_path_tracer() {
    let cases = [(2, 2, 0.0, 5, 0.006), (3, 3, -0.5, 1, 0.03), (2, 7, 0.7, 1, 0.03)];
    for (min, max, g, effort, precision) in cases {
        let depths = IntegratorSpec {
            min_depth: min,
            max_depth: Some(max),
            rr_depth: 4,
            ..IntegratorSpec::default()
        };
        let scene = ball(scenes::fog(1.2, 1.5, g), depths);
        let (seed, what) = (10 + u64::from(min), format!("depths {min} to {max}, g {g}"));
        let light = light::<1>(&scene, seed, 12_000 * u64::from(effort), 32);
        let path = path::<1>(&scene, seed + 50, 900 * effort, 32);
        light.assert_agree(&path, precision, &what);
    }
}

/// Colour: the mixture over channels; a channel that barely interacts, one that is dense.
#[test]
fn coloured_fog_agrees_with_the_path_tracer() {
    let depths = IntegratorSpec { max_depth: Some(5), ..IntegratorSpec::default() };
    let fog = scenes::colored_fog([1.0, 0.1, 3.0], [1.1, 0.1, 4.0], 0.3);
    let scene = ball(fog, depths);
    let light = light::<3>(&scene, 31, 15_000, 32);
    light.assert_agree(&path::<3>(&scene, 81, 1600, 32), 0.04, "colour");
}

/// One and three channels of a grey scene.
#[test]
fn grey_in_three_channels_is_grey_in_one() {
    let depths = IntegratorSpec { max_depth: Some(4), ..IntegratorSpec::default() };
    let scene = ball(scenes::fog(1.2, 1.5, 0.3), depths);
    let three = light::<3>(&scene, 41, 10_000, 32);
    let one = light::<1>(&scene, 42, 10_000, 32);
    for channel in 0..3 {
        let means = three.means.iter().skip(channel).step_by(3).copied().collect();
        let errors = three.errors.iter().skip(channel).step_by(3).copied().collect();
        one.with(means, errors).assert_agree(&one, 0.02, "grey");
    }
}

/// The eye in fog: flights pass it as closely as they like. Single scattering close to the eye
/// arrives at the lamp's own distance, 2 m; from 2.5 m on the scattering is at least 0.25 m away, the
/// variance is finite, and Student's t holds.
#[test]
fn an_eye_in_fog_agrees_with_the_path_tracer_away_from_itself() {
    let integrator = IntegratorSpec { max_depth: Some(2), ..IntegratorSpec::default() };
    let parts = scenes::infinite(
        scenes::fog(0.5, 0.6, 0.3),
        scenes::point(DVec3::new(0.0, 1.6, -1.2), Rgb::ONE),
        scenes::camera(DVec3::ZERO, -DVec3::Z, 40.0, (4, 4)),
        scenes::film(4, 4, 0.5, 16),
    );
    let scene = Scene::assemble(SceneParts { integrator, ..parts }).expect("a scene");
    let plan = Plan::new(&scene, &integrator);
    let late = |arrays: &tpb_film::Arrays| {
        let blocks = image_and_blocks(16)(arrays);
        // The first is the steady image, then bins.
        (0..4).map(|i| blocks[6 + 2 * i] + blocks[7 + 2 * i]).collect::<Vec<_>>()
    };
    let options = LightOptions { photons_per_pass: Some(20_000) };
    let light = LightTracer::<1>::new(&scene, &plan, integrator, &options).expect("options");
    let options = PathOptions { samples_per_pass: NonZeroU32::new(400) };
    let path = PathTracer::<1>::new(&scene, &plan, integrator, &options);
    let light = estimate(&light, &scene.film, (51, 40), late);
    light.assert_agree(&estimate(&path, &scene.film, (52, 40), late), 0.02, "in fog");
}
