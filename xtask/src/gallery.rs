//! `cargo xtask gallery`: renders the scenes of `scenes/` with the program, as a user would, and
//! puts them on one page.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;
use tpb_scene::load::{LoadedScene, Override, load_scene};
use tpb_validation::gallery::agreement::{Agreement, Terms, agreements};
use tpb_validation::gallery::{Card, GalleryScene, page, scenes_in};
use tpb_validation::measure::BatchPlan;
use tpb_validation::statistics::Finding;
use xshell::{Shell, cmd};

use crate::workspace::{Outcome, complain, root, say};

/// Options of `cargo xtask gallery`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask gallery                      all scenes, a minute each
  cargo xtask gallery window --time 300    one of them for five minutes
  cargo xtask gallery mirrors-area --method path
  cargo xtask gallery --agreement          do the methods agree on these scenes? (renders nothing else)

Writes index.html, and for each scene a result folder and the viewer's page. Scenes that are not
named stay on the page as they were rendered last.")]
pub(crate) struct GalleryArgs {
    /// Names of scenes [default: all of scenes/]
    names: Vec<String>,
    /// Rendering method; photon beams render all light of these scenes
    #[arg(long, default_value = "beams", value_parser = ["beams", "path", "light"])]
    method: String,
    /// Wall time of each render in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    time: f64,
    /// Pixels in a row; rows in proportion [default: the scene's]
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    width: Option<u32>,
    /// Largest size of each viewer's page, in MB
    #[arg(long, value_name = "MB", default_value_t = 12.0)]
    budget: f64,
    /// Renders nothing: makes the page again from what is there
    #[arg(long)]
    page_only: bool,
    /// Compares the methods, 32 batches each, instead
    #[arg(long, conflicts_with_all = ["page_only", "width", "budget", "time", "method"])]
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
        return compare(scenes.iter().filter(wanted), args.passes);
    }
    let out = args.out.clone().unwrap_or_else(|| root().join("target/gallery"));
    fs::create_dir_all(&out)?;
    let out = out.canonicalize()?;
    let mut sound = true;
    if !args.page_only {
        let program = Program::build()?;
        for scene in scenes.iter().filter(wanted) {
            say(&format!("== {}", scene.name));
            sound &= program.render(scene, args, &out)?;
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

/// The program `tpb`.
struct Program {
    sh: Shell,
    path: PathBuf,
}

impl Program {
    /// Builds it; it comes to lie where this program lies.
    fn build() -> Result<Self, Box<dyn std::error::Error>> {
        let sh = Shell::new()?;
        sh.change_dir(root());
        cmd!(sh, "cargo build --release --quiet --package tpb").quiet().run()?;
        let name = format!("tpb{}", std::env::consts::EXE_SUFFIX);
        Ok(Self { sh, path: std::env::current_exe()?.with_file_name(name) })
    }

    /// A result folder and the viewer's page; whether the result is sound.
    fn render(&self, scene: &GalleryScene, args: &GalleryArgs, out: &Path) -> Outcome {
        let Self { sh, path } = self;
        let (name, method, folder) = (&scene.name, &args.method, out.join(&scene.name));
        let (file, time) = (format!("scenes/{name}.json"), format!("{}ms", args.time * 1e3));
        let mut changes = Vec::new();
        if let Some(width) = args.width {
            changes.extend(["--set".to_owned(), format!("sensor.film.width={width}")]);
            changes.extend([
                "--set".to_owned(),
                format!("sensor.film.height={}", rows(scene, width)?),
            ]);
        }
        let render = cmd!(
            sh,
            "{path} render {file} --method {method} --time {time} {changes...} -o {folder}"
        );
        let output = render.quiet().ignore_status().output()?;
        let code = output.status.code();
        if !matches!(code, Some(0 | 1)) {
            let reason = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{name} was not rendered: {reason}").into());
        }
        let told = String::from_utf8_lossy(&output.stdout);
        let worth = |line: &&str| ["passes", "time", "error"].iter().any(|w| line.starts_with(w));
        told.lines().filter(worth).for_each(say);
        let (page, budget) = (out.join(format!("{name}.html")), args.budget.to_string());
        let title = &scene.title;
        cmd!(sh, "{path} view {folder} --title {title} --budget {budget} -o {page}")
            .quiet()
            .run()?;
        if code == Some(1) {
            complain(&format!("{name}: the result is not sound, see its report"));
        }
        Ok(code == Some(0))
    }
}

/// Rows of a film that keeps the scene's proportions.
fn rows(scene: &GalleryScene, width: u32) -> Result<u32, Box<dyn std::error::Error>> {
    let file: Value = serde_json::from_str(&fs::read_to_string(&scene.file)?)?;
    let film = &file["sensor"]["film"];
    let side = |key: &str| film[key].as_f64().ok_or_else(|| format!("no {key} in {}", scene.name));
    Ok(((side("height")? / side("width")? * f64::from(width)).round() as u32).max(1))
}

/// Columns of the film by which methods are compared.
const COLUMNS: u32 = 48;
/// What blur may take or give of a block's energy.
const BLUR: f64 = 0.02;
/// What else is too small to matter.
const MARGIN: f64 = 0.02;

fn compare<'a>(scenes: impl Iterator<Item = &'a GalleryScene>, passes: u64) -> Outcome {
    let plan = BatchPlan { batches: 32, passes, seed: 1 };
    let terms = Terms { plan, blur: BLUR, margin: MARGIN };
    let mut agree = true;
    for scene in scenes {
        let load = |changes: &[Override]| -> Result<LoadedScene, Box<dyn std::error::Error>> {
            Ok(load_scene(&scene.file, changes).map_err(|error| error.to_string())?)
        };
        let changes = [
            Override::parse(&format!("sensor.film.width={COLUMNS}")),
            Override::parse(&format!("sensor.film.height={}", rows(scene, COLUMNS)?)),
        ];
        let changes =
            changes.into_iter().collect::<Result<Vec<_>, _>>().map_err(|e| e.to_string())?;
        for found in agreements(&load(&changes)?, &load(&[])?, &terms)? {
            agree &= tell(&scene.name, &found);
        }
    }
    Ok(agree)
}

/// Prints what was found; whether it is no disagreement.
fn tell(name: &str, found: &Agreement) -> bool {
    let Agreement { method, judged, .. } = found;
    let judgement = match &found.found {
        Err(reason) => {
            say(&format!("{name}: beams, {method}: not compared, {reason}"));
            return true;
        }
        Ok(judgement) => judgement,
    };
    let [low, high] = judgement.interval.map(|end| 100.0 * end);
    let verdict = match judgement.finding {
        Finding::Equivalent => "equivalent",
        Finding::Unresolved => "no difference seen, not all resolved",
        Finding::Different => "DIFFERENT",
    };
    say(&format!(
        "{name}: beams, {method}: {verdict} on {:.0} % of the pixels; widest interval \
         [{low:+.1} %, {high:+.1} %], worst p {:.1e}",
        100.0 * judged,
        judgement.worst_p
    ));
    for contrast in &judgement.contrasts {
        let [low, high] = contrast.interval.map(|end| 100.0 * end);
        let mark = if contrast.adjusted_p <= judgement.false_alarm { "  <-" } else { "" };
        say(&format!(
            "  {:<26} {:.4e} (beams {:.4e}) [{low:+.1} %, {high:+.1} %]{mark}",
            contrast.name, contrast.expected, contrast.mean
        ));
    }
    judgement.finding != Finding::Different
}
