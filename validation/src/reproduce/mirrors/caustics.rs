//! Caustics by three methods: mean radiances of regions, with intervals, and whether they agree.
//!
//! Each method renders for the same time, in batches of as many passes each ([`crate::long_render`]);
//! beams go on shrinking their radii from batch to batch (progressive). A region is a block of pixels
//! about a place of the room, over all time or over a window of OPL; only pixels that look past
//! mirrors and glass count, since the light tracer does not see what stands in them, and none that is
//! near a lamp.
//!
//! Two methods *agree* on a region if the 95 % interval of their relative difference lies within the
//! margin, chosen beforehand; they *differ* if it lies outside; else the question is *open*: noise.
//!
//! **Blur.** Photons are blurred over a disc, beams over their radius: a region whose borders cut
//! through a caustic loses what is blurred out of it. Away from borders of media and surfaces a mean
//! B(R) is blurred by aR² + O(R⁴), so that beams render once more with radii of one half in every
//! pass, as many passes, and other random numbers:
//!
//! > blur ≈ 4/3 (B(R) − B(R/2)),   B(0) ≈ (4 B(R/2) − B(R))/3   (Richardson 1911)
//!
//! **Rare finds.** Path tracing finds the lamp in mirrors and through glass by chance. Light that each
//! of N camera paths finds with a probability below ln(1/δ)/N was missed by all with a probability above
//! δ, and no batch shows it; a find adds at most the radiance L of the brightest emitter, since
//! throughput is at most 1. Intervals of differences from path tracing therefore hold means from what
//! it found to L ln(1/δ)/N more, with δ = 2.5 %.
//!
//! What is left of B(0) against the unbiased methods is what blur ∝ R² does not explain: blur ∝ R, of
//! which a third is left, or a defect.

pub(super) mod regions;

use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tpb_beams::{BeamOptions, Settings};
use tpb_film::Arrays;
use tpb_optics::seed_of;
use tpb_scene::load::LoadedScene;
use tpb_scene::{EmitterKind, Plan, Scene};

use super::close_up::CloseUp;
use super::room::Room;
use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::judged::Referee;
use crate::long_render::{LongMean, LongRender};
use crate::measure::Estimator;
use crate::statistics::batches::{Summary, summarise};
use crate::statistics::student;
use crate::watch::Watch;
use regions::{Region, regions};

/// Relative difference that is small enough.
pub const MARGIN: f64 = 0.03;
/// Confidence of intervals.
const CONFIDENCE: f64 = 0.95;
/// Batches of each method, at least.
const BATCHES: u32 = 16;
/// Their seeds are not those of races.
const SEEDS: u64 = 0xca05_71c5;
/// Who renders: the unbiased ones, then beams, and beams with half their radii.
const METHODS: [&str; 4] = ["path", "light", "beams", "beams, radii halved"];
/// What B(0) is called.
const EXTRAPOLATED: &str = "beams, R \u{2192} 0";
/// Who is compared, the second being what differences are relative to; 4 is B(0).
const PAIRS: [(usize, usize); 6] = [(1, 0), (2, 0), (2, 1), (3, 1), (4, 1), (4, 0)];
/// Where [`RegionResult::differences`] compare light with path, beams with path, beams with light,
/// B(0) with light, B(0) with path.
pub const LIGHT_PATH: usize = 0;
/// See [`LIGHT_PATH`].
pub const BEAMS_PATH: usize = 1;
/// See [`LIGHT_PATH`].
pub const BEAMS_LIGHT: usize = 2;
/// See [`LIGHT_PATH`].
pub const LIMIT_LIGHT: usize = 4;
/// See [`LIGHT_PATH`].
pub const LIMIT_PATH: usize = 5;
/// The differences among path, light and beams.
pub const THREE: [usize; 3] = [LIGHT_PATH, BEAMS_PATH, BEAMS_LIGHT];
/// Those among path, light and B(0).
pub const THREE_LIMIT: [usize; 3] = [LIGHT_PATH, LIMIT_PATH, LIMIT_LIGHT];
/// δ of light that all paths missed: what an interval leaves out on one side.
const UNSEEN: f64 = 0.5 * (1.0 - CONFIDENCE);

/// What to compare.
pub struct CausticsPlan<'a> {
    /// Name of the scene.
    pub name: &'a str,
    /// The scene.
    pub loaded: &'a LoadedScene,
    /// Its geometry.
    pub room: &'a Room,
    /// Wall time of path, light and beams; the last render takes as many passes as beams.
    pub times: [Duration; 3],
    /// Seed of the first.
    pub seed: u64,
    /// Commit of the sources.
    pub commit: &'a str,
    /// Where renders are kept meanwhile.
    pub folder: &'a Path,
    /// What the scene's camera was turned to, if it was.
    pub(super) close_up: Option<&'a CloseUp>,
}

/// A method's mean over a region.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Mean over pixels of the energy within the window \[W m⁻² sr⁻¹\].
    pub mean: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// How two methods compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The interval lies within the margin.
    Agree,
    /// It lies outside.
    Differ,
    /// Neither.
    Open,
}

/// The relative difference of two methods.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Which: `beams − light`.
    pub of: String,
    /// 95 % interval of the difference over the second; `None` if that is 0.
    pub interval: Option<[f64; 2]>,
    /// What it says.
    pub verdict: Verdict,
}

/// A compared region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionResult {
    /// What it is.
    pub label: String,
    /// Pixels.
    pub pixels: usize,
    /// Bins from and to.
    pub bins: [usize; 2],
    /// By each method.
    pub levels: Vec<Level>,
    /// What path tracing may have missed in all its paths, over its mean; `None` if there is no bound.
    #[serde(default)]
    pub unseen: Option<f64>,
    /// What blur adds to beams, 4/3 (B(R) − B(R/2)), over the light tracer's level: 95 % interval.
    pub blur: Option<[f64; 2]>,
    /// Light and path, beams and path, beams and light, halved radii and light, R → 0 and light, and
    /// path.
    pub differences: Vec<Difference>,
}

/// All regions of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Caustics {
    /// Name of the scene.
    pub scene: String,
    /// Names of the methods.
    pub methods: Vec<String>,
    /// CPU time of each \[s\].
    pub cpu_seconds: Vec<f64>,
    /// Passes of each.
    pub passes: Vec<u64>,
    /// Batches of each, the fewest.
    pub batches: u64,
    /// The regions.
    pub regions: Vec<RegionResult>,
}

impl CausticsPlan<'_> {
    /// Carries it out; also gives the mean of each method, with its variance. What is rendered stays
    /// in the folder.
    ///
    /// # Errors
    /// If a method cannot render the scene, or the task is ended.
    pub fn run(&self, watch: &mut Watch<'_>) -> Result<(Caustics, Vec<Arrays>)> {
        let scene = &self.loaded.scene;
        let judged = Referee::Light.judged_of(scene)?;
        let regions = match self.close_up {
            Some(close_up) => close_up.regions(scene, &judged)?,
            None => regions(self.room, scene, &judged)?,
        };
        let mut made: Vec<LongMean> = Vec::new();
        for (index, name) in METHODS.into_iter().enumerate() {
            let estimator = match Estimator::of_name(name) {
                Some(estimator) => estimator,
                None => self.halved()?,
            };
            let mean = self.render(index, estimator, &judged, &regions, made.last(), watch)?;
            made.push(mean);
        }
        let of_regions = regions.iter().enumerate();
        let brightest = brightest(scene);
        let of_region = |(index, region)| result(region, index, &made, brightest);
        let found = Caustics {
            scene: self.name.to_owned(),
            methods: METHODS.map(str::to_owned).to_vec(),
            cpu_seconds: made.iter().map(|mean| mean.made.cpu_seconds).collect(),
            passes: made.iter().map(|mean| mean.made.batches * mean.made.passes).collect(),
            batches: made.iter().map(|mean| mean.made.batches).min().unwrap_or(0),
            regions: of_regions.map(of_region).collect(),
        };
        Ok((found, made.into_iter().map(|mean| mean.arrays).collect()))
    }

    /// One method; with half the radii there are as many batches and passes as `before`.
    fn render(
        &self,
        index: usize,
        estimator: Estimator,
        judged: &[bool],
        regions: &[Region],
        before: Option<&LongMean>,
        watch: &mut Watch<'_>,
    ) -> Result<LongMean> {
        let values = |batch: &Arrays| {
            let cube = Cube::of(batch);
            regions.iter().map(|region| region.value(&cube)).collect()
        };
        let like = before.filter(|_| index == METHODS.len() - 1).map(|mean| &mean.made);
        let order = LongRender {
            loaded: self.loaded,
            estimator,
            referee: Referee::Light,
            judged: Some(judged),
            time: self.times[index.min(self.times.len() - 1)],
            batches: BATCHES,
            fewest: like.map_or(u64::from(BATCHES), |made| made.batches),
            passes: like.map(|made| made.passes),
            seed: seed_of(self.seed ^ SEEDS, index as u64),
            commit: self.commit,
            command: "",
            own: true,
            values: &values,
        };
        super::super::folder(self.folder)?;
        let key = self.close_up.map_or("room", |close_up| close_up.key);
        order.obtain(&self.folder.join(format!("{}-{key}-{index}.npz", self.name)), watch)
    }

    /// Beams with half their radii.
    fn halved(&self) -> Result<Estimator> {
        let scene = &self.loaded.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let settings = Settings::new(scene, &plan, &BeamOptions::default())
            .map_err(|error| ValidationError::unusable("photon beams", error))?;
        Ok(Estimator::Beams(BeamOptions {
            radius: Some(0.5 * settings.radius),
            surface_radius: Some(0.5 * settings.surface_radius),
            ..BeamOptions::default()
        }))
    }
}

impl Caustics {
    /// Regions on which a pair of [`RegionResult::differences`] agrees, differs, is open.
    pub fn verdicts(&self, pair: usize) -> [usize; 3] {
        let count = |verdict: Verdict| {
            let of = |region: &&RegionResult| region.differences[pair].verdict == verdict;
            self.regions.iter().filter(of).count()
        };
        [Verdict::Agree, Verdict::Differ, Verdict::Open].map(count)
    }
}

impl RegionResult {
    /// The largest difference among some pairs that their 95 % intervals allow; `None` if one of them
    /// is not known.
    pub fn bound(&self, pairs: &[usize]) -> Option<f64> {
        let ends = pairs.iter().map(|&pair| {
            let [low, high] = self.differences.get(pair)?.interval?;
            Some(low.abs().max(high.abs()))
        });
        ends.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
    }
}

/// Radiance of the brightest emitter, mean over channels; `None` if one of them has no area.
fn brightest(scene: &Scene) -> Option<f64> {
    let radiances = scene.emitters.iter().map(|emitter| match &emitter.kind {
        EmitterKind::Area { radiance, .. } => Some(radiance.0.iter().sum::<f64>() / 3.0),
        _ => None,
    });
    radiances.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
}

fn result(
    region: &Region,
    index: usize,
    made: &[LongMean],
    brightest: Option<f64>,
) -> RegionResult {
    let batches = |mean: &LongMean| -> Vec<f64> {
        mean.made.values.iter().map(|values| values[index]).collect()
    };
    let mut summaries: Vec<Summary> = made.iter().map(|mean| summarise(&batches(mean))).collect();
    let level = |s: &Summary| Level { mean: s.mean, standard_error: s.standard_error };
    let levels = summaries.iter().map(level).collect();
    let freedom = made.iter().map(|mean| mean.made.batches).min().unwrap_or(0) as f64 - 1.0;
    let (whole, half) = (&summaries[2], &summaries[3]);
    let blur = combined(4.0 / 3.0, whole, -4.0 / 3.0, half);
    let limit = combined(4.0 / 3.0, half, -1.0 / 3.0, whole);
    let light = summaries[1];
    summaries.push(limit);
    let share = region.pixels.len() as f64 / made[0].judged.len().max(1) as f64;
    let paths = share * made[0].made.camera_paths as f64;
    let unseen = brightest.map(|radiance| unseen(radiance, paths) / summaries[0].mean);
    let name = |index: usize| METHODS.get(index).copied().unwrap_or(EXTRAPOLATED);
    let compare = |&(a, b): &(usize, usize)| {
        let of = format!("{} \u{2212} {}", name(a), name(b));
        let found = difference(of, &summaries[a], &summaries[b], freedom);
        // The first method is path tracing.
        if b == 0 { found.with_unseen(unseen.unwrap_or(0.0)) } else { found }
    };
    RegionResult {
        label: region.label.clone(),
        pixels: region.pixels.len(),
        bins: [region.bins.start, region.bins.end],
        levels,
        unseen: unseen.filter(|unseen| unseen.is_finite()),
        blur: ratio(&blur, &light, freedom),
        differences: PAIRS.iter().map(compare).collect(),
    }
}

/// Mean radiance that so many paths may all have missed, if one that finds it adds at most `radiance`.
fn unseen(radiance: f64, paths: f64) -> f64 {
    radiance * -UNSEEN.ln() / paths
}

impl Difference {
    /// The same if the mean of the second may be larger by up to `more` of it.
    fn with_unseen(self, more: f64) -> Self {
        let Some([low, high]) = self.interval.filter(|_| more.is_finite()) else {
            return Self { interval: None, verdict: Verdict::Open, ..self };
        };
        let interval = [low, high].map(|end| 1.0 + end);
        let interval = [interval[0].min(interval[0] / (1.0 + more)) - 1.0, interval[1] - 1.0];
        Self { interval: Some(interval), verdict: verdict(interval), ..self }
    }
}

/// x·a + y·b of independent means.
fn combined(x: f64, a: &Summary, y: f64, b: &Summary) -> Summary {
    let standard_error = (x * a.standard_error).hypot(y * b.standard_error);
    Summary { mean: x * a.mean + y * b.mean, standard_error }
}

/// (a − b)/b and what it says.
fn difference(of: String, a: &Summary, b: &Summary, freedom: f64) -> Difference {
    let interval = ratio(a, b, freedom).map(|ends| ends.map(|end| end - 1.0));
    Difference { of, interval, verdict: interval.map_or(Verdict::Open, verdict) }
}

/// The interval of a/b, of independent means; the relative error of b is held to first order.
fn ratio(a: &Summary, b: &Summary, freedom: f64) -> Option<[f64; 2]> {
    let ratio = a.mean / b.mean;
    let error = (a.standard_error / b.mean).hypot(ratio * b.standard_error / b.mean);
    let half = student::quantile(0.5 * (1.0 - CONFIDENCE), freedom) * error;
    let interval = [ratio - half, ratio + half];
    interval.iter().all(|end| end.is_finite()).then_some(interval)
}

fn verdict([low, high]: [f64; 2]) -> Verdict {
    if low >= -MARGIN && high <= MARGIN {
        Verdict::Agree
    } else if low > MARGIN || high < -MARGIN {
        Verdict::Differ
    } else {
        Verdict::Open
    }
}

#[cfg(test)]
mod tests;
