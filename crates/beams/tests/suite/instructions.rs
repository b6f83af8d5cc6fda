//! All vector instructions that the machine has give the same bits, one number at a time included:
//! what a machine without AVX computes.

use glam::DVec3;
use tpb_beams::{BeamOptions, KernelChoice, PhotonBeams, Temporal};
use tpb_film::{Arrays, FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_lanes::Instructions;
use tpb_optics::{Phase, Rgb};
use tpb_render::{Method, PassId};
use tpb_scene::{Bsdf, Plan, Reflector, Scene};

use crate::scenes;

/// Two passes with some instructions; and the pairs accepted in them.
fn render<const C: usize>(
    scene: &Scene,
    options: &BeamOptions,
    bins: bool,
    instructions: Instructions,
) -> (Arrays, u64) {
    let plan = Plan::new(scene, &scene.integrator);
    let method = PhotonBeams::new(scene, &plan, scene.integrator, options).unwrap();
    let method = method.with_instructions(instructions);
    let time = TimeAxis { start_opl: 0.0, bin_width_opl: 0.07, bins: 200 };
    let (width, height) = (scene.film.width, scene.film.height);
    let layout = Layout::new(width, height, Some(time).filter(|_| bins)).unwrap();
    let film = FilmOptions { variance: true, unwarp: true, ..FilmOptions::default() };
    let mut film = TransientFilm::<C>::new(layout, film).unwrap();
    let mut pairs = 0;
    for index in 0..2 {
        pairs += method.pass(PassId { seed: 3, index }, &mut film).counts.pairs_accepted;
    }
    assert_eq!(film.non_finite(), 0);
    (film.develop(), pairs)
}

fn check<const C: usize>(scene: &Scene, options: &BeamOptions, bins: bool) {
    let (expected, pairs) = render::<C>(scene, options, bins, Instructions::Scalar);
    assert!(pairs > 10_000 && expected.steady.iter().sum::<f64>() > 0.0, "{pairs} pairs");
    for instructions in Instructions::available() {
        let found = render::<C>(scene, options, bins, instructions);
        assert_eq!(found.1, pairs, "{instructions}");
        assert!(found.0 == expected, "{instructions} differ, {options:?}");
    }
}

/// Walls and fog; a mirror, whose rays find beams by bundles; one and three channels; each kernel.
#[test]
fn every_machine_gives_the_same_bits() {
    let mut scene = scenes::cornell_blocks(24);
    let options = |kernel, temporal| BeamOptions {
        kernel: Some(kernel),
        temporal: Some(temporal),
        radius: Some(0.1),
        photons_per_pass: Some(600),
        beam_photons: Some(600),
        gather_samples: Some(1),
        surface_samples: Some(1),
        ..BeamOptions::default()
    };
    let ways = [
        options(KernelChoice::OneD, Temporal::Exact),
        options(KernelChoice::TwoD, Temporal::Exact),
        options(KernelChoice::TwoD, Temporal::Even),
        options(KernelChoice::ThreeD, Temporal::Exact),
    ];
    for options in &ways[..3] {
        check::<1>(&scene, options, true);
        check::<1>(&scene, options, false);
    }
    // The 3D kernel is evaluated pair by pair.
    check::<1>(
        &scene,
        &BeamOptions { photons_per_pass: Some(150), beam_photons: Some(150), ..ways[3].clone() },
        true,
    );
    let mirror = Reflector::Mirror(Rgb::splat(0.9));
    scene.shapes[1].bsdf = Bsdf::Opaque { front: mirror, back: Reflector::Black };
    scene.media[0] = scenes::colored_fog([0.4, 0.5, 0.3], [0.6, 0.5, 0.7], 0.6);
    assert_ne!(scene.media[0].phase, Phase::Isotropic);
    for options in &ways[..3] {
        check::<3>(&scene, options, true);
    }
    // Fog behind the front alone: what lies before a ray's span.
    scene.sensor.position += DVec3::new(0.1, 0.05, -0.2);
    check::<3>(&scene, &ways[0], true);
}
