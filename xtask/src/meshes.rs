//! `cargo xtask meshes`: writes the gallery's meshes.

use std::fs;

use tpb_validation::gallery::meshes::{MESHES, MeshFile};

use crate::workspace::{Outcome, root, say};

/// Writes all of them into `scenes/meshes`.
pub(crate) fn run() -> Outcome {
    let folder = root().join("scenes/meshes");
    fs::create_dir_all(&folder)?;
    for MeshFile { name, make } in MESHES {
        let bytes = make().to_ply();
        fs::write(folder.join(name), &bytes)?;
        say(&format!("scenes/meshes/{name}: {} bytes", bytes.len()));
    }
    Ok(true)
}
