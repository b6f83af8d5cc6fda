//! `cargo xtask gallery`: renders the scenes of `scenes/` with the program, as a user would, and
//! puts them on one page.

mod agreement;
mod program;

use std::fs;
use std::path::PathBuf;

use clap::Args;
use serde_json::Value;
use tpb_scene::load::{LoadedScene, Override, load_scene};
use tpb_validation::gallery::{Beside, Card, GalleryScene, Order, page, scenes_in};

use crate::workspace::{Outcome, root, say};
use program::Program;

/// Options of `cargo xtask gallery`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask gallery                      all scenes, a minute each
  cargo xtask gallery window --time 300    one of them for five minutes
  cargo xtask gallery mirrors-area --method path
  cargo xtask gallery --agreement          do the methods agree on these scenes? (renders nothing else)

Writes index.html, and for each scene a result folder and the viewer's page, which flips between the
method and a second one that renders the scene: the path tracer, else the light tracer; beside these,
beams. The second one has three tenths of the time.

Scenes that are not named stay on the page as they were rendered last. One that this commit has
rendered with the same options already is kept, so that the command goes on where it was interrupted.")]
pub(crate) struct GalleryArgs {
    /// Names of scenes [default: all of scenes/]
    names: Vec<String>,
    /// Rendering method; photon beams render all light of these scenes
    #[arg(long, default_value = "beams", value_parser = ["beams", "path", "light"])]
    method: String,
    /// Wall time of each scene's renders in seconds, at least 0.1
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = seconds,
        allow_negative_numbers = true)]
    time: f64,
    /// Pixels in a row; rows in proportion [default: the scene's]
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    width: Option<u32>,
    /// Largest size of each viewer's page, in MB, from 0.1 to 10000
    #[arg(long, value_name = "MB", default_value_t = 12.0, value_parser = megabytes,
        allow_negative_numbers = true)]
    budget: f64,
    /// Renders nothing: makes the page again from what is there
    #[arg(long)]
    page_only: bool,
    /// Renders anew also what is there already
    #[arg(long, conflicts_with = "page_only")]
    anew: bool,
    /// Compares the methods, 32 batches each, instead
    #[arg(long, conflicts_with_all = ["page_only", "anew", "width", "budget", "time", "method"])]
    agreement: bool,
    /// Passes of a batch of that comparison
    #[arg(long, value_name = "N", default_value_t = 1, requires = "agreement")]
    passes: u64,
    /// Output folder [default: target/gallery]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Renders and writes, or compares.
pub(crate) fn run(args: &GalleryArgs) -> Outcome {
    let scenes = scenes_in(&root().join("scenes"))?;
    if let Some(name) = args.names.iter().find(|name| !scenes.iter().any(|s| s.name == **name)) {
        let known: Vec<_> = scenes.iter().map(|scene| scene.name.as_str()).collect();
        return Err(format!("there is no scene '{name}'; there are {}", known.join(", ")).into());
    }
    let wanted = |scene: &&GalleryScene| args.names.is_empty() || args.names.contains(&scene.name);
    if args.agreement {
        return agreement::compare(scenes.iter().filter(wanted), args.passes);
    }
    let out = args.out.clone().unwrap_or_else(|| root().join("target/gallery"));
    fs::create_dir_all(&out)?;
    let out = out.canonicalize()?;
    let mut sound = true;
    if !args.page_only {
        let program = Program::build()?;
        for scene in scenes.iter().filter(wanted) {
            let order = order(scene, args)?;
            if !args.anew && order.is_done(&scene.name, &out) {
                say(&format!("== {}: is there already, by this commit; --anew", scene.name));
                continue;
            }
            say(&format!("== {}", scene.name));
            sound &= program.carry_out(scene, &order, args.width, &out)?;
        }
    }
    let mut cards = Vec::new();
    for scene in &scenes {
        cards.extend(Card::read(scene, &out)?);
    }
    let index = out.join("index.html");
    page::write(&index, &cards)?;
    let size = fs::metadata(&index)?.len() as f64 / 1e6;
    say(&format!("wrote {}: {} scenes, {size:.1} MB", index.display(), cards.len()));
    Ok(sound)
}

/// What the command line asks of a scene.
fn order(scene: &GalleryScene, args: &GalleryArgs) -> Result<Order, Box<dyn std::error::Error>> {
    let loaded = load(scene, args.width)?;
    let beside = match args.method.as_str() {
        "beams" => tpb_validation::gallery::agreement::companion(&loaded.scene)
            .map_or_else(Beside::Nobody, |method| Beside::Method(method.to_owned())),
        _ => Beside::Method("beams".to_owned()),
    };
    Ok(Order {
        commit: crate::circumstances::commit(),
        scene: loaded.canonical,
        method: args.method.clone(),
        beside,
        seconds: args.time,
        budget: args.budget,
        sound: true,
    })
}

/// A scene, its film of a given width.
fn load(
    scene: &GalleryScene,
    width: Option<u32>,
) -> Result<LoadedScene, Box<dyn std::error::Error>> {
    let changes: Result<Vec<_>, _> =
        film(scene, width)?.iter().map(|change| Override::parse(change)).collect();
    let changes = changes.map_err(|error| error.to_string())?;
    Ok(load_scene(&scene.file, &changes).map_err(|error| error.to_string())?)
}

/// The changes of a scene that give its film another width, in proportion.
fn film(
    scene: &GalleryScene,
    width: Option<u32>,
) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let Some(width) = width else { return Ok(Vec::new()) };
    let file: Value = serde_json::from_str(&fs::read_to_string(&scene.file)?)?;
    let film = &file["sensor"]["film"];
    let side = |key: &str| film[key].as_f64().ok_or_else(|| format!("no {key} in {}", scene.name));
    let rows = ((side("height")? / side("width")? * f64::from(width)).round() as u32).max(1);
    Ok(vec![format!("sensor.film.width={width}"), format!("sensor.film.height={rows}")])
}

/// A wall time.
fn seconds(text: &str) -> Result<f64, String> {
    let time: Option<f64> = text.parse().ok();
    let possible = time.filter(|time| (0.1..=1e6).contains(time));
    possible.ok_or_else(|| "expected a number of seconds from 0.1 to 1e6".to_owned())
}

/// A size that the viewer's pages may have.
fn megabytes(text: &str) -> Result<f64, String> {
    let size: Option<f64> = text.parse().ok();
    let possible = size.filter(|size| (0.1..=10_000.0).contains(size));
    possible.ok_or_else(|| "expected a number of MB from 0.1 to 10000".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_made_is_refused_before_anything_is_rendered() {
        assert_eq!((megabytes("12"), seconds("0.5")), (Ok(12.0), Ok(0.5)));
        for text in ["0", "-1", "NaN", "inf", "0.01", "1e9", "much"] {
            assert!(megabytes(text).is_err() && seconds(text).is_err(), "{text}");
        }
    }
}
