//! Path tracing and photon beams at equal time on one scene, from the renders to the judged numbers.
//!
//! Cells that hold mostly light straight from the lamp off a surface, found by a render of that light
//! alone (fog that only absorbs, one event), are judged apart, and so are the first fronts in fog.
//! Cells are sorted by the noisy reference itself; where it is dark and noisy a few may be in the
//! wrong kind.

use std::path::PathBuf;
use std::time::Duration;

use tpb_beams::BeamOptions;
use tpb_path::PathOptions;
use tpb_render::{Budget, RunSettings};
use tpb_scene::load::LoadedScene;
use tpb_scene::{IntegratorSpec, Plan, Transport};

use super::compare::{Comparison, Maps};
use super::race::{Race, Replicate};
use super::truth::Truth;
use crate::error::Result;
use crate::judged::Referee;
use crate::long_render::LongRender;
use crate::measure::{Estimator, layout, render};
use crate::reference_cube::ReferenceCube;
use crate::watch::Watch;

/// The film is read at these parts of the time.
const READINGS: [f64; 3] = [0.25, 0.5, 1.0];
/// Path tracing and beams.
const METHODS: usize = 2;
/// Time of the render of direct light, as a part of the others'.
const DIRECT: f64 = 0.25;

/// Where the reference comes from.
pub enum Judge {
    /// It is rendered in batches, and kept.
    Rendered {
        /// By whom.
        referee: Referee,
        /// Its file.
        path: PathBuf,
        /// Wall time.
        time: Duration,
        /// Whether one that other sources made goes on; else it is made anew.
        any_commit: bool,
    },
    /// It ships with the scene.
    Shipped(PathBuf),
}

/// A comparison to be made.
pub struct Contest<'a> {
    /// The scene.
    pub loaded: &'a LoadedScene,
    /// The same with media that only absorb.
    pub absorbing: &'a LoadedScene,
    /// Wall time of a run.
    pub time: Duration,
    /// Replicates of each method.
    pub replicates: u64,
    /// Seed.
    pub seed: u64,
    /// Commit of the sources.
    pub commit: &'a str,
    /// The command that is carried out.
    pub command: &'a str,
    /// What errors are measured from.
    pub judge: Judge,
    /// Windows of time lie between these \[m\].
    pub windows: &'a [f64],
    /// Where replicates are kept meanwhile.
    pub folder: PathBuf,
}

/// What came of it.
pub struct Contested {
    /// The numbers.
    pub comparison: Comparison,
    /// What maps are made of, for each method.
    pub maps: Vec<Maps>,
    /// The reference.
    pub truth: Truth,
    /// Replicates of each method.
    pub runs: Vec<Vec<Replicate>>,
}

/// Wall time of the renders of a comparison, the reference apart \[s\].
pub fn seconds(time: Duration, replicates: u64) -> f64 {
    time.as_secs_f64() * (METHODS as f64 * replicates as f64 + DIRECT)
}

impl Contest<'_> {
    /// Carries it out; replicates stay until [`Contest::clear`].
    ///
    /// # Errors
    /// If a kept file is broken, the folder cannot be written, or the reference is too noisy.
    pub fn run(&self, watch: &mut Watch<'_>) -> Result<Contested> {
        let methods = methods();
        let times: Vec<Duration> = READINGS.iter().map(|&part| self.time.mul_f64(part)).collect();
        let runs = self.race(&methods, times.clone()).run(watch)?;
        let mut truth = self.truth(watch)?;
        let direct = direct_light(self.absorbing, self.time.mul_f64(DIRECT), self.seed)?;
        truth.sort_cells(&direct)?;
        let seconds: Vec<f64> = times.iter().map(Duration::as_secs_f64).collect();
        let names = methods.each_ref().map(Estimator::name);
        let (comparison, maps) = Comparison::new(&names, &runs, &truth, self.windows, &seconds)?;
        Ok(Contested { comparison, maps, truth, runs })
    }

    /// Removes the replicates, once what they told is kept elsewhere.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub fn clear(&self) -> Result<()> {
        self.race(&methods(), Vec::new()).clear()
    }

    fn race<'a>(&'a self, methods: &'a [Estimator], times: Vec<Duration>) -> Race<'a> {
        Race {
            loaded: self.loaded,
            methods,
            times,
            replicates: self.replicates,
            seed: self.seed,
            commit: self.commit,
            folder: self.folder.clone(),
        }
    }

    fn truth(&self, watch: &mut Watch<'_>) -> Result<Truth> {
        match &self.judge {
            Judge::Rendered { referee, path, time, any_commit } => {
                let seed = self.seed ^ 0x5eed_0000;
                let reference =
                    LongRender::reference(self.loaded, *referee, *time, seed, self.commit);
                let reference = LongRender { own: !any_commit, command: self.command, ..reference };
                Ok(Truth::of_long(reference.obtain(path, watch)?))
            }
            Judge::Shipped(path) => {
                let reference = ReferenceCube::read(path)?;
                reference.check(self.loaded)?;
                Ok(Truth::of_shipped(&reference))
            }
        }
    }
}

fn methods() -> [Estimator; METHODS] {
    [Estimator::Path(PathOptions::default()), Estimator::Beams(BeamOptions::default())]
}

/// Light that was scattered once, at a surface, for each cell of the film, averaged over channels.
fn direct_light(absorbing: &LoadedScene, time: Duration, seed: u64) -> Result<Vec<f32>> {
    match Plan::new(&absorbing.scene, &absorbing.scene.integrator).transport {
        Transport::Mono => direct_light_with::<1>(absorbing, time, seed),
        Transport::Rgb => direct_light_with::<3>(absorbing, time, seed),
    }
}

fn direct_light_with<const C: usize>(
    absorbing: &LoadedScene,
    time: Duration,
    seed: u64,
) -> Result<Vec<f32>> {
    let scene = &absorbing.scene;
    let once = IntegratorSpec { min_depth: 2, max_depth: Some(2), ..scene.integrator };
    let plan = Plan::new(scene, &once);
    let method = Estimator::Path(PathOptions::default()).prepare::<C>(scene, &plan, once)?;
    let settings =
        RunSettings { seed: seed ^ 0xd1_5ec7, budget: Budget::Time(time), first_pass: 0 };
    let (arrays, _) = render(&*method, layout(&scene.film, 0.0)?, &settings)?;
    let mean = |cell: &[f32]| cell.iter().sum::<f32>() / arrays.channels as f32;
    Ok(arrays.transient.chunks_exact(arrays.channels).map(mean).collect())
}
