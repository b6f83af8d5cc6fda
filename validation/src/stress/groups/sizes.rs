//! Sizes: one pixel, one photon, none; and the program's own way with extremes.

use std::fs;
use std::process::Command;

use serde_json::json;

use crate::error::{Result, ValidationError};
use crate::stress::case::{Case, Finding, Method, Setup, Work};
use crate::stress::laws::says;
use crate::stress::shot::Shot;
use crate::stress::world::{Film, Unit, World};
use crate::stress::worlds::{FILM, everything, furnace, steady};

pub(super) fn cases() -> Vec<Case> {
    let mut cases = vec![
        Case::new("size/1-pixel", "tiles, strips and grids of one", |setup, method| {
            let film = Film { width: 1, height: 1, ..FILM };
            let work = Work { samples: 64, ..Work::LITTLE };
            let image =
                Shot::new(&everything(Unit::SI, film), method, &work)?.render(setup.seed, 2)?;
            let lit = image.total() > 0.0;
            let lamp = Shot::new(&furnace(1.5, [0.0, 0.3, 1.6], steady(1)), method, &work)?;
            let radiance = lamp.render(setup.seed, 1)?.total();
            let text = format!("sound, sum {:e}; furnace {radiance}", image.total());
            // No connection crosses the furnace's glass.
            let furnace = method == Method::Light || (radiance - 1.0).abs() < 1e-9;
            Ok(Finding::exact(lit && furnace, text))
        }),
        Case::new(
            "size/1-x-1000-pixels",
            "films of one column: tiles without area",
            |setup, method| {
                let film = Film { width: 1, height: 1000, bins: 2, ..FILM };
                let world = everything(Unit::SI, film);
                let image = Shot::new(&world, method, &Work::LITTLE)?.render(setup.seed, 1)?;
                let text = format!("sound, sum {:e}", image.total());
                Ok(Finding::exact(image.total() > 0.0, text))
            },
        ),
        Case::new("size/1-photon", "maps with one entry or none, shares of 1", |setup, method| {
            let work = Work { photons: 1, samples: 1, ..Work::LITTLE };
            let mut lit = 0;
            let shot = Shot::new(&everything(Unit::SI, FILM), method, &work)?;
            shot.batches(setup.seed, 50, 1, |image| lit += usize::from(image.total() > 0.0))?;
            Ok(Finding::exact(lit > 0, format!("50 sound renders, {lit} of them lit")))
        })
        .without(Method::Path, "traces no photons"),
        Case::new("size/0-photons", "a division by the number of photons", |setup, method| {
            let work = Work { photons: 0, ..Work::LITTLE };
            let shot = Shot::new(&everything(Unit::SI, FILM), method, &work)?;
            let text = shot.render(setup.seed, 1).err().map(|e| e.to_string());
            Ok(says(&text.unwrap_or_default(), &["photons", "at least 1"]))
        })
        .without(Method::Path, "traces no photons"),
    ];
    cases.extend(program());
    cases
}

/// What a user who renders this with these options sees: exit code and parts of the text.
struct Seen {
    name: &'static str,
    risk: &'static str,
    text: fn() -> String,
    options: &'static [&'static str],
    code: i32,
    parts: &'static [&'static str],
}

fn room() -> String {
    everything(Unit::SI, FILM).text()
}

fn lit_by(light: f64) -> String {
    everything(Unit { light, ..Unit::SI }, FILM).text()
}

fn film(film: Film) -> String {
    everything(Unit::SI, film).text()
}

/// A lamp within a glass cube, paths without a limit.
fn trap() -> String {
    let depths = json!({"type": "path", "max_depth": -1});
    let world: World = furnace(1.5, [0.0, 0.3, 1.6], steady(4)).point("bulb", [0.1, 0.2, 0.3], 1.0);
    world.with("integrator", depths).text()
}

const QUICK: &[&str] = &["--passes", "1", "--no-pictures"];
const BEAMS: &[&str] = &["--method", "beams", "--photons", "100", "--passes", "1", "--no-pictures"];
const RADIUS: &[&str] = &["--method", "beams", "--radius", "1e300", "--passes", "1"];
const NO_PHOTONS: &[&str] = &["--method", "beams", "--photons", "0"];

const SEEN: [Seen; 10] = [
    Seen {
        name: "sound",
        risk: "the way itself: an extreme room of 1e16 m through the command line",
        text: || everything(Unit::of_length(1e16), FILM).text(),
        options: BEAMS,
        code: 0,
        parts: &["closes to", "not finite"],
    },
    Seen {
        name: "endless-glass",
        risk: "total internal reflection without a limit of depth: a hang",
        text: trap,
        options: QUICK,
        code: 2,
        parts: &["shape 'glass'", "'bulb'", "--max-depth N", "ledger"],
    },
    Seen {
        name: "too-bright",
        risk: "infinities in arrays and exit code 0",
        text: || lit_by(1e60),
        options: BEAMS,
        code: 1,
        parts: &["exceed 3e38", "lower all powers"],
    },
    Seen {
        name: "too-dark",
        risk: "zeros in arrays and exit code 0",
        text: || lit_by(1e-60),
        options: BEAMS,
        code: 1,
        parts: &["raise all powers"],
    },
    Seen {
        name: "power-1e305",
        risk: "a black image for an overflow",
        text: || lit_by(1e305),
        options: QUICK,
        code: 2,
        parts: &["1e-100 to 1e100", "scene.json:"],
    },
    Seen {
        name: "not-a-number",
        risk: "NaN in JSON: a panic, or an error without a place",
        text: || room().replacen("38.0", "NaN", 1),
        options: QUICK,
        code: 2,
        parts: &["scene.json:"],
    },
    Seen {
        name: "film-of-40-terabytes",
        risk: "an allocation that the system kills",
        text: || film(Film { width: 20_000, height: 20_000, bins: 100_000, ..FILM }),
        options: QUICK,
        code: 2,
        parts: &["does not fit", "at most"],
    },
    Seen {
        name: "bins-of-1e-300",
        risk: "bins that no arrival can be told apart in",
        text: || film(Film { bin: 1e-300, ..FILM }),
        options: QUICK,
        code: 2,
        parts: &["too narrow", "bin_width_opl"],
    },
    Seen {
        name: "radius-1e300",
        risk: "a radius whose square is infinite",
        text: room,
        options: RADIUS,
        code: 2,
        parts: &["'radius'", "must be"],
    },
    Seen {
        name: "0-photons",
        risk: "a division by the number of photons",
        text: room,
        options: NO_PHOTONS,
        code: 2,
        parts: &["--photons"],
    },
];

fn program() -> Vec<Case> {
    let case = |seen: &'static Seen| {
        Case::of_no_method(format!("program/{}", seen.name), seen.risk, move |setup| {
            shown(setup, seen)
        })
    };
    SEEN.iter().map(case).collect()
}

/// Runs the program.
fn shown(setup: &Setup, seen: &Seen) -> Result<Finding> {
    let Some(program) = &setup.program else {
        return Ok(Finding::exact(false, "there is no program to run"));
    };
    let folder = setup.folder.join(seen.name);
    let io = |error| ValidationError::io(&folder, error);
    fs::create_dir_all(&folder).map_err(io)?;
    fs::write(folder.join("scene.json"), (seen.text)()).map_err(io)?;
    let mut command = Command::new(program);
    command.current_dir(&folder).args(["render", "scene.json", "-o", "result", "--threads", "2"]);
    let output = command.args(seen.options).env("NO_COLOR", "1").output().map_err(io)?;
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    let code = output.status.code();
    if code != Some(seen.code) || text.contains("panicked") {
        return Ok(Finding::exact(false, format!("exit {code:?}, not {}: {text}", seen.code)));
    }
    let exit = Finding::exact(true, format!("exit {}", seen.code));
    Ok(exit.and(says(&text, seen.parts)))
}
