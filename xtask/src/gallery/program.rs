//! The gallery's renders and pages, by the program `tpb`.

use std::fs;
use std::path::{Path, PathBuf};

use tpb_validation::gallery::card::method as label;
use tpb_validation::gallery::{Beside, GalleryScene, Order, order};
use xshell::{Shell, cmd};

use crate::workspace::{Outcome, complain, root, say};

/// The part of the time that the method of the pictures has, if another one is beside it.
const SHARE: f64 = 0.7;

/// The program `tpb`.
pub(super) struct Program {
    sh: Shell,
    path: PathBuf,
}

/// A render.
struct Render<'a> {
    scene: &'a str,
    method: &'a str,
    seconds: f64,
    /// No two methods of a scene share random numbers.
    seed: u64,
    /// Changes of the scene.
    film: &'a [String],
    /// Whether there are pictures beside the arrays.
    pictures: bool,
    folder: PathBuf,
}

impl Program {
    /// Builds it; it comes to lie where this program lies.
    pub(super) fn build() -> Result<Self, Box<dyn std::error::Error>> {
        let sh = Shell::new()?;
        sh.change_dir(root());
        cmd!(sh, "cargo build --release --quiet --package tpb").quiet().run()?;
        let name = format!("tpb{}", std::env::consts::EXE_SUFFIX);
        Ok(Self { sh, path: std::env::current_exe()?.with_file_name(name) })
    }

    /// One or two result folders and the viewer's page; whether the results are sound.
    pub(super) fn carry_out(
        &self,
        scene: &GalleryScene,
        order: &Order,
        width: Option<u32>,
        out: &Path,
    ) -> Outcome {
        let name = &scene.name;
        Order::forget(name, out)?;
        let film = super::film(scene, width)?;
        let second = order::beside(name, out);
        if second.exists() {
            fs::remove_dir_all(&second)?;
        }
        let share = if let Beside::Method(_) = order.beside { SHARE } else { 1.0 };
        let first = Render {
            scene: name,
            method: &order.method,
            seconds: share * order.seconds,
            seed: 0,
            film: &film,
            pictures: true,
            folder: out.join(name),
        };
        let mut sound = self.render(&first)?;
        let mut shown = vec![(label(&order.method), first.folder.clone())];
        let mut notes = Vec::new();
        match &order.beside {
            Beside::Method(method) => {
                let seconds = order.seconds - first.seconds;
                let folder = second;
                let render = Render { method, seconds, seed: 1, pictures: false, folder, ..first };
                sound &= self.render(&render)?;
                shown.push((label(method), render.folder));
            }
            Beside::Nobody(reason) => notes.push(format!(
                "One method alone: others do not render all of this scene, and nothing here is a \
                 reference. {reason}."
            )),
        }
        self.view(scene, &shown, &notes, order.budget, &out.join(format!("{name}.html")))?;
        Order { sound, ..order.clone() }.keep(name, out)?;
        Ok(sound)
    }

    fn render(&self, render: &Render<'_>) -> Outcome {
        let Self { sh, path } = self;
        let Render { scene, method, folder, film, .. } = render;
        let seed = render.seed.to_string();
        let (file, time) = (format!("scenes/{scene}.json"), format!("{}ms", render.seconds * 1e3));
        let changes = film.iter().flat_map(|change| ["--set", change.as_str()]);
        let pictures = (!render.pictures).then_some("--no-pictures");
        let command = cmd!(
            sh,
            "{path} render {file} --method {method} --time {time} --seed {seed} {changes...} {pictures...} -o {folder}"
        );
        let output = command.quiet().ignore_status().output()?;
        let code = output.status.code();
        if !matches!(code, Some(0 | 1)) {
            let reason = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{scene} was not rendered by {method}: {reason}").into());
        }
        say(&format!("{}:", label(method)));
        let told = String::from_utf8_lossy(&output.stdout);
        let worth = |line: &&str| ["passes", "time", "error"].iter().any(|w| line.starts_with(w));
        told.lines().filter(worth).for_each(say);
        if code == Some(1) {
            complain(&format!("{scene}, {method}: the result is not sound, see its report"));
        }
        Ok(code == Some(0))
    }

    /// The viewer's page of results, each with its label.
    fn view(
        &self,
        scene: &GalleryScene,
        shown: &[(&str, PathBuf)],
        notes: &[String],
        budget: f64,
        page: &Path,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let Self { sh, path } = self;
        let (title, budget) = (&scene.title, budget.to_string());
        let folders = shown.iter().map(|(_, folder)| folder);
        let labels = shown.iter().flat_map(|(label, _)| ["--label", *label]);
        let notes = notes.iter().flat_map(|note| ["--note", note.as_str()]);
        let command = cmd!(
            sh,
            "{path} view {folders...} {labels...} {notes...} --title {title} --budget {budget} -o {page}"
        );
        // Cells that are not sound were complained about.
        let output = command.quiet().ignore_status().output()?;
        if !matches!(output.status.code(), Some(0 | 1)) {
            let reason = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{} has no viewer: {reason}", scene.name).into());
        }
        Ok(())
    }
}
