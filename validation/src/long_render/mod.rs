//! A method's long render, made in batches: the truth that others are compared with, or a mean with
//! an interval.
//!
//! A long render is the mean of K batches with as many passes each, one after the other with one
//! seed: it is what a single render of all passes would be. Its own noise is measured, not modelled:
//! the variance of the mean of K batches is Σ(x − x̄)²/(K(K − 1)), without bias for every cell, and
//! precise once summed over many ([`LongMean`]).
//!
//! With a file, it is written after each batch: nothing is lost by an interruption, and a later run
//! adds batches until it has been rendered for as long as asked.
//!
//! Methods that blur less from pass to pass have batches that differ in their blur: they are not
//! quite alike, and what the shrinking adds to their spread is counted as noise.

mod mean;

use std::path::Path;
use std::time::Duration;

use tpb_film::Arrays;
use tpb_render::{Budget, RunSettings};
use tpb_scene::load::LoadedScene;
use tpb_scene::{Plan, Transport};

use crate::error::{Result, ValidationError};
use crate::judged::Referee;
use crate::measure::{Estimator, layout, render};
use crate::watch::Watch;

pub use mean::{LongMean, Made};

/// What is told of each batch.
pub type Values<'a> = dyn Fn(&Arrays) -> Vec<f64> + 'a;

/// What to render.
pub struct LongRender<'a> {
    /// The scene.
    pub loaded: &'a LoadedScene,
    /// The method.
    pub estimator: Estimator,
    /// Who says which pixels are judged.
    pub referee: Referee,
    /// What they say, if that is known already.
    pub judged: Option<&'a [bool]>,
    /// Wall time of all.
    pub time: Duration,
    /// Batches that fill the time; pass counts are whole numbers, so that a few more or less may.
    pub batches: u32,
    /// There are so many at least, whatever the time: 2 or more.
    pub fewest: u64,
    /// Passes of a batch; `None`: as many as fit.
    pub passes: Option<u64>,
    /// Seed.
    pub seed: u64,
    /// Commit of the sources.
    pub commit: &'a str,
    /// The command that is carried out; empty if it is not kept.
    pub command: &'a str,
    /// Whether only batches of this seed and commit go on, as for what is measured; a truth may have
    /// any, and says whose it has ([`Made`]).
    pub own: bool,
    /// Numbers that are kept of every batch, in [`Made::values`].
    pub values: &'a Values<'a>,
}

/// No numbers.
pub fn no_values(_: &Arrays) -> Vec<f64> {
    Vec::new()
}

impl<'a> LongRender<'a> {
    /// The referee's own: in 8 batches, 4 at least.
    pub fn reference(
        loaded: &'a LoadedScene,
        referee: Referee,
        time: Duration,
        seed: u64,
        commit: &'a str,
    ) -> Self {
        let estimator = referee.estimator();
        let (batches, fewest, passes, own) = (8, 4, None, false);
        Self {
            loaded,
            estimator,
            referee,
            judged: None,
            time,
            batches,
            fewest,
            passes,
            seed,
            commit,
            command: "",
            own,
            values: &no_values,
        }
    }

    /// Makes it from nothing; it is kept nowhere.
    ///
    /// # Errors
    /// If the scene cannot be rendered, has no time bins, or the task is ended.
    pub fn make(&self, watch: &mut Watch<'_>) -> Result<LongMean> {
        self.grow(None, &mut |_| Ok(()), watch)
    }

    /// What the file has, and as many batches more as are missing; the file has them then.
    ///
    /// # Errors
    /// Those of [`LongRender::make`], and if the file cannot be written.
    pub fn obtain(&self, path: &Path, watch: &mut Watch<'_>) -> Result<LongMean> {
        let kept = if path.exists() { LongMean::read(path).ok() } else { None };
        let kept = kept.filter(|kept| self.is_begun_by(&kept.made));
        if let Some(LongMean { made: Made { method, batches, wall_seconds, .. }, .. }) = &kept {
            watch.tell(&format!(
                "  {method}: {batches} batches, {wall_seconds:.0} s, are there already"
            ));
        }
        self.grow(kept, &mut |whole: &LongMean| whole.write(path), watch)
    }

    /// Whether batches of this render can be added to what was made.
    fn is_begun_by(&self, made: &Made) -> bool {
        made.scene == self.loaded.canonical
            && made.method == self.estimator.name()
            && made.estimator.as_ref().is_none_or(|made| *made == format!("{:?}", self.estimator))
            && self.passes.is_none_or(|passes| passes == made.passes)
            && (!self.own || self.is_own(made))
    }

    /// Sources that differ from their commit are not known well enough.
    fn is_own(&self, made: &Made) -> bool {
        let known = !self.commit.ends_with("-dirty") && self.commit != "unknown";
        known && made.seed == self.seed && made.commits.iter().all(|made| made == self.commit)
    }

    fn grow(
        &self,
        start: Option<LongMean>,
        keep: &mut dyn FnMut(&LongMean) -> Result<()>,
        watch: &mut Watch<'_>,
    ) -> Result<LongMean> {
        match Plan::new(&self.loaded.scene, &self.loaded.scene.integrator).transport {
            Transport::Mono => self.grow_with::<1>(start, keep, watch),
            Transport::Rgb => self.grow_with::<3>(start, keep, watch),
        }
    }

    fn grow_with<const C: usize>(
        &self,
        start: Option<LongMean>,
        keep: &mut dyn FnMut(&LongMean) -> Result<()>,
        watch: &mut Watch<'_>,
    ) -> Result<LongMean> {
        let scene = &self.loaded.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let method = self.estimator.prepare::<C>(scene, &plan, scene.integrator)?;
        let mut mean = start;
        while mean.as_ref().is_none_or(|mean| self.wants_more(&mean.made)) {
            watch.go_on()?;
            let settings = self.settings(mean.as_ref().map(|mean| &mean.made));
            let (arrays, summary) = render(&*method, layout(&scene.film, 0.0)?, &settings)?;
            let whole = match &mut mean {
                Some(whole) => whole,
                none => none.insert(self.begin(&arrays, summary.passes)?),
            };
            whole.add(&arrays);
            whole.made.values.push((self.values)(&arrays));
            drop(arrays);
            whole.made.count(&summary, self.commit, self.command);
            keep(whole)?;
            self.tell(&whole.made, watch);
        }
        mean.ok_or_else(|| ValidationError::unusable("a long render", "no batch was made"))
    }

    /// Of the next batch.
    fn settings(&self, made: Option<&Made>) -> RunSettings {
        let (seed, passes) = made.map_or((self.seed, self.passes), |m| (m.seed, Some(m.passes)));
        let first_pass = made.map_or(0, |made| made.batches * made.passes);
        let first = Budget::Time(self.time / self.batches.max(1));
        RunSettings { seed, budget: passes.map_or(first, Budget::Passes), first_pass }
    }

    /// Whether another batch brings the wall time closer to what is wanted.
    fn wants_more(&self, made: &Made) -> bool {
        let batch = made.wall_seconds / made.batches as f64;
        made.batches < self.fewest
            || (self.passes.is_none() && made.wall_seconds + 0.5 * batch < self.time.as_secs_f64())
    }

    fn tell(&self, made: &Made, watch: &mut Watch<'_>) {
        let Made { method, batches, passes, wall_seconds, .. } = made;
        let of = match self.passes {
            Some(_) => format!("; {} batches are wanted", self.fewest),
            None => format!(" of {:.0} s", self.time.as_secs_f64()),
        };
        watch.tell(&format!(
            "  {method}: {batches} batches of {passes} passes, {wall_seconds:.0} s{of}"
        ));
    }

    /// An empty mean with the shape of a batch.
    fn begin(&self, batch: &Arrays, passes: u64) -> Result<LongMean> {
        if batch.bins == 0 {
            let reason = "the scene's film has no time bins";
            return Err(ValidationError::unusable("a long render", reason));
        }
        let made = Made {
            method: self.estimator.name().to_owned(),
            estimator: Some(format!("{:?}", self.estimator)),
            scene: self.loaded.canonical.clone(),
            seed: self.seed,
            passes,
            ..Made::default()
        };
        let judged = match self.judged {
            Some(judged) => judged.to_vec(),
            None => self.referee.judged_of(&self.loaded.scene)?,
        };
        Ok(LongMean::empty(batch, judged, made))
    }
}

#[cfg(test)]
mod tests;
