//! Pre-registered linear contrasts: the few numbers of a cube that are judged.
//!
//! A contrast is a sum over some pixels and some cells with a weight for each cell. They are chosen
//! from the *expected* cube alone, before anything is rendered: all energy, its mean arrival, equal
//! shares of energy in time, blocks of pixels. Each holds a share of the energy that is large
//! enough to be resolved within the budget.

use crate::cube::Cube;
use crate::statistics::Target;

/// A weighted sum over pixels × cells.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearContrast {
    /// What it is.
    pub name: String,
    /// Which pixels.
    pub pixels: Vec<usize>,
    /// Weight of each cell: before, bins, after.
    pub weights: Vec<f64>,
}

impl LinearContrast {
    /// Its value for a cube.
    pub fn value(&self, cube: &Cube) -> f64 {
        let sum = |&pixel: &usize| -> f64 {
            cube.pixel(pixel).iter().zip(&self.weights).map(|(v, w)| v * w).sum()
        };
        self.pixels.iter().map(sum).sum()
    }
}

/// The standard set: all energy in the window, its first moment in time, `shares` parts of equal
/// energy in time, and each of the pixel groups.
pub fn standard(
    expected: &Cube,
    groups: &[(String, Vec<usize>)],
    shares: usize,
) -> Vec<LinearContrast> {
    let cells = expected.bins + 2;
    let pixels: Vec<usize> = groups.iter().flat_map(|(_, pixels)| pixels.iter().copied()).collect();
    let in_window = |weight: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (0..cells).map(|c| if (1..=expected.bins).contains(&c) { weight(c) } else { 0.0 }).collect()
    };
    let everywhere =
        |name: String, weights: Vec<f64>| LinearContrast { name, pixels: pixels.clone(), weights };
    let mut contrasts = vec![
        everywhere("energy".into(), in_window(&|_| 1.0)),
        everywhere("first moment in time".into(), in_window(&|cell| cell as f64 - 0.5)),
    ];
    for (first, last) in equal_shares(expected, &pixels, shares) {
        let name = format!("bins {}..{}", first - 1, last);
        let inside = |cell| f64::from(u8::from((first..=last).contains(&cell)));
        contrasts.push(everywhere(name, in_window(&inside)));
    }
    if groups.len() > 1 {
        contrasts.extend(groups.iter().map(|(name, pixels)| LinearContrast {
            name: name.clone(),
            pixels: pixels.clone(),
            weights: in_window(&|_| 1.0),
        }));
    }
    contrasts
}

/// Targets of contrasts, with the error that a coarser expectation suggests.
pub fn targets(
    contrasts: &[LinearContrast],
    expected: &Cube,
    coarser: Option<&Cube>,
) -> Vec<Target> {
    contrasts
        .iter()
        .map(|contrast| {
            let value = contrast.value(expected);
            // Cells are stored with the rounding of f32.
            let rounding = 1e-7 * value.abs();
            let error = coarser.map_or(0.0, |cube| (contrast.value(cube) - value).abs());
            Target { name: contrast.name.clone(), expected: value, error: error + rounding }
        })
        .collect()
}

/// Consecutive runs of bins (as cells, ends included) with about equal energy.
fn equal_shares(expected: &Cube, pixels: &[usize], shares: usize) -> Vec<(usize, usize)> {
    let per_cell: Vec<f64> = (0..expected.bins + 2)
        .map(|cell| pixels.iter().map(|&pixel| expected.pixel(pixel)[cell]).sum())
        .collect();
    let total: f64 = per_cell[1..=expected.bins].iter().sum();
    let (mut runs, mut first, mut sum) = (Vec::new(), 1, 0.0);
    for (cell, energy) in per_cell.iter().enumerate().take(expected.bins + 1).skip(1) {
        sum += energy;
        let wanted = total * (runs.len() + 1) as f64 / shares as f64;
        let last = cell == expected.bins;
        if last || (sum >= wanted - 0.5 * energy && runs.len() + 1 < shares && sum > 0.0) {
            runs.push((first, cell));
            first = cell + 1;
        }
    }
    // Runs without expected energy (a tail of empty bins) are no contrast.
    runs.retain(|&(a, b)| per_cell[a..=b].iter().sum::<f64>() > 0.2 * total / shares as f64);
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Cube {
        let mut cube = Cube::zero(2, 1, 8);
        for pixel in 0..2 {
            let cells = cube.pixel_mut(pixel);
            for (cell, value) in cells.iter_mut().enumerate() {
                *value = cell as f64;
            }
        }
        cube
    }

    #[test]
    fn shares_cover_the_window_once() {
        let contrasts = standard(&ramp(), &[("all".into(), vec![0, 1])], 3);
        let covered: Vec<f64> =
            (0..10).map(|cell| contrasts[2..].iter().map(|c| c.weights[cell]).sum()).collect();
        assert_eq!(covered, [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
        assert_eq!(contrasts.len(), 5, "energy, moment and three shares");
        assert_eq!(contrasts[0].value(&ramp()), 72.0);
    }

    #[test]
    fn the_difference_to_a_coarser_expectation_is_an_error_of_the_target() {
        let (fine, mut coarse) = (ramp(), ramp());
        coarse.scale(1.01);
        let contrasts = standard(&fine, &[("all".into(), vec![0])], 2);
        let targets = targets(&contrasts, &fine, Some(&coarse));
        assert!((targets[0].error - 0.36).abs() < 1e-4, "{}", targets[0].error);
    }
}
