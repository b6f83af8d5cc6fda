//! The gallery's page, from a render to what its readers meet in a real browser.
//!
//! Needs Chromium; without one the test fails and says how to get it.

use std::path::Path;

use serde_json::Value;
use tpb_browser::{Browser, Page, Viewport};
use tpb_film::PictureOptions;
use tpb_render::{
    Budget, FilmSetup, MethodRecord, Outcome, RenderOptions, Report, RunSettings, SceneRecord,
    Stopwatch, run,
};
use tpb_scene::load::{Override, load_scene};
use tpb_scene::{MethodName, Plan};
use tpb_validation::gallery::{Card, GalleryScene, page, scenes_in};
use tpb_validation::measure::Estimator;

/// A tiny result of a scene, as the program leaves it.
fn render(scene: &GalleryScene, folder: &Path) {
    let change = |text: &str| Override::parse(text).expect("a change");
    let changes = [change("sensor.film.width=16"), change("sensor.film.height=12")];
    let loaded = load_scene(&scene.file, &changes).unwrap_or_else(|error| panic!("{error}"));
    let settings = RunSettings { seed: 3, budget: Budget::Passes(2), first_pass: 0 };
    let options = RenderOptions { run: settings, ..RenderOptions::default() };
    let integrator = loaded.scene.integrator;
    let plan = Plan::new(&loaded.scene, &integrator).of_method(MethodName::Beams);
    let setup = FilmSetup::new(&loaded.scene.film, plan.transport, &options).expect("a film");
    let mut film = setup.film::<3>().expect("a film");
    let beams = Estimator::of_name("beams").expect("a method");
    let method = beams.prepare::<3>(&loaded.scene, &plan, integrator).expect("a method");
    let summary = run(&*method, &mut film, &settings, &Stopwatch::start(), &mut ());
    let record = MethodRecord::new(method.name(), method.options(), &integrator);
    let (arrays, pulse) = setup.develop(film).expect("arrays");
    let file = scene.file.display().to_string();
    let outcome = Outcome {
        scene: SceneRecord { file, canonical: loaded.canonical.clone() },
        method: record,
        plan: &plan,
        run: summary,
        non_finite: 0,
        arrays: &arrays,
        pulse,
    };
    let report = Report::new("test", options, outcome);
    let pictures = PictureOptions::default();
    std::fs::create_dir_all(folder).expect("a folder");
    arrays.write_steady_png(&folder.join("steady.png"), &pictures).expect("a picture");
    arrays.write_arrival_time(&folder.join("arrival_time.png"), &pictures).expect("a picture");
    arrays.write_frames(&folder.join("frames"), &pictures).expect("pictures");
    let text = serde_json::to_string(&report).expect("a report");
    std::fs::write(folder.join("report.json"), text).expect("a report");
}

/// The value of a script.
fn ask(page: &mut Page<'_>, script: &str) -> Value {
    page.evaluate(script).unwrap_or_else(|error| panic!("{script}: {error}"))
}

#[test]
fn a_result_becomes_a_page_that_reads_well_on_desktop_and_phone() {
    let scenes =
        scenes_in(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes")).expect("scenes");
    let fog = scenes.iter().find(|scene| scene.name == "fog-only").expect("fog-only");
    let folder = tempfile::tempdir().expect("a folder");
    assert!(Card::read(fog, folder.path()).expect("no result is no error").is_none());
    render(fog, &folder.path().join(&fog.name));
    let card = Card::read(fog, folder.path()).expect("a result").expect("a card");
    assert_eq!(card.pictures.len(), 5);
    assert!(card.left_out.iter().any(|item| item.part == "surface photons"), "{:?}", card.left_out);
    let command = &card.command;
    assert!(command.contains("--passes 2 --seed 3 --set sensor.film.width=16"), "{command}");
    let arrival = &card.pictures[4].caption;
    assert!(arrival.contains("blue ") && arrival.contains(" to red "), "{arrival}");

    let file = folder.path().join("index.html");
    page::write(&file, &[card]).expect("a page");
    let mut browser = Browser::start().unwrap_or_else(|error| panic!("{error}"));
    let mut page = browser.open(&file).expect("the page opens");
    let pictures = "[...document.images].map((image) => [image.naturalWidth, image.alt.length])";
    let pictures = ask(&mut page, pictures);
    let pictures = pictures.as_array().expect("a list");
    assert_eq!(pictures.len(), 5);
    for picture in pictures {
        assert_eq!(picture[0], 16, "each picture is decoded");
        assert!(picture[1].as_u64().is_some_and(|letters| letters > 10), "and told in words");
    }
    let row = "new Set([...document.images].map((i) => i.getBoundingClientRect().top)).size";
    assert_eq!(ask(&mut page, row), 1, "one row on a desktop");
    page.viewport(Viewport::PHONE).expect("a phone");
    assert_eq!(ask(&mut page, row), 3, "below each other on a phone");
    let overflow = "document.documentElement.scrollWidth > innerWidth";
    assert_eq!(ask(&mut page, overflow), false, "nothing reaches beyond the screen");
    let mut colours = Vec::new();
    for theme in ["light", "dark"] {
        page.prefer("prefers-color-scheme", theme).expect("a theme");
        colours.push(ask(&mut page, "getComputedStyle(document.body).backgroundColor"));
    }
    assert_ne!(colours[0], colours[1], "two themes");
    let problems = page.problems();
    assert!(problems.is_empty(), "{problems:#?}");
}
