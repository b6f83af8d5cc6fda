//! The peer's process: started once for a scene, asked for one run after another.
//!
//! What it is asked and answers stands in `mitransient_driver.py`, one JSON object per line. CPU seconds are
//! its own, of all its threads, while its kernels run: the start of the interpreter, the scene, compilation and
//! tracing are not in them, and reported apart.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tpb_film::archive::ArchiveReader;

use super::translate::Translation;
use crate::cube::Cube;
use crate::error::{Result, ValidationError};

/// The script. Beside it nothing may be named like a package that it imports.
const SCRIPT: &str = include_str!("mitransient_driver.py");

/// What it says of itself once it has loaded and compiled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Introduction {
    /// Versions of its parts by name, and its number of threads.
    pub versions: Value,
    /// CPU time of interpreter, libraries and scene \[s\].
    pub load_cpu_seconds: f64,
    /// CPU time that the first launch took beyond the second \[s\]: compilation, little where its cache
    /// on disk has it.
    pub compile_cpu_seconds: f64,
    /// CPU time of tracing a launch \[s\], before its kernels run.
    pub trace_cpu_seconds: f64,
    /// CPU time of a launch \[s\], of its kernels alone.
    pub launch_cpu_seconds: f64,
}

/// The state of a run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Shot {
    /// Launches made.
    pub launches: u64,
    /// CPU time that they took \[s\].
    pub cpu_seconds: f64,
    /// Wall time that they took \[s\].
    pub wall_seconds: f64,
    /// Their mean.
    file: PathBuf,
}

/// A running peer, with one scene.
pub struct Peer {
    child: Child,
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    folder: PathBuf,
    introduction: Introduction,
}

impl Peer {
    /// Starts it. `python` is the interpreter that has its packages, `folder` is for its files (it is
    /// made), `samples` those of a pixel in each launch.
    ///
    /// # Errors
    /// [`ValidationError`] if it cannot be started, or ends before it has rendered: then with the
    /// end of what it said.
    pub fn start(
        python: &Path,
        folder: &Path,
        scene: &Translation,
        threads: usize,
        samples: u32,
    ) -> Result<Self> {
        let io = |path: &Path| {
            let path = path.to_owned();
            move |error| ValidationError::io(path, error)
        };
        fs::create_dir_all(folder).map_err(io(folder))?;
        let [script, dictionary, said] =
            ["driver.py", "scene.json", "said.txt"].map(|name| folder.join(name));
        fs::write(&script, SCRIPT).map_err(io(&script))?;
        fs::write(&dictionary, format!("{:#}\n", scene.dictionary)).map_err(io(&dictionary))?;
        let errors = File::create(&said).map_err(io(&said))?;
        let mut child = Command::new(python)
            .args([&script, &dictionary])
            .args([scene.variant, &threads.to_string(), &samples.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(errors)
            .spawn()
            .map_err(io(python))?;
        let (requests, answers) = (child.stdin.take(), child.stdout.take());
        let Some(answers) = answers else {
            return Err(ValidationError::unusable("the peer", "has no standard output"));
        };
        let answers = BufReader::new(answers);
        let folder = folder.to_owned();
        let introduction = Introduction {
            versions: Value::Null,
            load_cpu_seconds: 0.0,
            compile_cpu_seconds: 0.0,
            trace_cpu_seconds: 0.0,
            launch_cpu_seconds: 0.0,
        };
        let mut peer = Self { child, requests, answers, folder, introduction };
        peer.introduction = peer.answer()?;
        Ok(peer)
    }

    /// What it said of itself.
    pub fn introduction(&self) -> &Introduction {
        &self.introduction
    }

    /// One run from a seed of its own, observed after so many launches, in rising order.
    ///
    /// # Errors
    /// [`ValidationError`] if the process has ended.
    pub fn run(&mut self, seed: u64, launches: &[u64]) -> Result<Vec<Shot>> {
        // Seeds of launches follow one another; the uppermost are those of the first two.
        let request = json!({
            "seed": seed % (1 << 31),
            "launches": launches,
            "file": self.folder.join("run"),
        });
        let sent = self.requests.as_mut().map(|pipe| writeln!(pipe, "{request}"));
        if !matches!(sent, Some(Ok(()))) {
            return Err(self.ended());
        }
        launches.iter().map(|_| self.answer()).collect()
    }

    /// The cube of a shot, mean over channels; what its steady image has beyond the bins is taken as
    /// after them. The file is removed.
    ///
    /// # Errors
    /// [`ValidationError`] if the file does not hold such arrays.
    pub fn cube(&self, shot: &Shot) -> Result<Cube> {
        let mut npz = ArchiveReader::open(&shot.file)?;
        let (shape, bins) = npz.required::<f32>("transient", None)?;
        let &[height, width, count] = shape.as_slice() else {
            return Err(ValidationError::unusable("the peer's cube", format!("shape {shape:?}")));
        };
        let (_, steady) = npz.required::<f32>("steady", Some(&[height, width]))?;
        let mut cube = Cube::zero(width, height, count);
        for (pixel, (bins, steady)) in bins.chunks_exact(count.max(1)).zip(steady).enumerate() {
            let cells = cube.pixel_mut(pixel);
            for (cell, &bin) in cells[1..].iter_mut().zip(bins) {
                *cell = f64::from(bin);
            }
            cells[count + 1] = f64::from(steady) - cells[1..=count].iter().sum::<f64>();
        }
        fs::remove_file(&shot.file).map_err(|error| ValidationError::io(&shot.file, error))?;
        Ok(cube)
    }

    fn answer<T: for<'de> Deserialize<'de>>(&mut self) -> Result<T> {
        let mut line = String::new();
        match self.answers.read_line(&mut line) {
            Ok(length) if length > 0 => serde_json::from_str(&line)
                .map_err(|error| ValidationError::unusable("the peer's answer", error)),
            _ => Err(self.ended()),
        }
    }

    /// Why there is no answer.
    fn ended(&mut self) -> ValidationError {
        self.requests = None;
        let status = self.child.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
        let said = fs::read_to_string(self.folder.join("said.txt")).unwrap_or_default();
        ValidationError::unusable("the peer ended", format!("{status}; {}", telling(&said)))
    }
}

impl Drop for Peer {
    /// It ends by itself when nothing more can be asked.
    fn drop(&mut self) {
        self.requests = None;
        // Nothing can be done about a process that cannot be waited for.
        let _ = self.child.wait();
    }
}

/// The line that tells most: the first error of LLVM, else the last line.
fn telling(said: &str) -> &str {
    let llvm = said.lines().find(|line| line.contains("LLVM"));
    llvm.or_else(|| said.lines().rfind(|line| !line.trim().is_empty())).unwrap_or("it said nothing")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn translation() -> Translation {
        Translation { dictionary: json!({ "type": "scene" }), variant: "llvm_ad_mono" }
    }

    #[cfg(unix)]
    #[test]
    fn a_peer_that_ends_at_once_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let Err(error) = Peer::start(Path::new("false"), folder.path(), &translation(), 1, 1)
        else {
            panic!("`false` renders nothing");
        };
        assert_eq!(error.to_string(), "the peer ended: exit status: 1; it said nothing");
    }

    #[test]
    fn no_interpreter_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("python");
        let Err(error) = Peer::start(&missing, folder.path(), &translation(), 1, 1) else {
            panic!("there is no such program");
        };
        assert_eq!(error.to_string(), format!("cannot access {}", missing.display()));
    }

    #[test]
    fn errors_of_llvm_tell_more_than_what_follows_them() {
        assert_eq!(telling("a\nLLVM ERROR: Cannot select\n  0x1\n"), "LLVM ERROR: Cannot select");
        assert_eq!(telling("Traceback\n  x\nKeyError: 'a'\n\n"), "KeyError: 'a'");
        assert_eq!(telling(""), "it said nothing");
    }
}
