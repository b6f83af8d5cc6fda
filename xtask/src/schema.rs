//! `cargo xtask schema`: the JSON schema of the scene format, generated from the code.

use std::fs;

use crate::workspace::{Outcome, complain, root, say};

/// Writes `scene.schema.json`, or checks that it is what the code says.
pub(crate) fn run(write: bool) -> Outcome {
    let path = root().join("scene.schema.json");
    let text = tpb_scene::description::schema_text();
    if write {
        fs::write(&path, text)?;
        say(&format!("wrote {}", path.display()));
        return Ok(true);
    }
    let fresh = fs::read_to_string(&path).is_ok_and(|old| old == text);
    if fresh {
        say("scene.schema.json is fresh");
    } else {
        complain("scene.schema.json is stale; run `cargo xtask schema --write`");
    }
    Ok(fresh)
}
