//! A run over several figures that may be interrupted, and goes on when it is asked for again.
//!
//! While it is under way the output folder has `unfinished.json`: the command, the commit, and the
//! figures that are finished. The same command with the same sources skips those; within a figure,
//! references, races and caustics find what they rendered. A run that came to its end leaves no such
//! file, and the next one renders anew, references apart.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use super::summary::Summary;
use super::{Options, cornell, folder, mirrors, write_json};
use crate::error::{Result, ValidationError};
use crate::watch::{Step, Watch, duration};

/// What is made again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Figure {
    /// Figure 2.
    CornellBlocks,
    /// Figure 3.
    Mirrors,
}

impl Figure {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::CornellBlocks, Self::Mirrors];

    /// What it takes, in order.
    ///
    /// # Errors
    /// If its scene cannot be loaded.
    pub fn steps(self, options: &Options) -> Result<Vec<Step>> {
        match self {
            Self::CornellBlocks => cornell::steps(options),
            Self::Mirrors => mirrors::steps(options),
        }
    }

    fn make(self, options: &Options, watch: &mut Watch<'_>) -> Result<()> {
        match self {
            Self::CornellBlocks => cornell::run(options, watch).map(drop),
            Self::Mirrors => mirrors::run(options, watch).map(drop),
        }
    }
}

/// What `unfinished.json` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Begun {
    command: String,
    commit: String,
    finished: Vec<Figure>,
}

/// A run under way.
struct Session {
    path: PathBuf,
    begun: Begun,
}

impl Session {
    /// That of an interrupted run of the same command and sources, or a new one.
    fn begin(options: &Options) -> Result<Self> {
        let path = options.out.join("unfinished.json");
        let commit = options.circumstances.commit.clone();
        let new = Begun { command: options.command.clone(), commit, finished: Vec::new() };
        let left: Option<Begun> =
            fs::read(&path).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
        // Sources that differ from their commit are not known well enough.
        let known = !new.commit.ends_with("-dirty") && new.commit != "unknown";
        let same = |left: &Begun| (&left.command, &left.commit) == (&new.command, &new.commit);
        let begun = left.filter(|left| known && same(left)).unwrap_or(new);
        let session = Self { path, begun };
        session.write()?;
        Ok(session)
    }

    fn has(&self, figure: Figure) -> bool {
        self.begun.finished.contains(&figure)
    }

    fn finish(&mut self, figure: Figure) -> Result<()> {
        self.begun.finished.push(figure);
        self.write()
    }

    fn end(self) -> Result<()> {
        fs::remove_file(&self.path).map_err(|error| ValidationError::io(&self.path, error))
    }

    fn write(&self) -> Result<()> {
        write_json(&self.path, &self.begun)
    }
}

/// Makes figures, then the pages over all; `tell` is told of every step, `stop` ends it between two.
///
/// # Errors
/// [`ValidationError::Interrupted`] after `stop`; else what keeps a figure from being made.
pub fn run(
    figures: &[Figure],
    options: &Options,
    tell: &mut dyn FnMut(&str),
    stop: &AtomicBool,
) -> Result<Summary> {
    folder(&options.out)?;
    let mut session = Session::begin(options)?;
    let mut steps = Vec::new();
    for figure in figures.iter().filter(|&&figure| !session.has(figure)) {
        steps.extend(figure.steps(options)?);
    }
    for line in plan(&steps) {
        tell(&line);
    }
    let mut watch = Watch::new(tell).with_stop(stop).with_steps(steps);
    for &figure in figures {
        if session.has(figure) {
            watch.tell(&format!("{figure:?}: finished by the run that was interrupted"));
            continue;
        }
        figure.make(options, &mut watch)?;
        Summary::read(&options.out).write(options)?;
        session.finish(figure)?;
    }
    let summary = Summary::read(&options.out);
    summary.write(options)?;
    session.end()?;
    Ok(summary)
}

/// The budget, for people.
fn plan(steps: &[Step]) -> Vec<String> {
    let whole: f64 = steps.iter().map(|step| step.seconds).sum();
    let mut lines = vec![format!(
        "plan: about {} on a quiet machine; what is kept of an earlier run makes it shorter",
        duration(whole)
    )];
    lines.extend(steps.iter().map(|s| format!("  {:>8}  {}", duration(s.seconds), s.name)));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::cornell::tests::trial;

    #[test]
    fn only_the_same_command_and_commit_go_on() {
        let options = trial("session");
        let _ = fs::remove_dir_all(&options.out);
        folder(&options.out).unwrap();
        let mut first = Session::begin(&options).unwrap();
        first.finish(Figure::CornellBlocks).unwrap();
        let again = Session::begin(&options).unwrap();
        assert!(again.has(Figure::CornellBlocks) && !again.has(Figure::Mirrors));
        let mut other = options.clone();
        other.command += " --seed 2";
        assert!(!Session::begin(&other).unwrap().has(Figure::CornellBlocks));
        let mut dirty = options.clone();
        dirty.circumstances.commit = "abc-dirty".into();
        Session::begin(&dirty).unwrap().finish(Figure::Mirrors).unwrap();
        let dirty = Session::begin(&dirty).unwrap();
        assert!(!dirty.has(Figure::Mirrors));
        dirty.end().unwrap();
        assert!(!options.out.join("unfinished.json").exists());
        fs::remove_dir_all(&options.out).unwrap();
    }

    #[test]
    fn the_budget_is_told_before_anything_is_rendered() {
        let mut options = trial("budget");
        let _ = fs::remove_dir_all(&options.out);
        options.time = std::time::Duration::from_secs(40);
        options.reference_time = options.time * 10;
        options.replicates = 5;
        let (mut told, stop) = (Vec::new(), AtomicBool::new(true));
        let ended = run(&Figure::ALL, &options, &mut |line| told.push(line.to_owned()), &stop);
        assert!(matches!(ended, Err(ValidationError::Interrupted)));
        assert!(told[0].starts_with("plan: about 2") && told[0].contains(" min "), "{told:?}");
        assert!(told.iter().any(|line| line.contains("mirrors: ")), "{told:?}");
        fs::remove_dir_all(&options.out).unwrap();
    }
}
