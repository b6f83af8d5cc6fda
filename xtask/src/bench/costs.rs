//! What a scene pays for what it does not need, as ratios of instructions.
//!
//! Both sides of a pair are renders of one scene with one seed that differ in one thing. For media,
//! the other side is another program: `tpb` with the feature `vacuum`, in which nothing can name a
//! medium (`crates/scene/src/medium.rs`), so that the compiler leaves out all that depends on one.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tpb_dashboard::bench_runs::Cost;

use super::callgrind::Callgrind;
use super::cases::{film_options, render_options};
use super::programs::{Command, Programs};
use crate::workspace::{root, say};

/// One side of a pair.
#[derive(Clone, Copy)]
struct Side {
    /// What it does.
    what: &'static str,
    /// Options beside those that both have.
    options: &'static [&'static str],
    /// Rendered by the program without media.
    vacuum: bool,
}

/// Two renders.
struct Pair {
    name: &'static str,
    /// File below the root, or [`EMPTY_ROOM`].
    scene: &'static str,
    /// What both have.
    options: &'static [&'static str],
    sides: [Side; 2],
    at_most: Option<f64>,
    at_least: Option<f64>,
}

/// Pixels along an edge of the films.
const EDGE: usize = 32;

/// cornell-blocks without its fog.
const EMPTY_ROOM: &str = "empty room";
const FOG: &str = "validation/scenes/cornell-blocks.json";
// What is chosen from scene and film otherwise, so that both sides do the same work.
const PATH: &[&str] = &["--method=path", "--samples-per-pass=8"];
const LIGHT: &[&str] = &["--method=light", "--photons=4096"];
const ONE: &[&str] = &["--method=beams", "--kernel=1d", "--radius=0.02", "--surface-radius=0.05"];
const TWO: &[&str] = &["--method=beams", "--kernel=2d", "--radius=0.02", "--surface-radius=0.05"];

/// Colour on two walls.
const WALLS: &[&str] = &[
    "--set=sensor.film.pixel_format=rgb",
    "--set=left.reflectance=[0.45,0.4,0.35]",
    "--set=right.reflectance=[0.2,0.3,0.35]",
];
/// Colour on two walls and in the fog.
const ALL: &[&str] = &[
    "--set=sensor.film.pixel_format=rgb",
    "--set=left.reflectance=[0.45,0.4,0.35]",
    "--set=right.reflectance=[0.2,0.3,0.35]",
    "--set=fog.sigma_t=[0.45,0.5,0.55]",
];

const fn side(what: &'static str, options: &'static [&'static str]) -> Side {
    Side { what, options, vacuum: false }
}

const PLAIN: Side = side("media in the program", &[]);
const COMPILED_OUT: Side = Side { what: "media compiled out", options: &[], vacuum: true };
const MONO: Side = side("mono", &[]);
const STEADY: Side = side("steady", &["--set=sensor.film.temporal_bins=0"]);
const BINS: Side = side("200 bins", &[]);
const OFF: Side = side("variance off", &[]);
const ON: Side = side("variance on", &["--variance"]);

const fn media(name: &'static str, scene: &'static str, options: &'static [&'static str]) -> Pair {
    let sides = [PLAIN, COMPILED_OUT];
    Pair { name, scene, options, sides, at_most: Some(1.02), at_least: None }
}

const fn colour(
    name: &'static str,
    options: &'static [&'static str],
    what: &'static str,
    coloured: &'static [&'static str],
) -> Pair {
    let sides = [side(what, coloured), MONO];
    Pair { name, scene: FOG, options, sides, at_most: None, at_least: Some(2.0) }
}

/// The first must not be dearer than the second.
const fn without(name: &'static str, options: &'static [&'static str], sides: [Side; 2]) -> Pair {
    Pair { name, scene: FOG, options, sides, at_most: Some(1.0), at_least: None }
}

const PAIRS: &[Pair] = &[
    media("cost/media, path", EMPTY_ROOM, PATH),
    media("cost/media, path, surfaces-only", "scenes/surfaces-only.json", PATH),
    media("cost/media, beams", EMPTY_ROOM, ONE),
    media("cost/media, light", EMPTY_ROOM, LIGHT),
    colour("cost/colour, path", PATH, "rgb walls and fog", ALL),
    colour("cost/colour, path, walls", PATH, "rgb walls", WALLS),
    colour("cost/colour, beams 1D", ONE, "rgb walls and fog", ALL),
    colour("cost/colour, beams 2D", TWO, "rgb walls and fog", ALL),
    colour("cost/colour, light", LIGHT, "rgb walls and fog", ALL),
    without("cost/bins, path", PATH, [STEADY, BINS]),
    without("cost/bins, beams 1D", ONE, [STEADY, BINS]),
    without("cost/bins, beams 2D", TWO, [STEADY, BINS]),
    Pair {
        name: "cost/even, beams 2D",
        scene: FOG,
        options: TWO,
        sides: [side("even in time", &["--temporal=even"]), side("exact in time", &[])],
        at_most: Some(1.05),
        at_least: None,
    },
    without("cost/variance, path", PATH, [OFF, ON]),
    without("cost/variance, beams 1D", ONE, [OFF, ON]),
];

/// Names of all pairs.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    PAIRS.iter().map(|pair| pair.name)
}

/// Counts the pairs whose names are `wanted`.
pub(crate) fn measure(
    programs: &Programs,
    callgrind: &Callgrind,
    seed: u64,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<Cost>, Box<dyn Error>> {
    let pairs: Vec<&Pair> = PAIRS.iter().filter(|pair| wanted(pair.name)).collect();
    let vacuum = if pairs.iter().any(|pair| pair.sides.iter().any(|side| side.vacuum)) {
        say("building tpb without media");
        Some(programs.build_vacuum()?)
    } else {
        None
    };
    let room = programs.file("empty-room.json");
    fs::write(&room, empty_room(&fs::read_to_string(root().join(FOG))?)?)?;
    let mut costs: Vec<Cost> = Vec::new();
    // Several pairs have a side in common.
    let mut counted: BTreeMap<(bool, String), f64> = BTreeMap::new();
    for pair in pairs {
        let mut count = |side: &Side| -> Result<f64, Box<dyn Error>> {
            let tpb = vacuum.as_deref().filter(|_| side.vacuum).unwrap_or(programs.tpb());
            let file = programs.file("callgrind.out");
            let make = |passes| command(programs, tpb, (pair, side), &room, passes, seed);
            let key = (side.vacuum, make(1).shown);
            if let Some(&known) = counted.get(&key) {
                return Ok(known);
            }
            let found = callgrind.count(programs.shell(), &file, 1, make)?.instructions;
            counted.insert(key, found);
            Ok(found)
        };
        let instructions = [count(&pair.sides[0])?, count(&pair.sides[1])?];
        let cost = Cost {
            name: pair.name.to_owned(),
            sides: pair.sides.map(|side| side.what.to_owned()),
            instructions,
            at_most: pair.at_most,
            at_least: pair.at_least,
        };
        say(&format!("{}: {:.4}", cost.name, cost.ratio()));
        costs.push(cost);
    }
    Ok(costs)
}

fn command(
    programs: &Programs,
    tpb: &Path,
    (pair, side): (&Pair, &Side),
    room: &Path,
    passes: u64,
    seed: u64,
) -> Command {
    let scene = if pair.scene == EMPTY_ROOM { room.to_owned() } else { PathBuf::from(pair.scene) };
    let options = pair.options.iter().chain(side.options).map(|&option| option.to_owned());
    let arguments = std::iter::once(scene.display().to_string()).chain(options);
    let arguments = arguments.chain(film_options(EDGE)).chain(render_options(passes, seed));
    programs.render(tpb, arguments.collect())
}

/// The scene cornell-blocks without its fog and the boundary in front of it.
fn empty_room(text: &str) -> Result<String, Box<dyn Error>> {
    let mut scene: Value = serde_json::from_str(text)?;
    let parts = scene.as_object_mut().ok_or("the scene is no dictionary")?;
    for part in ["fog", "front"] {
        parts.remove(part).ok_or_else(|| format!("the scene has no '{part}'"))?;
    }
    Ok(scene.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_room_has_no_medium() {
        let text = fs::read_to_string(root().join(FOG)).unwrap();
        let scene: Value = serde_json::from_str(&empty_room(&text).unwrap()).unwrap();
        let parts = scene.as_object().unwrap();
        assert!(parts.contains_key("lamp") && !parts.contains_key("fog"));
        assert!(parts.values().all(|part| part.get("interior").is_none()));
        assert!(empty_room("{}").is_err() && empty_room("[").is_err());
    }

    #[test]
    fn pairs_differ_in_one_thing_and_have_names_of_their_own() {
        let mut all: Vec<_> = names().collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), PAIRS.len());
        for Pair { name, sides: [a, b], .. } in PAIRS {
            assert!(name.starts_with("cost/"), "{name}");
            assert!((a.options != b.options) != (a.vacuum != b.vacuum), "{name}");
        }
    }
}
