//! What must hold whatever the light: threads, depths, the ledger, unwarping, options.

use glam::DVec3;
use tpb_film::{Arrays, FilmOptions};
use tpb_light::{LightOptions, LightTracer, OptionError};
use tpb_optics::Rgb;
use tpb_render::{PassId, PassReport};
use tpb_scene::{
    Bsdf, Dielectric, IntegratorSpec, MediumBoundary, MediumId, Plan, Reflector, Scene, SceneParts,
};

use crate::scenes;
use crate::statistics::pass;

/// A box of fog with a lamp, a mirror, a glass ball and a null ball of coloured fog; the eye is in
/// the fog.
fn everything(integrator: IntegratorSpec, eye: DVec3) -> Scene {
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let (mx, my, mz) = ([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]);
    let wall =
        |centre, u, v, bsdf| scenes::shape("wall", vec![scenes::rectangle(centre, u, v)], bsdf);
    let mirror = Bsdf::Opaque { front: Reflector::Mirror(Rgb::splat(0.9)), back: Reflector::Black };
    let glass = Bsdf::Dielectric(Dielectric {
        interior_eta: 1.5,
        exterior_eta: 1.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    });
    let ball = |x: f64, bsdf, interior| {
        let at = DVec3::new(x, 0.0, 0.0);
        let mut ball = scenes::shape("ball", vec![scenes::sphere(at, 0.3, false)], bsdf);
        ball.boundary = Some(MediumBoundary { interior, exterior: Some(MediumId(0)) });
        ball
    };
    let panel = scenes::rectangle([0.0, 0.9, 0.0], [0.3, 0.0, 0.0], z);
    let mut lamp = scenes::shape("lamp", vec![panel], scenes::diffuse(0.0));
    lamp.radiance = Some(Rgb::ONE);
    Scene::assemble(SceneParts {
        shapes: vec![
            wall(mz, x, y, mirror),
            wall(z, x, my, scenes::diffuse(0.5)),
            wall(my, x, mz, scenes::diffuse(0.9)),
            wall(mx, mz, y, scenes::diffuse(0.8)),
            ball(-0.5, glass, None),
            ball(0.5, Bsdf::Null, Some(MediumId(1))),
            lamp,
        ],
        media: vec![
            scenes::fog(0.4, 0.5, 0.5),
            scenes::colored_fog([2.0, 1.0, 0.0], [2.0, 1.5, 4.0], -0.2),
        ],
        textures: vec![],
        emitters: vec![scenes::point(DVec3::new(0.1, 0.4, 0.3), Rgb::ONE)],
        background: Some(MediumId(0)),
        sensor: scenes::camera(eye, -DVec3::Z, 60.0, (6, 6)),
        film: scenes::film(6, 6, 0.1, 50),
        integrator,
    })
    .expect("a scene")
}

const EYE: DVec3 = DVec3::new(0.0, 0.0, 0.9);

fn render(
    scene: &Scene,
    integrator: IntegratorSpec,
    film: FilmOptions,
    photons: u64,
) -> (Arrays, PassReport) {
    let plan = Plan::new(scene, &integrator);
    let options = LightOptions { photons_per_pass: Some(photons) };
    let method = LightTracer::<3>::new(scene, &plan, integrator, &options).expect("options");
    pass(&method, &scene.film, film, PassId { seed: 5, index: 2 })
}

#[test]
fn the_same_bits_for_one_two_and_seven_threads() {
    let integrator = IntegratorSpec { max_depth: Some(8), ..Default::default() };
    let scene = everything(integrator, EYE);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| render(&scene, integrator, FilmOptions::default(), 3000))
    };
    let one = with(1);
    assert!(one.0.steady.iter().all(|&v| v > 0.0) && one.1.counts.connections > 3000);
    assert!(one == with(2) && one == with(7));
}

/// Runs restricted to one depth add up to the run of all depths: min_depth draws no random number.
#[test]
fn depths_part_the_light() {
    let whole = IntegratorSpec { max_depth: Some(5), rr_depth: 9, ..Default::default() };
    let scene = everything(whole, EYE);
    let all = render(&scene, whole, FilmOptions::default(), 3000).0.steady;
    let mut sum = vec![0.0; all.len()];
    for depth in 1..=5 {
        let only = IntegratorSpec { min_depth: depth, max_depth: Some(depth), ..whole };
        let part = render(&scene, only, FilmOptions::default(), 3000).0.steady;
        sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
    }
    for (sum, all) in sum.iter().zip(&all) {
        assert!((sum / all - 1.0).abs() < 1e-9, "{sum} {all}");
    }
}

/// Fog in a black ball around the eye: every ray's first surface is 2 m away, so that all light
/// moves by 20 bins.
#[test]
fn an_unwarping_film_subtracts_the_way_to_the_first_surface_behind_fog() {
    let black = Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black };
    let ball = scenes::shape("ball", vec![scenes::sphere(DVec3::ZERO, 2.0, true)], black);
    let integrator = IntegratorSpec { max_depth: Some(4), ..Default::default() };
    let scene = Scene::assemble(SceneParts {
        shapes: vec![ball],
        media: vec![scenes::fog(0.6, 0.7, 0.2)],
        textures: vec![],
        emitters: vec![scenes::point(DVec3::new(0.4, 0.3, -1.6), Rgb::ONE)],
        background: Some(MediumId(0)),
        sensor: scenes::camera(DVec3::ZERO, -DVec3::Z, 60.0, (4, 4)),
        film: scenes::film(4, 4, 0.1, 60),
        integrator,
    })
    .expect("a scene");
    let plain = render(&scene, integrator, FilmOptions::default(), 2000).0;
    let options = FilmOptions { unwarp: true, ..Default::default() };
    let unwarped = render(&scene, integrator, options, 2000).0;
    for pixel in 0..16 {
        let (a, b) = (plain.pixel(pixel), unwarped.pixel(pixel));
        assert!(a[60..].iter().any(|&v| v > 0.0));
        for (a, b) in a[60..].iter().zip(b) {
            assert!((a - b).abs() <= 1e-6 * a.abs(), "{a} {b}");
        }
    }
}

/// On surfaces the time that is left is the light's leg: bins of it, of the irradiance of a point
/// above a wall.
#[test]
fn an_unwarping_film_shows_a_surface_when_light_reaches_it() {
    let lamp = DVec3::new(0.0, 0.0, 1.0);
    let plate = scenes::rectangle([0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0]);
    let integrator = IntegratorSpec { max_depth: Some(2), ..Default::default() };
    let scene = Scene::assemble(SceneParts {
        shapes: vec![scenes::shape("wall", vec![plate], scenes::diffuse(0.6))],
        media: vec![],
        textures: vec![],
        emitters: vec![scenes::point(lamp, Rgb::ONE)],
        background: None,
        sensor: scenes::camera(DVec3::new(0.0, 0.0, 3.0), -DVec3::Z, 40.0, (4, 4)),
        film: scenes::film(4, 4, 0.1, 60),
        integrator,
    })
    .expect("a scene");
    let options = FilmOptions { unwarp: true, ..Default::default() };
    let arrays = render(&scene, integrator, options, 20_000).0;
    // In view are points up to 3 tan 20° √2 = 1.544 m beside the axis, 1 to 1.84 m from the lamp.
    for pixel in 0..16 {
        let bins = arrays.pixel(pixel);
        let lit = |range: std::ops::Range<usize>| {
            bins[3 * range.start..3 * range.end].iter().any(|&v| v > 0.0)
        };
        assert!(lit(10..19) && !lit(0..10) && !lit(19..60));
    }
}

#[test]
fn numbers_of_photons_out_of_range_are_refused() {
    let scene = everything(IntegratorSpec::default(), EYE);
    let plan = Plan::new(&scene, &scene.integrator);
    for photons in [0, 1 << 40] {
        let options = LightOptions { photons_per_pass: Some(photons) };
        let made = LightTracer::<3>::new(&scene, &plan, scene.integrator, &options);
        let Err(OptionError { found, .. }) = made else { panic!("{photons} photons") };
        assert_eq!(found, photons);
    }
    let made = LightTracer::<3>::new(&scene, &plan, scene.integrator, &LightOptions::default());
    assert_eq!(made.expect("defaults").settings().photons_per_pass, 1 << 14);
}

/// A ball of fog, 200 mean free paths across, with a lamp in its middle: a photon is seen 1e4 times.
#[test]
fn thick_media_get_passes_of_fewer_photons() {
    let lamp = scenes::point(DVec3::ZERO, Rgb::ONE);
    let mut ball = scenes::shape("ball", vec![scenes::sphere(DVec3::ZERO, 1.0, false)], Bsdf::Null);
    ball.boundary = Some(MediumBoundary { interior: Some(MediumId(0)), exterior: None });
    let integrator = IntegratorSpec { rr_depth: u32::MAX, ..Default::default() };
    let scene = Scene::assemble(SceneParts {
        shapes: vec![ball],
        media: vec![scenes::fog(100.0, 100.0, 0.0)],
        textures: vec![],
        emitters: vec![lamp],
        background: None,
        sensor: scenes::camera(DVec3::new(0.0, 0.0, 4.0), -DVec3::Z, 40.0, (4, 4)),
        film: scenes::film(4, 4, 0.1, 60),
        integrator,
    })
    .expect("a scene");
    let plan = Plan::new(&scene, &integrator);
    let made = LightTracer::<1>::new(&scene, &plan, integrator, &LightOptions::default());
    let photons = made.expect("defaults").settings().photons_per_pass;
    assert!((300..10_000).contains(&photons), "{photons}");
    let asked = LightOptions { photons_per_pass: Some(5000) };
    let made = LightTracer::<1>::new(&scene, &plan, integrator, &asked);
    assert_eq!(made.expect("options").settings().photons_per_pass, 5000);
}

/// Without light nothing is traced, and the image is black.
#[test]
fn a_scene_without_light_is_black() {
    let integrator = IntegratorSpec::default();
    let mut scene = everything(integrator, EYE);
    scene.emitters.clear();
    let (arrays, report) = render(&scene, integrator, FilmOptions::default(), 1000);
    assert!(arrays.steady.iter().all(|&v| v == 0.0));
    assert!(report == PassReport::default(), "{report:?}");
}
