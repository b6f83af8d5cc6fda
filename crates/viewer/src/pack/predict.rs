//! Predictions of codes, so that what is deflated is small numbers.
//!
//! A code is told from neighbours that the reader has already: the pixel to the left, the one above,
//! the same pixel one bin earlier, or the mean of these; neighbours that are 0 do not count, and
//! where none counts, the last code that is not 0 stands in. Channels of one render are noisy
//! together, so what is predicted of red and blue may be their difference to green.
//!
//! With the prediction p of a code c in 1..=M (M = 65535, or 255 for standard errors), the symbol is
//! `1 + z(c − p)`, where z maps 0, −1, 1, −2, … to 0, 1, 2, 3, … and differences are modulo M, so
//! that every code has one. Symbol 0 is code 0: a dark cell among bright ones costs little. What
//! suits a cube best depends on its noise, and is found by trying on a sample.

use serde::Serialize;

/// Codes that the choice of a prediction looks at.
const SAMPLE: usize = 400_000;

/// What a code is told from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Neighbours {
    /// The last one.
    Last,
    /// The same pixel, one bin earlier.
    Bin,
    /// The pixel to the left.
    Left,
    /// The mean of left, above and one bin earlier.
    Mean,
}

/// How a stream is predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Prediction {
    pub(crate) neighbours: Neighbours,
    /// Whether differences to channel 1 are predicted.
    pub(crate) minus_green: bool,
}

/// How codes are arranged, frames of rows, and how many there are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub(crate) width: usize,
    /// Cells of a frame.
    pub(crate) pixels: usize,
    /// Whether codes are below 256 and take one byte.
    pub(crate) narrow: bool,
}

impl Shape {
    /// M, the largest code.
    fn largest(self) -> i32 {
        if self.narrow { 255 } else { 65_535 }
    }

    /// Indices of left, above, and one bin earlier, where they exist and are wanted.
    fn neighbours(self, at: usize, wanted: Neighbours) -> [Option<usize>; 3] {
        let left = (!at.is_multiple_of(self.width)).then(|| at - 1);
        let above = (at % self.pixels >= self.width).then(|| at - self.width);
        let bin = at.checked_sub(self.pixels);
        match wanted {
            Neighbours::Last => [None; 3],
            Neighbours::Bin => [bin, None, None],
            Neighbours::Left => [left, None, None],
            Neighbours::Mean => [left, above, bin],
        }
    }
}

/// What a reader knows while it goes through a stream.
struct Reader<'a> {
    shape: Shape,
    neighbours: Neighbours,
    guide: Option<&'a [u16]>,
    /// The last code that was not 0, less green.
    last: i32,
}

impl<'a> Reader<'a> {
    fn new(prediction: Prediction, guide: Option<&'a [u16]>, shape: Shape) -> Self {
        let guide = guide.filter(|_| prediction.minus_green);
        Self { shape, neighbours: prediction.neighbours, guide, last: 0 }
    }

    fn green(&self, at: usize) -> i32 {
        self.guide.map_or(0, |guide| i32::from(guide[at]))
    }

    /// The prediction of a code from those before it.
    fn predict(&self, codes: &[u16], at: usize) -> i32 {
        let (mut sum, mut count) = (0, 0);
        for from in self.shape.neighbours(at, self.neighbours).into_iter().flatten() {
            if codes[from] != 0 {
                sum += i32::from(codes[from]) - self.green(from);
                count += 1;
            }
        }
        self.green(at) + if count > 0 { sum / count } else { self.last }
    }

    /// Takes note of a code.
    fn pass(&mut self, code: u16, at: usize) {
        if code != 0 {
            self.last = i32::from(code) - self.green(at);
        }
    }
}

impl Prediction {
    /// What is stored in the place of codes.
    pub(crate) fn symbols(self, codes: &[u16], guide: Option<&[u16]>, shape: Shape) -> Vec<u16> {
        let mut reader = Reader::new(self, guide, shape);
        let largest = shape.largest();
        let mut symbols = Vec::with_capacity(codes.len());
        for (at, &code) in codes.iter().enumerate() {
            let mut symbol = 0;
            if code != 0 {
                let difference = (i32::from(code) - reader.predict(codes, at)).rem_euclid(largest);
                let negative = difference > largest / 2;
                let zigzag = if negative { 2 * (largest - difference) - 1 } else { 2 * difference };
                symbol = (1 + zigzag) as u16;
            }
            symbols.push(symbol);
            reader.pass(code, at);
        }
        symbols
    }

    /// The codes again, as the page restores them.
    #[cfg(test)]
    pub(crate) fn restore(
        self,
        mut symbols: Vec<u16>,
        guide: Option<&[u16]>,
        shape: Shape,
    ) -> Vec<u16> {
        let mut reader = Reader::new(self, guide, shape);
        let largest = shape.largest();
        for at in 0..symbols.len() {
            if symbols[at] != 0 {
                let zigzag = i32::from(symbols[at]) - 1;
                let difference = (zigzag >> 1) ^ -(zigzag & 1);
                let code = reader.predict(&symbols, at) + difference - 1;
                symbols[at] = (1 + code.rem_euclid(largest)) as u16;
            }
            reader.pass(symbols[at], at);
        }
        symbols
    }
}

/// The prediction whose symbols have the least entropy, on a sample of whole frames.
pub(crate) fn best(codes: &[u16], guide: Option<&[u16]>, shape: Shape) -> Prediction {
    let frames = codes.len() / shape.pixels;
    // A block of frames from the middle, where the light is.
    let wanted = (SAMPLE / shape.pixels).clamp(2, frames.max(2)).min(frames);
    let first = (frames - wanted) / 2 * shape.pixels;
    let sample = first..first + wanted * shape.pixels;
    let (codes, guide) = (&codes[sample.clone()], guide.map(|guide| &guide[sample]));
    let mut candidates = Vec::new();
    for minus_green in [false, true] {
        for neighbours in [Neighbours::Last, Neighbours::Bin, Neighbours::Left, Neighbours::Mean] {
            if !minus_green || guide.is_some() {
                candidates.push(Prediction { neighbours, minus_green });
            }
        }
    }
    let cost = |prediction: &Prediction| {
        let symbols = prediction.symbols(codes, guide, shape);
        let low = entropy(symbols.iter().map(|&symbol| symbol as u8));
        let high = || entropy(symbols.iter().map(|&symbol| (symbol >> 8) as u8));
        low + if shape.narrow { 0.0 } else { high() }
    };
    let costs = candidates.iter().map(|candidate| (cost(candidate), *candidate));
    let cheapest = costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, candidate)| candidate);
    cheapest.unwrap_or(Prediction { neighbours: Neighbours::Last, minus_green: false })
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

    const ALL: [Neighbours; 4] =
        [Neighbours::Last, Neighbours::Bin, Neighbours::Left, Neighbours::Mean];

    fn noise(count: usize, mut state: u32) -> Vec<u16> {
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as u16
        };
        (0..count).map(|_| random()).collect()
    }

    #[test]
    fn all_predictions_can_be_undone() {
        for narrow in [false, true] {
            let shape = Shape { width: 5, pixels: 15, narrow };
            let fit = |mut codes: Vec<u16>| {
                // All extremes beside each other, and zeros.
                codes[..8].copy_from_slice(&[1, 65_535, 32_768, 0, 0, 32_769, 1, 32_767]);
                let mask = if narrow { 255 } else { 65_535 };
                for code in &mut codes {
                    *code &= mask;
                }
                codes
            };
            let (codes, guide) = (fit(noise(600, 1)), fit(noise(600, 2)));
            for minus_green in [false, true] {
                for neighbours in ALL {
                    let prediction = Prediction { neighbours, minus_green };
                    let symbols = prediction.symbols(&codes, Some(&guide), shape);
                    let zeros = symbols.iter().zip(&codes).all(|(s, c)| (*s == 0) == (*c == 0));
                    assert!(zeros && symbols.iter().all(|&s| !narrow || s < 256));
                    assert_eq!(prediction.restore(symbols, Some(&guide), shape), codes);
                }
            }
        }
    }

    #[test]
    fn the_prediction_suits_the_codes() {
        let shape = Shape { width: 20, pixels: 400, narrow: false };
        let green = noise(4000, 1);
        let scaled: Vec<u16> = green.iter().map(|code| code.wrapping_add(70)).collect();
        assert!(best(&scaled, Some(&green), shape).minus_green);
        let still: Vec<u16> = (0..4000).map(|i| green[i % 400]).collect();
        assert_eq!(best(&still, None, shape).neighbours, Neighbours::Bin);
        let grain: Vec<u16> = green.iter().map(|code| 5000 + (code >> 10)).collect();
        assert_eq!(best(&grain, None, shape).neighbours, Neighbours::Mean);
    }
}
