//! Predictions of codes, so that what is deflated is small numbers.
//!
//! A code is replaced by its difference to another that the reader already has: the one in the bin
//! before, or of the pixel to the left. Channels of one render are noisy together, so red and blue
//! may first be replaced by their difference to green. All differences are modulo 2^16 and come
//! back exactly. What suits a cube best depends on its noise: it is found by trying on a sample.

use serde::Serialize;

/// Codes that the choice of a prediction looks at.
const SAMPLE: usize = 400_000;

/// What a code is told from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Neighbour {
    /// Nothing.
    None,
    /// The same pixel, one bin earlier.
    Bin,
    /// The pixel to the left.
    Left,
}

/// How a stream is predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Prediction {
    pub(crate) neighbour: Neighbour,
    /// Whether channel 1 is subtracted before.
    pub(crate) minus_green: bool,
}

/// How codes are arranged: frames of rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub(crate) width: usize,
    pub(crate) pixels: usize,
}

impl Shape {
    /// The index of the neighbour of a code.
    fn neighbour(self, at: usize, neighbour: Neighbour) -> Option<usize> {
        match neighbour {
            Neighbour::None => None,
            Neighbour::Bin => at.checked_sub(self.pixels),
            Neighbour::Left => (!at.is_multiple_of(self.width)).then(|| at - 1),
        }
    }
}

impl Prediction {
    /// What is stored in the place of codes.
    pub(crate) fn residuals(self, codes: &[u16], guide: Option<&[u16]>, shape: Shape) -> Vec<u16> {
        let guide = guide.filter(|_| self.minus_green);
        let plain = |at: usize| codes[at].wrapping_sub(guide.map_or(0, |guide| guide[at]));
        let all = 0..codes.len();
        all.map(|at| {
            let predicted = shape.neighbour(at, self.neighbour).map_or(0, plain);
            plain(at).wrapping_sub(predicted)
        })
        .collect()
    }

    /// The codes again, as the page restores them.
    #[cfg(test)]
    pub(crate) fn restore(
        self,
        mut codes: Vec<u16>,
        guide: Option<&[u16]>,
        shape: Shape,
    ) -> Vec<u16> {
        for at in 0..codes.len() {
            if let Some(from) = shape.neighbour(at, self.neighbour) {
                codes[at] = codes[at].wrapping_add(codes[from]);
            }
        }
        if let Some(guide) = guide.filter(|_| self.minus_green) {
            codes.iter_mut().zip(guide).for_each(|(code, guide)| *code = code.wrapping_add(*guide));
        }
        codes
    }
}

/// The prediction whose residuals have the least entropy, on a sample of whole frames.
pub(crate) fn best(codes: &[u16], guide: Option<&[u16]>, shape: Shape, narrow: bool) -> Prediction {
    let frames = codes.len() / shape.pixels;
    // A block of frames from the middle, where the light is.
    let wanted = (SAMPLE / shape.pixels).clamp(2, frames.max(2)).min(frames);
    let first = (frames - wanted) / 2 * shape.pixels;
    let sample = first..first + wanted * shape.pixels;
    let (codes, guide) = (&codes[sample.clone()], guide.map(|guide| &guide[sample]));
    let mut candidates = Vec::new();
    for minus_green in [false, true] {
        for neighbour in [Neighbour::None, Neighbour::Bin, Neighbour::Left] {
            if !minus_green || guide.is_some() {
                candidates.push(Prediction { neighbour, minus_green });
            }
        }
    }
    let cost = |prediction: &Prediction| {
        let residuals = prediction.residuals(codes, guide, shape);
        let low = entropy(residuals.iter().map(|&code| code as u8));
        low + if narrow { 0.0 } else { entropy(residuals.iter().map(|&code| (code >> 8) as u8)) }
    };
    let costs = candidates.iter().map(|candidate| (cost(candidate), *candidate));
    let cheapest = costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, candidate)| candidate);
    cheapest.unwrap_or(Prediction { neighbour: Neighbour::None, minus_green: false })
}

/// Bits that an ideal code of single bytes would need (Shannon 1948).
fn entropy(bytes: impl Iterator<Item = u8>) -> f64 {
    let mut counts = [0_u32; 256];
    let mut total = 0.0;
    for byte in bytes {
        counts[usize::from(byte)] += 1;
        total += 1.0;
    }
    let used = counts.iter().filter(|&&count| count > 0).map(|&count| f64::from(count));
    used.map(|count| -count * (count / total).log2()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_predictions_can_be_undone() {
        let shape = Shape { width: 5, pixels: 15 };
        let codes: Vec<u16> = (0..60_u16).map(|i| i.wrapping_mul(54_321)).collect();
        let guide: Vec<u16> = (0..60_u16).map(|i| i.wrapping_mul(12_345)).collect();
        for minus_green in [false, true] {
            for neighbour in [Neighbour::None, Neighbour::Bin, Neighbour::Left] {
                let prediction = Prediction { neighbour, minus_green };
                let residuals = prediction.residuals(&codes, Some(&guide), shape);
                assert_eq!(prediction.restore(residuals, Some(&guide), shape), codes);
            }
        }
    }

    #[test]
    fn the_prediction_suits_the_codes() {
        let shape = Shape { width: 20, pixels: 400 };
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as u16
        };
        let noise: Vec<u16> = (0..4000).map(|_| random()).collect();
        let scaled: Vec<u16> = noise.iter().map(|code| code.wrapping_add(70)).collect();
        let found = best(&scaled, Some(&noise), shape, false);
        assert_eq!(found, Prediction { neighbour: Neighbour::None, minus_green: true });
        let still: Vec<u16> = (0..4000).map(|i| noise[i % 400]).collect();
        assert_eq!(best(&still, None, shape, false).neighbour, Neighbour::Bin);
    }
}
