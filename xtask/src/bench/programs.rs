//! The programs that are measured: built, run, and what they say of themselves.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use xshell::{Shell, cmd};

use super::cases::Work;
use crate::workspace::root;

/// Where programs and results are kept.
pub(crate) struct Programs {
    sh: Shell,
    /// Folder of results.
    out: PathBuf,
    tpb: PathBuf,
    kernels: PathBuf,
}

/// What a run says of itself.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Said {
    /// CPU time \[s\]; of a kernel without its set-up.
    pub(crate) cpu_seconds: f64,
    /// Wall time of the same \[s\].
    pub(crate) wall_seconds: f64,
    /// The vector instructions that it used.
    pub(crate) vectors: String,
    /// What it did in all passes, and how much.
    pub(crate) work: BTreeMap<String, f64>,
}

impl Programs {
    /// Builds `tpb` and, if asked for, the kernels, as `cargo build --release` does.
    pub(crate) fn build(out: PathBuf, kernels: bool) -> Result<Self, Box<dyn Error>> {
        let sh = shell()?;
        fs::create_dir_all(&out)?;
        cmd!(sh, "cargo build --release --package tpb").quiet().run()?;
        if kernels {
            cmd!(sh, "cargo build --release --package tpb-benches --example kernels")
                .quiet()
                .run()?;
        }
        let release = target().join("release");
        let (tpb, kernels) = (release.join("tpb"), release.join("examples/kernels"));
        Ok(Self { sh, out, tpb, kernels })
    }

    /// Builds `tpb` without media beside the plain one; where it is.
    pub(crate) fn build_vacuum(&self) -> Result<PathBuf, Box<dyn Error>> {
        let (sh, kept) = (&self.sh, self.out.join("tpb-vacuum"));
        cmd!(sh, "cargo build --release --package tpb --features vacuum").quiet().run()?;
        fs::copy(&self.tpb, &kept)?;
        // Cargo puts both into the same place.
        cmd!(sh, "cargo build --release --package tpb").quiet().run()?;
        Ok(kept)
    }

    /// A shell in the root of the workspace.
    pub(crate) fn shell(&self) -> &Shell {
        &self.sh
    }

    /// The program of some work with these arguments, and how it is written down.
    pub(crate) fn command(&self, work: Work, arguments: Vec<String>) -> Command {
        match work {
            Work::Kernel(_) => {
                let shown = format!("kernels {}", arguments.join(" "));
                Command { program: self.kernels.clone(), arguments, shown, result: None }
            }
            Work::Render(..) => self.render(&self.tpb, arguments),
        }
    }

    /// A render by a certain `tpb`.
    pub(crate) fn render(&self, tpb: &Path, arguments: Vec<String>) -> Command {
        let shown = format!("tpb render {}", arguments.join(" "));
        let folder = self.out.join("render");
        let output = ["-o".to_owned(), folder.display().to_string()];
        let arguments =
            std::iter::once("render".to_owned()).chain(arguments).chain(output).collect();
        Command { program: tpb.to_owned(), arguments, shown, result: Some(folder) }
    }

    /// The `tpb` that is built by `cargo build --release`.
    pub(crate) fn tpb(&self) -> &Path {
        &self.tpb
    }

    /// A file beside the results.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.out.join(name)
    }
}

/// A command that was put together.
pub(crate) struct Command {
    pub(crate) program: PathBuf,
    pub(crate) arguments: Vec<String>,
    /// How histories write it down: without what differs from checkout to checkout.
    pub(crate) shown: String,
    /// The result folder of a render.
    result: Option<PathBuf>,
}

impl Command {
    /// Runs it, perhaps under a tool, and reads what it says.
    pub(crate) fn run(&self, sh: &Shell, under: &[String]) -> Result<Said, Box<dyn Error>> {
        let words = under.iter().cloned().chain([self.program.display().to_string()]);
        let words: Vec<String> = words.chain(self.arguments.iter().cloned()).collect();
        let (program, arguments) = words.split_first().ok_or("no command")?;
        let output = cmd!(sh, "{program} {arguments...}")
            .quiet()
            .ignore_stderr()
            .ignore_status()
            .output()?;
        if !output.status.success() {
            let shown = &self.shown;
            return Err(format!("`{shown}` ended with {}; run it by hand", output.status).into());
        }
        let text = match &self.result {
            Some(folder) => fs::read_to_string(folder.join("report.json"))?,
            None => String::from_utf8(output.stdout)?,
        };
        let value: Value = serde_json::from_str(&text)?;
        let said = if self.result.is_some() { of_report(&value) } else { of_kernel(&value) };
        said.ok_or_else(|| format!("`{}` does not say what it did", self.shown).into())
    }
}

/// From the line of a kernel.
fn of_kernel(line: &Value) -> Option<Said> {
    Some(Said {
        cpu_seconds: line["cpu_seconds"].as_f64()?,
        wall_seconds: line["wall_seconds"].as_f64()?,
        vectors: line["instructions"].as_str()?.to_owned(),
        work: BTreeMap::from([(line["unit"].as_str()?.to_owned(), line["work"].as_f64()?)]),
    })
}

/// From the report of a render.
fn of_report(report: &Value) -> Option<Said> {
    let run = &report["run"];
    let names = [
        ("paths", "camera_paths"),
        ("photons", "photon_paths"),
        ("connections", "connections"),
        ("pairs", "pairs_accepted"),
    ];
    let count = |field: &str| run["counts"][field].as_f64();
    let work = names.iter().filter_map(|(name, field)| Some(((*name).to_owned(), count(field)?)));
    Some(Said {
        cpu_seconds: run["cpu_seconds"].as_f64()?,
        wall_seconds: run["wall_seconds"].as_f64()?,
        vectors: report["vectors"].as_str()?.to_owned(),
        work: work.filter(|(_, count)| *count > 0.0).collect(),
    })
}

/// A shell in the root of the workspace.
fn shell() -> Result<Shell, Box<dyn Error>> {
    let sh = Shell::new()?;
    sh.change_dir(root());
    Ok(sh)
}

/// Where cargo builds.
fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn programs_say_what_they_did() {
        let line = json!({ "setup_seconds": 0.5, "cpu_seconds": 2.0, "wall_seconds": 2.5,
                           "instructions": "AVX2", "unit": "pairs", "work": 300 });
        let said = of_kernel(&line).unwrap();
        assert_eq!((said.cpu_seconds, said.vectors.as_str()), (2.0, "AVX2"));
        assert_eq!(said.work, BTreeMap::from([("pairs".to_owned(), 300.0)]));
        let mut report = json!({ "vectors": "scalar", "run": { "cpu_seconds": 3.0,
            "wall_seconds": 4.0, "counts": { "camera_paths": 10, "photon_paths": 0,
            "connections": 0, "pairs_accepted": 7, "pairs_tested": 8 } } });
        let said = of_report(&report).unwrap();
        let work = [("pairs", 7.0), ("paths", 10.0)].map(|(name, n)| (name.to_owned(), n));
        assert_eq!((said.work, said.wall_seconds), (BTreeMap::from(work), 4.0));
        report["run"]["cpu_seconds"] = Value::Null;
        assert_eq!(of_report(&report), None, "a system without CPU times");
    }
}
