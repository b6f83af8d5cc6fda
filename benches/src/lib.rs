//! What the benchmarks share: the scenes that they measure on, their films, one thread.
//!
//! `cargo bench -p tpb-benches` runs all; times are reported, never asserted.

pub mod gathers;

use std::path::Path;

use tpb_film::TransientFilm;
use tpb_render::{FilmSetup, RenderOptions, with_threads};
use tpb_scene::load::{Override, load_scene};
use tpb_scene::{Scene, Transport};

/// A scene that ships in `validation/scenes`, by its name.
///
/// # Panics
/// If the scene does not load: a broken checkout.
pub fn shipped_scene(name: &str) -> Scene {
    sized_scene(name, None)
}

/// The same with so many pixels along both edges of its film.
///
/// # Panics
/// If the scene does not load: a broken checkout.
pub fn sized_scene(name: &str, pixels: Option<usize>) -> Scene {
    let edges = ["width", "height"].into_iter();
    let edges: Option<Vec<_>> =
        pixels.map(|n| edges.map(|edge| format!("sensor.film.{edge}={n}")).collect());
    changed_scene(name, &edges.unwrap_or_default())
}

/// The same with `PATH=VALUE` changes.
///
/// # Panics
/// If the scene does not load: a broken checkout, or a change of what it does not have.
pub fn changed_scene(name: &str, changes: &[String]) -> Scene {
    let overrides: Vec<Override> =
        changes.iter().map(|text| Override::parse(text).expect("an override")).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/scenes");
    let file = folder.join(format!("{name}.json"));
    load_scene(&file, &overrides).expect("shipped scenes load").scene
}

/// The film that an achromatic scene asks for.
///
/// # Panics
/// If there is no memory for it.
pub fn film_of(scene: &Scene) -> TransientFilm<1> {
    let setup = FilmSetup::new(&scene.film, Transport::Mono, &RenderOptions::default());
    setup.expect("a sound film").film().expect("a film that fits")
}

/// Runs `work` on one thread: figures are per core.
///
/// # Panics
/// If the thread cannot be started.
pub fn one_thread<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    with_threads(Some(1), work).expect("a thread")
}
