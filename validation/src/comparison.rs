//! One estimator against one expected cube: batches in, outcome with a z map out.

use tpb_film::{Layout, TimeAxis};
use tpb_scene::Scene;

use crate::contrasts::{LinearContrast, targets};
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{BinPlot, Context, Outcome, ZMap};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::sabotage::Sabotage;
use crate::statistics::{Batches, Criterion, judge};

/// What is compared with what, and how.
pub struct Comparison<'a> {
    /// What is rendered.
    pub scene: &'a Scene,
    /// By whom.
    pub estimator: Estimator,
    /// In which batches.
    pub plan: BatchPlan,
    /// What is expected.
    pub expected: &'a Cube,
    /// The expectation by a coarser rule, which tells its error.
    pub coarser: Option<&'a Cube>,
    /// Which sums are judged.
    pub contrasts: &'a [LinearContrast],
    /// What is asked of them.
    pub criterion: Criterion,
    /// The cosine, or the η², that a twin's estimate lacks, pixel by pixel
    /// ([`Sabotage::drops_a_factor`]); empty where that is not tried.
    pub dropped: &'a [f64],
}

impl Comparison<'_> {
    /// Renders the scene's film and judges; a twin's defect that acts on window or estimate is
    /// brought about here.
    pub fn run(self, context: &Context) -> Result<Outcome> {
        let layout = context.layout(&self.scene.film)?;
        let mut found = Found::new(self.expected);
        batches(self.scene, &self.estimator, layout, &self.plan, |cube| {
            found.add(&self.spoil(cube, context), self.contrasts);
        })?;
        Ok(self.judge(found, layout))
    }

    /// The same, but batches are made only if the context does not remember them. `key` names
    /// scene and estimator, without a twin's defect.
    pub fn run_remembered(self, context: &Context, key: &str) -> Result<Outcome> {
        let layout = context.layout(&self.scene.film)?;
        let key = format!("{key} {:?} {layout:?} {:?}", self.plan, context.defect_of_the_scene());
        let cubes = context.memory.recall(&key, || {
            let mut cubes = Vec::new();
            batches(self.scene, &self.estimator, layout, &self.plan, |cube| {
                cubes.push(cube.clone());
            })?;
            Ok(cubes)
        })?;
        let mut found = Found::new(self.expected);
        for cube in cubes.iter() {
            found.add(&self.spoil(cube, context), self.contrasts);
        }
        Ok(self.judge(found, layout))
    }

    fn judge(&self, found: Found, layout: Layout) -> Outcome {
        let targets = targets(self.contrasts, self.expected, self.coarser);
        let mut outcome: Outcome = judge(&targets, &found.values, &self.criterion).into();
        outcome.z_map = Some(found.cells.z_map(self.expected));
        let expected = self.expected.sum_of_pixels();
        outcome.bins = layout.time.map(|axis| found.sums.plot(&axis, expected));
        outcome
    }

    fn spoil(&self, cube: &Cube, context: &Context) -> Cube {
        let mut cube = cube.clone();
        cube.scale(context.estimate_factor());
        if context.sabotage.is_some_and(Sabotage::drops_a_factor) {
            for (pixel, factor) in self.dropped.iter().enumerate() {
                for cell in cube.pixel_mut(pixel) {
                    *cell /= factor;
                }
            }
        }
        cube
    }
}

/// What batches have in them.
struct Found {
    values: Batches,
    cells: CellMoments,
    sums: CellMoments,
}

impl Found {
    fn new(expected: &Cube) -> Self {
        let cells = CellMoments::new(expected.values.len());
        Self { values: Batches::new(), cells, sums: CellMoments::new(expected.bins) }
    }

    fn add(&mut self, cube: &Cube, contrasts: &[LinearContrast]) {
        self.values.push(contrasts.iter().map(|c| c.value(cube)).collect());
        self.cells.add(&cube.values);
        self.sums.add(&cube.sum_of_pixels());
    }
}

/// Running mean and sum of squared deviations of each cell (Welford 1962).
struct CellMoments {
    batches: f64,
    mean: Vec<f64>,
    squares: Vec<f64>,
}

impl CellMoments {
    fn new(cells: usize) -> Self {
        Self { batches: 0.0, mean: vec![0.0; cells], squares: vec![0.0; cells] }
    }

    fn add(&mut self, values: &[f64]) {
        self.batches += 1.0;
        let moments = self.mean.iter_mut().zip(&mut self.squares);
        for ((mean, squares), value) in moments.zip(values) {
            let before = value - *mean;
            *mean += before / self.batches;
            *squares += before * (value - *mean);
        }
    }

    fn standard_error(&self, cell: usize) -> f64 {
        (self.squares[cell] / (self.batches * (self.batches - 1.0))).sqrt()
    }

    fn plot(self, axis: &TimeAxis, expected: Vec<f64>) -> BinPlot {
        let standard_error = (0..expected.len()).map(|bin| self.standard_error(bin)).collect();
        let opl = axis.edges().windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
        BinPlot { opl, expected, mean: self.mean, standard_error }
    }

    /// (mean − expected)/standard error of every bin; NaN where there is no noise.
    fn z_map(&self, expected: &Cube) -> ZMap {
        let z = |cell: usize| (self.mean[cell] - expected.values[cell]) / self.standard_error(cell);
        let per_pixel = expected.bins + 2;
        let row =
            |pixel: usize| (1..=expected.bins).map(|bin| z(pixel * per_pixel + bin)).collect();
        ZMap { width: expected.width, rows: (0..expected.pixels()).map(row).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_is_in_standard_errors_of_the_mean() {
        let mut cells = CellMoments::new(3);
        for value in [1.0, 2.0, 3.0] {
            let mut cube = Cube::zero(1, 1, 1);
            cube.pixel_mut(0)[1] = value;
            cube.scale(2.0);
            cells.add(&cube.values);
        }
        // Mean 4, standard error 2/√3.
        let z = cells.z_map(&Cube::zero(1, 1, 1)).rows[0][0];
        assert!((z - 2.0 * 3.0_f64.sqrt()).abs() < 1e-14, "{z}");
    }
}
