//! Where in the image a method errs: false-colour maps of variance and of bias.
//!
//! * Variance of a pixel over replicates, summed over bins, over the mean signal Σr² of a judged
//!   pixel; logarithmic, one scale for all methods.
//! * Bias of blocks of pixels: (x̄ − r)/r of their energy within the window, signed. A block is
//!   coloured only where it is resolved: where Student's interval at 99 %, which holds the noise of
//!   replicates and reference, leaves 0 out; of blocks without bias one in a hundred is coloured by
//!   chance. The others are grey, and nothing is claimed of them. Both variances are estimates, of n
//!   replicates and, pixel by pixel, of the reference's K batches: the degrees of freedom of their sum
//!   are Satterthwaite's (1946), V²/Σ(V_i²/f_i).

use serde::{Deserialize, Serialize};
use tpb_statistics::VarianceSum;

use super::colour::{GREY, diverging, sequential};
use super::compare::Maps;
use super::picture::Picture;
use super::truth::Truth;
use crate::statistics::batches::summarise;

/// Decades that the scale of variances spans.
const DECADES: f64 = 4.0;
/// Blocks along an edge of the image, about.
const BLOCKS: usize = 32;
/// Chance that a block without bias is coloured.
const CHANCE: f64 = 0.01;

/// Variance maps of all methods, on one scale.
pub struct VarianceMaps {
    /// A picture for each method.
    pub pictures: Vec<Picture>,
    /// What is white.
    pub brightest: f64,
    /// What is black.
    pub darkest: f64,
}

impl VarianceMaps {
    /// Of all methods.
    pub fn new(maps: &[Maps], truth: &Truth) -> Self {
        let judged = truth.judged.iter().filter(|&&judged| judged).count().max(1);
        let signal = truth.noise(0..truth.bins, true).signal() / judged as f64;
        let mut relative: Vec<f64> = maps
            .iter()
            .flat_map(|m| m.variance.iter().zip(&truth.judged))
            .filter_map(|(v, judged)| judged.then_some(v / signal))
            .collect();
        relative.sort_by(f64::total_cmp);
        let top = relative.get(relative.len() * 999 / 1000).copied().unwrap_or(1.0);
        // A whole decade.
        let top = if top > 0.0 { top.log10().ceil() } else { 0.0 };
        let colour = |v: f64| {
            let decades = (v / signal).max(f64::MIN_POSITIVE).log10() - top;
            sequential(1.0 + decades / DECADES)
        };
        let picture =
            |m: &Maps| Picture::by_pixel(truth.width, truth.height, |p| colour(m.variance[p]));
        Self {
            pictures: maps.iter().map(picture).collect(),
            brightest: 10.0_f64.powf(top),
            darkest: 10.0_f64.powf(top - DECADES),
        }
    }
}

/// Relative bias of a block of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BlockBias {
    /// Left pixel.
    pub x: usize,
    /// Upper pixel.
    pub y: usize,
    /// (x̄ − r)/r.
    pub bias: f64,
    /// Half of its 99 % interval; infinite where the block is black.
    pub half: f64,
}

impl BlockBias {
    /// Whether 0 is left out.
    pub fn resolved(&self) -> bool {
        self.bias.abs() > self.half
    }
}

/// The bias of a method, block by block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BiasMap {
    /// Edge of a block in pixels.
    pub side: usize,
    /// Blocks of which all pixels are judged.
    pub blocks: Vec<BlockBias>,
}

impl BiasMap {
    /// Of one method. `None` if the reference does not tell its noise.
    pub fn new(map: &Maps, truth: &Truth) -> Option<Self> {
        if truth.window_variance.is_empty() || map.window_residuals.len() < 2 {
            return None;
        }
        let side = truth.width.div_ceil(BLOCKS).max(1);
        let mut blocks = Vec::new();
        for y in (0..truth.height).step_by(side) {
            for x in (0..truth.width).step_by(side) {
                let pixels: Vec<usize> = (y..(y + side).min(truth.height))
                    .flat_map(|y| (x..(x + side).min(truth.width)).map(move |x| (x, y)))
                    .map(|(x, y)| y * truth.width + x)
                    .collect();
                if pixels.iter().all(|&pixel| truth.judged[pixel]) {
                    let (bias, half) = block(map, truth, &pixels);
                    blocks.push(BlockBias { x, y, bias, half });
                }
            }
        }
        Some(Self { side, blocks })
    }

    /// How many blocks are resolved.
    pub fn resolved(&self) -> usize {
        self.blocks.iter().filter(|block| block.resolved()).count()
    }

    /// How many of its blocks would be without any bias.
    pub fn by_chance(&self) -> f64 {
        CHANCE * self.blocks.len() as f64
    }

    /// The largest bias that is resolved, apart from the most extreme twentieth.
    pub fn largest(&self) -> f64 {
        let mut found: Vec<f64> =
            self.blocks.iter().filter(|b| b.resolved()).map(|b| b.bias.abs()).collect();
        found.sort_by(f64::total_cmp);
        found.get(found.len() * 19 / 20).copied().unwrap_or(0.0)
    }

    /// As a picture, with full colour at `scale`.
    pub fn picture(&self, truth: &Truth, scale: f64) -> Picture {
        let mut picture = Picture::filled(truth.width, truth.height, GREY);
        for block in self.blocks.iter().filter(|block| block.resolved()) {
            let colour = diverging(block.bias / scale);
            picture.put(&Picture::filled(self.side, self.side, colour), block.x, block.y);
        }
        picture
    }
}

/// Relative bias of the energy of some pixels, and half of its interval.
fn block(map: &Maps, truth: &Truth, pixels: &[usize]) -> (f64, f64) {
    let energy: f64 =
        pixels.iter().flat_map(|&p| truth.pixel(p)).map(|&value| f64::from(value)).sum();
    if energy <= 0.0 {
        return (0.0, f64::INFINITY);
    }
    let sums: Vec<f64> = map
        .window_residuals
        .iter()
        .map(|residuals| pixels.iter().map(|&p| residuals[p]).sum::<f64>() / energy)
        .collect();
    let found = summarise(&sums);
    let own = found.standard_error * found.standard_error;
    let mut variance = VarianceSum::default().and(own, sums.len() as f64 - 1.0);
    for &pixel in pixels {
        let reference = truth.window_variance[pixel] / (energy * energy);
        variance = variance.and(reference, truth.window_freedom);
    }
    (found.mean, variance.half_width(0.5 * CHANCE).unwrap_or(f64::INFINITY))
}

/// A scale from one end of a colour map to the other, as a flat picture.
pub fn scale_bar(colour: impl Fn(f64) -> [u8; 3]) -> Picture {
    Picture::by_pixel(256, 12, |pixel| colour((pixel % 256) as f64 / 255.0))
}

#[cfg(test)]
mod tests {
    use tpb_optics::Stream;

    use super::*;
    use crate::reproduce::testing::arrays;

    fn setting() -> (Truth, Maps) {
        let values = arrays(64, 64, 2, 1).transient;
        let mut truth = Truth::of_cells((64, 64, 2), values, 0.0);
        truth.window_variance = vec![1e-8; 64 * 64];
        truth.judged[0] = false;
        // 1 % too dark on the right half, on average over five replicates with noise; none left.
        let residuals = |replicate: i32| {
            (0..64 * 64)
                .map(|pixel| {
                    let energy: f64 = truth.pixel(pixel).iter().map(|&v| f64::from(v)).sum();
                    let bias = if pixel % 64 >= 32 { -0.01 * energy } else { 0.0 };
                    bias + 1e-3 * f64::from(replicate - 2)
                })
                .collect()
        };
        let window_residuals = (0..5).map(residuals).collect();
        let variance = (0..64 * 64).map(|pixel| if pixel % 64 < 32 { 1e-4 } else { 1.0 }).collect();
        (truth, Maps { variance, window_residuals })
    }

    #[test]
    fn bias_is_shown_where_it_is_resolved_and_nowhere_else() {
        let (truth, map) = setting();
        let bias = BiasMap::new(&map, &truth).unwrap();
        assert_eq!((bias.side, bias.blocks.len()), (2, 1023));
        assert!(bias.blocks.iter().all(|b| b.resolved() == (b.x >= 32)));
        assert!((bias.largest() - 0.01).abs() < 1e-6);
        let picture = bias.picture(&truth, 0.01);
        assert_eq!((picture.pixels[10], picture.pixels[40]), (GREY, diverging(-1.0)));
        assert!((bias.by_chance() - 10.23).abs() < 1e-9);
    }

    /// Regression: where the reference's noise ruled, none of a thousand blocks was ever resolved.
    #[test]
    fn as_many_blocks_are_resolved_by_chance_as_is_said() {
        let (batches, mut rng) = (8, Stream::new(5, 0, 0));
        let mut normal = || (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
        let (mut truth, _) = setting();
        truth.judged.fill(true);
        // Noise of the reference's batches; its mean is off by their mean, and so are all residuals.
        let mut means = Vec::new();
        for variance in &mut truth.window_variance {
            let values: Vec<f64> = (0..batches).map(|_| 1e-2 * normal()).collect();
            let found = summarise(&values);
            *variance = found.standard_error * found.standard_error;
            means.push(found.mean);
        }
        let window_residuals =
            (0..5).map(|_| means.iter().map(|mean| 2e-3 * normal() - mean).collect()).collect();
        let map = Maps { variance: vec![0.0; 64 * 64], window_residuals };
        let bias = BiasMap::new(&map, &truth).unwrap();
        // Binomial of 1024 blocks at 1 %: mean 10, standard deviation 3.2; from 1 to six of these above.
        assert!((1..=30).contains(&bias.resolved()), "{} by chance", bias.resolved());
    }

    #[test]
    fn variances_share_a_scale_of_whole_decades() {
        let (truth, map) = setting();
        let quiet =
            Maps { variance: vec![1e-9; 64 * 64], window_residuals: map.window_residuals.clone() };
        let maps = VarianceMaps::new(&[map, quiet], &truth);
        assert!((maps.brightest / maps.darkest - 1e4).abs() < 1e-6);
        let [noisy, quiet] = maps.pictures.as_slice() else { panic!("two pictures") };
        assert_eq!(quiet.pixels[9], [0; 3]);
        assert!(noisy.pixels[40] > noisy.pixels[9]);
    }
}
