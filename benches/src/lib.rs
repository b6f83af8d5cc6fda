//! What the benchmarks share: the scenes that they measure on.
//!
//! `cargo bench -p tpb-benches` runs all; times are reported, never asserted.

use std::path::Path;

use tpb_scene::Scene;

/// A scene that ships in `validation/scenes`, by its name.
///
/// # Panics
/// If the scene does not load: a broken checkout.
pub fn shipped_scene(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/scenes");
    let file = folder.join(format!("{name}.json"));
    tpb_scene::load::load_scene(&file, &[]).expect("shipped scenes load").scene
}
