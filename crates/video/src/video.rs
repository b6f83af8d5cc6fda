//! From arrays to a file.

use std::ops::Range;
use std::path::Path;

use tpb_film::{Arrays, FilmError, atomic_write};

use crate::encode::{Progress, Reel, ffmpeg, gif, png};
use crate::paint::Painter;
use crate::{Format, VideoError, VideoOptions};

/// What became of a video.
#[derive(Clone, Debug, PartialEq)]
pub struct VideoReport {
    /// Pixels in a row and rows, with scale and padding.
    pub size: (usize, usize),
    /// Columns and rows of black at the right and below, so that sides are even.
    pub padding: (usize, usize),
    /// How many frames.
    pub frames: usize,
    /// The bins that they show.
    pub bins: Range<usize>,
    /// Bins of a frame; the last may have fewer.
    pub bins_per_frame: usize,
    /// What is display white before the exposure's stops: energy per bin or radiance
    /// \[W m^-2 sr^-1\].
    pub white: f64,
    /// Size of the file; 0 where it went to a pipe or device.
    pub bytes: u64,
}

/// Writes a video, whole or not at all. `progress` is told how many steps of how many are done
/// before each of them, and may stop it.
///
/// # Errors
/// [`VideoError::Option`], [`VideoError::TooLarge`], [`VideoError::Label`] for what cannot be made;
/// [`VideoError::Film`] without a time axis, or if the file cannot be written;
/// [`VideoError::NoFfmpeg`], [`VideoError::Ffmpeg`]; [`VideoError::Interrupted`] if it was stopped.
pub fn write_video(
    arrays: &Arrays,
    path: &Path,
    format: Format,
    options: &VideoOptions,
    progress: Progress<'_>,
) -> Result<VideoReport, VideoError> {
    let mut options = options.clone();
    if format == Format::Png {
        // One picture of all bins, exposed like the steady image.
        options.pictures.max_frames = 1;
        options.pictures.white_percentile = options.pictures.steady_white_percentile;
    }
    if arrays.bins == 0 {
        let reason = "a video needs a time axis; this film is steady";
        return Err(FilmError::Unsuitable(reason).into());
    }
    options.check(arrays, format)?;
    let painter = Painter::new(arrays, &options, format)?;
    let mut report = report(arrays, &options, &painter);
    let frames_per_second = options.pictures.frames_per_second;
    match format {
        Format::Png | Format::Apng => {
            let speed = (format == Format::Apng).then_some(frames_per_second);
            let mut reel = Reel::new(painter, 1, progress);
            let written = atomic_write(path, |file| png::write(&mut reel, speed, file));
            finished(&reel, written)?;
        }
        Format::Gif => {
            let rounds = gif::rounds(painter.channels());
            let mut reel = Reel::new(painter, rounds, progress);
            let written = atomic_write(path, |file| {
                gif::write(&mut reel, frames_per_second, options.dither, file)
            });
            finished(&reel, written)?;
        }
        Format::Mp4 | Format::Webm => {
            let mut reel = Reel::new(painter, 1, progress);
            ffmpeg::write(&mut reel, path, format, &options)?;
        }
    }
    report.bytes = path.metadata().map_or(0, |found| found.len());
    Ok(report)
}

/// A stop looks like a failure of the file until here.
fn finished(reel: &Reel<'_, '_>, written: Result<(), FilmError>) -> Result<(), VideoError> {
    if reel.stopped() {
        return Err(VideoError::Interrupted);
    }
    Ok(written?)
}

fn report(arrays: &Arrays, options: &VideoOptions, painter: &Painter<'_>) -> VideoReport {
    VideoReport {
        size: painter.size(),
        padding: painter.padding(),
        frames: painter.count(),
        bins: options.bins(arrays),
        bins_per_frame: painter.frames().per_frame(),
        white: painter.white(),
        bytes: 0,
    }
}
