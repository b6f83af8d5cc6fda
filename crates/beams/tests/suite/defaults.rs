//! Defaults chosen from the scene, and options that are refused.

use glam::DVec3;
use tpb_beams::{BeamOptions, OptionError, PhotonBeams, Settings};
use tpb_film::{FilmOptions, Layout, TransientFilm};
use tpb_optics::Rgb;
use tpb_render::{Method, PassId};
use tpb_scene::{
    Bsdf, IntegratorSpec, MediumBoundary, MediumId, Plan, Primitive, Scene, SceneParts,
};

use crate::scenes;

fn settings(scene: &Scene, options: &BeamOptions) -> Result<Settings, OptionError> {
    Settings::new(scene, &Plan::new(scene, &scene.integrator), options)
}

fn radii(scene: &Scene) -> (f64, f64) {
    let settings = settings(scene, &BeamOptions::default()).expect("sound defaults");
    (settings.radius, settings.surface_radius)
}

/// The radii that results were measured with are 0.0420 and 0.1049.
#[test]
fn cornell_blocks_keeps_its_radii() {
    let (beams, disc) = radii(&scenes::cornell_blocks(64));
    assert!((0.037..0.045).contains(&beams), "{beams}");
    assert!((0.094..0.112).contains(&disc), "{disc}");
}

#[test]
fn radii_are_a_pixel_on_fine_films_and_part_of_the_scene_on_coarse_ones() {
    let (fine, fine_disc) = radii(&scenes::cornell_blocks(256));
    // Media at 2.9 + 0.5 m to 2.9 + 1 m, surfaces between 3 and 5 m.
    let pixel = scenes::cornell_blocks(256).sensor.pixel_width();
    assert!((3.2..4.1).contains(&(fine / pixel)), "{fine}");
    assert!((7.5..12.5).contains(&(fine_disc / pixel)), "{fine_disc}");
    let (coarse, coarse_disc) = radii(&scenes::cornell_blocks(8));
    assert!(coarse < 0.05 && coarse_disc < 0.125, "{coarse} {coarse_disc}");
    let (single, single_disc) = radii(&scenes::cornell_blocks(1));
    assert!(single < 0.05 && single_disc < 0.125, "{single} {single_disc}");
}

/// A cube of fog with half an edge of `half` around `centre`, lit by a point in it.
fn cube_of_fog(
    centre: DVec3,
    half: f64,
    sigma_t: f64,
    eye: DVec3,
    others: Vec<tpb_scene::ShapePart>,
) -> Scene {
    let faces = scenes::block(DVec3::splat(half), 0.0, centre);
    let mut cube = scenes::shape("cube", faces, Bsdf::Null);
    cube.boundary = Some(MediumBoundary { interior: Some(MediumId(0)), exterior: None });
    let mut shapes = vec![cube];
    shapes.extend(others);
    Scene::assemble(SceneParts {
        shapes,
        media: vec![scenes::fog(0.8 * sigma_t, sigma_t, 0.0)],
        textures: vec![],
        emitters: vec![scenes::point(centre + DVec3::splat(0.3 * half), Rgb::ONE)],
        background: None,
        sensor: scenes::camera(eye, centre - DVec3::Y * half - eye, 40.0, (64, 64)),
        film: scenes::film(64, 64, 0.1, 50),
        integrator: IntegratorSpec::default(),
    })
    .expect("the scene is consistent")
}

/// A square of `half` edges at y = 0.
fn ground(half: f64) -> Primitive {
    scenes::rectangle([0.0; 3], [half, 0.0, 0.0], [0.0, 0.0, -half])
}

#[test]
fn a_large_ground_plane_does_not_widen_radii() {
    let (centre, eye) = (DVec3::new(0.0, 1.01, 0.0), DVec3::new(0.0, 3.0, 6.0));
    // Whatever is drawn far from the camera's view, or is large, does not matter.
    let plane = scenes::shape("ground", vec![ground(500.0)], scenes::diffuse(0.5));
    let scene = cube_of_fog(centre, 1.0, 0.5, eye, vec![plane]);
    let (beams, disc) = radii(&scene);
    let pixel = scene.sensor.pixel_width();
    assert!(beams <= 8.0 * pixel && beams > 3.0 * pixel, "{beams}");
    assert!((10.0..20.0).contains(&(disc / pixel)), "{disc}");
}

#[test]
fn in_endless_fog_radii_are_of_the_mean_free_path() {
    for (sigma_t, width) in [(0.5, 64), (200.0, 64), (1e-3, 64), (0.5, 1)] {
        let scene = Scene::assemble(scenes::infinite(
            scenes::fog(0.8 * sigma_t, sigma_t, 0.0),
            scenes::point(DVec3::new(0.2, 0.0, 1.0), Rgb::ONE),
            scenes::camera(DVec3::ZERO, DVec3::Z, 60.0, (width, width)),
            scenes::film(width, width, 0.1, 50),
        ))
        .expect("the scene is consistent");
        let (beams, disc) = radii(&scene);
        let expected = (0.5 * scene.sensor.pixel_width()).min(0.1) / sigma_t;
        assert!((beams / expected - 1.0).abs() < 1e-12, "{sigma_t} {width}: {beams}");
        assert!(disc > 0.0 && disc.is_finite(), "{disc}");
    }
}

#[test]
fn inside_a_tiny_cube_of_fog_radii_are_of_the_cube() {
    let half = 1e-3;
    let plane = scenes::shape("ground", vec![ground(500.0)], scenes::diffuse(0.5));
    let centre = DVec3::new(0.0, 1.0, 0.0);
    let scene = cube_of_fog(centre, half, 0.5, centre + 0.5 * half * DVec3::Z, vec![plane]);
    let (beams, disc) = radii(&scene);
    assert!(beams > 0.0 && beams < 0.1 * half, "{beams}");
    assert!(disc < 0.2, "{disc}");
}

#[test]
fn rays_that_see_nothing_leave_sound_radii() {
    let centre = DVec3::new(0.0, 0.0, -1e3);
    let scene = Scene::assemble(SceneParts {
        sensor: scenes::camera(DVec3::ZERO, DVec3::Z, 40.0, (8, 8)),
        shapes: vec![scenes::shape(
            "ball",
            vec![scenes::sphere(centre, 1.0, false)],
            scenes::diffuse(0.5),
        )],
        media: vec![],
        textures: vec![],
        emitters: vec![scenes::point(DVec3::ZERO, Rgb::ONE)],
        background: None,
        film: scenes::film(8, 8, 0.1, 50),
        integrator: IntegratorSpec::default(),
    })
    .expect("the scene is consistent");
    let (beams, disc) = radii(&scene);
    assert!(beams > 0.0 && beams.is_finite() && disc > 0.0 && disc.is_finite(), "{beams} {disc}");
}

/// In a scene that keeps no photons on surfaces, the number given is the number traced, and shown.
#[test]
fn given_photons_are_the_photons_traced() {
    let scene = Scene::assemble(scenes::infinite(
        scenes::fog(0.4, 0.5, 0.0),
        scenes::point(DVec3::new(0.2, 0.0, 1.0), Rgb::ONE),
        scenes::camera(DVec3::ZERO, DVec3::Z, 60.0, (2, 2)),
        scenes::film(2, 2, 0.1, 50),
    ))
    .expect("the scene is consistent");
    let plan = Plan::new(&scene, &scene.integrator);
    assert!(plan.beams && !plan.surface_photons);
    let given = |photons_per_pass, beam_photons| {
        let options = BeamOptions { photons_per_pass, beam_photons, ..Default::default() };
        let method = PhotonBeams::new(&scene, &plan, scene.integrator, &options).expect("sound");
        let layout = Layout::new(2, 2, None).expect("a film");
        let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).expect("a film");
        let report = method.pass(PassId { seed: 1, index: 0 }, &mut film);
        let settings = method.settings();
        assert_eq!(settings.photons_per_pass, settings.beam_photons);
        assert_eq!(settings.photons_per_pass, report.counts.photon_paths);
        settings.beam_photons
    };
    assert_eq!(given(Some(20_000), None), 20_000);
    assert_eq!(given(Some(700), None), 700);
    assert_eq!(given(None, Some(700)), 700);
    assert_eq!(given(Some(1000), Some(700)), 700);
}

#[test]
fn absurd_numbers_of_photons_are_refused() {
    let scene = scenes::cornell_blocks(8);
    let given = |photons_per_pass, beam_photons| {
        settings(&scene, &BeamOptions { photons_per_pass, beam_photons, ..Default::default() })
    };
    assert!(given(Some(1_000_000), Some(1_000_000)).is_ok());
    for (photons, beams) in
        [(u64::MAX, None), (1_000_000_000_000, None), (30_000_000, Some(30_000_000))]
    {
        let error = given(Some(photons), beams).expect_err("too many");
        assert_eq!(error.option, "photons_per_pass");
        assert!(error.to_string().contains("16 GiB"), "{error}");
    }
    assert!(given(None, Some(u64::MAX)).is_err());
    assert_eq!(given(Some(10), Some(11)).expect_err("more").option, "beam_photons");
    assert_eq!(given(Some(0), None).expect_err("none").option, "photons_per_pass");
    assert_eq!(given(None, Some(0)).expect_err("none").option, "beam_photons");
}
