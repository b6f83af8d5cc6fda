//! Other pulses than the delta, made from the recorded response.
//!
//! A film records the response to a pulse of no duration at OPL 0. The response to a pulse of unit
//! energy with density `p(u)` is its convolution with p, for which the energy `E_j` of a bin is
//! taken as uniform within it. With bins of equal width w, bin i then receives `E_j K(i − j)`,
//!
//! `K(m) = (1/w) ∫_0^w ds ∫_{mw}^{(m+1)w} p(t − s) dt = ∫ p(t) Λ(t/w − m) dt`,
//!
//! Λ the unit triangle over (−1, 1): an exact integral over the pair of bins.
//!
//! * Box of length W, from 0 to W: `K(m) = (w/W) [C(W/w − m) − C(−m)]`, `C(x) = ∫_{−1}^x Λ`, which
//!   is piecewise quadratic.
//! * Gaussian around 0: `K(m) = [P(m + 1) − 2 P(m) + P(m − 1)]/w` with the second antiderivative
//!   `P(m) = σ φ(z) − z σ Q(z)`, `z = |m| w/σ`, `Q(z) = erfc(z/√2)/2`, all arguments taken on the
//!   side where P decays. Pulses wider than a bin would lose digits that way; there p is smooth
//!   on each half of Λ and an 8-point Gauss rule is exact to rounding.
//!
//! Energy that leaves the window goes to before and after. Energy that was there already stays:
//! its arrival is not known. So bins closer to an end than the support of the pulse may lack what
//! came from outside; [`PulseReport`] says how many, and [`Arrays::crop_bins`] drops them.
//!
//! Error of "uniform within a bin": if E_j really arrived at s within its bin, the bins' errors sum
//! to at most `E_j V mean|s − s'| ≤ E_j V w/2`, with `V = ∫|p'|` (2/W for the box, √(2/π)/σ for
//! the Gaussian), and never to more than `2 E_j`.
//!
//! Continuous emission of unit power switched on at 0: the radiance at an edge is all that has
//! arrived before it, exactly.

use std::f64::consts::{PI, SQRT_2};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use tpb_optics::opl::opl_from_seconds;

use crate::{Arrays, FilmError, Quantity};

/// Edges of equal bins are where they should be, to this part of a bin: those of other programs are
/// rounded to 32 bits.
const EDGE_TOLERANCE: f64 = 1e-3;

/// Beyond this many σ a Gaussian holds less than 1e-16 of its energy.
const GAUSSIAN_SUPPORT: f64 = 8.5;

/// Gauss-Legendre nodes and weights over (0, 1), 8 points; the other four mirror these.
const GAUSS: [(f64, f64); 4] = [
    (0.019_855_071_751_231_88, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_6, 0.111_190_517_226_687_2),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_6),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
];

/// The shape of the emitters' pulse in time; unit energy, or unit power for continuous emission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Pulse {
    /// No duration: what the film records.
    #[default]
    Delta,
    /// Gaussian around time 0.
    Gaussian {
        /// Standard deviation \[s\].
        sigma_s: f64,
    },
    /// Constant power from time 0 on.
    Box {
        /// Duration \[s\].
        width_s: f64,
    },
    /// Switched on at time 0, for ever.
    Continuous,
}

/// What a pulse did to the arrays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PulseReport {
    /// Bins at the start of the window that may lack energy that arrived before it.
    pub guard_bins_start: usize,
    /// Bins at the end of the window that may lack energy that arrived after it.
    pub guard_bins_end: usize,
    /// Upper bound of Σ|error of bins| of a pixel, as a part of the pixel's energy within the
    /// window, of taking energy as uniform within a bin.
    pub relative_error_bound: f64,
}

/// The weights K(m).
struct Kernel {
    /// How many of the weights have m < 0.
    back: usize,
    /// K(−back), K(−back + 1), ...
    weights: Vec<f64>,
    /// Sums of K below and above those: there, m is farther than the window is long.
    below: f64,
    above: f64,
}

impl PulseReport {
    const fn exact() -> Self {
        Self { guard_bins_start: 0, guard_bins_end: 0, relative_error_bound: 0.0 }
    }
}

impl Kernel {
    /// Constant over `width` bins from 0 on, for a window of `bins` bins.
    fn boxed(width: f64, bins: usize) -> Self {
        // The mean of 1 − |m − u| over u from 0 to the width, where positive: piece by piece, each
        // linear. (The difference of primitives over the width cancels for short pulses.)
        let weight = |m: f64| -> f64 {
            let cuts = [0.0, m - 1.0, m, m + 1.0, width].map(|u| u.clamp(0.0, width));
            let piece = |ends: &[f64]| {
                (ends[1] - ends[0]) / width * (1.0 - (m - 0.5 * (ends[0] + ends[1])).abs()).max(0.0)
            };
            cuts.windows(2).map(piece).sum()
        };
        let last = width.ceil().min(bins as f64) as usize;
        let weights: Vec<f64> = (0..=last).map(|m| weight(m as f64)).collect();
        let above = (1.0 - weights.iter().sum::<f64>()).max(0.0);
        Self { back: 0, weights, below: 0.0, above }
    }

    /// Gaussian with standard deviation `sigma` bins.
    fn gaussian(sigma: f64, bins: usize) -> Self {
        let last = ((GAUSSIAN_SUPPORT * sigma).ceil() + 1.0).min(bins as f64) as usize;
        let density = |x: f64| (-0.5 * (x / sigma).powi(2)).exp() / (sigma * (2.0 * PI).sqrt());
        let smooth = |m: f64| -> f64 {
            let at = |x: f64| (1.0 - x) * (density(m + x) + density(m - x));
            GAUSS.iter().map(|(x, weight)| weight * (at(*x) + at(1.0 - x))).sum()
        };
        let primitive = |x: f64| {
            let decay = if x == 0.0 { 1.0 } else { (-0.5 * (x / sigma).powi(2)).exp() };
            let beyond = if x == 0.0 { 0.0 } else { 0.5 * libm::erfc(x / (sigma * SQRT_2)) };
            sigma * decay / (2.0 * PI).sqrt() - x * beyond
        };
        let weight = |m: f64| {
            if sigma >= 1.0 {
                smooth(m)
            } else if m == 0.0 {
                1.0 - 2.0 * (primitive(0.0) - primitive(1.0))
            } else {
                (primitive(m + 1.0) - primitive(m)) + (primitive(m - 1.0) - primitive(m))
            }
        };
        let half: Vec<f64> = (0..=last).map(|m| weight(m as f64)).collect();
        let weights: Vec<f64> = half[1..].iter().rev().chain(&half).copied().collect();
        let rest = 0.5 * (1.0 - weights.iter().sum::<f64>()).max(0.0);
        Self { back: last, weights, below: rest, above: rest }
    }

    /// The first bin that energy of bin `bin` reaches, and the weights from there on.
    fn within(&self, bin: usize) -> (usize, &[f64]) {
        (bin.saturating_sub(self.back), &self.weights[self.back.saturating_sub(bin)..])
    }

    /// For each bin, the parts that leave the window to before and to after.
    fn leaving(&self, bins: usize) -> (Vec<f64>, Vec<f64>) {
        // Sums of the first weights and of the last, each added up from its small end.
        let sums = |start: f64, weights: &mut dyn Iterator<Item = &f64>| -> Vec<f64> {
            let mut sum = start;
            let rest = weights.map(|weight| {
                sum += weight;
                sum
            });
            [start].into_iter().chain(rest).collect()
        };
        let firsts = sums(self.below, &mut self.weights.iter());
        let lasts = sums(self.above, &mut self.weights.iter().rev());
        let early = |bin: usize| firsts[self.back.saturating_sub(bin)];
        let late = |bin: usize| lasts[self.weights.len().saturating_sub(self.back + bins - bin)];
        ((0..bins).map(early).collect(), (0..bins).map(late).collect())
    }
}

impl Pulse {
    /// A Gaussian by its full width at half maximum \[s\].
    pub fn gaussian_fwhm(fwhm_s: f64) -> Self {
        Self::Gaussian { sigma_s: fwhm_s / (8.0 * 2.0_f64.ln()).sqrt() }
    }

    /// Refuses durations that are not positive and finite.
    fn check(self) -> Result<(), FilmError> {
        let (name, duration) = match self {
            Self::Delta | Self::Continuous => return Ok(()),
            Self::Gaussian { sigma_s } => ("sigma_s", sigma_s),
            Self::Box { width_s } => ("width_s", width_s),
        };
        if duration > 0.0 && duration.is_finite() {
            return Ok(());
        }
        Err(FilmError::Pulse(format!("{name} must be positive and finite, not {duration}")))
    }
}

impl Arrays {
    /// Turns the response to a delta pulse into the response to `pulse`. The variance over passes
    /// is dropped unless the pulse is a delta: bins of a pass are not independent.
    ///
    /// # Errors
    /// [`FilmError::Pulse`] for impossible parameters, and for a Gaussian or a box on bins of
    /// different widths; [`FilmError::Unsuitable`] without bins or after [`Pulse::Continuous`].
    pub fn apply_pulse(&mut self, pulse: Pulse) -> Result<PulseReport, FilmError> {
        pulse.check()?;
        if self.bins == 0 {
            return Err(FilmError::Unsuitable("a pulse needs a time axis; this film is steady"));
        }
        if self.quantity != Quantity::BinEnergy {
            return Err(FilmError::Unsuitable("a pulse needs energies per bin, not radiance"));
        }
        if !matches!(pulse, Pulse::Delta | Pulse::Continuous) {
            self.need_equal_bins()?;
        }
        let bin_width = (self.opl_edges[self.bins] - self.opl_edges[0]) / self.bins as f64;
        let (kernel, variation) = match pulse {
            Pulse::Delta => return Ok(PulseReport::exact()),
            Pulse::Continuous => {
                self.switch_on();
                return Ok(PulseReport::exact());
            }
            Pulse::Gaussian { sigma_s } => {
                let sigma = opl_from_seconds(sigma_s) / bin_width;
                (Kernel::gaussian(sigma, self.bins), (2.0 / PI).sqrt() / sigma)
            }
            Pulse::Box { width_s } => {
                let width = opl_from_seconds(width_s) / bin_width;
                (Kernel::boxed(width, self.bins), 2.0 / width)
            }
        };
        self.variance = None;
        self.convolve(&kernel);
        Ok(PulseReport {
            guard_bins_start: (kernel.weights.len() - 1 - kernel.back).min(self.bins),
            guard_bins_end: kernel.back.min(self.bins),
            relative_error_bound: (0.5 * variation).min(2.0),
        })
    }

    /// That one kernel holds for all bins.
    fn need_equal_bins(&self) -> Result<(), FilmError> {
        let edges = &self.opl_edges;
        let width = (edges[self.bins] - edges[0]) / self.bins as f64;
        let even = |(k, edge): (usize, &f64)| {
            (edge - edges[0] - k as f64 * width).abs() <= EDGE_TOLERANCE * width
        };
        if edges.iter().enumerate().all(even) {
            return Ok(());
        }
        let widths = edges.windows(2).map(|pair| pair[1] - pair[0]);
        let (least, most) =
            widths.fold((f64::INFINITY, 0.0_f64), |(least, most), w| (least.min(w), most.max(w)));
        Err(FilmError::Pulse(format!(
            "a Gaussian or a box needs bins of one width; these are {least:.3e} m to {most:.3e} m wide \
             (a continuous pulse needs no such thing)"
        )))
    }

    fn switch_on(&mut self) {
        let channels = self.channels;
        let pixels = self.transient.par_chunks_exact_mut(self.bins * channels);
        pixels.zip(self.before.par_chunks_exact(channels)).for_each(|(cells, before)| {
            for (channel, &before) in before.iter().enumerate() {
                let mut sum = before;
                for cell in cells.iter_mut().skip(channel).step_by(channels) {
                    sum += f64::from(*cell);
                    *cell = sum as f32;
                }
            }
        });
        self.variance = None;
        self.quantity = Quantity::RadianceAtUpperEdges;
    }

    fn convolve(&mut self, kernel: &Kernel) {
        let (bins, channels) = (self.bins, self.channels);
        // Parts of a bin's energy that end up before the window and after it.
        let (early, late) = kernel.leaving(bins);
        let pixels = self.transient.par_chunks_exact_mut(bins * channels);
        let outside = self.before.par_chunks_exact_mut(channels);
        let outside = outside.zip(self.after.par_chunks_exact_mut(channels));
        let buffer = || vec![0.0; bins];
        pixels.zip(outside).for_each_init(buffer, |spread, (cells, (before, after))| {
            for channel in 0..channels {
                spread.fill(0.0);
                for bin in 0..bins {
                    let energy = f64::from(cells[bin * channels + channel]);
                    if energy == 0.0 {
                        continue;
                    }
                    before[channel] += energy * early[bin];
                    after[channel] += energy * late[bin];
                    let (to, weights) = kernel.within(bin);
                    for (sum, weight) in spread[to..].iter_mut().zip(weights) {
                        *sum += energy * weight;
                    }
                }
                for (cell, &sum) in cells.iter_mut().skip(channel).step_by(channels).zip(&*spread) {
                    *cell = sum as f32;
                }
            }
        });
    }
}

#[cfg(test)]
mod tests;
