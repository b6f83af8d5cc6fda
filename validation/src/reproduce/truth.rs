//! What errors are measured from: a cube of means over channels, the variance of its own noise, the
//! pixels that are judged, and kinds of cells that are judged apart.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::error::{Result, ValidationError};
use crate::long_render::LongMean;
use crate::reference_cube::ReferenceCube;
use crate::statistics::ReferenceNoise;

/// Kinds of cells, by what most of their light has done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Kind {
    /// Light straight from the lamp, scattered once, at a surface, is at least nine tenths of it.
    Pure,
    /// Else: at least half of it.
    Direct,
    /// Else: the first twentieth of the pixel's energy has arrived by the end of no earlier bin.
    Early,
    /// All others.
    Rest,
}

impl Kind {
    /// In the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Pure, Self::Direct, Self::Early, Self::Rest];

    /// For people.
    pub fn label(self) -> &'static str {
        match self {
            Self::Pure => "direct light on surfaces alone (90 %)",
            Self::Direct => "direct light on surfaces and others (half)",
            Self::Early => "early fronts in fog",
            Self::Rest => "all other cells",
        }
    }
}

/// Where a reference comes from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// The method.
    pub method: String,
    /// Batches of so many passes each; 0 batches if it ships.
    pub batches: u64,
    /// Passes of a batch.
    pub passes: u64,
    /// Commits of the sources that made it.
    pub commits: Vec<String>,
    /// Commands that made it; empty if they are not known.
    pub commands: Vec<String>,
}

/// Share of direct light that makes a cell [`Kind::Pure`], and [`Kind::Direct`].
const PURE: f32 = 0.9;
const HALF: f32 = 0.5;
/// Part of a pixel's energy by which its front has passed.
const FRONT: f64 = 0.05;

/// Name of the method that does not see what stands in mirrors and glass.
const LIGHT: &str = "light";

/// Variances of the cells.
enum Variance {
    /// Of each cell, (pixel, bin).
    Cells(Vec<f32>),
    /// Of each pixel, times the share of each bin: what a shipped reference tells.
    Separable { pixel: Vec<f64>, share: Vec<f64> },
}

/// The reference, as errors need it.
pub struct Truth {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bins of a pixel.
    pub bins: usize,
    /// (pixel, bin), means over channels.
    pub values: Vec<f32>,
    /// Edges of the bins \[m\].
    pub opl_edges: Vec<f64>,
    /// Which pixels are judged.
    pub judged: Vec<bool>,
    /// Variance of a pixel's energy within the window; empty if it is not known.
    pub window_variance: Vec<f64>,
    /// Degrees of freedom of each of those variances: batches less one.
    pub window_freedom: f64,
    /// CPU time of the reference \[s\].
    pub cpu_seconds: f64,
    /// Where it comes from.
    pub origin: Option<Origin>,
    /// Whether it has all light of pixels that are not judged, too: the light tracer's lacks what
    /// stands in mirrors and glass.
    pub sees_all: bool,
    /// [`Kind`] of each cell; empty until [`Truth::sort_cells`].
    kinds: Vec<Kind>,
    variance: Variance,
}

impl Truth {
    /// From a reference made in batches; it is used up.
    pub fn of_long(reference: LongMean) -> Self {
        let LongMean { arrays, mean_variance, window_variance, judged, made } = reference;
        let channels = arrays.channels;
        let mean = |cell: &[f32]| cell.iter().sum::<f32>() / channels as f32;
        Self {
            width: arrays.width,
            height: arrays.height,
            bins: arrays.bins,
            values: arrays.transient.chunks_exact(channels).map(mean).collect(),
            opl_edges: arrays.opl_edges,
            judged,
            window_variance,
            window_freedom: made.batches.saturating_sub(1) as f64,
            cpu_seconds: made.cpu_seconds,
            sees_all: made.method != LIGHT,
            origin: Some(Origin {
                method: made.method,
                batches: made.batches,
                passes: made.passes,
                commits: made.commits,
                commands: made.commands,
            }),
            kinds: Vec::new(),
            variance: Variance::Cells(mean_variance),
        }
    }

    /// From one that ships with its scene. Of its variance it tells sums over bins and over judged
    /// pixels; that of a cell is taken as their product over the total.
    pub fn of_shipped(reference: &ReferenceCube) -> Self {
        let cube = &reference.cube;
        let total: f64 = reference.variance_frame.iter().sum();
        let share =
            reference.variance_frame.iter().map(|v| if total > 0.0 { v / total } else { 0.0 });
        let values = (0..cube.pixels()).flat_map(|pixel| cube.pixel_bins(pixel));
        Self {
            width: cube.width,
            height: cube.height,
            bins: cube.bins,
            values: values.map(|&value| value as f32).collect(),
            opl_edges: reference.opl_edges.clone(),
            judged: reference.mask.clone(),
            window_variance: Vec::new(),
            window_freedom: 0.0,
            cpu_seconds: reference.provenance.cpu_seconds.unwrap_or(0.0),
            sees_all: reference.provenance.method != LIGHT,
            origin: Some(Origin {
                method: reference.provenance.method.clone(),
                batches: 0,
                passes: reference.provenance.passes,
                commits: vec![reference.provenance.commit.clone()],
                commands: Vec::new(),
            }),
            kinds: Vec::new(),
            variance: Variance::Separable {
                pixel: reference.variance_pixel.clone(),
                share: share.collect(),
            },
        }
    }

    /// Pixels.
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// The bins of a pixel.
    pub fn pixel(&self, pixel: usize) -> &[f32] {
        &self.values[pixel * self.bins..(pixel + 1) * self.bins]
    }

    /// Variance of a cell.
    pub fn variance(&self, pixel: usize, bin: usize) -> f64 {
        match &self.variance {
            Variance::Cells(cells) => f64::from(cells[pixel * self.bins + bin]),
            Variance::Separable { pixel: pixels, share } => pixels[pixel] * share[bin],
        }
    }

    /// Kinds of a pixel's cells; empty if they were not sorted.
    pub fn kinds(&self, pixel: usize) -> &[Kind] {
        if self.kinds.is_empty() {
            return &[];
        }
        &self.kinds[pixel * self.bins..(pixel + 1) * self.bins]
    }

    /// Sorts cells into kinds: `direct` is what light that was scattered once, at a surface, adds to
    /// each, (pixel, bin). Shares are those of 3x3 pixels together, so that noise sorts less.
    ///
    /// # Errors
    /// If it has another shape.
    pub fn sort_cells(&mut self, direct: &[f32]) -> Result<()> {
        if direct.len() != self.values.len() {
            return Err(ValidationError::unusable("direct light", "has another shape"));
        }
        let mut kinds = Vec::with_capacity(direct.len());
        let (mut around, mut direct_around) = (vec![0.0; self.bins], vec![0.0; self.bins]);
        for (pixel, cells) in self.values.chunks_exact(self.bins).enumerate() {
            self.pool(&self.values, pixel, &mut around);
            self.pool(direct, pixel, &mut direct_around);
            let energy: f64 = cells.iter().map(|&v| f64::from(v)).sum();
            let mut arrived = 0.0;
            for (bin, &cell) in cells.iter().enumerate() {
                let front = arrived < FRONT * energy;
                arrived += f64::from(cell);
                let (direct, all) = (direct_around[bin], around[bin]);
                kinds.push(if direct > 0.0 && direct >= PURE * all {
                    Kind::Pure
                } else if direct > 0.0 && direct >= HALF * all {
                    Kind::Direct
                } else if front {
                    Kind::Early
                } else {
                    Kind::Rest
                });
            }
        }
        self.kinds = kinds;
        Ok(())
    }

    /// Sums over the pixels around a pixel, and itself, of every bin.
    fn pool(&self, cells: &[f32], pixel: usize, sums: &mut [f32]) {
        sums.fill(0.0);
        let (x, y) = (pixel % self.width, pixel / self.width);
        let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        for place in near(y, self.height)
            .flat_map(|y| near(x, self.width).map(move |x| (x, y)))
            .map(|(x, y)| y * self.width + x)
        {
            let cells = &cells[place * self.bins..(place + 1) * self.bins];
            sums.iter_mut().zip(cells).for_each(|(sum, cell)| *sum += cell);
        }
    }

    /// The reference's noise over the bins of a range, of judged pixels or of all.
    pub fn noise(&self, bins: Range<usize>, judged: bool) -> ReferenceNoise {
        self.noise_of(bins, |pixel| !judged || self.judged[pixel], |_, _| true)
    }

    /// The same of pixels that are not judged.
    pub fn noise_of_others(&self) -> ReferenceNoise {
        self.noise_of(0..self.bins, |pixel| !self.judged[pixel], |_, _| true)
    }

    /// The same over the cells of a kind, of judged pixels.
    pub fn noise_of_kind(&self, kind: Kind, bins: Range<usize>) -> ReferenceNoise {
        let is_of = |pixel: usize, bin: usize| self.kinds(pixel).get(bin) == Some(&kind);
        self.noise_of(bins, |pixel| self.judged[pixel], is_of)
    }

    fn noise_of(
        &self,
        bins: Range<usize>,
        pixels: impl Fn(usize) -> bool,
        include: impl Fn(usize, usize) -> bool,
    ) -> ReferenceNoise {
        let mut noise = ReferenceNoise::default();
        for pixel in (0..self.pixels()).filter(|&pixel| pixels(pixel)) {
            let mut variance = 0.0;
            for (bin, &value) in bins.clone().zip(&self.pixel(pixel)[bins.clone()]) {
                if include(pixel, bin) {
                    noise.power += f64::from(value) * f64::from(value);
                    variance += self.variance(pixel, bin);
                }
            }
            noise.variance += variance;
            noise.squares += variance * variance;
            noise.largest = noise.largest.max(variance);
        }
        noise
    }

    /// The noise of every single bin, in one sweep.
    pub fn noise_of_frames(&self, judged: bool) -> Vec<ReferenceNoise> {
        let mut frames = vec![ReferenceNoise::default(); self.bins];
        for pixel in (0..self.pixels()).filter(|&pixel| !judged || self.judged[pixel]) {
            for (bin, (noise, &value)) in frames.iter_mut().zip(self.pixel(pixel)).enumerate() {
                let variance = self.variance(pixel, bin);
                noise.power += f64::from(value) * f64::from(value);
                noise.variance += variance;
                noise.squares += variance * variance;
                noise.largest = noise.largest.max(variance);
            }
        }
        frames
    }
}

#[cfg(test)]
impl Truth {
    /// A truth of given cells, with the same variance in each.
    pub(crate) fn of_cells(
        (width, height, bins): (usize, usize, usize),
        values: Vec<f32>,
        variance: f32,
    ) -> Self {
        Self {
            width,
            height,
            bins,
            opl_edges: (0..=bins).map(|edge| edge as f64).collect(),
            judged: vec![true; width * height],
            window_variance: Vec::new(),
            window_freedom: 7.0,
            cpu_seconds: 1.0,
            origin: None,
            sees_all: true,
            kinds: Vec::new(),
            variance: Variance::Cells(vec![variance; values.len()]),
            values,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_sorted_by_direct_light_and_by_the_front() {
        use Kind::{Direct, Early, Pure, Rest};
        // Energy 10; the first 0.5 of it has arrived within the second bin.
        let mut truth = Truth::of_cells((1, 1, 5), vec![0.4, 0.6, 4.0, 4.0, 1.0], 0.0);
        truth.sort_cells(&[0.0, 0.0, 3.0, 1.9, 0.95]).unwrap();
        assert_eq!(truth.kinds(0), [Early, Early, Direct, Rest, Pure]);
        assert!(truth.sort_cells(&[0.0]).is_err());
        // A noisy cell among quiet neighbours is of their kind: 1 of 1 + 2·0.7.
        let mut row = Truth::of_cells((3, 1, 1), vec![0.7, 1.0, 0.7], 0.0);
        row.sort_cells(&[0.65, 0.65, 0.65]).unwrap();
        assert_eq!([0, 1, 2].map(|pixel| row.kinds(pixel)[0]), [Direct; 3]);
    }

    #[test]
    fn noise_of_parts_adds_up() {
        let values: Vec<f32> = (0..24).map(|cell| cell as f32).collect();
        let mut truth = Truth::of_cells((2, 2, 6), values, 0.5);
        truth.judged[1] = false;
        truth.sort_cells(&[0.0; 24]).unwrap();
        let whole = truth.noise(0..6, true);
        let frames = truth.noise_of_frames(true);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b, "{a} {b}");
        close(frames.iter().map(|n| n.power).sum(), whole.power);
        close(frames.iter().map(|n| n.variance).sum(), whole.variance);
        let of_kind = |&kind: &Kind| truth.noise_of_kind(kind, 0..6).power;
        close(Kind::ALL.iter().map(of_kind).sum(), whole.power);
        close(truth.noise_of_others().power + whole.power, truth.noise(0..6, false).power);
        assert_eq!((whole.variance, whole.squares, whole.largest), (9.0, 27.0, 3.0));
    }
}
