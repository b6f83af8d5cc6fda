//! Rays that look for lamps: the same light, with less noise.

use glam::DVec3;
use tpb_beams::BeamOptions;
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor};
use tpb_optics::{Rgb, Spectrum};
use tpb_scene::{Bsdf, IntegratorSpec, Plan, Reflector, RoughMetal, Scene, SceneParts};

use crate::scenes;
use crate::transport::render_passes;

const RUNS: u64 = 64;

/// A lamp on the left, a mirror on the right that shows it, a floor of rough metal below.
fn scene() -> Scene {
    let one_sided = |front| Bsdf::Opaque { front, back: Reflector::Black };
    let mut lamp = scenes::shape(
        "lamp",
        vec![scenes::rectangle([-0.6, 0.13, 0.0], [0.31, 0.0, 0.0], [0.0, 0.27, 0.0])],
        scenes::diffuse(0.0),
    );
    lamp.radiance = Some(Rgb::splat(3.0));
    let mirror = one_sided(Reflector::Mirror(Spectrum([0.9; 3])));
    let ggx = Ggx::new(0.2);
    let surface = RoughConductor { ggx, metal: Metal::Perfect };
    let metal = one_sided(Reflector::Rough(RoughMetal { surface, reflectance: Rgb::ONE }));
    let shapes = vec![
        lamp,
        scenes::shape(
            "mirror",
            vec![scenes::rectangle([0.4, 0.0, 1.2], [0.0, 0.0, 1.2], [0.0, 1.0, 0.0])],
            mirror,
        ),
        scenes::shape(
            "floor",
            vec![scenes::rectangle([0.0, -0.7, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0])],
            metal,
        ),
    ];
    Scene::assemble(SceneParts {
        shapes,
        media: vec![],
        textures: vec![],
        emitters: vec![],
        background: None,
        sensor: scenes::camera(DVec3::new(0.0, 0.0, 3.0), -DVec3::Z, 60.0, (12, 12)),
        film: scenes::film(12, 12, 0.1, 60),
        integrator: IntegratorSpec { max_depth: Some(3), ..IntegratorSpec::default() },
    })
    .expect("the scene is consistent")
}

/// Mean and squared standard error of a value.
fn mean(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (mean, squares / (n * (n - 1.0)))
}

/// Sums over left half, right half and floor, of all bins, with and without: within 6 standard
/// errors of 64 runs each (false-alarm probability below 1e-7 each), and less noise where the lamp
/// is seen straight and in the mirror.
#[test]
fn rays_to_lamps_bring_the_same_light_with_less_noise() {
    let scene = scene();
    let plan = Plan::new(&scene, &scene.integrator);
    assert!(plan.lamp_rays && !plan.rough.is_empty() && !plan.mirrors.is_empty());
    // 12 rows of 12 pixels; the floor fills the lowest third.
    let part = |which: usize, pixel: usize| match which {
        0 => pixel / 12 < 8 && pixel % 12 < 6,
        1 => pixel / 12 < 8 && pixel % 12 >= 6,
        _ => pixel / 12 >= 8,
    };
    let sums = |samples: u32| -> [Vec<f64>; 3] {
        let lamp_samples = Some(samples);
        let options = BeamOptions { lamp_samples, light_samples: Some(2), ..Default::default() };
        let runs: Vec<_> = (0..RUNS)
            .map(|run| render_passes(&scene, scene.integrator, &options, run..run + 1).0.steady)
            .collect();
        [0, 1, 2].map(|which| {
            let sum = |steady: &Vec<f64>| {
                (0..144).filter(|&pixel| part(which, pixel)).map(|pixel| steady[pixel]).sum()
            };
            runs.iter().map(sum).collect()
        })
    };
    let (with, without) = (sums(64), sums(0));
    for which in 0..3 {
        let ((a, va), (b, vb)) = (mean(&with[which]), mean(&without[which]));
        assert!(b > 0.0 && (a - b).abs() < 6.0 * (va + vb).sqrt(), "{which}: {a} {b}");
        if which < 2 {
            // An F distribution of 63 and 63 degrees of freedom is above 5 with probability 1e-9.
            assert!(5.0 * va < vb, "{which}: {va} {vb}");
        }
    }
}

#[test]
fn pixels_far_from_lamps_get_no_more_rays() {
    let scene = scene();
    let first = |samples: u32| {
        let lamp_samples = Some(samples);
        let options = BeamOptions { lamp_samples, ..Default::default() };
        render_passes(&scene, scene.integrator, &options, 0..1).0
    };
    let (with, without) = (first(64), first(0));
    // The floor's last row is as before, and not all is.
    let changed = |pixel: usize| with.steady[pixel].to_bits() != without.steady[pixel].to_bits();
    assert!((132..144).all(|pixel| with.steady[pixel] > 0.0 && !changed(pixel)));
    assert!((0..96).any(changed));
}
