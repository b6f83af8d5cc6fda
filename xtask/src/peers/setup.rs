//! `cargo xtask peers --setup`: a Python environment with the peer's packages, checked by a render.

use std::error::Error;
use std::path::{Path, PathBuf};

use tpb_scene::load::load_scene;
use tpb_validation::peers::driver::Peer;
use tpb_validation::peers::translate::translate;
use tpb_validation::peers::{NAME, PACKAGES};
use xshell::{Shell, cmd};

use crate::workspace::{Outcome, root, say};

/// What to do about an LLVM that is missing or too old. 14 and 15 lack an instruction that Dr.Jit 1.5
/// uses (`fminimum`) and end the process; 19 works.
const LLVM: &str = "Dr.Jit compiles with the system's shared LLVM library, and there is none, or one that is too old: \
    LLVM 14 and 15 are, 19 works.
  Debian, Ubuntu: apt-get install libllvm19
  Fedora: dnf install llvm-libs; macOS: brew install llvm
  or name the library in the environment variable DRJIT_LIBLLVM_PATH";

/// The environment's interpreter.
pub(super) fn interpreter(environment: &Path) -> PathBuf {
    let place = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
    environment.join(place)
}

/// What is said where there is no environment.
pub(super) fn missing(environment: &Path) -> String {
    format!(
        "there is no {}\n\
         This command renders scenes with {NAME} and with our methods in turn, at equal CPU seconds, and compares \
         their errors.\n\
         It needs a Python environment with {}:\n\
         \n    cargo xtask peers --setup\n\n\
         makes it there from the Python package index (100 MB), and says which system library is missing.",
        environment.display(),
        PACKAGES.join(" and "),
    )
}

/// Makes the environment and renders with it.
pub(super) fn run(python: &Path, environment: &Path) -> Outcome {
    let sh = Shell::new()?;
    if !interpreter(environment).exists() {
        say(&format!("making {}", environment.display()));
        cmd!(sh, "{python} -m venv {environment}").quiet().run()?;
    }
    let python = interpreter(environment);
    say(&format!("installing {}", PACKAGES.join(", ")));
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    cmd!(sh, "{python} {pip...} {PACKAGES...}").quiet().run()?;
    for scene in ["validation/scenes/cornell-blocks.json", "scenes/cornell-blocks.json"] {
        if let Err(error) = check(&python, scene) {
            let text = error.to_string();
            say(&format!("{NAME} is installed, but does not render: {text}"));
            if text.contains("LLVM") {
                say(LLVM);
            }
            return Ok(false);
        }
    }
    say("setup: all is there; `cargo xtask peers` compares");
    Ok(true)
}

/// One sample per pixel of a scene.
fn check(python: &Path, scene: &str) -> Result<(), Box<dyn Error>> {
    let path = root().join(scene);
    let translation = translate(&load_scene(&path, &[])?, path.parent().unwrap_or(Path::new("")))?;
    let folder = root().join("target/peers/check");
    let peer = Peer::start(python, &folder, &translation, 1, 1)?;
    say(&format!("{}: renders {scene}, {}", translation.variant, peer.introduction().versions));
    Ok(())
}
