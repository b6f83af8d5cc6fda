//! Both programs on one scene, in turn, at equal CPU seconds.
//!
//! First each player is timed, off the record; then its passes are chosen so that a run takes the
//! CPU seconds asked for, and n replicates are made: ours, the peer, ours, the peer, … so that whatever
//! else the machine does meets all alike. Runs are observed after 1/16, 1/8, … of their passes, which
//! makes the curves; what is compared is the end. A pass of the peer is a launch of
//! [`ContestPlan::samples`] samples per pixel.
//!
//! CPU seconds are measured again in each replicate, and "times less error" compares NMSE · CPU
//! seconds: as a ratio of means by Fieller's theorem, whose interval holds the reference's noise, and, for
//! methods with fireflies, as a ratio of medians with a bootstrap interval, given the reference. Ours include the method's preparation; the
//! peer's leave out its start, compilation and tracing, in its favour.

use serde::{Deserialize, Serialize};
use serde_json::json;
use tpb_optics::seed_of;
use tpb_scene::{Plan, Scene, Transport};

use super::NAME;
use super::agreement::{Agreement, agreement, totals};
use super::driver::{Introduction, Peer};
use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::measure::Estimator;
use crate::reference_cube::ReferenceCube;
use crate::run_time::measure::{Run, Seconds, Snapshot, Underway, curve, residuals};
use crate::run_time::{CONFIDENCE, ErrorAgainstTime};
use crate::statistics::batches::summarise;
use crate::statistics::split::Estimate;
use crate::statistics::{Factor, Gram, Split, bootstrap};
use crate::suite::Circumstances;

/// A run is observed after these parts of its passes.
const PARTS: [f64; 5] = [1.0 / 16.0, 0.125, 0.25, 0.5, 1.0];

/// Part of a run's CPU seconds that timing takes at least.
const TIMED: f64 = 0.125;

/// What to compare.
pub struct ContestPlan<'a> {
    /// Name of the scene.
    pub name: String,
    /// The scene.
    pub scene: &'a Scene,
    /// Its reference.
    pub reference: &'a ReferenceCube,
    /// Our methods; the first that is the reference's own is what the peer must agree with.
    pub ours: Vec<Estimator>,
    /// Samples per pixel of the peer's launches.
    pub samples: u32,
    /// CPU time of a run \[s\].
    pub cpu_seconds: f64,
    /// Runs of each player, at least 3; 16 for medians that mean something.
    pub replicates: u64,
    /// Seed: each run has one of its own ([`seed_of`]).
    pub seed: u64,
    /// Where and how; noted, not used.
    pub circumstances: Circumstances,
    /// What is known to be wrong; noted, not used.
    pub faults: Vec<String>,
}

/// What was found on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contest {
    /// Name of the scene.
    pub scene: String,
    /// CPU time that each run was to take \[s\].
    pub cpu_seconds: f64,
    /// The peer's versions, and what its start took.
    pub peer: Introduction,
    /// Samples per pixel of a launch.
    pub samples: u32,
    /// What is known to be wrong with it here.
    pub faults: Vec<String>,
    /// Players, ours first.
    pub rows: Vec<Row>,
    /// Whether both render the same.
    pub agreement: Vec<Agreement>,
    /// Errors of all players against run time.
    pub curves: ErrorAgainstTime,
}

/// A player at the end of its runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the method.
    pub method: String,
    /// Passes of a run.
    pub passes: u64,
    /// CPU time of each run \[s\].
    pub cpu_seconds: Vec<f64>,
    /// Error over judged pixels.
    pub split: Split,
    /// Median over replicates of the NMSE.
    pub median: f64,
    /// NMSE of the whole cube.
    pub whole: Estimate,
    /// (NMSE · CPU s of the peer)/(that of this one), means; not for the peer.
    pub less: Option<Factor>,
    /// The same of medians over replicates, with its bootstrap interval.
    pub less_median: Option<(f64, [f64; 2])>,
}

/// Who renders.
enum Player<'a, 'b, const C: usize> {
    Ours(&'a Estimator),
    Peer(&'b mut Peer),
}

/// A run and what is kept of its last cube.
struct Ended {
    run: Run,
    whole: Vec<f32>,
    /// Sum of bins, sum of all, mean arrival in bins.
    totals: [f64; 3],
}

impl ContestPlan<'_> {
    /// Carries it out; `each` is told of every finished run (method, replicate).
    ///
    /// # Errors
    /// If a method cannot be prepared or adds what is not finite, the peer ends, or there are fewer
    /// than three replicates or no light in the reference.
    pub fn run(&self, peer: &mut Peer, each: impl FnMut(&str, u64)) -> Result<Contest> {
        match Plan::new(self.scene, &self.scene.integrator).transport {
            Transport::Mono => self.run_with::<1>(peer, each),
            Transport::Rgb => self.run_with::<3>(peer, each),
        }
    }

    fn run_with<const C: usize>(
        &self,
        peer: &mut Peer,
        mut each: impl FnMut(&str, u64),
    ) -> Result<Contest> {
        let names: Vec<&str> = self.ours.iter().map(Estimator::label).chain([NAME]).collect();
        let mut ended: Vec<Vec<Ended>> = names.iter().map(|_| Vec::new()).collect();
        let mut checkpoints = Vec::new();
        for index in 0..names.len() {
            checkpoints.push(self.checkpoints(&mut self.player::<C>(index, peer))?);
        }
        for replicate in 0..self.replicates {
            for (index, name) in names.iter().enumerate() {
                // No two runs share random numbers.
                let number = replicate * names.len() as u64 + index as u64;
                let seed = seed_of(self.seed, number);
                let mut player = self.player::<C>(index, peer);
                ended[index].push(self.observed(&mut player, seed, &checkpoints[index])?);
                each(name, replicate);
            }
        }
        self.judge(&names, ended, peer.introduction().clone())
    }

    fn player<'b, const C: usize>(&self, index: usize, peer: &'b mut Peer) -> Player<'_, 'b, C> {
        self.ours.get(index).map_or_else(|| Player::Peer(peer), Player::Ours)
    }

    /// Passes after which a run is observed, so that the last takes the CPU seconds asked for.
    fn checkpoints<const C: usize>(&self, player: &mut Player<'_, '_, C>) -> Result<Vec<u64>> {
        let mut passes = 1;
        let (per_pass, before) = loop {
            let timed = self.observed(player, seed_of(!self.seed, passes), &[passes])?.run;
            let all = timed.snapshots[0].seconds.cpu;
            if all - timed.setup_seconds > TIMED * self.cpu_seconds {
                break ((all - timed.setup_seconds) / passes as f64, timed.setup_seconds);
            }
            passes *= 2;
        };
        Ok(parts((self.cpu_seconds - before) / per_pass))
    }

    fn observed<const C: usize>(
        &self,
        player: &mut Player<'_, '_, C>,
        seed: u64,
        checkpoints: &[u64],
    ) -> Result<Ended> {
        match player {
            Player::Ours(estimator) => self.ours_observed::<C>(estimator, seed, checkpoints),
            Player::Peer(peer) => self.peer_observed(peer, seed, checkpoints),
        }
    }

    fn ours_observed<const C: usize>(
        &self,
        estimator: &Estimator,
        seed: u64,
        checkpoints: &[u64],
    ) -> Result<Ended> {
        let scene = self.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let (mut underway, mut run) = Underway::<C>::new(scene, &plan, estimator, seed)?;
        let mut cube = None;
        for &passes in checkpoints {
            let seen = cube.insert(underway.until(passes)?);
            run.snapshots.push(self.snapshot(passes, underway.seconds, seen));
        }
        self.end(run, cube)
    }

    fn peer_observed(&self, peer: &mut Peer, seed: u64, checkpoints: &[u64]) -> Result<Ended> {
        let about = peer.introduction();
        let options = json!({
            "versions": about.versions,
            "samples_per_pass": self.samples,
            "seconds_left_out": {
                "load": about.load_cpu_seconds,
                "compile": about.compile_cpu_seconds,
                "trace_each_pass": about.trace_cpu_seconds,
            },
            "known_faults": self.faults,
        });
        let mut run = Run { setup_seconds: 0.0, options, snapshots: Vec::new() };
        let mut cube = None;
        for shot in peer.run(seed, checkpoints)? {
            let seconds = Seconds { wall: shot.wall_seconds, cpu: shot.cpu_seconds };
            let seen = cube.insert(peer.cube(&shot)?);
            let wanted = &self.reference.cube;
            if (seen.width, seen.height, seen.bins) != (wanted.width, wanted.height, wanted.bins) {
                return Err(ValidationError::unusable("the peer's cube", "has another size"));
            }
            run.snapshots.push(self.snapshot(shot.launches, seconds, seen));
        }
        self.end(run, cube)
    }

    fn snapshot(&self, passes: u64, seconds: Seconds, cube: &Cube) -> Snapshot {
        Snapshot { passes, seconds, residuals: residuals(cube, self.reference) }
    }

    fn end(&self, run: Run, cube: Option<Cube>) -> Result<Ended> {
        let Some(cube) = cube else {
            return Err(ValidationError::unusable("a contest", "needs a checkpoint"));
        };
        let reference = &self.reference.cube;
        let whole = (0..cube.pixels())
            .flat_map(|pixel| cube.pixel_bins(pixel).iter().zip(reference.pixel_bins(pixel)))
            .map(|(x, r)| (x - r) as f32)
            .collect();
        Ok(Ended { run, whole, totals: totals(&cube, &self.reference.mask) })
    }

    fn judge(
        &self,
        names: &[&str],
        mut ended: Vec<Vec<Ended>>,
        peer: Introduction,
    ) -> Result<Contest> {
        let noise = self.reference.noise(|pixel| self.reference.mask[pixel]);
        let judged = self.reference.mask.iter().filter(|&&judged| judged).count();
        let mut rows = Vec::new();
        for (name, runs) in names.iter().zip(&mut ended) {
            rows.push(self.row(name, runs)?);
        }
        let (ours, last) = rows.split_at_mut(self.ours.len());
        for row in ours {
            row.compare(&last[0]);
        }
        let unbiased = |name: &&str| *name == self.reference.provenance.method;
        let of = |at: usize| ended[at].iter().map(|e| e.totals).collect::<Vec<_>>();
        let agreement = match names.iter().position(unbiased) {
            Some(at) => agreement(&of(at), &of(names.len() - 1)),
            None => Vec::new(),
        };
        let cells = judged * self.reference.cube.bins;
        let curves = names.iter().zip(ended).map(|(name, ended)| {
            let runs = ended.into_iter().map(|ended| ended.run).collect();
            curve(name, runs, &noise, cells)
        });
        Ok(Contest {
            scene: self.name.clone(),
            cpu_seconds: self.cpu_seconds,
            samples: self.samples,
            faults: self.faults.clone(),
            rows,
            agreement,
            curves: ErrorAgainstTime {
                scene: format!("{} beside {NAME}", self.name),
                reference: self.reference.provenance.clone(),
                reference_nmse: noise.variance / noise.signal(),
                pixels: [judged, self.reference.cube.pixels()],
                replicates: self.replicates,
                seed: self.seed,
                threads: rayon::current_num_threads(),
                circumstances: self.circumstances.clone(),
                left_out: Vec::new(),
                curves: curves.collect(),
            },
            peer,
        })
    }

    fn row(&self, name: &str, ended: &mut [Ended]) -> Result<Row> {
        let too_few =
            || ValidationError::unusable("a contest", "needs three replicates and a lit reference");
        let whole: Vec<Vec<f32>> =
            ended.iter_mut().map(|ended| std::mem::take(&mut ended.whole)).collect();
        let noise = self.reference.noise(|_| true);
        let whole = Gram::of(&whole).split(&noise, CONFIDENCE).ok_or_else(too_few)?;
        let last = |ended: &Ended| ended.run.snapshots.last().map(|s| (s.passes, s.seconds.cpu));
        let ends: Vec<(u64, f64)> = ended.iter().filter_map(last).collect();
        let residuals: Vec<Vec<f32>> = ended
            .iter()
            .filter_map(|ended| Some(ended.run.snapshots.last()?.residuals.clone()))
            .collect();
        let noise = self.reference.noise(|pixel| self.reference.mask[pixel]);
        let split = Gram::of(&residuals).split(&noise, CONFIDENCE).ok_or_else(too_few)?;
        Ok(Row {
            method: name.to_owned(),
            passes: ends.first().map_or(0, |end| end.0),
            cpu_seconds: ends.iter().map(|end| end.1).collect(),
            median: bootstrap::median(&split.replicates),
            split,
            whole: whole.nmse,
            less: None,
            less_median: None,
        })
    }
}

impl Row {
    /// How many times less error · CPU seconds this one has.
    fn compare(&mut self, peer: &Self) {
        let freedom = self.cpu_seconds.len() as f64 - 1.0;
        let factor = Factor::of(&peer.split.nmse, &self.split.nmse, freedom, CONFIDENCE);
        let seconds = summarise(&peer.cpu_seconds).mean / summarise(&self.cpu_seconds).mean;
        self.less = factor.map(|factor| factor.scaled(seconds));
        let medians = bootstrap::ratio_of_medians(&peer.work(), &self.work(), CONFIDENCE);
        self.less_median = Some(medians);
    }

    /// NMSE · CPU seconds of each replicate.
    fn work(&self) -> Vec<f64> {
        self.split.replicates.iter().zip(&self.cpu_seconds).map(|(nmse, cpu)| nmse * cpu).collect()
    }
}

/// Rising numbers of passes, each once, of which the last is `passes`, or 1 at least.
fn parts(passes: f64) -> Vec<u64> {
    let mut parts: Vec<u64> = PARTS.map(|part| (part * passes).round().max(1.0) as u64).into();
    parts.dedup();
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_observed_at_halves_and_ends_where_it_should() {
        assert_eq!(parts(160.0), [10, 20, 40, 80, 160]);
        assert_eq!(parts(3.4), [1, 2, 3]);
        assert_eq!(parts(0.2), [1]);
        assert_eq!(parts(-1.0), [1]);
    }
}
