//! Every scene of the gallery: loads, plans, and is rendered by every method that takes it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tpb_beams::BeamOptions;
use tpb_light::LightOptions;
use tpb_path::PathOptions;
use tpb_render::{Budget, FilmSetup, RenderOptions, RunSettings, Stopwatch, run};
use tpb_scene::load::{LoadedScene, Override, load_scene};
use tpb_scene::{MethodName, Plan, Scene, Transport};

use super::agreement::companion;
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
    for entry in &ENTRIES {
        assert!(found.iter().any(|scene| scene.name == entry.name), "{} has no scene", entry.name);
    }
    for scene in &found {
        let described = !scene.text.is_empty() && scene.moments.iter().all(|m| !m.seen.is_empty());
        assert!(described, "{} has no entry, or one that says nothing", scene.name);
    }
}

/// All `type`s of a description.
fn types(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            found.extend(members.get("type").and_then(Value::as_str).map(str::to_owned));
            members.values().for_each(|member| types(member, found));
        }
        Value::Array(items) => items.iter().for_each(|item| types(item, found)),
        _ => {}
    }
}

/// What light does in scenes, and what these may say of it, is seen in some scene of the gallery.
#[test]
fn the_gallery_shows_what_scenes_can_have() {
    let mut found = BTreeSet::new();
    for scene in scenes() {
        types(&small(&scene).canonical, &mut found);
    }
    let shown = [
        &["diffuse", "conductor", "roughconductor", "dielectric", "roughdielectric"][..],
        &["thindielectric", "null", "twosided", "checkerboard", "bitmap", "homogeneous", "hg"],
        &["isotropic", "point", "spot", "area", "directional", "laser", "rectangle", "cube"],
        &["sphere", "disk", "cylinder", "ply"],
    ]
    .concat();
    let missing: Vec<_> = shown.iter().filter(|&&name| !found.contains(name)).collect();
    assert!(missing.is_empty(), "no scene has {missing:?}");
    let lamps: BTreeSet<String> =
        scenes().iter().flat_map(|s| lamps(&small(s).canonical)).collect();
    assert_eq!(
        lamps.into_iter().collect::<Vec<_>>(),
        ["cylinder", "disk", "ply", "rectangle", "sphere"]
    );
}

/// The shapes that shine.
fn lamps(scene: &Value) -> Vec<String> {
    let members = scene.as_object().into_iter().flat_map(|members| members.values());
    let lamps = members.filter(|member| member.get("emitter").is_some());
    lamps.filter_map(|lamp| lamp["type"].as_str().map(str::to_owned)).collect()
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

/// Each viewer has two methods, the path tracer where it renders all.
#[test]
fn every_scene_has_a_second_method() {
    let all = [
        ("torus-knot", "light"),
        ("laser-smoke", "light"),
        ("liquid", "light"),
        ("window", "path"),
        ("chapel", "light"),
        ("frosted", "path"),
        ("neon", "path"),
        ("surfaces-only", "path"),
        ("fog-only", "path"),
        ("cornell-blocks", "path"),
        ("mirrors", "light"),
        ("mirrors-area", "path"),
    ];
    let found: Vec<_> =
        all.iter().map(|&(name, _)| (name, companion(&named(name).scene).expect(name))).collect();
    assert_eq!(found, all);
}

#[test]
fn rough_surfaces_are_no_limit_of_any_method() {
    for (name, rough) in [("frosted", &["block", "slab"][..]), ("neon", &["floor"])] {
        let loaded = named(name);
        let plan = Plan::new(&loaded.scene, &loaded.scene.integrator);
        assert_eq!(plan.rough, rough);
        assert!(plan.left_out.iter().all(|item| !item.loses_light), "{name}: {plan}");
    }
}

/// Neither path tracing nor light tracing renders all light of the chapel, and they say so.
#[test]
fn sunlight_through_panes_is_for_beams() {
    let loaded = named("chapel");
    let plan = Plan::new(&loaded.scene, &loaded.scene.integrator);
    assert!(reason(&plan, "caustics of points and spots").contains("sun"));
    assert!(reason(&plan, "light in mirrors and glass").contains("panes_ruby"));
}
