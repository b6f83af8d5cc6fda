//! Renders of all methods with the same time, in turn, kept on disk as they come.
//!
//! Each method makes n independent replicates, one method after the other (path, beams, path, …), so
//! that whatever else the machine does meets all alike. A replicate is one run that is read when its
//! clock shows each of the given times; reading is off the clock, preparation of the method on it.
//! Passes are not cut: what was really spent, wall and CPU time, is measured and kept with it.
//!
//! A finished replicate is a file. A race that was interrupted goes on with those that are
//! there, if scene, method, options, seed, times, threads and commit are the same, and the sources
//! are those of the commit.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use half::f16;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tpb_film::archive::{ArchiveReader, ArchiveWriter, Compression};
use tpb_film::{Arrays, FilmOptions, TransientFilm, atomic_write};
use tpb_optics::seed_of;
use tpb_render::{Budget, Method, RunSettings, Stopwatch, run};
use tpb_scene::load::LoadedScene;
use tpb_scene::{Plan, Transport};

use super::halves::HalfCube;
use crate::error::{Result, ValidationError};
use crate::measure::{Estimator, layout};
use crate::watch::Watch;

/// What was spent until a film was read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spent {
    /// Wall time \[s\].
    pub wall_seconds: f64,
    /// CPU time of the process \[s\]; the wall time where the system does not tell.
    pub cpu_seconds: f64,
    /// Passes.
    pub passes: u64,
}

/// What decides a replicate, the clock apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Key {
    scene: Value,
    estimator: String,
    seed: u64,
    seconds: Vec<f64>,
    threads: usize,
    commit: String,
}

/// A finished replicate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Record {
    key: Key,
    options: Value,
    spent: Vec<Spent>,
}

impl Record {
    /// Whether a run of this key would make it again. Sources that differ from their commit are
    /// not known well enough.
    fn is_of(&self, key: &Key) -> bool {
        let known = !key.commit.ends_with("-dirty") && key.commit != "unknown";
        known && self.key == *key
    }
}

/// A replicate on disk.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicate {
    /// Its file.
    pub path: PathBuf,
    /// Seed.
    pub seed: u64,
    /// The method's effective options.
    pub options: Value,
    /// What was spent at each reading.
    pub spent: Vec<Spent>,
}

/// Who renders what, how often, and for how long.
pub struct Race<'a> {
    /// The scene.
    pub loaded: &'a LoadedScene,
    /// The methods.
    pub methods: &'a [Estimator],
    /// When films are read, increasing; the last ends the run.
    pub times: Vec<Duration>,
    /// Replicates of each method.
    pub replicates: u64,
    /// Seed: each replicate has one of its own ([`seed_of`]).
    pub seed: u64,
    /// Commit of the sources.
    pub commit: &'a str,
    /// Where replicates are kept.
    pub folder: PathBuf,
}

impl Race<'_> {
    /// The replicates of each method; `watch` is told of each.
    pub fn run(&self, watch: &mut Watch<'_>) -> Result<Vec<Vec<Replicate>>> {
        fs::create_dir_all(&self.folder).map_err(|e| ValidationError::io(&self.folder, e))?;
        let mut all: Vec<Vec<Replicate>> = self.methods.iter().map(|_| Vec::new()).collect();
        for number in 0..self.replicates {
            for (index, estimator) in self.methods.iter().enumerate() {
                // No two runs share random numbers.
                let run = number * self.methods.len() as u64 + index as u64;
                let seed = seed_of(self.seed, run);
                let path = self.folder.join(format!("{}-{number}.npz", estimator.name()));
                let key = self.key(estimator, seed);
                let kept = read_record(&path).filter(|kept| kept.is_of(&key));
                let (record, how) = if let Some(record) = kept {
                    (record, "kept from an earlier run")
                } else {
                    watch.go_on()?;
                    (self.render(estimator, key, &path)?, "done")
                };
                let spent = record.spent.last().copied().unwrap_or_default();
                watch.tell(&format!(
                    "  {} {}/{}: {how}, {} passes, {:.1} s, {:.1} CPU s",
                    estimator.name(),
                    number + 1,
                    self.replicates,
                    spent.passes,
                    spent.wall_seconds,
                    spent.cpu_seconds,
                ));
                let Record { options, spent, .. } = record;
                all[index].push(Replicate { path, seed, options, spent });
            }
        }
        Ok(all)
    }

    /// Removes the replicates, once what they told is kept elsewhere.
    pub fn clear(&self) -> Result<()> {
        fs::remove_dir_all(&self.folder).map_err(|e| ValidationError::io(&self.folder, e))
    }

    fn key(&self, estimator: &Estimator, seed: u64) -> Key {
        Key {
            scene: self.loaded.canonical.clone(),
            estimator: format!("{estimator:?}"),
            seed,
            seconds: self.times.iter().map(Duration::as_secs_f64).collect(),
            threads: rayon::current_num_threads(),
            commit: self.commit.to_owned(),
        }
    }

    fn render(&self, estimator: &Estimator, key: Key, path: &Path) -> Result<Record> {
        let scene = &self.loaded.scene;
        match Plan::new(scene, &scene.integrator).transport {
            Transport::Mono => self.render_with::<1>(estimator, key, path),
            Transport::Rgb => self.render_with::<3>(estimator, key, path),
        }
    }

    fn render_with<const C: usize>(
        &self,
        estimator: &Estimator,
        key: Key,
        path: &Path,
    ) -> Result<Record> {
        let scene = &self.loaded.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let mut film = TransientFilm::<C>::new(layout(&scene.film, 0.0)?, FilmOptions::default())?;
        let clock = Stopwatch::start();
        let method = estimator.prepare::<C>(scene, &plan, scene.integrator)?;
        let mut spent = Spent { wall_seconds: clock.wall().as_secs_f64(), ..Spent::default() };
        spent.cpu_seconds = clock.cpu().map_or(spent.wall_seconds, |cpu| cpu.as_secs_f64());
        let (mut readings, mut record) = (Vec::new(), Vec::new());
        for (index, time) in self.times.iter().enumerate() {
            go_on(&*method, &mut film, key.seed, *time, &mut spent)?;
            let arrays = film.develop();
            let last = index + 1 == self.times.len();
            readings.push(Reading::of(&arrays, last));
            record.push(spent);
        }
        let record = Record { key, options: method.options(), spent: record };
        write(path, &readings, &record)?;
        Ok(record)
    }
}

/// Makes passes until `time` is spent, at least one if there are none.
fn go_on<const C: usize>(
    method: &dyn Method<C>,
    film: &mut TransientFilm<C>,
    seed: u64,
    time: Duration,
    spent: &mut Spent,
) -> Result<()> {
    let left = time.as_secs_f64() - spent.wall_seconds;
    let mean = spent.wall_seconds / film.passes().max(1) as f64;
    // As a run decides by itself between its passes.
    if film.passes() > 0 && left < 0.5 * mean {
        return Ok(());
    }
    let budget = Budget::Time(Duration::try_from_secs_f64(left.max(0.0)).unwrap_or_default());
    let settings = RunSettings { seed, budget, first_pass: film.passes() };
    let summary = run(method, film, &settings, &Stopwatch::start(), &mut ());
    if film.non_finite() > 0 {
        let reason = format!("{} contributions were not finite", film.non_finite());
        return Err(ValidationError::unusable(method.name(), reason));
    }
    spent.wall_seconds += summary.wall_seconds;
    spent.cpu_seconds += summary.cpu_seconds.unwrap_or(summary.wall_seconds);
    spent.passes = film.passes();
    Ok(())
}

/// A film as it was read.
struct Reading {
    cube: HalfCube,
    images: [Vec<f64>; 3],
}

impl Reading {
    /// Pictures need all channels, errors their mean.
    fn of(arrays: &Arrays, last: bool) -> Self {
        let cube = if last { HalfCube::of(arrays) } else { HalfCube::mean_of(arrays) };
        let images = [arrays.before.clone(), arrays.after.clone(), arrays.steady.clone()];
        Self { cube, images }
    }
}

/// Names of the images beside the bins.
const IMAGES: [&str; 3] = ["before", "after", "steady"];

fn write(path: &Path, readings: &[Reading], record: &Record) -> Result<()> {
    let json = serde_json::to_vec(record).map_err(|e| ValidationError::unusable("record", e))?;
    atomic_write(path, |file| {
        let mut npz = ArchiveWriter::new(file, Compression::Stored);
        npz.put("record", &[json.len()], &json)?;
        for (index, Reading { cube, images }) in readings.iter().enumerate() {
            let shape = [cube.pixels, cube.bins, cube.channels];
            npz.put(&format!("cube{index}"), &shape, &cube.values)?;
            npz.put(&format!("scale{index}"), &[cube.bins], &cube.scale)?;
            for (name, image) in IMAGES.iter().zip(images) {
                npz.put(&format!("{name}{index}"), &[image.len()], image)?;
            }
        }
        npz.finish()
    })?;
    Ok(())
}

/// The record of a whole file; `None` if there is none, or not a sound one.
fn read_record(path: &Path) -> Option<Record> {
    let mut npz = ArchiveReader::open(path).ok()?;
    let bytes = npz.required::<u8>("record", None).ok()?.1;
    serde_json::from_slice(&bytes).ok()
}

impl Replicate {
    /// The bins at a reading.
    pub fn cube(&self, reading: usize) -> Result<HalfCube> {
        let mut npz = ArchiveReader::open(&self.path)?;
        let (shape, values) = npz.required::<f16>(&format!("cube{reading}"), None)?;
        let &[pixels, bins, channels] = shape.as_slice() else {
            let reason = "a cube without three dimensions";
            return Err(ValidationError::unusable(self.path.display().to_string(), reason));
        };
        let scale = npz.required::<f32>(&format!("scale{reading}"), Some(&[bins]))?.1;
        Ok(HalfCube { pixels, bins, channels, scale, values })
    }

    /// The whole arrays at the last reading; `like` tells shape and edges.
    pub fn arrays(&self, like: &Arrays) -> Result<Arrays> {
        let reading = self.spent.len().saturating_sub(1);
        let cube = self.cube(reading)?;
        let mut npz = ArchiveReader::open(&self.path)?;
        let size = [like.pixels() * cube.channels];
        let mut image = |name: &str| -> Result<Vec<f64>> {
            Ok(npz.required(&format!("{name}{reading}"), Some(&size))?.1)
        };
        Ok(Arrays {
            width: like.width,
            height: like.height,
            bins: cube.bins,
            channels: cube.channels,
            quantity: like.quantity,
            opl_edges: like.opl_edges.clone(),
            transient: cube.cells(),
            variance: None,
            before: image("before")?,
            after: image("after")?,
            steady: image("steady")?,
        })
    }
}

/// The whole arrays of the first replicate, with the variance of one replicate as the others tell it:
/// per cell and channel, Σ(x − x̄)²/(n − 1). Needs two replicates at least.
pub fn first_with_variance(replicates: &[Replicate], like: &Arrays) -> Result<Arrays> {
    let Some((first, others)) = replicates.split_first().filter(|(_, others)| !others.is_empty())
    else {
        return Err(ValidationError::unusable("a variance", "needs two replicates"));
    };
    let mut arrays = first.arrays(like)?;
    let mut mean = arrays.transient.clone();
    let mut squares = vec![0.0_f32; mean.len()];
    for (index, replicate) in others.iter().enumerate() {
        let cube = replicate.cube(replicate.spent.len().saturating_sub(1))?;
        let share = 1.0 / (index + 2) as f32;
        for ((mean, squares), value) in mean.iter_mut().zip(&mut squares).zip(cube.cells()) {
            let before = value - *mean;
            *mean += before * share;
            *squares += before * (value - *mean);
        }
    }
    let freedom = others.len() as f32;
    for square in &mut squares {
        *square /= freedom;
    }
    arrays.variance = Some(squares);
    Ok(arrays)
}
