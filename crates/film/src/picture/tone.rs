//! Tone mapping: from radiance to what a display shows.
//!
//! Display white is the luminance that a given part (99 % by default) of all lit cells of the
//! whole cube does not exceed: all frames share it, so that brightnesses compare across time, and
//! lamps seen directly do not decide it. With x = radiance / white · 2^stops, the display value is
//!
//! * linear: `min(x, 1)`; what is brighter is shown white;
//! * logarithmic: the *encoded* grey is `ln(1 + 1000 x)/ln(1 + 10^4)`, a quarter of the grey scale
//!   for each decade from x = 10 (white) down to 0.001, then linear to black. It is that of the
//!   luminance; colours keep their ratios, and turn pale only where they would leave the display;
//! * filmic: `x (2.51 x + 0.03)/(x (2.43 x + 0.59) + 0.14)` per channel, the fit to the ACES curve
//!   by Narkowicz (2015): deeper shadows, brighter middle, highlights that roll off up to x = 7.2.
//!
//! Then the sRGB curve (IEC 61966-2-1). Videos and the viewer's pages draw the same curves.

use serde::{Deserialize, Serialize};
use tpb_optics::Spectrum;

/// Bins of the histogram of positive f32 luminances: the upper 16 bits of their representation,
/// which order like the numbers; 128 per octave.
const BUCKETS: usize = 1 << 15;

/// Where the logarithmic curve bends to a straight line: x = 1/`LOG_KNEE`.
const LOG_KNEE: f64 = 1000.0;

/// The x that the logarithmic curve shows white.
const LOG_WHITE: f64 = 10.0;

/// The curve from exposed radiance to display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tone {
    /// Proportional, up to white.
    #[default]
    Linear,
    /// Equal ratios of radiance are equal steps of grey, over four decades.
    Log,
    /// A film's: deep shadows, soft highlights.
    Filmic,
}

/// Exposure and curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMap {
    scale: f64,
    tone: Tone,
}

impl ToneMap {
    /// A radiance of `white` becomes x = 2^`exposure_stops`; `white` is positive and finite.
    pub fn new(white: f64, tone: Tone, exposure_stops: f64) -> Self {
        Self { scale: exposure_stops.exp2() / white, tone }
    }

    /// The display value of a luminance, linear, from 0 to 1 = white.
    pub fn grey(self, luminance: f64) -> f64 {
        let x = luminance * self.scale;
        match self.tone {
            Tone::Linear => x.clamp(0.0, 1.0),
            Tone::Log => logarithmic(x),
            Tone::Filmic => filmic(x),
        }
    }

    /// The display values of a colour, linear, from 0 to 1.
    pub fn colour(self, rgb: [f64; 3]) -> [f64; 3] {
        if self.tone != Tone::Log {
            return rgb.map(|value| self.grey(value));
        }
        let x = rgb.map(|value| (value * self.scale).max(0.0));
        let luminance = Spectrum(x).luminance();
        let shown = logarithmic(luminance);
        if shown == 0.0 || luminance.is_infinite() {
            return [shown; 3];
        }
        let colour = x.map(|value| if value > 0.0 { value / luminance * shown } else { 0.0 });
        let largest = colour.into_iter().fold(0.0, f64::max);
        // Towards the grey of the same luminance, until all channels are on the display.
        let kept = if largest > 1.0 { (1.0 - shown) / (largest - shown) } else { 1.0 };
        colour.map(|value| (shown + (value - shown) * kept).clamp(0.0, 1.0))
    }

    /// The samples of a cell of one or three channels, appended to an image.
    pub(super) fn encode(self, cell: &[f64], samples: &mut Vec<u8>) {
        match *cell {
            [r, g, b] => samples.extend(self.colour([r, g, b]).map(srgb)),
            _ => samples.push(srgb(self.grey(cell[0]))),
        }
    }
}

/// The luminance that `percentile` of the lit cells do not exceed, to 1/128 of an octave: of n lit
/// cells in order of luminance, the ⌈percentile n⌉-th. Cells that are not positive or not finite count
/// as unlit. 1 if there are none. The viewer's pages define display white likewise.
pub fn white_level(luminances: impl Iterator<Item = f64>, percentile: f64) -> f64 {
    let mut histogram = vec![0_u64; BUCKETS];
    let mut lit = 0_u64;
    for luminance in luminances {
        let luminance = luminance as f32;
        if luminance > 0.0 && luminance.is_finite() {
            histogram[(luminance.to_bits() >> 16) as usize] += 1;
            lit += 1;
        }
    }
    let wanted = ((lit as f64 * percentile).ceil() as u64).clamp(1, lit.max(1));
    let mut seen = 0;
    let bucket = histogram.iter().position(|&count| {
        seen += count;
        seen >= wanted
    });
    // The upper end of the bucket; a black image has none.
    bucket.map_or(1.0, |b| f64::from(f32::from_bits(((b as u32) << 16) | 0xffff)))
}

fn logarithmic(x: f64) -> f64 {
    let level = (LOG_KNEE * x.max(0.0)).ln_1p() / (LOG_KNEE * LOG_WHITE).ln_1p();
    linear_of_srgb(level.min(1.0))
}

fn filmic(x: f64) -> f64 {
    let x = x.max(0.0);
    // White long since; infinity must not be divided by itself.
    if x > 10.0 {
        return 1.0;
    }
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
}

/// The linear display value of an encoded one in \[0, 1\]: of an 8-bit sample, that over 255.
pub fn linear_of_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// A linear display value as an 8-bit sRGB sample; what is below 0 or no number is black, what is
/// above 1 white.
pub fn srgb(linear: f64) -> u8 {
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TONES: [Tone; 3] = [Tone::Linear, Tone::Log, Tone::Filmic];

    fn sample(tone: Tone, x: f64) -> u8 {
        srgb(ToneMap::new(1.0, tone, 0.0).grey(x))
    }

    #[test]
    fn white_is_the_percentile_of_lit_cells() {
        let values = (1..=1000).map(f64::from).chain(vec![0.0; 5000]).chain([1e30; 5]);
        let white = white_level(values, 0.9);
        // 90 % of 1005 lit cells is 905, to the 1/128 of the histogram.
        assert!((white / 905.0 - 1.0).abs() < 0.01, "{white}");
        assert_eq!(srgb(ToneMap::new(white, Tone::Linear, 0.0).grey(1e30)), 255);
        // The rank is rounded up: 99 % of ten cells are all of them.
        let white = white_level((0..10).map(|i| f64::from(1 << i)), 0.99);
        assert!((512.0..516.0).contains(&white), "{white}");
        let odd = [0.0, -1.0, f64::NAN, f64::INFINITY];
        assert_eq!(white_level(odd.into_iter(), 0.99), 1.0, "nothing is lit");
    }

    #[test]
    fn srgb_hits_its_known_points() {
        assert_eq!((srgb(0.0), srgb(1.0)), (0, 255));
        assert_eq!(srgb(0.215_861), 128, "a middle grey");
        assert_eq!(srgb(0.002), 7, "the linear toe: 255 * 12.92 * 0.002 = 6.6");
        assert_eq!([-1.0, 7.0, f64::INFINITY, f64::NAN].map(srgb), [0, 255, 255, 0]);
        for sample in 0..=255 {
            assert_eq!(srgb(linear_of_srgb(f64::from(sample) / 255.0)), sample);
        }
    }

    #[test]
    fn curves_hit_their_known_values() {
        // Linear: half of white is 188 in sRGB.
        assert_eq!([0.0, 0.5, 1.0, 7.0].map(|x| sample(Tone::Linear, x)), [0, 188, 255, 255]);
        // Log: 255 ln(1 + 1000 x)/ln(10001) = 0, 19.2, 66.4, 127.8, 191.3, 255.
        let levels = [0.0, 1e-3, 1e-2, 0.1, 1.0, 10.0].map(|x| sample(Tone::Log, x));
        assert_eq!(levels, [0, 19, 66, 128, 191, 255]);
        // Filmic: 0.18 (0.4818)/(0.18 (1.0274) + 0.14) = 0.26689; 2.54/3.16 = 0.80380.
        let filmic = |x| ToneMap::new(1.0, Tone::Filmic, 0.0).grey(x);
        assert!((filmic(0.18) - 0.266_89).abs() < 1e-5 && (filmic(1.0) - 0.803_80).abs() < 1e-5);
        assert!(filmic(7.0) < 1.0 && filmic(7.3) == 1.0 && filmic(1e9) == 1.0);
    }

    #[test]
    fn a_stop_doubles_and_white_divides() {
        for tone in TONES {
            let plain = ToneMap::new(1.0, tone, 0.0);
            let exposed = ToneMap::new(8.0, tone, 2.0);
            for x in [0.01, 0.1, 0.3] {
                assert!((plain.grey(x) - exposed.grey(2.0 * x)).abs() < 1e-15, "{tone:?} {x}");
            }
        }
    }

    #[test]
    fn what_is_no_radiance_is_black_or_white() {
        for tone in TONES {
            let map = ToneMap::new(1.0, tone, 0.0);
            for odd in [-1.0, f64::NAN, f64::NEG_INFINITY] {
                assert_eq!(srgb(map.grey(odd)), 0, "{tone:?} {odd}");
                assert_eq!(map.colour([odd; 3]).map(srgb), [0; 3], "{tone:?} {odd}");
            }
            assert_eq!(map.grey(f64::INFINITY), 1.0, "{tone:?}");
            assert_eq!(map.colour([f64::INFINITY; 3]), [1.0; 3], "{tone:?}");
        }
    }

    proptest! {
        #[test]
        fn curves_rise_and_stay_on_the_display(a in 0.0..30.0_f64, step in 0.0..30.0_f64) {
            for tone in TONES {
                let map = ToneMap::new(1.0, tone, 0.0);
                let (low, high) = (map.grey(a), map.grey(a + step));
                prop_assert!((0.0..=1.0).contains(&low) && low <= high && high <= 1.0);
            }
        }

        #[test]
        fn the_logarithm_keeps_luminance_and_the_order_of_channels(
            rgb in prop::array::uniform3(-4.0..1.5_f64),
        ) {
            let rgb = rgb.map(|decade| 10_f64.powf(decade));
            let map = ToneMap::new(1.0, Tone::Log, 0.0);
            let shown = map.colour(rgb);
            let expected = map.grey(Spectrum(rgb).luminance());
            prop_assert!((Spectrum(shown).luminance() - expected).abs() < 1e-12);
            prop_assert!(shown.iter().all(|c| (0.0..=1.0).contains(c)));
            for (a, b) in [(0, 1), (1, 2), (0, 2)] {
                prop_assert!(rgb[a] <= rgb[b] || shown[a] >= shown[b] - 1e-12);
            }
        }
    }
}
