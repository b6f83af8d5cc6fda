//! `cargo xtask meshes`: writes the gallery's meshes and images.

use std::fs;

use tpb_validation::gallery::compass;
use tpb_validation::gallery::meshes::{MESHES, MeshFile};

use crate::workspace::{Outcome, root, say};

/// Writes all of them into `scenes/meshes` and `scenes/textures`.
pub(crate) fn run() -> Outcome {
    let folder = root().join("scenes/meshes");
    fs::create_dir_all(&folder)?;
    for MeshFile { name, make } in MESHES {
        let bytes = make().to_ply();
        fs::write(folder.join(name), &bytes)?;
        say(&format!("scenes/meshes/{name}: {} bytes", bytes.len()));
    }
    let folder = root().join("scenes/textures");
    fs::create_dir_all(&folder)?;
    let bytes = compass::png();
    fs::write(folder.join("compass.png"), &bytes)?;
    say(&format!("scenes/textures/compass.png: {} bytes", bytes.len()));
    Ok(true)
}
