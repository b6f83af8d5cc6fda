//! Caustics by three methods: mean radiances of regions, with intervals, and whether they agree.
//!
//! Each method renders for the same time, in batches of as many passes each; beams go on shrinking
//! their radius from batch to batch (progressive). A region is a block of pixels about a place of the
//! room, over all time or over a window of OPL; only pixels that look past mirrors and glass count,
//! since the light tracer does not see what stands in them, and none that is near a lamp.
//!
//! Two methods *agree* on a region if the 95 % interval of their relative difference lies within the
//! margin, chosen beforehand; they *differ* if it lies outside; else the question is *open*: noise.

use std::ops::Range;
use std::time::Duration;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use tpb_film::Arrays;
use tpb_render::{Budget, Method, RunSettings};
use tpb_scene::load::LoadedScene;
use tpb_scene::{Plan, Scene, Transport};

use super::room::Room;
use crate::cube::Cube;
use crate::error::Result;
use crate::judged::Referee;
use crate::measure::{Estimator, layout, render};
use crate::statistics::batches::{Summary, summarise};
use crate::statistics::student;
use crate::watch::Watch;

/// Relative difference that is small enough.
pub const MARGIN: f64 = 0.03;
/// Confidence of intervals.
const CONFIDENCE: f64 = 0.95;
/// Batches of each method.
const BATCHES: u32 = 16;
/// Who renders, the unbiased ones first.
const METHODS: [&str; 3] = ["path", "light", "beams"];

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
}

/// Where light is compared.
#[derive(Clone, Debug, PartialEq)]
struct Region {
    label: String,
    pixels: Vec<usize>,
    bins: Range<usize>,
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
    /// Light and path, beams and path, beams and light.
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
    /// Batches of each.
    pub batches: u64,
    /// The regions.
    pub regions: Vec<RegionResult>,
}

impl CausticsPlan<'_> {
    /// Carries it out; also gives the mean of each method, with its variance.
    ///
    /// # Errors
    /// If a method cannot render the scene.
    pub fn run(&self, watch: &mut Watch<'_>) -> Result<(Caustics, Vec<Arrays>)> {
        match Plan::new(&self.loaded.scene, &self.loaded.scene.integrator).transport {
            Transport::Mono => self.run_with::<1>(watch),
            Transport::Rgb => self.run_with::<3>(watch),
        }
    }

    fn run_with<const C: usize>(
        &self,
        watch: &mut Watch<'_>,
    ) -> Result<(Caustics, Vec<Arrays>)> {
        let scene = &self.loaded.scene;
        let plan = Plan::new(scene, &scene.integrator);
        let mask = Referee::Light.judged::<C>(scene)?;
        let regions = self.regions(&mask)?;
        let mut found = Caustics {
            scene: self.name.to_owned(),
            methods: METHODS.map(str::to_owned).to_vec(),
            cpu_seconds: Vec::new(),
            passes: Vec::new(),
            batches: u64::from(BATCHES),
            regions: Vec::new(),
        };
        let (mut values, mut means) = (Vec::new(), Vec::new());
        for (index, name) in METHODS.into_iter().enumerate() {
            let Some(estimator) = Estimator::of_name(name) else { continue };
            let method = estimator.prepare::<C>(scene, &plan, scene.integrator)?;
            let made = self.batches(&*method, self.seed * 10 + index as u64, &regions)?;
            watch.tell(&format!("  {name}: {} passes, {:.0} CPU s", made.passes, made.cpu_seconds));
            found.cpu_seconds.push(made.cpu_seconds);
            found.passes.push(made.passes);
            values.push(made.values);
            means.extend(made.mean);
        }
        found.regions =
            regions.iter().enumerate().map(|(i, region)| result(region, i, &values)).collect();
        Ok((found, means))
    }

    fn batches<const C: usize>(
        &self,
        method: &dyn Method<C>,
        seed: u64,
        regions: &[Region],
    ) -> Result<Made> {
        let mut made = Made::default();
        let mut passes = 0;
        for batch in 0..u64::from(BATCHES) {
            let budget =
                if batch == 0 { Budget::Time(self.time / BATCHES) } else { Budget::Passes(passes) };
            let settings = RunSettings { seed, budget, first_pass: batch * passes };
            let (arrays, summary) =
                render(method, layout(&self.loaded.scene.film, 0.0)?, &settings)?;
            passes = summary.passes;
            made.passes += passes;
            made.cpu_seconds += summary.cpu_seconds.unwrap_or(summary.wall_seconds);
            let cube = Cube::of(&arrays);
            made.values.push(regions.iter().map(|region| region.value(&cube)).collect());
            made.add(arrays);
        }
        made.finish();
        Ok(made)
    }

    /// Blocks about places of the room, and everything.
    fn regions(&self, mask: &[bool]) -> Result<Vec<Region>> {
        let scene = &self.loaded.scene;
        let axis = layout(&scene.film, 0.0)?.time;
        let (bins, width_opl, start) =
            axis.map_or((0, 1.0, 0.0), |axis| (axis.bins, axis.bin_width_opl, axis.start_opl));
        let window = |from: f64, to: f64| -> Range<usize> {
            let bin =
                |opl: f64| ((opl - start) / width_opl).round().clamp(0.0, bins as f64) as usize;
            bin(from)..bin(to).max(bin(from) + 1).min(bins)
        };
        let Room { lamp, ball, floor, back, .. } = *self.room;
        let halfway = 0.5 * (self.room.poles()[1] + self.room.focus());
        let t_floor = self.room.through(floor);
        let t_halfway = self.room.through(halfway);
        let beside = floor + DVec3::new(0.0, 0.0, 0.5);
        let below = DVec3::new(lamp.x, floor.y, 0.3);
        let whole = 0..bins;
        let list: [(&str, DVec3, f64, Range<usize>); 8] = [
            ("caustic on the floor, all time", floor, 0.16, whole.clone()),
            (
                "caustic on the floor, as it arrives",
                floor,
                0.16,
                window(t_floor - 0.12, t_floor + 0.2),
            ),
            ("focused light in fog, all time", halfway, 0.12, whole.clone()),
            (
                "focused light in fog, as it arrives",
                halfway,
                0.12,
                window(t_halfway - 0.16, t_halfway + 0.28),
            ),
            ("floor in front of the caustic", beside, 0.2, whole.clone()),
            ("floor below the lamp", below, 0.3, whole.clone()),
            ("back wall behind the lamp", back, 0.3, whole.clone()),
            (
                "fog and back wall above the ball",
                ball + DVec3::new(0.0, 0.75, -0.5),
                0.2,
                whole.clone(),
            ),
        ];
        let mut regions: Vec<Region> = list
            .into_iter()
            .filter_map(|(label, place, half, bins)| {
                let pixels = block(scene, place, half, mask);
                (!pixels.is_empty()).then(|| Region { label: label.to_owned(), pixels, bins })
            })
            .collect();
        let all: Vec<usize> = (0..mask.len()).filter(|&pixel| mask[pixel]).collect();
        regions.push(Region {
            label: "all pixels that look past mirrors, glass and lamp".to_owned(),
            pixels: all,
            bins: whole,
        });
        Ok(regions)
    }
}

/// Pixels within `half` \[m\] of a place, across and along the image, that the mask admits.
fn block(scene: &Scene, place: DVec3, half: f64, mask: &[bool]) -> Vec<usize> {
    let eye = scene.sensor.position;
    let (width, height) = (scene.film.width, scene.film.height);
    let Some(centre) = scene.sensor.project(place - eye) else { return Vec::new() };
    let along = (place - eye).dot(scene.sensor.forward());
    let side = half / (along * scene.sensor.pixel_width());
    let range = |at: f64, end: usize| {
        let first = (at - side).round().max(0.0) as usize;
        first..((at + side).round().max(0.0) as usize).max(first + 1).min(end)
    };
    range(centre.y, height)
        .flat_map(|y| range(centre.x, width).map(move |x| y * width + x))
        .filter(|&pixel| mask[pixel])
        .collect()
}

impl Region {
    /// Mean over pixels of the energy within the window.
    fn value(&self, cube: &Cube) -> f64 {
        let energy = |&pixel: &usize| cube.pixel_bins(pixel)[self.bins.clone()].iter().sum::<f64>();
        self.pixels.iter().map(energy).sum::<f64>() / self.pixels.len().max(1) as f64
    }
}

/// The batches of one method.
#[derive(Default)]
struct Made {
    passes: u64,
    cpu_seconds: f64,
    /// By batch and region.
    values: Vec<Vec<f64>>,
    /// Mean of all batches; its variance, Σ(x − x̄)² until it is finished.
    mean: Option<Arrays>,
    count: f64,
}

impl Made {
    fn add(&mut self, mut batch: Arrays) {
        self.count += 1.0;
        let share = 1.0 / self.count;
        let Some(mean) = &mut self.mean else {
            batch.variance = Some(vec![0.0; batch.transient.len()]);
            self.mean = Some(batch);
            return;
        };
        let squares = mean.variance.get_or_insert_default();
        for ((mean, squares), x) in mean.transient.iter_mut().zip(squares).zip(&batch.transient) {
            let before = x - *mean;
            *mean += before * share as f32;
            *squares += before * (x - *mean);
        }
        for (mean, batch) in [
            (&mut mean.before, &batch.before),
            (&mut mean.after, &batch.after),
            (&mut mean.steady, &batch.steady),
        ] {
            mean.iter_mut().zip(batch).for_each(|(mean, x)| *mean += (x - *mean) * share);
        }
    }

    /// Σ(x − x̄)² becomes the variance of the mean.
    fn finish(&mut self) {
        let factor = 1.0 / (self.count * (self.count - 1.0)).max(1.0);
        let squares = self.mean.as_mut().and_then(|mean| mean.variance.as_mut());
        squares.into_iter().flatten().for_each(|square| *square *= factor as f32);
    }
}

fn result(region: &Region, index: usize, values: &[Vec<Vec<f64>>]) -> RegionResult {
    let summaries: Vec<Summary> = values
        .iter()
        .map(|batches| summarise(&batches.iter().map(|batch| batch[index]).collect::<Vec<_>>()))
        .collect();
    let level = |s: &Summary| Level { mean: s.mean, standard_error: s.standard_error };
    let pairs = [(1, 0), (2, 0), (2, 1)];
    RegionResult {
        label: region.label.clone(),
        pixels: region.pixels.len(),
        bins: [region.bins.start, region.bins.end],
        levels: summaries.iter().map(level).collect(),
        differences: pairs
            .iter()
            .map(|&(a, b)| difference(METHODS[a], &summaries[a], METHODS[b], &summaries[b]))
            .collect(),
    }
}

/// (a − b)/b with the interval of independent means; the relative error of b is held to first order.
fn difference(name_a: &str, a: &Summary, name_b: &str, b: &Summary) -> Difference {
    let ratio = a.mean / b.mean;
    let error = (a.standard_error / b.mean).hypot(ratio * b.standard_error / b.mean);
    let half = student::quantile(0.5 * (1.0 - CONFIDENCE), f64::from(BATCHES) - 1.0) * error;
    let interval = [ratio - 1.0 - half, ratio - 1.0 + half];
    let interval = interval.iter().all(|end| end.is_finite()).then_some(interval);
    let verdict = interval.map_or(Verdict::Open, verdict);
    Difference { of: format!("{name_a} \u{2212} {name_b}"), interval, verdict }
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
        let d = difference("beams", &summary(1.02, 0.003), "light", &summary(1.0, 0.004));
        let [low, high] = d.interval.unwrap();
        let middle = 0.5 * (low + high);
        assert!((middle - 0.02).abs() < 1e-12 && d.verdict == Verdict::Open, "{d:?}");
        // t of 15 degrees of freedom at 95 % is 2.131; √(0.003² + (1.02·0.004)²) = 0.005064.
        assert!((high - middle - 2.1314 * 0.005_064).abs() < 1e-5);
        let dark = difference("beams", &summary(1.0, 0.1), "path", &summary(0.0, 0.0));
        assert_eq!((dark.interval, dark.verdict), (None, Verdict::Open));
    }

    #[test]
    fn the_mean_of_batches_has_its_variance() {
        let mut made = Made::default();
        for value in [1.0_f32, 2.0, 6.0] {
            let mut arrays = crate::reproduce::testing::arrays(1, 1, 2, 1);
            arrays.transient.fill(value);
            arrays.steady.fill(f64::from(2.0 * value));
            made.add(arrays);
        }
        made.finish();
        let mean = made.mean.unwrap();
        // Mean 3, squares 14, over 3·2.
        assert!((mean.transient[0] - 3.0).abs() < 1e-6 && (mean.steady[0] - 6.0).abs() < 1e-12);
        assert!((mean.variance.unwrap()[1] - 14.0 / 6.0).abs() < 1e-6);
    }
}
