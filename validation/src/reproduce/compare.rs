//! An equal-time comparison with all its parts: render times, windows of time, single bins, kinds of
//! cells, kinds within windows, and the pixels that see a lamp.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::halves::HalfCube;
use super::judge::Products;
use super::race::{Replicate, Spent};
use super::truth::{Kind, Origin, Truth};
use crate::error::{Result, ValidationError};
use crate::statistics::{Factor, Gram, ReferenceNoise, Split, Winner};

/// Confidence of all intervals.
pub const CONFIDENCE: f64 = 0.95;

/// A method at one render time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// What was spent, mean over replicates.
    pub spent: Spent,
    /// Passes, mean over replicates.
    pub passes: f64,
    /// Error over judged pixels.
    pub judged: Split,
    /// Error over all pixels; `None` if the reference lacks light in those that are not judged.
    pub whole: Option<Split>,
}

/// All methods at one render time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AtTime {
    /// Wall time that each was given \[s\].
    pub seconds: f64,
    /// The methods, in their order.
    pub methods: Vec<Standing>,
    /// NMSE · CPU seconds of the first over that of the second, judged pixels.
    pub factor: Option<Factor>,
    /// The same over all pixels.
    pub factor_whole: Option<Factor>,
    /// NMSE · wall seconds likewise, judged pixels: what a method gains that keeps all processors busy.
    #[serde(default)]
    pub factor_wall: Option<Factor>,
}

/// A part of the cells, at the last render time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// What it holds.
    pub label: String,
    /// OPL from and to \[m\].
    pub opl: [f64; 2],
    /// Share of the signal Σr² of judged pixels; of all pixels for those that see a lamp.
    pub share: f64,
    /// Error of each method, as a part of this part's signal; `None` where there is none.
    pub splits: Vec<Option<Split>>,
    /// NMSE · CPU seconds of the first over that of the second.
    pub factor: Option<Factor>,
}

impl Part {
    /// Which method has less error at equal time.
    pub fn winner(&self) -> Winner {
        self.factor.map_or(Winner::Unresolved, |factor| factor.winner())
    }
}

/// A whole comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Names of the methods: the baseline, then the one that is hoped to be better.
    pub methods: Vec<String>,
    /// Effective options of each.
    pub options: Vec<serde_json::Value>,
    /// Replicates of each.
    pub replicates: usize,
    /// Columns, rows, bins.
    pub shape: [usize; 3],
    /// Judged pixels, and all.
    pub pixels: [usize; 2],
    /// Where the reference comes from.
    #[serde(default)]
    pub reference: Option<Origin>,
    /// CPU time of the reference \[s\].
    pub reference_cpu_seconds: f64,
    /// NMSE of the reference itself over judged pixels.
    pub reference_nmse: f64,
    /// By render time, the last being the whole time.
    pub times: Vec<AtTime>,
    /// Windows of time.
    pub windows: Vec<Part>,
    /// Kinds of cells; empty if they were not sorted.
    pub kinds: Vec<Part>,
    /// Kinds of cells within windows, kind by kind.
    #[serde(default)]
    pub kinds_in_windows: Vec<Part>,
    /// Pixels that see a lamp, which are not judged; `None` if there are none, or the reference lacks
    /// light there.
    #[serde(default)]
    pub lamps: Option<Part>,
    /// Single bins.
    pub frames: Vec<Part>,
}

/// What maps are made of, at the last render time, for each method.
pub struct Maps {
    /// Variance of each pixel, summed over bins.
    pub variance: Vec<f64>,
    /// Residual of each pixel's energy within the window, for each replicate.
    pub window_residuals: Vec<Vec<f64>>,
}

impl Comparison {
    /// Judges the replicates of each method. `windows` are OPLs \[m\] between which windows of
    /// time lie, rounded to bins.
    ///
    /// # Errors
    /// If files are broken, there are fewer than three replicates, or the reference is black.
    pub fn new(
        names: &[&str],
        runs: &[Vec<Replicate>],
        truth: &Truth,
        windows: &[f64],
        seconds: &[f64],
    ) -> Result<(Self, Vec<Maps>)> {
        let bins = 0..truth.bins;
        let (noise, noise_whole) =
            (truth.noise(bins.clone(), true), truth.noise(bins.clone(), false));
        let mut times = Vec::new();
        let mut last = Vec::new();
        for (reading, &seconds) in seconds.iter().enumerate() {
            let mut methods = Vec::new();
            last.clear();
            for runs in runs {
                let cubes =
                    runs.iter().map(|run| run.cube(reading)).collect::<Result<Vec<HalfCube>>>()?;
                let products = Products::of(&cubes, truth)?;
                drop(cubes);
                let judged = split(&Products::over(&products.frames, bins.clone()), &noise)?;
                let whole = truth.sees_all.then(|| split(&products.whole(), &noise_whole));
                let whole = whole.transpose()?;
                let (spent, passes) = mean_spent(runs, reading);
                methods.push(Standing { spent, passes, judged, whole });
                last.push(products);
            }
            times.push(at_time(seconds, methods));
        }
        let cpu: Vec<f64> = times.last().map_or(Vec::new(), |time| {
            time.methods.iter().map(|method| method.spent.cpu_seconds).collect()
        });
        let parts = Parts { truth, cpu, signal: noise.signal(), products: &last };
        let comparison = Self {
            methods: names.iter().map(|&name| name.to_owned()).collect(),
            options: runs.iter().map(|runs| runs[0].options.clone()).collect(),
            replicates: runs.iter().map(Vec::len).min().unwrap_or(0),
            shape: [truth.width, truth.height, truth.bins],
            pixels: [truth.judged.iter().filter(|&&judged| judged).count(), truth.pixels()],
            reference: truth.origin.clone(),
            reference_cpu_seconds: truth.cpu_seconds,
            reference_nmse: noise.variance / noise.signal(),
            windows: parts.windows(windows),
            kinds: parts.kinds(),
            kinds_in_windows: parts.kinds_in_windows(windows),
            lamps: parts.lamps(noise_whole.signal()),
            frames: parts.frames(),
            times,
        };
        let maps = last
            .into_iter()
            .map(|p| Maps { variance: p.variance, window_residuals: p.window_residuals })
            .collect();
        Ok((comparison, maps))
    }

    /// The last render time.
    pub fn whole(&self) -> &AtTime {
        &self.times[self.times.len() - 1]
    }

    /// Ranges of consecutive bins that a method wins, each with its share of the signal.
    pub fn won(&self, winner: Winner) -> Vec<(Range<usize>, f64)> {
        let mut ranges: Vec<(Range<usize>, f64)> = Vec::new();
        for (bin, frame) in self.frames.iter().enumerate() {
            if frame.factor.is_none() || frame.winner() != winner {
                continue;
            }
            match ranges.last_mut() {
                Some((range, share)) if range.end == bin => {
                    range.end += 1;
                    *share += frame.share;
                }
                _ => ranges.push((bin..bin + 1, frame.share)),
            }
        }
        ranges
    }
}

fn split(gram: &Gram, noise: &ReferenceNoise) -> Result<Split> {
    gram.split(noise, CONFIDENCE).ok_or_else(|| {
        ValidationError::unusable(
            "the comparison",
            "needs three replicates, and a reference whose light is above its noise: give it more time",
        )
    })
}

fn mean_spent(runs: &[Replicate], reading: usize) -> (Spent, f64) {
    let n = runs.len() as f64;
    let mean =
        |of: fn(&Spent) -> f64| runs.iter().map(|run| of(&run.spent[reading])).sum::<f64>() / n;
    let passes = mean(|s| s.passes as f64);
    let spent = Spent {
        wall_seconds: mean(|s| s.wall_seconds),
        cpu_seconds: mean(|s| s.cpu_seconds),
        passes: passes.round() as u64,
    };
    (spent, passes)
}

fn at_time(seconds: f64, methods: Vec<Standing>) -> AtTime {
    let factor = |of: fn(&Standing) -> Option<&Split>, clock: fn(&Spent) -> f64| match &methods[..]
    {
        [a, b, ..] => {
            of_splits(of(a)?, of(b)?).map(|f| f.scaled(clock(&a.spent) / clock(&b.spent)))
        }
        _ => None,
    };
    let factors = (
        factor(|standing| Some(&standing.judged), |spent| spent.cpu_seconds),
        factor(|standing| standing.whole.as_ref(), |spent| spent.cpu_seconds),
        factor(|standing| Some(&standing.judged), |spent| spent.wall_seconds),
    );
    let (factor, factor_whole, factor_wall) = factors;
    AtTime { seconds, methods, factor, factor_whole, factor_wall }
}

fn of_splits(a: &Split, b: &Split) -> Option<Factor> {
    let freedom = a.replicates.len().min(b.replicates.len()) as f64 - 1.0;
    Factor::of(&a.nmse, &b.nmse, freedom, CONFIDENCE)
}

/// Makes parts.
struct Parts<'a> {
    truth: &'a Truth,
    cpu: Vec<f64>,
    signal: f64,
    products: &'a [Products],
}

impl Parts<'_> {
    fn part(
        &self,
        label: String,
        bins: Range<usize>,
        noise: &ReferenceNoise,
        gram: impl Fn(&Products) -> Gram,
    ) -> Part {
        let splits: Vec<Option<Split>> =
            self.products.iter().map(|p| gram(p).split(noise, CONFIDENCE)).collect();
        let factor = match splits.as_slice() {
            [Some(a), Some(b), ..] => {
                of_splits(a, b).map(|factor| factor.scaled(self.cpu[0] / self.cpu[1]))
            }
            _ => None,
        };
        let edges = &self.truth.opl_edges;
        let share = noise.signal() / self.signal;
        Part { label, opl: [edges[bins.start], edges[bins.end]], share, splits, factor }
    }

    /// Bins between OPLs, with their label.
    fn ranges(&self, opls: &[f64]) -> Vec<(Range<usize>, String)> {
        let edges = &self.truth.opl_edges;
        let bin = |opl: f64| edges.partition_point(|&edge| edge < opl - 1e-9).min(self.truth.bins);
        let ranges = opls.windows(2).map(|ends| bin(ends[0])..bin(ends[1]));
        ranges
            .filter(|bins| !bins.is_empty())
            .map(|bins| {
                let label = format!("{:.2} to {:.2} m", edges[bins.start], edges[bins.end]);
                (bins, label)
            })
            .collect()
    }

    fn windows(&self, opls: &[f64]) -> Vec<Part> {
        let part = |(bins, label): (Range<usize>, String)| {
            let noise = self.truth.noise(bins.clone(), true);
            self.part(label, bins.clone(), &noise, |p| Products::over(&p.frames, bins.clone()))
        };
        self.ranges(opls).into_iter().map(part).collect()
    }

    fn kinds(&self) -> Vec<Part> {
        if self.truth.kinds(0).is_empty() {
            return Vec::new();
        }
        let part = |&kind: &Kind| self.kind(kind, kind.label().to_owned(), 0..self.truth.bins);
        Kind::ALL.iter().map(part).collect()
    }

    fn kinds_in_windows(&self, opls: &[f64]) -> Vec<Part> {
        if self.truth.kinds(0).is_empty() {
            return Vec::new();
        }
        let ranges = self.ranges(opls);
        let part = |kind: Kind, (bins, label): &(Range<usize>, String)| {
            self.kind(kind, format!("{}, {label}", kind.label()), bins.clone())
        };
        Kind::ALL
            .into_iter()
            .flat_map(|kind| ranges.iter().map(move |range| (kind, range)))
            .map(|(kind, range)| part(kind, range))
            .collect()
    }

    fn kind(&self, kind: Kind, label: String, bins: Range<usize>) -> Part {
        let noise = self.truth.noise_of_kind(kind, bins.clone());
        self.part(label, bins.clone(), &noise, |p| {
            Products::over(&p.kinds[kind as usize], bins.clone())
        })
    }

    fn lamps(&self, signal: f64) -> Option<Part> {
        if !self.truth.sees_all || self.truth.judged.iter().all(|&judged| judged) {
            return None;
        }
        let noise = self.truth.noise_of_others();
        let label = "pixels that see a lamp".to_owned();
        let part = self.part(label, 0..self.truth.bins, &noise, |p| p.others.clone());
        Some(Part { share: noise.signal() / signal, ..part })
    }

    fn frames(&self) -> Vec<Part> {
        let noise = self.truth.noise_of_frames(true);
        let part = |(bin, noise): (usize, &ReferenceNoise)| {
            self.part(format!("bin {bin}"), bin..bin + 1, noise, |p| p.frames[bin].clone())
        };
        noise.iter().enumerate().map(part).collect()
    }
}
