//! What renders are compared with: exact values, exact laws, clear errors.

use crate::contrasts::LinearContrast;
use crate::error::Result;
use crate::statistics::{Batches, Criterion, Finding as Found, Target, judge};
use crate::stress::case::Finding;
use crate::stress::shot::{Image, Shot, load};
use crate::stress::world::World;

/// Independent batches of a comparison with exact values.
pub const BATCHES: u64 = 64;

/// A right answer is one within 2 %, with 99 % confidence; sound programs are called different with
/// a chance of 1e-8. (Smaller errors are the experiments' business: here something breaks or not.)
pub const CRITERION: Criterion = Criterion { margin: 0.02, confidence: 0.99, level: 1e-8 };

/// Sums of one channel over pixels and cells, with their exact values.
pub struct Expected {
    /// What is summed: weights over the cells before, bins, after.
    pub contrasts: Vec<LinearContrast>,
    /// Channel of each.
    pub channels: Vec<usize>,
    /// Exact value and the bound of its error, of each.
    pub values: Vec<(f64, f64)>,
    /// The steady image is summed, not cells.
    of_steady: bool,
}

impl Expected {
    /// Sums of the first channel.
    pub fn grey(contrasts: Vec<LinearContrast>, values: Vec<(f64, f64)>) -> Self {
        Self { channels: vec![0; contrasts.len()], contrasts, values, of_steady: false }
    }

    /// The exact values times a factor: what sabotage expects.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        for (value, error) in &mut self.values {
            (*value, *error) = (*value * factor, *error * factor);
        }
        self
    }

    /// Sums of the steady image of these pixels, whatever the weights.
    #[must_use]
    pub fn steady(self) -> Self {
        Self { of_steady: true, ..self }
    }

    fn of(&self, image: &Image) -> Vec<f64> {
        if self.of_steady {
            let steady = |pixels: &[usize], channel: usize| -> f64 {
                pixels
                    .iter()
                    .map(|p| image.arrays.steady[p * image.arrays.channels + channel])
                    .sum()
            };
            let named = self.contrasts.iter().zip(&self.channels);
            return named.map(|(contrast, &channel)| steady(&contrast.pixels, channel)).collect();
        }
        let value = |(contrast, &channel): (&LinearContrast, &usize)| -> f64 {
            let pixel = |&pixel: &usize| -> f64 {
                image.cells(pixel, channel).iter().zip(&contrast.weights).map(|(v, w)| v * w).sum()
            };
            contrast.pixels.iter().map(pixel).sum()
        };
        self.contrasts.iter().zip(&self.channels).map(value).collect()
    }
}

/// Batches of a shot against exact values.
pub fn agrees(shot: &Shot, seed: u64, passes: u64, expected: &Expected) -> Result<Finding> {
    let mut batches = Batches::new();
    shot.batches(seed, BATCHES, passes, |image| batches.push(expected.of(&image)))?;
    let named = expected.contrasts.iter().zip(&expected.values);
    let targets: Vec<Target> = named
        .map(|(contrast, &(value, error))| Target {
            name: contrast.name.clone(),
            expected: value,
            // Cells are f32.
            error: error + 1e-7 * value.abs(),
        })
        .collect();
    let judgement = judge(&targets, &batches, &CRITERION);
    let [low, high] = judgement.interval.map(|end| 100.0 * end);
    let worst = judgement.contrasts.iter().min_by(|a, b| a.p.total_cmp(&b.p));
    let mut text = format!("error {low:+.2} %..{high:+.2} %, p {:.1e}", judgement.worst_p);
    match (judgement.finding, worst) {
        (Found::Equivalent, _) | (_, None) => {}
        (found, Some(c)) => {
            let what = if found == Found::Different { "DIFFERENT" } else { "too noisy to tell" };
            text = format!(
                "{what}: {} is {:.5e} +- {:.1e}, expected {:.5e} ({text})",
                c.name, c.mean, c.standard_error, c.expected
            );
        }
    }
    let passed = judgement.finding == Found::Equivalent;
    Ok(Finding { passed, text, false_alarm: judgement.false_alarm })
}

/// Two images whose every number differs by exactly this factor.
pub fn same_to_the_bit(a: &Image, b: &Image, factor: f64) -> Finding {
    let single = |a: &[f32], b: &[f32]| {
        a.len() == b.len() && a.iter().zip(b).all(|(&a, &b)| (f64::from(a) * factor) as f32 == b)
    };
    let double = |a: &[f64], b: &[f64]| {
        a.len() == b.len() && a.iter().zip(b).all(|(&a, &b)| a * factor == b)
    };
    let (x, y) = (&a.arrays, &b.arrays);
    let same = single(&x.transient, &y.transient)
        && double(&x.before, &y.before)
        && double(&x.after, &y.after)
        && double(&x.steady, &y.steady);
    let (total, expected) = (b.total(), a.total() * factor);
    let difference = if total == expected { 0.0 } else { total / expected - 1.0 };
    let lit = expected > 0.0;
    let text = match (lit, same) {
        (false, _) => "nothing is seen: the case tells nothing".to_owned(),
        (true, true) => format!("the same to the bit, sum {total:.6e}"),
        (true, false) => format!("NOT the same to the bit: sums differ by {difference:.1e}"),
    };
    Finding::exact(same && lit, text)
}

/// Two images whose numbers differ by this factor, to a relative tolerance: of each pixel's steady
/// value, and of the sum of the absolute differences of all cells over the sum of all cells.
pub fn near(a: &Image, b: &Image, factor: f64, tolerance: f64) -> Finding {
    let pairs = a.arrays.steady.iter().zip(&b.arrays.steady);
    let relative = |(&a, &b): (&f64, &f64)| {
        let a = a * factor;
        if a == b { 0.0 } else { (a - b).abs() / a.abs().max(b.abs()) }
    };
    let steady = pairs.map(relative).fold(0.0, f64::max);
    let pixels = 0..a.arrays.pixels();
    let (mut difference, mut sum) = (0.0, 0.0);
    for (pixel, channel) in pixels.flat_map(|p| (0..a.arrays.channels).map(move |c| (p, c))) {
        for (a, b) in a.cells(pixel, channel).iter().zip(b.cells(pixel, channel)) {
            difference += (a * factor - b).abs();
            sum += a * factor;
        }
    }
    if a.arrays.bins == 0 {
        // All there is are the pixels.
        (difference, sum) = (0.0, factor * a.total());
    }
    let cells = difference / sum;
    let alike = a.arrays.steady.len() == b.arrays.steady.len() && a.arrays.bins == b.arrays.bins;
    // Cells are f32.
    let passed = alike && sum > 0.0 && steady <= tolerance && cells <= tolerance.max(2e-7);
    let text = format!("sum {sum:.6e}; pixels differ by {steady:.1e}, cells by {cells:.1e}");
    Finding::exact(passed, text)
}

/// The loader refuses the scene with a text that has these parts.
pub fn refused(world: &World, parts: &[&str]) -> Finding {
    match load(world) {
        Ok(_) => Finding::exact(false, "accepted without a word"),
        Err(error) => says(&error.to_string(), parts),
    }
}

/// An error's text has these parts.
pub fn says(text: &str, parts: &[&str]) -> Finding {
    let first = text.lines().next().unwrap_or_default();
    match parts.iter().find(|part| !text.contains(**part)) {
        None => Finding::exact(true, first.to_owned()),
        Some(part) => Finding::exact(false, format!("'{part}' is missing in: {text}")),
    }
}
