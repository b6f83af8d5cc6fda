//! Every scene of the gallery: loads, plans, and is rendered by every method that takes it.

use std::path::{Path, PathBuf};

use tpb_beams::BeamOptions;
use tpb_light::LightOptions;
use tpb_path::PathOptions;
use tpb_render::{Budget, FilmSetup, RenderOptions, RunSettings, Stopwatch, run};
use tpb_scene::load::{LoadedScene, Override, load_scene};
use tpb_scene::{MethodName, Plan, Scene, Transport};

use super::catalogue::{ENTRIES, GalleryScene, scenes_in};
use crate::measure::Estimator;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes")
}

fn scenes() -> Vec<GalleryScene> {
    scenes_in(&folder()).expect("the gallery's scenes")
}

fn small(scene: &GalleryScene) -> LoadedScene {
    let change = |text: &str| Override::parse(text).expect("a change");
    let changes = [change("sensor.film.width=16"), change("sensor.film.height=12")];
    load_scene(&scene.file, &changes).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

fn named(name: &str) -> LoadedScene {
    let scenes = scenes();
    small(scenes.iter().find(|scene| scene.name == name).expect(name))
}

/// Methods with little work in a pass.
fn estimators() -> [Estimator; 3] {
    let photons = Some(3000);
    [
        Estimator::Path(PathOptions { samples_per_pass: std::num::NonZeroU32::new(2) }),
        Estimator::Light(LightOptions { photons_per_pass: photons }),
        Estimator::Beams(BeamOptions {
            photons_per_pass: photons,
            beam_photons: Some(600),
            surface_samples: Some(2),
            light_samples: Some(1),
            ..BeamOptions::default()
        }),
    ]
}

#[test]
fn known_scenes_are_there() {
    let found = scenes();
    for name in ["torus-knot", "laser-smoke", "liquid", "window", "surfaces-only", "fog-only"] {
        assert!(found.iter().any(|scene| scene.name == name), "{name}");
        assert!(ENTRIES.iter().any(|entry| entry.name == name), "{name} has no entry");
    }
}

#[test]
fn every_method_renders_every_scene_soundly() {
    for scene in scenes() {
        let loaded = small(&scene);
        let plan = Plan::new(&loaded.scene, &loaded.scene.integrator);
        for estimator in estimators() {
            let what = format!("{}, {}", scene.name, estimator.name());
            match plan.transport {
                Transport::Mono => render::<1>(&loaded.scene, &plan, &estimator, &what),
                Transport::Rgb => render::<3>(&loaded.scene, &plan, &estimator, &what),
            }
        }
    }
}

/// One pass: all finite, none negative, bins and cells beside them add up, the ledger closes.
fn render<const C: usize>(scene: &Scene, plan: &Plan, estimator: &Estimator, what: &str) {
    let setup = FilmSetup::new(&scene.film, plan.transport, &RenderOptions::default());
    let setup = setup.unwrap_or_else(|error| panic!("{what}: {error}"));
    let mut film = setup.film::<C>().expect(what);
    let method = estimator.prepare::<C>(scene, plan, scene.integrator).expect(what);
    let settings = RunSettings { seed: 5, budget: Budget::Passes(1), first_pass: 0 };
    let summary = run(&*method, &mut film, &settings, &Stopwatch::start(), &mut ());
    assert_eq!(film.non_finite(), 0, "{what}");
    assert!(summary.ledger.mean_of_a_pass.closure().abs() < 1e-9, "{what}");
    let (arrays, _) = setup.develop(film).expect(what);
    assert!(arrays.steady.iter().all(|value| value.is_finite() && *value >= 0.0), "{what}");
    let inside: f64 = arrays.transient.iter().map(|&cell| f64::from(cell)).sum();
    let sum = |values: &[f64]| values.iter().sum::<f64>();
    let (beside, steady) = (sum(&arrays.before) + sum(&arrays.after), sum(&arrays.steady));
    assert!(
        (inside + beside - steady).abs() <= 1e-5 * steady,
        "{what}: {inside} {beside} {steady}"
    );
    let lost = plan
        .left_out
        .iter()
        .any(|item| item.loses_light && item.methods.iter().any(|&method| is(method, estimator)));
    assert!(lost || inside > 0.0, "{what}: the film's window is dark");
}

fn is(method: MethodName, estimator: &Estimator) -> bool {
    matches!(
        (method, estimator),
        (MethodName::Path, Estimator::Path(_))
            | (MethodName::Light, Estimator::Light(_))
            | (MethodName::Beams, Estimator::Beams(_))
    )
}

/// The part of the plan's list that says why something is left out.
fn reason(plan: &Plan, part: &str) -> String {
    let item = plan.left_out.iter().find(|item| item.part == part);
    item.unwrap_or_else(|| panic!("{part} is not left out:\n{plan}")).reason.clone()
}

#[test]
fn a_scene_of_surfaces_only_leaves_out_media() {
    let loaded = named("surfaces-only");
    let plan = Plan::new(&loaded.scene, &loaded.scene.integrator).of_method(MethodName::Beams);
    assert!(!plan.beams && plan.surface_photons && plan.next_event_estimation);
    assert_eq!(reason(&plan, "media"), "vacuum everywhere");
    assert_eq!(reason(&plan, "photon beams"), "no medium scatters light");
    assert_eq!(reason(&plan, "specular chains"), "no mirror and no refracting boundary");
}

#[test]
fn a_scene_of_fog_only_leaves_out_surfaces() {
    let loaded = named("fog-only");
    let plan = Plan::new(&loaded.scene, &loaded.scene.integrator).of_method(MethodName::Beams);
    assert!(plan.beams && !plan.surface_photons);
    assert_eq!(reason(&plan, "surface photons"), "no surface scatters diffusely");
    assert_eq!(reason(&plan, "specular chains"), "no mirror and no refracting boundary");
    assert!(reason(&plan, "next-event estimation").contains("in media, beams bring all light"));
    let path = Plan::new(&loaded.scene, &loaded.scene.integrator).of_method(MethodName::Path);
    assert!(path.left_out.iter().all(|item| !item.loses_light), "{path}");
}

/// Beams lose nothing in any of them but what a rough surface hides.
#[test]
fn photon_beams_render_all_light_of_every_scene() {
    for scene in scenes() {
        let loaded = small(&scene);
        let plan = Plan::new(&loaded.scene, &loaded.scene.integrator).of_method(MethodName::Beams);
        assert!(plan.left_out.iter().all(|item| !item.loses_light), "{}: {plan}", scene.name);
    }
}
