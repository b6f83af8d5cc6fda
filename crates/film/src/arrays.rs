//! The arrays that leave the film.
//!
//! Cells are f32, (row, column, bin, channel) with row 0 at the top; images beside them are f64
//! (row, column, channel), so that bins + before + after = steady holds to the rounding of f32. Rows,
//! columns and bins count from 0, here and in all that names them.

use std::fmt;
use std::ops::Range;

use serde::{Deserialize, Serialize};
use tpb_optics::opl::seconds_from_opl;
use tpb_optics::spectrum::LUMINANCE;

/// What the cells of [`Arrays::transient`] hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Time-integrated radiance within each bin \[W m^-2 sr^-1\] (\[J m^-2 sr^-1\] for a pulse
    /// whose energies are in J).
    #[default]
    BinEnergy,
    /// Radiance \[W m^-2 sr^-1\] at the upper edge of each bin, of emission that was switched on
    /// at 0; `before` is the radiance at the first edge, `before + after` is no longer complete.
    RadianceAtUpperEdges,
}

/// Cells add up to the steady image so well, relatively: rounding to f32 is 6e-8.
const LARGEST_LOSS: f64 = 1e-6;

/// A developed film.
#[derive(Clone, PartialEq)]
pub struct Arrays {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bins per pixel; 0 for a steady film, whose only array is `steady`.
    pub bins: usize,
    /// Channels.
    pub channels: usize,
    /// What `transient` holds.
    pub quantity: Quantity,
    /// The edges of the bins, `bins + 1` \[m\] (none for a steady film).
    pub opl_edges: Vec<f64>,
    /// (height, width, bins, channels).
    pub transient: Vec<f32>,
    /// Variance of the mean over passes, like `transient`, in its unit squared; asked for, and
    /// after at least two passes.
    pub variance: Option<Vec<f32>>,
    /// What arrived before the first bin, (height, width, channels); empty for a steady film.
    pub before: Vec<f64>,
    /// What arrived after the last bin, likewise.
    pub after: Vec<f64>,
    /// The steady image \[W m^-2 sr^-1\], (height, width, channels).
    pub steady: Vec<f64>,
}

impl Arrays {
    /// The edges of the bins \[s\].
    pub fn time_edges(&self) -> Vec<f64> {
        self.opl_edges.iter().map(|&opl| seconds_from_opl(opl)).collect()
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// The cells of one pixel, (bins, channels).
    pub fn pixel(&self, pixel: usize) -> &[f32] {
        let size = self.bins * self.channels;
        &self.transient[pixel * size..(pixel + 1) * size]
    }

    /// What the cells, 32-bit floats, could not hold, and what to do about it; `None` if they hold
    /// what the film holds. Cells above 3e38 are infinite, below 1e-38 they lose digits. The latter
    /// is asked only if the cells are to add up to the steady image, which a pulse may prevent, and
    /// told only if it matters to the whole image.
    pub fn out_of_range(&self, adds_up: bool) -> Option<String> {
        let all = self.transient.iter().chain(self.variance.iter().flatten());
        if let Some(count) = Some(all.filter(|cell| cell.is_infinite()).count()).filter(|&n| n > 0)
        {
            return Some(format!(
                "{count} values of the time-resolved arrays exceed 3e38, the largest 32-bit float: \
                 lower all powers by the same factor (the image is proportional to them)"
            ));
        }
        if !adds_up || self.bins == 0 || self.quantity != Quantity::BinEnergy {
            return None;
        }
        let inside: f64 = self.transient.iter().map(|&cell| f64::from(cell)).sum();
        let outside: f64 = self.before.iter().chain(&self.after).sum();
        let steady: f64 = self.steady.iter().sum();
        let lost = (inside + outside - steady).abs();
        (lost > LARGEST_LOSS * steady).then(|| {
            format!(
                "the time-resolved arrays lost {:.1e} of the light: it is below 1e-38, the smallest \
                 32-bit float: raise all powers by the same factor (the image is proportional to them)",
                lost / steady
            )
        })
    }

    /// Forgets what arrived outside the window: `before` and `after` become 0, and the steady image
    /// the sum of the bins (of continuous emission, the radiance at the last edge).
    pub fn keep_window(&mut self) {
        let (bins, channels) = (self.bins, self.channels);
        if bins == 0 {
            return;
        }
        let size = self.pixels() * channels;
        let counted = match self.quantity {
            Quantity::BinEnergy => bins,
            Quantity::RadianceAtUpperEdges => 1,
        };
        self.steady = vec![0.0; size];
        let cells = self.transient.chunks_exact(bins * channels);
        for (sums, cells) in self.steady.chunks_exact_mut(channels).zip(cells) {
            for cell in cells.rchunks_exact(channels).take(counted) {
                sums.iter_mut().zip(cell).for_each(|(sum, &value)| *sum += f64::from(value));
            }
        }
        (self.before, self.after) = (vec![0.0; size], vec![0.0; size]);
    }

    /// Keeps only some bins, at least one; what the others hold goes to before and after. Used to
    /// drop the guard bins around a pulse. Does nothing unless cells hold bin energies and the
    /// range is within the bins and not empty.
    pub fn crop_bins(&mut self, keep: Range<usize>) {
        let whole = self.quantity == Quantity::BinEnergy;
        if !whole || keep.is_empty() || keep.end > self.bins {
            return;
        }
        let (bins, channels) = (self.bins, self.channels);
        let cut = |cells: &mut Vec<f32>| {
            let size = keep.len() * channels;
            let count = cells.len() / (bins * channels);
            for pixel in 0..count {
                let from = (pixel * bins + keep.start) * channels;
                cells.copy_within(from..from + size, pixel * size);
            }
            cells.truncate(count * size);
            cells.shrink_to_fit();
        };
        for (pixel, cells) in self.transient.chunks_exact(bins * channels).enumerate() {
            for (bin, cell) in cells.chunks_exact(channels).enumerate() {
                let outside = match bin {
                    b if b < keep.start => &mut self.before,
                    b if b >= keep.end => &mut self.after,
                    _ => continue,
                };
                for (channel, &value) in cell.iter().enumerate() {
                    outside[pixel * channels + channel] += f64::from(value);
                }
            }
        }
        cut(&mut self.transient);
        self.variance.as_mut().map(cut);
        self.opl_edges = self.opl_edges[keep.start..=keep.end].to_vec();
        self.bins = keep.len();
    }
}

/// Sizes only: a cube is no reading.
impl fmt::Debug for Arrays {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { width, height, bins, channels, quantity, .. } = self;
        write!(f, "Arrays {width} x {height}, {bins} bins, {channels} channels, {quantity:?}")
    }
}

/// Luminance of a cell with one or three channels.
pub(crate) fn luminance(cell: &[f32]) -> f64 {
    match *cell {
        [r, g, b] => {
            [r, g, b].iter().zip(LUMINANCE).map(|(&value, weight)| f64::from(value) * weight).sum()
        }
        _ => f64::from(cell[0]),
    }
}
