//! Display white of each frame.
//!
//! One for all frames keeps brightnesses comparable and cannot flicker. Where it follows the
//! frames, the white of frame k is the geometric mean of the percentiles of the frames around it
//! within a quarter of a second, each held at or above 2⁻¹⁶ of the whole video's, so that noise of
//! frames that are almost dark is not blown up further. Black frames have no say.

use tpb_film::{Frames, white_level};

use crate::{VideoOptions, White};

/// A frame's own white is at least this part of the video's.
const DARKEST: f64 = 1.0 / 65_536.0;

/// Whites of the frames.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Exposure {
    /// Of the whole video.
    pub(crate) white: f64,
    /// Of each frame, where they differ.
    followed: Option<Vec<f64>>,
}

impl Exposure {
    pub(crate) fn new(frames: &Frames<'_>, options: &VideoOptions) -> Self {
        let percentile = options.pictures.white_percentile;
        let white = match options.white {
            White::Given(white) => white,
            White::Shared | White::Followed => frames.white(percentile),
        };
        let followed = (options.white == White::Followed).then(|| {
            let least = (white * DARKEST).max(f64::MIN_POSITIVE);
            let own = |frame| {
                let lit = frames.luminances(frame).any(|luminance| luminance > 0.0);
                lit.then(|| white_level(frames.luminances(frame), percentile).max(least).ln())
            };
            let logarithms: Vec<Option<f64>> = (0..frames.count()).map(own).collect();
            let reach = usize::from(options.pictures.frames_per_second / 4);
            let smooth = smooth(&logarithms, reach).into_iter();
            smooth.map(|logarithm| logarithm.map_or(white, f64::exp)).collect()
        });
        Self { white, followed }
    }

    /// The white of one frame.
    pub(crate) fn of(&self, frame: usize) -> f64 {
        self.followed.as_ref().map_or(self.white, |whites| whites[frame])
    }

    /// Stops that a frame is brighter than the video's own exposure, if it follows the frames.
    pub(crate) fn stops(&self, frame: usize) -> Option<f64> {
        self.followed.as_ref().map(|whites| (self.white / whites[frame]).log2())
    }
}

/// Means of what there is within `reach` neighbours on both sides; fewer at the ends.
fn smooth(values: &[Option<f64>], reach: usize) -> Vec<Option<f64>> {
    let mean = |index: usize| {
        let reach = reach.min(index).min(values.len() - 1 - index);
        let around = || values[index - reach..=index + reach].iter().flatten();
        let count = around().count();
        (count > 0).then(|| around().sum::<f64>() / count as f64)
    };
    (0..values.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smoothing_keeps_lines_spreads_steps_and_leaves_gaps_out() {
        let line: Vec<Option<f64>> = (0..9).map(|i| Some(f64::from(i))).collect();
        assert_eq!(smooth(&line, 3), line, "symmetrical windows, also at the ends");
        let step = [0.0, 0.0, 3.0, 3.0].map(Some);
        assert_eq!(smooth(&step, 1), [0.0, 1.0, 2.0, 3.0].map(Some));
        assert_eq!(smooth(&[Some(5.0)], 4), [Some(5.0)]);
        let gap = [Some(2.0), None, Some(4.0), None, None, None];
        assert_eq!(smooth(&gap, 1), [Some(2.0), Some(3.0), Some(4.0), Some(4.0), None, None]);
    }
}
