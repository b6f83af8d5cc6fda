//! From a scene file to a scene, or to an error that says what to change.
//!
//! The way of a file: text → a tree that knows the place of every value (`scan`) → overrides
//! applied to the tree → structs of the [vocabulary](crate::description), read through serde by a
//! deserialiser that keeps those places (`de`) → references followed and values checked against
//! each other (`build`) → [`Scene::assemble`], which finds contradictions between media.
//!
//! The first error ends the way. It carries file, line, column, JSON path and a hint, because a
//! scene is written by hand and the loader is where a user meets the program first. No input
//! makes the loader panic: whatever the bytes, the answer is a scene or a [`SceneError`].

mod build;
mod de;
mod dictionary;
mod error;
mod mesh;
mod names;
mod overrides;
mod scan;
mod source;
mod transform;
mod tree;
mod trouble;
mod vocabulary;

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use glam::DAffine3;

use crate::Scene;
use crate::assemble::check_camera;
use build::Builder;
use dictionary::Dictionary;
use source::Source;
use tree::Node;
use trouble::Trouble;

pub use error::SceneError;
pub use overrides::Override;

/// Larger scene files are refused \[bytes\].
pub const LARGEST_FILE: u64 = 64 << 20;

/// A scene, and what it was made from.
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// The scene file with the overrides applied: the effective input, for reports.
    pub canonical: serde_json::Value,
}

/// Loads a scene file; mesh files are looked for beside it.
///
/// # Errors
///
/// Whatever is wrong with the file, its values, or the overrides.
pub fn load_scene(path: &Path, overrides: &[Override]) -> Result<LoadedScene, SceneError> {
    let name = path.display().to_string();
    let text = read_file(path).map_err(|message| SceneError::of_file(name.clone(), message))?;
    let directory = path.parent().unwrap_or(Path::new(""));
    parse_scene(&text, &name, directory, overrides)
}

/// Loads a scene from its text; `file_name` is only shown, and mesh files are looked for in
/// `directory`.
///
/// # Errors
///
/// Whatever is wrong with the text, its values, or the overrides.
pub fn parse_scene(
    text: &str,
    file_name: &str,
    directory: &Path,
    overrides: &[Override],
) -> Result<LoadedScene, SceneError> {
    let source = Source::new(file_name, text.to_owned());
    if text.len() as u64 > LARGEST_FILE {
        return Err(SceneError::of_file(file_name, too_large()));
    }
    let mut root = match scan::scan(&source) {
        Ok(root) => root,
        Err(trouble) => return Err(SceneError::new(source, None, trouble)),
    };
    for (index, change) in overrides.iter().enumerate() {
        if let Err(trouble) = change.apply(&mut root, index) {
            let note = blame(overrides, index);
            return Err(SceneError::new(source, Some(&root), trouble).with_note(note));
        }
        root.renumber();
    }
    match build_scene(&root, directory) {
        Ok(scene) => Ok(LoadedScene { scene, canonical: root.to_json() }),
        Err(trouble) => {
            let culprit = trouble.origin(&root).and_then(|index| blame(overrides, index));
            Err(SceneError::new(source, Some(&root), trouble).with_note(culprit))
        }
    }
}

/// The map of a list of steps, as it stands in [`LoadedScene::canonical`]; `None` if it is no list of
/// steps, or degenerate.
pub fn to_world(steps: &serde_json::Value) -> Option<DAffine3> {
    let node = scan::scan(&Source::new("to_world", steps.to_string())).ok()?;
    transform::to_affine(&de::read(&node).ok()?, &node).ok()
}

fn build_scene(root: &Node, directory: &Path) -> Result<Scene, Trouble> {
    let dictionary = Dictionary::read(root)?;
    let mut builder = Builder::new(&dictionary, directory);
    let parts = builder.parts()?;
    let scene = Scene::assemble(parts).map_err(|error| builder.blame(&error))?;
    check_camera(&scene).map_err(|error| builder.blame(&error))?;
    Ok(scene)
}

fn blame(overrides: &[Override], index: usize) -> Option<String> {
    let change = overrides.get(index)?;
    Some(format!("the value comes from `--set {}`", names::shortened(change.text())))
}

fn read_file(path: &Path) -> Result<String, String> {
    let failed = |error: std::io::Error| format!("cannot read the scene file: {error}");
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err("cannot read the scene file: this is not a file".to_owned());
    }
    if metadata.len() > LARGEST_FILE {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(failed)?;
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(failed)?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        format!("the scene file is not UTF-8 text: byte {at} begins no character")
    })
}

fn too_large() -> String {
    format!("the scene file is larger than {} MiB", LARGEST_FILE >> 20)
}
