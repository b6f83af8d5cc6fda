//! The loader, seen from outside: the shipped scenes, the vocabulary, the wording of errors, and
//! the promise that no input makes it panic.

mod errors;
mod plan;
mod properties;
mod surfaces;
mod vocabulary;

use std::path::{Path, PathBuf};

use tpb_scene::load::{LoadedScene, Override, SceneError, load_scene, parse_scene};

/// The shipped scenes, with the room of the Cornell box as the typical one first.
pub(crate) const SHIPPED: [&str; 4] =
    ["cornell-blocks", "infinite-point", "mirror-caustic", "mirror-caustic-point"];

pub(crate) fn shipped_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../validation/scenes")
        .join(name)
        .with_extension("json")
}

pub(crate) fn shipped_text(name: &str) -> String {
    std::fs::read_to_string(shipped_path(name)).expect("the shipped scenes are there")
}

/// Loads a text as `scene.json` in an empty directory.
pub(crate) fn parse(text: &str) -> Result<LoadedScene, SceneError> {
    parse_scene(text, "scene.json", Path::new("no-such-directory"), &[])
}

/// Loads the Cornell box with changes as of the command line.
pub(crate) fn cornell_with(changes: &[&str]) -> Result<LoadedScene, SceneError> {
    let changes: Vec<_> =
        changes.iter().map(|c| Override::parse(c).expect("a valid override")).collect();
    load_scene(&shipped_path(SHIPPED[0]), &changes)
}

/// A small scene with one more object, the value of `key`.
pub(crate) fn scene_with(key: &str, value: &str) -> String {
    format!(
        r#"{{
  "type": "scene",
  "sensor": {{"type": "perspective", "fov": 40, "film": {{"type": "hdrfilm", "width": 4, "height": 3}}}},
  "lamp": {{"type": "point", "position": [0, 0, 3]}},
  "{key}": {value}
}}"#
    )
}

/// The error of a text that must not load.
pub(crate) fn error_of(text: &str) -> SceneError {
    match parse(text) {
        Err(error) => error,
        Ok(_) => panic!("this loads:\n{text}"),
    }
}
