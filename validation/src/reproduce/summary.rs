//! All scenes together: who wins where, whether caustics agree, and the delay in glass; as a page, as
//! Markdown, and as JSON.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::compare::Comparison;
use super::cornell::{self, CornellResult};
use super::losses::losses;
use super::mirrors::caustics::{BEAMS_LIGHT, Caustics, LIGHT_PATH, LIMIT_LIGHT, MARGIN, THREE};
use super::mirrors::{self, MirrorsResult};
use super::page::Page;
use super::{Options, tables, write_json, write_text};
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

/// A table over all scenes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Heads of its columns.
    pub heads: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    fn new<const N: usize>(caption: String, heads: [&str; N], rows: Vec<Vec<String>>) -> Self {
        Self { caption, heads: heads.map(str::to_owned).to_vec(), rows }
    }

    fn markdown(&self) -> String {
        let row = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule: Vec<String> = self.heads.iter().map(|_| "---".to_owned()).collect();
        let rows: Vec<String> = self.rows.iter().map(|cells| row(cells)).collect();
        format!("{}:\n\n{}{}{}", self.caption, row(&self.heads), row(&rule), rows.concat())
    }
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

    /// The comparisons with their names and commits.
    fn comparisons(&self) -> Vec<(String, &str, &Comparison)> {
        let named = |name: &str, c: &Comparison| {
            format!("{name}, {}x{}x{}", c.shape[0], c.shape[1], c.shape[2])
        };
        let mut list = Vec::new();
        if let Some(cornell) = &self.cornell {
            let commit = cornell.circumstances.commit.as_str();
            let all = std::iter::once(&cornell.picture).chain(&cornell.precise);
            list.extend(all.map(|c| (named(cornell::NAME, c), commit, c)));
        }
        if let Some(mirrors) = &self.mirrors {
            let (commit, c) = (mirrors.circumstances.commit.as_str(), &mirrors.equal_time);
            list.push((named(mirrors::TWIN, c), commit, c));
        }
        list
    }

    /// Equal time, where beams lose, caustics, delays: those that there is something to say of.
    pub fn tables(&self) -> Vec<Table> {
        let mut all = vec![self.equal_time(), self.lost()];
        if let Some(mirrors) = &self.mirrors {
            all.push(close_ups(&mirrors.close));
            all.extend([&mirrors.twin, &mirrors.point].map(caustics));
            all.push(delays(mirrors));
        }
        all.push(self.origins());
        all.retain(|table| !table.rows.is_empty());
        all
    }

    /// A row for each scene and method.
    fn equal_time(&self) -> Table {
        let rows = |(scene, commit, c): (String, &str, &Comparison)| -> Vec<Vec<String>> {
            let whole = c.whole();
            let row = |(index, method): (usize, &String)| {
                let standing = &whole.methods[index];
                let mut row = vec![
                    scene.clone(),
                    method.clone(),
                    format!("{:.1}", standing.spent.wall_seconds),
                    format!("{:.1}", standing.spent.cpu_seconds),
                    tables::interval(&standing.judged.nmse),
                ];
                let factors = [whole.factor, whole.factor_wall, whole.factor_whole];
                row.extend(factors.map(|f| if index == 1 { text(f) } else { String::new() }));
                row.push(reference(c));
                row.push(commit.to_owned());
                row
            };
            c.methods.iter().enumerate().map(row).collect()
        };
        Table::new(
            "Equal time: NMSE over judged pixels (that see no lamp; where the light tracer is the \
             reference, nor mirrors and glass), and how many times less error photon beams have than \
             path tracing (ratios of NMSE \u{d7} seconds; 95 % intervals)"
                .to_owned(),
            [
                "scene",
                "method",
                "wall s",
                "CPU s",
                "NMSE",
                "by CPU s",
                "by wall s",
                "all pixels",
                "reference",
                "commit",
            ],
            self.comparisons().into_iter().flat_map(rows).collect(),
        )
    }

    /// A row for each part that beams lose; a row for each scene where they lose none.
    fn lost(&self) -> Table {
        let rows = |(scene, _, c): (String, &str, &Comparison)| -> Vec<Vec<String>> {
            let of_scene = |row: Vec<String>| [vec![scene.clone()], row].concat();
            let rows: Vec<_> = losses(c).into_iter().map(tables::loss).map(of_scene).collect();
            if rows.is_empty() {
                let nothing = ["nothing that is resolved", "", "", ""].map(str::to_owned);
                return vec![of_scene(nothing.to_vec())];
            }
            rows
        };
        let [place, factor, share, why] = tables::LOSS;
        Table::new(
            "Where photon beams lose at equal time, each with its 95 % interval, and why"
                .to_owned(),
            ["scene", place, factor, share, why],
            self.comparisons().into_iter().flat_map(rows).collect(),
        )
    }

    /// What made each scene's rows.
    fn origins(&self) -> Table {
        let of = |name: &str, c: &Circumstances, command: &str| {
            [name, &c.commit, &c.machine, &c.flags, command].map(str::to_owned).to_vec()
        };
        let cornell = self.cornell.iter().map(|r| of(cornell::NAME, &r.circumstances, &r.command));
        let mirrors = self.mirrors.iter().map(|r| of(mirrors::NAME, &r.circumstances, &r.command));
        Table::new(
            "What made the rows of each scene".to_owned(),
            ["scene and its twins", "commit", "machine", "flags", "command"],
            cornell.chain(mirrors).collect(),
        )
    }

    /// All tables as Markdown.
    pub fn markdown(&self) -> String {
        self.tables().iter().map(Table::markdown).collect::<Vec<_>>().join("\n")
    }

    /// Writes `index.html`, `table.md` and `table.json` into the folder of all scenes.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&self, options: &Options) -> Result<()> {
        let out = &options.out;
        let tables = self.tables();
        write_json(&out.join("table.json"), &tables)?;
        let trial = options.trial().map(|name| {
            format!("A trial ({name}): less time or a smaller film than the figures have.")
        });
        let heading = trial.as_ref().map_or(String::new(), |trial| format!("{trial}\n\n"));
        write_text(&out.join("table.md"), &(heading + &self.markdown()))?;
        let mut page = Page::new("Transient photon beams: the evidence, made again");
        if let Some(trial) = &trial {
            page.note(trial);
        }
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
        page.heading("In numbers");
        for table in &tables {
            let heads: Vec<&str> = table.heads.iter().map(String::as_str).collect();
            page.table(&table.caption, &heads, &table.rows);
        }
        for (name, _, comparison) in self.comparisons() {
            page.note(&format!("{name}: {}", tables::won(comparison, Winner::First)));
        }
        page.write(&out.join(PAGE)).map(drop)
    }
}

fn text(factor: Option<Factor>) -> String {
    factor.map_or("—".to_owned(), |factor| factor.text())
}

/// Who referees a comparison, and by which sources.
fn reference(comparison: &Comparison) -> String {
    comparison.reference.as_ref().map_or("not known".to_owned(), |origin| {
        let ships = if origin.batches == 0 { ", ships" } else { "" };
        format!("{}, {}{ships}", origin.method, origin.commits.join(", "))
    })
}

/// Whether three methods agree on the caustics, close up: a row for each region.
fn close_ups(close: &[Caustics]) -> Table {
    let row = |region: &mirrors::caustics::RegionResult| {
        let mut row = vec![region.label.clone()];
        let pair = |&pair: &usize| {
            region.differences.get(pair).map_or("\u{2014}".to_owned(), tables::difference)
        };
        row.extend(THREE.iter().map(pair));
        row.push(match region.bound(&THREE) {
            Some(bound) if bound <= MARGIN => format!("agree within \u{b1}{:.1} %", 100.0 * bound),
            Some(bound) => format!("open: \u{b1}{:.1} %", 100.0 * bound),
            None => "\u{2014}".to_owned(),
        });
        row
    };
    Table::new(
        format!(
            "Caustics of {} close up: relative differences of means, 95 % intervals, and whether all \
             three methods lie within \u{b1}{:.0} % of each other",
            mirrors::TWIN,
            100.0 * MARGIN
        ),
        [
            "region",
            "light \u{2212} path",
            "beams \u{2212} path",
            "beams \u{2212} light",
            "path, light, beams",
        ],
        close.iter().flat_map(|found| &found.regions).map(row).collect(),
    )
}

/// A row for each region.
fn caustics(found: &Caustics) -> Table {
    let row = |region: &mirrors::caustics::RegionResult| {
        let pair = |pair: usize| tables::difference(&region.differences[pair]);
        vec![
            region.label.clone(),
            pair(LIGHT_PATH),
            pair(BEAMS_LIGHT),
            region.blur.map_or("—".to_owned(), tables::percent),
            pair(LIMIT_LIGHT),
        ]
    };
    let [agree, differ, open] = found.verdicts(LIMIT_LIGHT);
    Table::new(
        format!(
            "Caustics of {}: relative differences of means, 95 % intervals, and whether they lie within \
             \u{b1}{:.0} %. Blur of beams: by halving their radii; R \u{2192} 0: beams without it. There \
             {agree} regions agree, {differ} differ, {open} are open",
            found.scene,
            100.0 * MARGIN
        ),
        [
            "region",
            "light \u{2212} path",
            "beams \u{2212} light",
            "blur",
            "beams, R \u{2192} 0, \u{2212} light",
        ],
        found.regions.iter().map(row).collect(),
    )
}

/// A row for each method.
fn delays(mirrors: &MirrorsResult) -> Table {
    let row = |d: &mirrors::delay::Delay| {
        vec![
            d.method.clone(),
            format!("{:.5} \u{b1} {:.5} m", d.measured, d.half),
            format!("{:.5} m", d.exact),
            if d.agrees() { "agrees".to_owned() } else { "DIFFERS".to_owned() },
        ]
    };
    Table::new(
        "Delay behind the glass ball of Mirrors, 99 % intervals".to_owned(),
        ["method", "measured", "exact", "verdict"],
        mirrors.delays.iter().map(row).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_markdown_with_as_many_cells_as_heads() {
        let rows = vec![vec!["a".into(), "b".into()]];
        let table = Table::new("What".into(), ["x", "y"], rows);
        assert_eq!(table.markdown(), "What:\n\n| x | y |\n| --- | --- |\n| a | b |\n");
        assert!(Summary::default().tables().is_empty());
    }
}
