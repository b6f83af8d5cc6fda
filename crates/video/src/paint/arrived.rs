//! What has arrived so far: hue tells when, brightness how much.
//!
//! After the bins up to some time, a pixel has the brightness of all light that they brought it and
//! the hue of that light's mean (or brightest) time of arrival, on the scale of the still picture
//! of arrival times. The light of the frame itself is laid over it in white. Once all has
//! arrived, the still remains.

use std::ops::Range;

use rayon::prelude::*;
use tpb_film::{
    Arrays, ArrivalColours, ArrivalTime, PictureOptions, ToneMap, arrival_scale, white_level,
};
use tpb_optics::Spectrum;

/// The light of a frame covers what came before up to this part: waves stay coloured.
const COVER: f64 = 0.85;

/// Light so far.
pub(super) struct Arrived<'a> {
    arrays: &'a Arrays,
    kind: ArrivalTime,
    map: ToneMap,
    colours: ArrivalColours,
    scale: Vec<u8>,
    pixels: Vec<Pixel>,
}

/// Sums over the bins so far.
#[derive(Clone, Copy, Default)]
struct Pixel {
    energy: f64,
    /// Energy times the bins' centres.
    moment: f64,
    /// The brightest bin's luminance and centre.
    peak: (f64, f64),
}

impl<'a> Arrived<'a> {
    /// For light within some bins.
    pub(super) fn new(
        arrays: &'a Arrays,
        bins: Range<usize>,
        kind: ArrivalTime,
        options: &PictureOptions,
    ) -> Self {
        let window = (arrays.opl_edges[bins.start], arrays.opl_edges[bins.end]);
        let mut arrived = Self {
            arrays,
            kind,
            map: options.tone_map(1.0),
            colours: ArrivalColours { early_opl: window.0, late_opl: window.1 },
            scale: arrival_scale(arrays.width, arrays.height),
            pixels: vec![Pixel::default(); arrays.pixels()],
        };
        arrived.advance(bins);
        let energies = arrived.pixels.iter().map(|pixel| pixel.energy);
        arrived.map = options.tone_map(white_level(energies, options.steady_white_percentile));
        let times: Vec<Option<f64>> = arrived.pixels.iter().map(|p| p.time(arrived.kind)).collect();
        let brightness = |pixel: usize| arrived.map.grey(arrived.pixels[pixel].energy);
        arrived.colours = ArrivalColours::of(&times, brightness, window);
        arrived.restart();
        arrived
    }

    /// Forgets all light.
    pub(super) fn restart(&mut self) {
        self.pixels.fill(Pixel::default());
    }

    /// Adds the light of the next bins.
    pub(super) fn advance(&mut self, bins: Range<usize>) {
        let (arrays, channels) = (self.arrays, self.arrays.channels);
        let edges = &arrays.opl_edges;
        self.pixels.par_iter_mut().enumerate().for_each(|(index, pixel)| {
            let cells = &arrays.pixel(index)[bins.start * channels..bins.end * channels];
            for (cell, bin) in cells.chunks_exact(channels).zip(bins.clone()) {
                let luminance = match *cell {
                    [r, g, b] => Spectrum([r, g, b].map(f64::from)).luminance(),
                    _ => f64::from(cell[0]),
                };
                let centre = 0.5 * (edges[bin] + edges[bin + 1]);
                pixel.energy += luminance;
                pixel.moment += luminance * centre;
                // The last of equals, as in the still picture.
                if luminance > 0.0 && luminance >= pixel.peak.0 {
                    pixel.peak = (luminance, centre);
                }
            }
        });
    }

    /// The linear colour of a pixel, below the light of a frame that is shown as `light`.
    pub(super) fn colour(&self, pixel: usize, light: f64) -> [f64; 3] {
        let pixel = self.pixels[pixel];
        let brightness = self.map.grey(pixel.energy);
        let hue = pixel.time(self.kind).map_or([0.0; 3], |time| self.colours.colour(time));
        hue.map(|c| c * brightness + (1.0 - c * brightness) * COVER * light)
    }

    /// Rows of the scale below the image.
    pub(super) fn scale_rows(&self) -> usize {
        self.scale.len() / (3 * self.arrays.width)
    }

    /// The scale, perhaps with a mark at an OPL \[m\].
    pub(super) fn paint_scale(&self, opl: Option<f64>, samples: &mut [u8]) {
        samples.copy_from_slice(&self.scale);
        let Some(opl) = opl else { return };
        let width = self.arrays.width;
        let at = ((self.colours.position(opl) * width as f64) as usize).min(width - 1);
        for row in samples.chunks_exact_mut(3 * width).skip(1) {
            for (x, shade) in [(at.wrapping_sub(1), 0), (at + 1, 0), (at, 255)] {
                if x < width {
                    row[3 * x..3 * x + 3].fill(shade);
                }
            }
        }
    }
}

impl Pixel {
    /// OPL of arrival \[m\].
    fn time(&self, kind: ArrivalTime) -> Option<f64> {
        match kind {
            ArrivalTime::Mean => (self.energy > 0.0).then(|| self.moment / self.energy),
            ArrivalTime::Peak => (self.peak.0 > 0.0).then_some(self.peak.1),
        }
    }
}
