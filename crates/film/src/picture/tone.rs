//! Tone mapping: one exposure, then the sRGB curve (IEC 61966-2-1).
//!
//! Display white is the luminance that a given part (99 % by default) of all lit cells of the
//! whole cube does not exceed: all frames share it, so that brightnesses compare across time, and
//! lamps seen directly do not decide it. What is brighter is shown white.

/// Bins of the histogram of positive f32 luminances: the upper 16 bits of their representation,
/// which order like the numbers; 128 per octave.
const BUCKETS: usize = 1 << 15;

/// Factor from radiance to display values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exposure(f64);

impl Exposure {
    /// From the luminances of all cells; those that are not positive count as unlit.
    pub(super) fn new(luminances: impl Iterator<Item = f64>, percentile: f64, extra: f64) -> Self {
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
        let white = bucket.map_or(1.0, |b| f64::from(f32::from_bits(((b as u32) << 16) | 0xffff)));
        Self(extra / white)
    }

    /// The display value of a radiance, linear, 1 = white.
    pub(super) fn display(self, radiance: f64) -> f64 {
        (radiance * self.0).clamp(0.0, 1.0)
    }

    /// The encoded sample of a radiance.
    pub(super) fn encode(self, radiance: f64) -> u8 {
        srgb(self.display(radiance))
    }
}

/// A linear display value in \[0, 1\] as an 8-bit sRGB sample.
pub(super) fn srgb(linear: f64) -> u8 {
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_the_percentile_of_lit_cells() {
        let values = (1..=1000).map(f64::from).chain(vec![0.0; 5000]).chain([1e30; 5]);
        let exposure = Exposure::new(values, 0.9, 1.0);
        // 90 % of 1005 lit cells is 905, to the 1/128 of the histogram.
        assert!((exposure.display(450.0) * 905.0 / 450.0 - 1.0).abs() < 0.01);
        assert_eq!(exposure.encode(1e30), 255);
        let black = Exposure::new([0.0; 9].into_iter(), 0.99, 1.0);
        assert_eq!(black.encode(0.0), 0);
    }

    #[test]
    fn srgb_hits_its_known_points() {
        assert_eq!((srgb(0.0), srgb(1.0)), (0, 255));
        assert_eq!(srgb(0.215_861), 128, "a middle grey");
        assert_eq!(srgb(0.002), 7, "the linear toe: 255 * 12.92 * 0.002 = 6.6");
    }
}
