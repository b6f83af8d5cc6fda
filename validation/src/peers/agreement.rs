//! Whether both programs render the same image, apart from noise.
//!
//! Three numbers of each replicate, over judged pixels: the sum of all bins, the sum of the steady
//! image, and the mean arrival in bins. The peer is compared with the unbiased method of ours (the
//! reference's), by the difference of means and Welch's interval at [`AGREEMENT`].

use serde::{Deserialize, Serialize};
use tpb_statistics::VarianceSum;

use crate::cube::Cube;
use crate::statistics::batches::summarise;

/// Confidence of the intervals that decide.
pub const AGREEMENT: f64 = 0.999;

/// One number of the peer's image against ours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Which.
    pub what: String,
    /// The peer's less ours, relative to ours, or in bins.
    pub difference: f64,
    /// Its interval at [`AGREEMENT`].
    pub interval: [f64; 2],
}

impl Agreement {
    /// Whether 0 is in the interval.
    pub fn holds(&self) -> bool {
        self.interval[0] <= 0.0 && 0.0 <= self.interval[1]
    }
}

/// Sum of bins, sum of all, mean arrival in bins; over judged pixels.
pub(super) fn totals(cube: &Cube, judged: &[bool]) -> [f64; 3] {
    let (mut window, mut steady, mut moment) = (0.0, 0.0, 0.0);
    for pixel in (0..cube.pixels()).filter(|&pixel| judged[pixel]) {
        steady += cube.pixel(pixel).iter().sum::<f64>();
        for (bin, value) in cube.pixel_bins(pixel).iter().enumerate() {
            window += value;
            moment += value * (bin as f64 + 0.5);
        }
    }
    [window, steady, moment / window]
}

/// The peer's totals against ours, of replicates.
pub(super) fn agreement(ours: &[[f64; 3]], peer: &[[f64; 3]]) -> Vec<Agreement> {
    let what = ["sum of all bins", "steady image", "mean arrival, in bins"];
    let compare = |index: usize| {
        let of = |totals: &[[f64; 3]]| totals.iter().map(|t| t[index]).collect::<Vec<f64>>();
        let (ours, peer) = (of(ours), of(peer));
        let unit = if index < 2 { summarise(&ours).mean } else { 1.0 };
        difference(what[index], &peer, &ours, unit)
    };
    (0..3).map(compare).collect()
}

/// The difference of two means over `unit`, Welch's interval.
fn difference(what: &str, a: &[f64], b: &[f64], unit: f64) -> Agreement {
    let (x, y) = (summarise(a), summarise(b));
    let half = VarianceSum::default()
        .and(x.standard_error.powi(2), a.len() as f64 - 1.0)
        .and(y.standard_error.powi(2), b.len() as f64 - 1.0)
        .half_width(0.5 * (1.0 - AGREEMENT));
    let (difference, half) = ((x.mean - y.mean) / unit, half.unwrap_or(f64::INFINITY) / unit);
    let interval = [difference - half, difference + half];
    Agreement { what: what.to_owned(), difference, interval }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_found_where_they_are() {
        let around =
            |mean: f64| (0..16).map(|i| mean + 0.01 * f64::from(i % 4)).collect::<Vec<_>>();
        let same = difference("x", &around(2.0), &around(2.0), 2.0);
        assert!(same.holds() && same.difference == 0.0);
        let found = difference("x", &around(2.1), &around(2.0), 2.0);
        assert!(!found.holds() && (found.difference - 0.05).abs() < 1e-12, "{found:?}");
        let unresolved = difference("x", &[2.1], &[2.0, 2.0], 2.0);
        assert!(unresolved.holds(), "a single run tells nothing");
    }

    #[test]
    fn totals_are_of_judged_pixels_and_know_what_lies_outside() {
        let mut cube = Cube::zero(2, 1, 2);
        cube.pixel_mut(0).copy_from_slice(&[1.0, 2.0, 6.0, 4.0]);
        cube.pixel_mut(1).fill(100.0);
        assert_eq!(totals(&cube, &[true, false]), [8.0, 13.0, (2.0 * 0.5 + 6.0 * 1.5) / 8.0]);
    }
}
