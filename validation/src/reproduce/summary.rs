//! All scenes together: the table of who wins where, as a page, as text, and as Markdown.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::compare::Comparison;
use super::cornell::{self, CornellResult};
use super::mirrors::{self, MirrorsResult};
use super::page::Page;
use super::{report, tables, write_json, write_text};
use crate::error::Result;
use crate::statistics::{Factor, Winner};
use crate::suite::Circumstances;

/// Where each scene's files are.
const PAGE: &str = "index.html";

/// What the scenes' `result.json` say; those that were not made are left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// *Cornell blocks*.
    pub cornell: Option<CornellResult>,
    /// *Mirrors*.
    pub mirrors: Option<MirrorsResult>,
}

/// A line of the table: a method on a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Scene and film.
    pub scene: String,
    /// Method.
    pub method: String,
    /// CPU time of a run \[s\].
    pub cpu_seconds: String,
    /// NMSE with its interval.
    pub error: String,
    /// Times less error of beams over path.
    pub factor: String,
    /// Kinds of cells and windows of time in which path tracing has less error.
    pub lost: String,
}

impl Summary {
    /// What earlier runs left in a folder.
    pub fn read(out: &Path) -> Self {
        fn found<T: for<'a> Deserialize<'a>>(out: &Path, name: &str) -> Option<T> {
            let text = std::fs::read_to_string(out.join(name).join("result.json")).ok()?;
            serde_json::from_str(&text).ok()
        }
        Self { cornell: found(out, cornell::NAME), mirrors: found(out, mirrors::NAME) }
    }

    /// The comparisons with their names.
    fn comparisons(&self) -> Vec<(String, &Comparison)> {
        let named = |name: &str, c: &Comparison| {
            format!("{name}, {}x{}x{}", c.shape[0], c.shape[1], c.shape[2])
        };
        let mut list = Vec::new();
        if let Some(cornell) = &self.cornell {
            list.push((named(cornell::NAME, &cornell.picture), &cornell.picture));
            list.extend(cornell.precise.iter().map(|c| (named(cornell::NAME, c), c)));
        }
        if let Some(mirrors) = &self.mirrors {
            list.push((named(mirrors::TWIN, &mirrors.equal_time), &mirrors.equal_time));
        }
        list
    }

    /// The table: a line for each scene and method.
    pub fn lines(&self) -> Vec<Line> {
        let lines = |(scene, c): (String, &Comparison)| -> Vec<Line> {
            let whole = c.whole();
            let line = |(index, method): (usize, &String)| Line {
                scene: scene.clone(),
                method: method.clone(),
                cpu_seconds: format!("{:.1}", whole.methods[index].spent.cpu_seconds),
                error: tables::interval(&whole.methods[index].judged.nmse),
                factor: if index == 1 { factor(c) } else { String::new() },
                lost: if index == 1 { lost(c) } else { String::new() },
            };
            c.methods.iter().enumerate().map(line).collect()
        };
        self.comparisons().into_iter().flat_map(lines).collect()
    }

    /// The table as Markdown.
    pub fn markdown(&self) -> String {
        let head = "| scene | method | CPU s | NMSE (95 % interval) | times less error | beams lose in |\n\
                    | --- | --- | ---: | ---: | ---: | --- |\n";
        let row = |l: Line| {
            let Line { scene, method, cpu_seconds, error, factor, lost } = l;
            format!("| {scene} | {method} | {cpu_seconds} | {error} | {factor} | {lost} |\n")
        };
        self.lines().into_iter().map(row).fold(head.to_owned(), |text, row| text + &row)
    }

    /// Writes `index.html`, `table.md` and `table.json` into the folder of all scenes.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&self, out: &Path, circumstances: &Circumstances, command: &str) -> Result<()> {
        let lines = self.lines();
        write_json(&out.join("table.json"), &lines)?;
        write_text(&out.join("table.md"), &self.markdown())?;
        let mut page = Page::new("Transient photon beams: the evidence, made again");
        for (name, title, there) in [
            (
                cornell::NAME,
                "Cornell blocks: equal time, reference, errors, maps",
                self.cornell.is_some(),
            ),
            (
                mirrors::NAME,
                "Mirrors: delta and continuous, delay in glass, caustics",
                self.mirrors.is_some(),
            ),
        ] {
            if there {
                page.link(&format!("{name}/{PAGE}"), title);
            }
        }
        let rows: Vec<Vec<String>> = lines
            .into_iter()
            .map(|l| vec![l.scene, l.method, l.cpu_seconds, l.error, l.factor, l.lost])
            .collect();
        page.heading("Equal time");
        page.table(
            "NMSE over pixels that see no lamp; times less error is a ratio of NMSE \u{d7} CPU s",
            &["scene", "method", "CPU s", "NMSE", "times less error", "beams lose in"],
            &rows,
        );
        for (name, comparison) in self.comparisons() {
            page.note(&format!("{name}: {}", tables::won(comparison, Winner::First)));
        }
        report::provenance(&mut page, circumstances, command, &[]);
        page.write(&out.join(PAGE))
    }
}

fn factor(comparison: &Comparison) -> String {
    let whole = comparison.whole();
    let text = |f: Option<Factor>| f.map_or("—".to_owned(), |f| f.text());
    format!("{} (all pixels: {})", text(whole.factor), text(whole.factor_whole))
}

/// Kinds and windows that path tracing wins, with factor, and the whole image if it wins that.
fn lost(comparison: &Comparison) -> String {
    let parts = comparison.kinds.iter().chain(&comparison.windows);
    let mut lost: Vec<String> = parts
        .filter(|part| part.factor.is_some() && part.winner() == Winner::First)
        .map(|part| {
            let factor = part.factor.map_or(String::new(), |factor| factor.text());
            format!("{} ({factor}; {:.0} % of \u{3a3}r\u{b2})", part.label, 100.0 * part.share)
        })
        .collect();
    let whole = comparison.whole().factor_whole;
    if let Some(factor) = whole.filter(|factor| factor.winner() == Winner::First) {
        // Over judged pixels nothing of this is seen.
        lost.push(format!("all pixels, with those that see a lamp ({})", factor.text()));
    }
    if lost.is_empty() { "none resolved".to_owned() } else { lost.join("; ") }
}
