//! Spectra of `C` channels: 1 (achromatic) or 3 (linear RGB, Rec. 709 primaries).
//!
//! The scene stores [`Rgb`]; hot loops run on `Spectrum<1>` when the plan finds the scene
//! achromatic, and pay nothing for colour then.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, MulAssign, Sub};

/// Values of `C` channels. Arithmetic acts channel by channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum<const C: usize>(pub [f64; C]);

/// What a scene file can say: a number (three equal channels) or linear RGB.
pub type Rgb = Spectrum<3>;

/// Luminance weights of linear Rec. 709 RGB (ITU-R BT.709-6, item 3.2).
pub const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

impl<const C: usize> Spectrum<C> {
    /// All channels zero.
    pub const ZERO: Self = Self([0.0; C]);
    /// All channels one.
    pub const ONE: Self = Self([1.0; C]);

    /// The same value in all channels.
    #[inline]
    pub const fn splat(value: f64) -> Self {
        Self([value; C])
    }

    /// Applies `f` to each channel.
    #[must_use]
    #[inline]
    pub fn map(mut self, mut f: impl FnMut(f64) -> f64) -> Self {
        // Loops, here and below: `array::map` and `from_fn` are not always inlined.
        for value in &mut self.0 {
            *value = f(*value);
        }
        self
    }

    /// The mean of the channels.
    #[inline]
    pub fn mean(self) -> f64 {
        self.0.iter().sum::<f64>() / C as f64
    }

    /// The largest channel.
    #[inline]
    pub fn max_channel(self) -> f64 {
        self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether every channel is exactly zero.
    #[inline]
    pub fn is_zero(self) -> bool {
        self.0.iter().all(|&v| v == 0.0)
    }

    /// Whether every channel is finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }

    /// Luminance: the one channel itself, or the Rec. 709 combination of three.
    #[inline]
    pub fn luminance(self) -> f64 {
        if C == 3 { (0..C).map(|c| LUMINANCE[c] * self.0[c]).sum() } else { self.mean() }
    }
}

impl Rgb {
    /// Whether the three channels are equal, so that one channel tells all.
    pub fn is_achromatic(self) -> bool {
        self.0[0] == self.0[1] && self.0[1] == self.0[2]
    }

    /// The channels that a render with `C` channels uses: all three, or the first one
    /// (only asked of achromatic scenes, where it equals the others).
    #[inline]
    pub fn channels<const C: usize>(self) -> Spectrum<C> {
        let mut channels = [0.0; C];
        for (channel, value) in channels.iter_mut().zip(self.0) {
            *channel = value;
        }
        Spectrum(channels)
    }
}

macro_rules! channelwise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const C: usize> $trait for Spectrum<C> {
            type Output = Self;
            #[inline]
            fn $method(mut self, other: Self) -> Self {
                for (value, other) in self.0.iter_mut().zip(other.0) {
                    *value $op other;
                }
                self
            }
        }
    };
}
channelwise!(Add, add, +=);
channelwise!(Sub, sub, -=);
channelwise!(Mul, mul, *=);
channelwise!(Div, div, /=);

impl<const C: usize> Mul<f64> for Spectrum<C> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        self.map(|v| v * factor)
    }
}

impl<const C: usize> Div<f64> for Spectrum<C> {
    type Output = Self;
    #[inline]
    fn div(self, divisor: f64) -> Self {
        self.map(|v| v / divisor)
    }
}

impl<const C: usize> AddAssign for Spectrum<C> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const C: usize> MulAssign for Spectrum<C> {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const C: usize> MulAssign<f64> for Spectrum<C> {
    #[inline]
    fn mul_assign(&mut self, factor: f64) {
        *self = *self * factor;
    }
}

impl<const C: usize> Sum for Spectrum<C> {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, |a, b| a + b)
    }
}

impl<const C: usize> Index<usize> for Spectrum<C> {
    type Output = f64;
    #[inline]
    fn index(&self, channel: usize) -> &f64 {
        &self.0[channel]
    }
}

impl<const C: usize> IndexMut<usize> for Spectrum<C> {
    #[inline]
    fn index_mut(&mut self, channel: usize) -> &mut f64 {
        &mut self.0[channel]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_of_white_is_one_and_of_a_single_channel_itself() {
        assert!((Rgb::ONE.luminance() - 1.0).abs() < 1e-15);
        assert!((Spectrum([0.3]).luminance() - 0.3).abs() < 1e-15);
    }

    #[test]
    fn channels_of_a_grey_keep_its_value() {
        let grey = Rgb::splat(0.25);
        assert!(grey.is_achromatic());
        assert_eq!(grey.channels::<1>(), Spectrum([0.25]));
        assert_eq!(grey.channels::<3>(), grey);
    }
}
