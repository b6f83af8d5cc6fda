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
//! What is left of B(0) against the unbiased methods is what blur ∝ R² does not explain: blur ∝ R, of
//! which a third is left, or a defect.

mod regions;

use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tpb_beams::{BeamOptions, Settings};
use tpb_film::Arrays;
use tpb_scene::Plan;
use tpb_scene::load::LoadedScene;

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
/// Who renders: the unbiased ones, then beams, and beams with half their radii.
const METHODS: [&str; 4] = ["path", "light", "beams", "beams, radii halved"];
/// What B(0) is called.
const EXTRAPOLATED: &str = "beams, R \u{2192} 0";
/// Who is compared, the second being what differences are relative to; 4 is B(0).
const PAIRS: [(usize, usize); 5] = [(1, 0), (2, 0), (2, 1), (3, 1), (4, 1)];
/// Where [`RegionResult::differences`] compare light with path, beams with light, B(0) with light.
pub const LIGHT_PATH: usize = 0;
/// See [`LIGHT_PATH`].
pub const BEAMS_LIGHT: usize = 2;
/// See [`LIGHT_PATH`].
pub const LIMIT_LIGHT: usize = 4;

/// What to compare.
pub struct CausticsPlan<'a> {
    /// Name of the scene.
    pub name: &'a str,
    /// The scene.
    pub loaded: &'a LoadedScene,
    /// Its geometry.
    pub room: &'a Room,
    /// Wall time of each method.
    pub time: Duration,
    /// Seed of the first.
    pub seed: u64,
    /// Commit of the sources.
    pub commit: &'a str,
    /// Where renders are kept meanwhile.
    pub folder: &'a Path,
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
    /// What blur adds to beams, 4/3 (B(R) − B(R/2)), over the light tracer's level: 95 % interval.
    pub blur: Option<[f64; 2]>,
    /// Light and path, beams and path, beams and light, halved radii and light, R → 0 and light.
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
        let regions = regions(self.room, scene, &judged)?;
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
        let found = Caustics {
            scene: self.name.to_owned(),
            methods: METHODS.map(str::to_owned).to_vec(),
            cpu_seconds: made.iter().map(|mean| mean.made.cpu_seconds).collect(),
            passes: made.iter().map(|mean| mean.made.batches * mean.made.passes).collect(),
            batches: made.iter().map(|mean| mean.made.batches).min().unwrap_or(0),
            regions: of_regions.map(|(index, region)| result(region, index, &made)).collect(),
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
            time: self.time,
            batches: BATCHES,
            fewest: like.map_or(u64::from(BATCHES), |made| made.batches),
            passes: like.map(|made| made.passes),
            seed: self.seed * 10 + index as u64,
            commit: self.commit,
            own: true,
            values: &values,
        };
        super::super::folder(self.folder)?;
        order.obtain(&self.folder.join(format!("{}-{index}.npz", self.name)), watch)
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

fn result(region: &Region, index: usize, made: &[LongMean]) -> RegionResult {
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
    let name = |index: usize| METHODS.get(index).copied().unwrap_or(EXTRAPOLATED);
    let compare = |&(a, b): &(usize, usize)| {
        let of = format!("{} \u{2212} {}", name(a), name(b));
        difference(of, &summaries[a], &summaries[b], freedom)
    };
    RegionResult {
        label: region.label.clone(),
        pixels: region.pixels.len(),
        bins: [region.bins.start, region.bins.end],
        levels,
        blur: ratio(&blur, &light, freedom),
        differences: PAIRS.iter().map(compare).collect(),
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
mod tests {
    use super::*;

    #[test]
    fn verdicts_need_the_whole_interval() {
        assert_eq!(verdict([-0.02, 0.029]), Verdict::Agree);
        assert_eq!(verdict([-0.02, 0.031]), Verdict::Open);
        assert_eq!(verdict([0.031, 0.5]), Verdict::Differ);
        assert_eq!(verdict([-0.5, -0.04]), Verdict::Differ);
    }

    #[test]
    fn differences_are_relative_to_the_second() {
        let summary = |mean, standard_error| Summary { mean, standard_error };
        let named = || "beams \u{2212} light".to_owned();
        let d = difference(named(), &summary(1.02, 0.003), &summary(1.0, 0.004), 15.0);
        let [low, high] = d.interval.unwrap();
        let middle = 0.5 * (low + high);
        assert!((middle - 0.02).abs() < 1e-12 && d.verdict == Verdict::Open, "{d:?}");
        // t of 15 degrees of freedom at 95 % is 2.131; √(0.003² + (1.02·0.004)²) = 0.005064.
        assert!((high - middle - 2.1314 * 0.005_064).abs() < 1e-5);
        let dark = difference(named(), &summary(1.0, 0.1), &summary(0.0, 0.0), 15.0);
        assert_eq!((dark.interval, dark.verdict), (None, Verdict::Open));
    }

    #[test]
    fn half_the_radius_tells_the_blur_and_the_mean_without_it() {
        // B(R) = 1 − 0.08 R² at R = 1 and R = 1/2.
        let summary = |mean, standard_error| Summary { mean, standard_error };
        let (whole, half) = (summary(0.92, 0.003), summary(0.98, 0.004));
        let limit = combined(4.0 / 3.0, &half, -1.0 / 3.0, &whole);
        assert!((limit.mean - 1.0).abs() < 1e-12);
        assert!((limit.standard_error - (16.0 * 16.0 + 9.0_f64).sqrt() / 3e3).abs() < 1e-9);
        let blur = combined(4.0 / 3.0, &whole, -4.0 / 3.0, &half);
        assert!((blur.mean + 0.08).abs() < 1e-12);
    }
}
