//! Time-of-arrival picture: hue tells when light arrives at a pixel, brightness how much.
//!
//! The time of a pixel is the mean of the bins' centres weighted by their energy, or the centre
//! of the brightest bin. Hues run from blue (early) over green to red (late) at constant lightness
//! and chroma of OKLCh (Ottosson 2020), so that colour does not feign brightness: `L = 0.75`,
//! `C = 0.12`, hue 265° to 25°, within sRGB throughout. Brightness is the steady image, exposed by
//! its own percentile. Early and late are the times that 1 % and 99 % of the *shown* brightness
//! precede, so that a lamp seen directly, which may be nearly all of the energy, does not take the
//! whole scale. A bar below the picture shows the scale.

use std::ops::Range;
use std::path::Path;

use serde::{Deserialize, Serialize};
use tpb_optics::opl::seconds_from_opl;

use super::tone::{srgb, white_level};
use super::{Image, PictureOptions};
use crate::arrays::luminance;
use crate::{Arrays, FilmError, Quantity};

/// Which time of arrival a pixel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArrivalTime {
    /// Mean, weighted by energy.
    #[default]
    Mean,
    /// The bin with the most energy.
    Peak,
}

/// The scale of a time-of-arrival picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArrivalColours {
    /// OPL that is shown blue \[m\].
    pub early_opl: f64,
    /// OPL that is shown red \[m\].
    pub late_opl: f64,
}

impl ArrivalColours {
    /// The times that 1 % and 99 % of the lit pixels' brightness precede; `window` where nothing is
    /// lit \[m\].
    pub fn of(
        times: &[Option<f64>],
        brightness: impl Fn(usize) -> f64,
        window: (f64, f64),
    ) -> Self {
        let mut weighted: Vec<(f64, f64)> = times
            .iter()
            .enumerate()
            .filter_map(|(pixel, time)| time.map(|time| (time, brightness(pixel))))
            .collect();
        weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = weighted.iter().map(|w| w.1).sum();
        let preceded_by = |part: f64| {
            let mut sum = 0.0;
            let found = weighted.iter().find(|w| {
                sum += w.1;
                sum >= part * total
            });
            found.or(weighted.last()).map(|w| w.0)
        };
        Self {
            early_opl: preceded_by(0.01).unwrap_or(window.0),
            late_opl: preceded_by(0.99).unwrap_or(window.1),
        }
    }

    /// Where an OPL \[m\] stands on the scale: 0 at the early end, 1 at the late one.
    pub fn position(&self, opl: f64) -> f64 {
        let span = self.late_opl - self.early_opl;
        if span > 0.0 { ((opl - self.early_opl) / span).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// The linear colour of an OPL \[m\].
    pub fn colour(&self, opl: f64) -> [f64; 3] {
        scale_colour(self.position(opl))
    }
}

/// The scale as a bar below a picture of this size, early to late: sRGB samples, three a pixel, of
/// a black row and of the bar.
pub fn arrival_scale(width: usize, height: usize) -> Vec<u8> {
    let mut samples = vec![0; 3 * width];
    let at = |x: usize| (x as f64 + 0.5) / width as f64;
    for _ in 0..(height / 32).max(2) {
        samples.extend((0..width).flat_map(|x| scale_colour(at(x)).map(srgb)));
    }
    samples
}

/// Linear sRGB of the scale at 0 (early) to 1 (late).
fn scale_colour(at: f64) -> [f64; 3] {
    const LIGHTNESS: f64 = 0.75;
    const CHROMA: f64 = 0.12;
    let hue = (265.0 - 240.0 * at.clamp(0.0, 1.0)).to_radians();
    let (a, b) = (CHROMA * hue.cos(), CHROMA * hue.sin());
    // OKLab to linear sRGB, matrices of Ottosson 2020.
    let l = (LIGHTNESS + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (LIGHTNESS - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (LIGHTNESS - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

impl Arrays {
    /// OPL of arrival \[m\] at a pixel within these bins; `None` where nothing arrives.
    pub fn arrival(&self, pixel: usize, bins: Range<usize>, kind: ArrivalTime) -> Option<f64> {
        let centre = |bin: usize| 0.5 * (self.opl_edges[bin] + self.opl_edges[bin + 1]);
        let cells = self.pixel(pixel).chunks_exact(self.channels).map(luminance).enumerate();
        let cells = cells.skip(bins.start).take(bins.len());
        match kind {
            ArrivalTime::Mean => {
                let (mut energy, mut moment) = (0.0, 0.0);
                for (bin, luminance) in cells {
                    energy += luminance;
                    moment += luminance * centre(bin);
                }
                (energy > 0.0).then(|| moment / energy)
            }
            ArrivalTime::Peak => {
                let (bin, luminance) = cells.max_by(|a, b| a.1.total_cmp(&b.1))?;
                (luminance > 0.0).then(|| centre(bin))
            }
        }
    }

    /// Writes the time-of-arrival picture and returns its scale, which the file also names.
    ///
    /// # Errors
    /// [`FilmError::Io`]; [`FilmError::Unsuitable`] without energies per bin.
    pub fn write_arrival_time(
        &self,
        path: &Path,
        options: &PictureOptions,
    ) -> Result<ArrivalColours, FilmError> {
        self.need_arrivals()?;
        let steady = |pixel: usize| self.steady_luminance(pixel);
        let pixels = 0..self.pixels();
        let times: Vec<Option<f64>> = pixels
            .clone()
            .map(|pixel| self.arrival(pixel, 0..self.bins, options.arrival))
            .collect();
        let white = white_level(pixels.map(steady), options.steady_white_percentile);
        let map = options.tone_map(white);
        let brightness = |pixel: usize| map.grey(steady(pixel));
        let window = (self.opl_edges[0], self.opl_edges[self.bins]);
        let colours = ArrivalColours::of(&times, brightness, window);

        let mut samples = Vec::with_capacity(times.len() * 3);
        for (pixel, time) in times.iter().enumerate() {
            let colour = time.map_or([0.0; 3], |time| colours.colour(time));
            samples.extend(colour.map(|c| srgb(c * brightness(pixel))));
        }
        samples.extend(arrival_scale(self.width, self.height));
        let height = samples.len() / (3 * self.width);
        let image = Image { width: self.width, height, channels: 3, samples };
        let ArrivalColours { early_opl, late_opl } = colours;
        let (early_s, late_s) = (seconds_from_opl(early_opl), seconds_from_opl(late_opl));
        let text = format!("blue {early_opl} m = {early_s} s; red {late_opl} m = {late_s} s");
        image.write(path, &[("Title", "Time of arrival".to_owned()), ("Comment", text)])?;
        Ok(colours)
    }

    /// That there are times of arrival to show.
    ///
    /// # Errors
    /// [`FilmError::Unsuitable`] without energies per bin.
    pub fn need_arrivals(&self) -> Result<(), FilmError> {
        self.need_bins()?;
        if self.quantity == Quantity::BinEnergy {
            return Ok(());
        }
        Err(FilmError::Unsuitable("continuous emission has no time of arrival"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_within_srgb_and_runs_from_blue_to_red() {
        for i in 0..=100 {
            let colour = scale_colour(f64::from(i) / 100.0);
            assert!(colour.iter().all(|c| (0.0..=1.0).contains(c)), "{i}: {colour:?}");
        }
        let ([r0, _, b0], [r1, _, b1]) = (scale_colour(0.0), scale_colour(1.0));
        assert!(b0 > 2.0 * r0 && r1 > 2.0 * b1);
    }
}
