//! Photons and whole passes: the ledger, depths, threads, and light that is known.

use std::ops::Range;

use glam::DVec3;
use tpb_beams::photons::PhotonTracer;
use tpb_beams::{BeamLength, BeamOptions, KernelChoice, PhotonBeams, Sampler, Sampling, Temporal};
use tpb_film::{Arrays, FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_optics::{Rgb, Spectrum, Stream};
use tpb_render::{Method, PassId, PassReport};
use tpb_scene::{
    Bsdf, Dielectric, EmitterKind, EmitterPart, IntegratorSpec, MediumBoundary, MediumId, Plan,
    Reflector, Scene, SceneParts,
};
use tpb_transport::{Part, Photon, PhotonBatch, PhotonVisitor, SurfaceArrival};

use crate::scenes;

const SAMPLING: Sampling = Sampling { sampler: Sampler::Sobol, thin_from: 1, horizon: None };

/// Runs passes and develops the film.
pub(crate) fn render(
    scene: &Scene,
    integrator: IntegratorSpec,
    options: &BeamOptions,
    passes: u64,
) -> (Arrays, PassReport) {
    render_passes(scene, integrator, options, 0..passes)
}

/// Only these passes.
pub(crate) fn render_passes(
    scene: &Scene,
    integrator: IntegratorSpec,
    options: &BeamOptions,
    passes: Range<u64>,
) -> (Arrays, PassReport) {
    let plan = Plan::new(scene, &integrator);
    let method = PhotonBeams::new(scene, &plan, integrator, options).expect("sound options");
    let axis = scene.film.time.map(|t| TimeAxis {
        start_opl: t.start_opl,
        bin_width_opl: t.bin_width_opl,
        bins: t.bins,
    });
    let layout = Layout::new(scene.film.width, scene.film.height, axis).expect("a film");
    let statistics = FilmOptions { variance: true, ..Default::default() };
    let mut film = TransientFilm::<1>::new(layout, statistics).expect("a film");
    let mut report = PassReport::default();
    for index in passes {
        report.add(&method.pass(PassId { seed: 5, index }, &mut film));
    }
    assert_eq!(film.non_finite(), 0);
    (film.develop(), report)
}

/// A closed box of fog with a mirror, a glass ball, and a null ball of another, coloured fog.
fn everything(integrator: IntegratorSpec) -> Scene {
    let wall =
        |centre, u, v, bsdf| scenes::shape("wall", vec![scenes::rectangle(centre, u, v)], bsdf);
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let (mx, my, mz) = ([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]);
    let red = Bsdf::Opaque {
        front: Reflector::Diffuse(Spectrum([0.9, 0.3, 0.1])),
        back: Reflector::Black,
    };
    let mirror = Bsdf::Opaque {
        front: Reflector::Mirror(Spectrum([0.9, 0.8, 1.0])),
        back: Reflector::Black,
    };
    let glass = Bsdf::Dielectric(Dielectric {
        interior_eta: 1.5,
        exterior_eta: 1.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    });
    let ball = |x: f64, bsdf, interior| {
        let mut ball =
            scenes::shape("ball", vec![scenes::sphere(DVec3::new(x, 0.0, 0.0), 0.3, false)], bsdf);
        ball.boundary = Some(MediumBoundary { interior, exterior: Some(MediumId(0)) });
        ball
    };
    let shapes = vec![
        wall(mz, x, y, mirror),
        wall(z, x, my, scenes::diffuse(0.5)),
        wall(my, x, mz, red),
        wall(mx, mz, y, scenes::diffuse(0.8)),
        wall(x, z, y, red),
        ball(-0.5, glass, None),
        ball(0.5, Bsdf::Null, Some(MediumId(1))),
    ];
    let spot = EmitterPart {
        name: "spot".to_owned(),
        kind: EmitterKind::Spot {
            position: DVec3::new(0.0, 0.8, 0.1),
            axis: -DVec3::Y,
            intensity: Rgb::splat(2.0),
            cos_cutoff: 0.5,
            cos_beam: 0.8,
        },
        stated_medium: None,
    };
    Scene::assemble(SceneParts {
        shapes,
        media: vec![
            scenes::fog(0.4, 0.5, 0.5),
            scenes::colored_fog([2.0, 1.0, 0.0], [2.0, 1.5, 4.0], -0.2),
        ],
        textures: vec![],
        emitters: vec![scenes::point(DVec3::new(0.1, 0.4, 0.3), Rgb::ONE), spot],
        background: Some(MediumId(0)),
        sensor: scenes::camera(DVec3::new(0.0, 0.0, 0.9), -DVec3::Z, 60.0, (6, 6)),
        film: scenes::film(6, 6, 0.1, 50),
        integrator,
    })
    .expect("the scene is consistent")
}

fn ledger_closes<const C: usize>(integrator: IntegratorSpec, length: BeamLength) {
    let scene = everything(integrator);
    let plan = Plan::new(&scene, &integrator);
    let tracer =
        PhotonTracer { scene: &scene, plan: &plan, integrator, length, sampling: SAMPLING };
    let photons = tracer.trace::<C>(PassId { seed: 3, index: 1 }, 3000, 2000);
    let ledger = photons.ledger;
    assert!(ledger.closure().abs() < 1e-9, "{ledger:?}");
    for part in [ledger.absorbed_in_media, ledger.absorbed_on_surfaces] {
        assert!(part > 0.0, "{ledger:?}");
    }
    assert!(ledger.cut_by_depth > 0.0 || integrator.max_depth.is_none());
    assert!(ledger.roulette_lost > 0.0);
    assert!(!photons.beams.is_empty() && !photons.surface.is_empty());
    assert!(photons.beams.iter().all(|b| b.length.is_finite() && b.power.is_finite()));
    assert!(photons.beams.iter().all(|b| integrator.reaches(b.depth)));
}

#[test]
fn the_ledger_closes_with_glass_mirrors_null_boundaries_colour_and_roulette() {
    for length in [BeamLength::Long, BeamLength::Short] {
        for max_depth in [Some(6), None] {
            let integrator = IntegratorSpec { max_depth, rr_depth: 3, ..Default::default() };
            ledger_closes::<1>(integrator, length);
            ledger_closes::<3>(integrator, length);
        }
    }
}

/// Remembers whether a photon has scattered in a medium or on a surface.
#[derive(Default)]
struct Scattered {
    yes: bool,
    arrivals: [u32; 2],
}

impl PhotonVisitor<1> for Scattered {
    fn emission(&mut self, _: &Photon<1>, _: &mut Stream) {
        self.yes = false;
    }

    fn collision(&mut self, _: &Photon<1>, _: &Part<'_, 1>, _: &mut Stream) {
        self.yes = true;
    }

    fn surface(&mut self, photon: &Photon<1>, _: &SurfaceArrival, _: &mut Stream) {
        assert_eq!(photon.specular, !self.yes, "{} events", photon.events);
        self.arrivals[usize::from(photon.specular && photon.events > 0)] += 1;
        self.yes = true;
    }
}

#[test]
fn photons_know_whether_mirrors_and_glass_alone_have_turned_them() {
    let integrator = IntegratorSpec { max_depth: Some(8), ..Default::default() };
    let scene = everything(integrator);
    let tracer = tpb_transport::PhotonTracer { scene: &scene, integrator, sampling: SAMPLING };
    let batch = PhotonBatch { seed: 3, pass: 1, count: 3000 };
    let (seen, _) = tracer.trace(batch, |_| Scattered::default());
    for kind in 0..2 {
        assert!(seen.iter().map(|s| s.arrivals[kind]).sum::<u32>() > 100);
    }
}

#[test]
fn caustic_photons_are_kept_apart_where_the_plan_has_any() {
    let integrator = IntegratorSpec { max_depth: Some(8), ..Default::default() };
    let scene = everything(integrator);
    let planned = Plan::new(&scene, &integrator);
    let trace = |plan: &Plan| {
        let length = BeamLength::Long;
        let tracer = PhotonTracer { scene: &scene, plan, integrator, length, sampling: SAMPLING };
        tracer.trace::<1>(PassId { seed: 3, index: 1 }, 3000, 2000)
    };
    let (apart, together) =
        (trace(&planned), trace(&Plan { caustic_photons: false, ..planned.clone() }));
    assert!(planned.caustic_photons && !apart.caustic.is_empty() && together.caustic.is_empty());
    assert_eq!(apart.surface.len() + apart.caustic.len(), together.surface.len());
    assert!(apart.caustic.iter().all(|photon| photon.depth >= 3));
}

#[test]
fn light_that_leaves_an_open_box_is_booked_as_escaped() {
    let scene = scenes::cornell_blocks(8);
    let integrator = scene.integrator;
    let plan = Plan::new(&scene, &integrator);
    let tracer = PhotonTracer {
        scene: &scene,
        plan: &plan,
        integrator,
        length: BeamLength::Long,
        sampling: SAMPLING,
    };
    let ledger = tracer.trace::<1>(PassId { seed: 3, index: 0 }, 3000, 3000).ledger;
    assert!(ledger.closure().abs() < 1e-9, "{ledger:?}");
    // A lamp of 0.16 m² and radiance 10 emits 1.6 π.
    assert!((ledger.emitted / (1.6 * std::f64::consts::PI) - 1.0).abs() < 1e-12, "{ledger:?}");
    assert!(ledger.escaped > 0.05 * ledger.emitted, "{ledger:?}");
}

#[test]
fn the_same_bits_for_one_two_and_seven_threads() {
    let integrator = IntegratorSpec { max_depth: Some(8), ..Default::default() };
    let scene = everything(integrator);
    let options = BeamOptions { photons_per_pass: Some(3000), ..Default::default() };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| render(&scene, integrator, &options, 2))
    };
    let (one, report) = with(1);
    assert!(one.steady.iter().all(|&v| v > 0.0));
    for threads in [2, 7] {
        let (other, its_report) = with(threads);
        assert!(one == other && report == its_report, "{threads} threads");
    }
}

/// Runs restricted to one depth add up to the run of all depths: the same random numbers make the
/// same paths, so they agree to rounding (up to f32 arrays; steady is f64).
#[test]
fn depths_part_the_light_and_limits_hold() {
    let deepest = 5;
    let whole = IntegratorSpec { max_depth: Some(deepest), rr_depth: 9, ..Default::default() };
    let scene = everything(whole);
    for kernel in [KernelChoice::OneD, KernelChoice::TwoD, KernelChoice::ThreeD] {
        let options = BeamOptions {
            kernel: Some(kernel),
            photons_per_pass: Some(4000),
            // One path per pixel: a second one's random numbers would follow the first's length.
            gather_samples: Some(1),
            surface_samples: Some(1),
            ..Default::default()
        };
        let all = render(&scene, whole, &options, 1).0.steady;
        let mut sum = vec![0.0; all.len()];
        for depth in 1..=deepest {
            let only = IntegratorSpec { min_depth: depth, ..whole };
            let only = IntegratorSpec { max_depth: Some(depth), ..only };
            // The photons' random numbers do not depend on max_depth up to there.
            let part = render(&scene, only, &options, 1).0.steady;
            sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
        }
        for (sum, all) in sum.iter().zip(&all) {
            assert!((sum / all - 1.0).abs() < 1e-9, "{sum} {all}");
        }
    }
}

/// Exact and even spreading carry the same total.
#[test]
fn even_and_exact_spreading_have_the_same_total() {
    let integrator = IntegratorSpec { max_depth: Some(5), ..Default::default() };
    let scene = everything(integrator);
    let with = |kernel, temporal, length| {
        let options = BeamOptions {
            kernel: Some(kernel),
            temporal: Some(temporal),
            length: Some(length),
            photons_per_pass: Some(2000),
            radius: Some(0.1),
            ..Default::default()
        };
        render(&scene, integrator, &options, 1).0
    };
    for kernel in [KernelChoice::TwoD, KernelChoice::ThreeD] {
        for length in [BeamLength::Long, BeamLength::Short] {
            let exact = with(kernel, Temporal::Exact, length);
            let even = with(kernel, Temporal::Even, length);
            for (a, b) in exact.steady.iter().zip(&even.steady) {
                assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
            }
            assert!(exact.transient != even.transient, "but not the same distribution");
        }
    }
}

/// Inside a closed diffuse sphere with a point light at its centre every order has the radiance
/// Φρᵏ/(4π²R²): with Φ = 4π² R² (1 − ρ)/ρ the sum is 1 (pbrt's test), and up to depth k + 1
/// 1 − ρᵏ. Order 1 is next-event estimation's, the rest the photons': counted once.
#[test]
fn a_closed_diffuse_sphere_glows_with_radiance_one_per_order() {
    let (radius, rho) = (2.0, 0.5);
    let power = 4.0 * (std::f64::consts::PI * radius).powi(2) * (1.0 - rho) / rho;
    let intensity = Rgb::splat(power / (4.0 * std::f64::consts::PI));
    let integrator = IntegratorSpec { max_depth: Some(7), rr_depth: 4, ..Default::default() };
    let ball = scenes::sphere(DVec3::ZERO, radius, true);
    let scene = Scene::assemble(SceneParts {
        shapes: vec![scenes::shape("ball", vec![ball], scenes::diffuse(rho))],
        media: vec![],
        textures: vec![],
        emitters: vec![scenes::point(DVec3::ZERO, intensity)],
        background: None,
        sensor: scenes::camera(DVec3::new(0.3, 0.2, -0.4), DVec3::Z, 80.0, (8, 8)),
        film: scenes::film(8, 8, 0.5, 40),
        integrator,
    })
    .expect("the scene is consistent");
    let options = BeamOptions {
        surface_radius: Some(0.4),
        photons_per_pass: Some(2000),
        ..Default::default()
    };
    for depth in 2..=4_u32 {
        let only =
            IntegratorSpec { min_depth: depth, max_depth: Some(depth), rr_depth: 9, ..integrator };
        let expected = (1.0 - rho) * rho.powf(f64::from(depth) - 2.0);
        let (mean, error) = mean_of_batches(&scene, only, &options, 16);
        // Direct light is without noise; a disc on a sphere has no blur where light is uniform.
        let allowed = if depth == 2 { 1e-12 } else { 5.0 * error };
        assert!((mean - expected).abs() < allowed, "depth {depth}: {mean} {expected} {error}");
        assert!(depth == 2 || error < 0.02 * expected, "depth {depth}: error {error}");
    }
    let (mean, error) = mean_of_batches(&scene, integrator, &options, 16);
    let expected = 1.0 - rho.powi(6);
    // Student's t with 15 degrees of freedom: beyond 5 standard errors with probability 1.6e-4.
    assert!((mean - expected).abs() < 5.0 * error && error < 0.01, "{mean} {expected} {error}");
}

/// A laser's spot on a diffuse floor: next-event estimation cannot connect to it, so unscattered
/// photons must show it, at depth 2, with radiance ρ/π · Φ/(π a²) all over the spot.
#[test]
fn a_laser_lights_a_surface_directly() {
    let (spot, power, rho) = (0.3, 2.0, 0.6);
    let integrator = IntegratorSpec { max_depth: Some(2), ..Default::default() };
    let kind = EmitterKind::Laser {
        position: DVec3::new(0.0, 1.0, 0.0),
        axis: -DVec3::Y,
        radius: spot,
        power: Rgb::splat(power),
    };
    let floor = scenes::rectangle([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]);
    let scene = Scene::assemble(SceneParts {
        shapes: vec![scenes::shape("floor", vec![floor], scenes::diffuse(rho))],
        media: vec![],
        textures: vec![],
        emitters: vec![EmitterPart { name: "laser".to_owned(), kind, stated_medium: None }],
        background: None,
        sensor: scenes::camera(DVec3::new(0.0, 3.0, 4.0), DVec3::new(0.0, -3.0, -4.0), 1.0, (4, 4)),
        film: scenes::film(4, 4, 1.0, 10),
        integrator,
    })
    .expect("the scene is consistent");
    let options = BeamOptions {
        surface_radius: Some(0.15),
        photons_per_pass: Some(4000),
        ..Default::default()
    };
    let (mean, error) = mean_of_batches(&scene, integrator, &options, 16);
    let expected = rho * power / (std::f64::consts::PI * spot).powi(2);
    // Beyond 5 standard errors of 16 batches: probability 1.6e-4.
    assert!((mean - expected).abs() < 5.0 * error, "{mean} {expected} {error}");
    assert!(error < 0.01 * expected, "{error}");
}

/// Walls that all glow with radiance 1, and a ball so small around the eye that no ray is trapped
/// in it by total reflection: from inside glass every ray sees η², whatever it does at
/// the boundary, and from outside 1.
#[test]
fn radiance_scales_with_eta_squared_in_a_furnace_with_glass() {
    let glass = Bsdf::Dielectric(Dielectric {
        interior_eta: 1.5,
        exterior_eta: 1.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    });
    let ball = scenes::shape("ball", vec![scenes::sphere(DVec3::ZERO, 0.5, false)], glass);
    let wall = scenes::sphere(DVec3::ZERO, 2.0, true);
    let mut walls = scenes::shape("walls", vec![wall], scenes::diffuse(0.0));
    walls.radiance = Some(Rgb::ONE);
    for (eye, expected) in [(DVec3::new(0.1, 0.1, 0.2), 2.25), (DVec3::new(0.0, 0.0, -1.2), 1.0)] {
        let integrator = IntegratorSpec { rr_depth: 1000, ..Default::default() };
        let scene = Scene::assemble(SceneParts {
            shapes: vec![ball.clone(), walls.clone()],
            media: vec![],
            textures: vec![],
            emitters: vec![],
            background: None,
            sensor: scenes::camera(eye, DVec3::Z, 70.0, (8, 8)),
            film: scenes::film(8, 8, 1.0, 10),
            integrator,
        })
        .expect("the scene is consistent");
        let (arrays, _) = render(&scene, integrator, &BeamOptions::default(), 1);
        for value in arrays.steady {
            assert!((value / expected - 1.0).abs() < 1e-12, "{value} {expected}");
        }
    }
}

/// Mean over the image and its standard error from independent passes.
fn mean_of_batches(
    scene: &Scene,
    integrator: IntegratorSpec,
    options: &BeamOptions,
    batches: u64,
) -> (f64, f64) {
    let plan = Plan::new(scene, &integrator);
    let method = PhotonBeams::new(scene, &plan, integrator, options).expect("sound options");
    let layout = Layout::new(scene.film.width, scene.film.height, None).expect("a film");
    let means: Vec<f64> = (0..batches)
        .map(|index| {
            let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).expect("a film");
            method.pass(PassId { seed: 11, index }, &mut film);
            let steady = film.develop().steady;
            steady.iter().sum::<f64>() / steady.len() as f64
        })
        .collect();
    let n = batches as f64;
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>() / (n * (n - 1.0));
    (mean, variance.sqrt())
}
