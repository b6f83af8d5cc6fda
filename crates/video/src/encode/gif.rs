//! GIF: one palette for all frames, and of each frame only what changed.
//!
//! Greys are kept exactly: their palette is all 256 of them. Colours take two rounds over the
//! frames, one that draws colours for the palette and one that encodes. A frame covers the
//! rectangle that changed; within it, pixels that did not are transparent.
//!
//! Delays are multiples of 1/100 s: those of consecutive frames are rounded so that their sums are
//! right to 1/200 s.

use std::borrow::Cow;
use std::io::{self, Write};

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use super::Reel;
use super::palette::{Draw, Palette};

/// How many times [`write()`] plays the frames.
pub(crate) fn rounds(channels: usize) -> usize {
    if channels == 3 { 2 } else { 1 }
}

/// Writes all frames, which play for ever.
pub(crate) fn write(
    reel: &mut Reel<'_, '_>,
    frames_per_second: u16,
    dither: bool,
    file: &mut impl Write,
) -> io::Result<()> {
    let palette = if reel.channels() == 3 { Some(palette(reel)?) } else { None };
    let greys = || (0..=255).flat_map(|grey| [grey; 3]).collect();
    let (width, height) = reel.size();
    let (columns, rows) = (side(width)?, side(height)?);
    let table: Vec<u8> = palette.as_ref().map_or_else(greys, Palette::samples);
    let transparent = palette.as_ref().and_then(|palette| u8::try_from(palette.len()).ok());
    let mut encoder = Encoder::new(file, columns, rows, &table).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let mut shown: Option<Vec<u8>> = None;
    let mut number = 0;
    reel.play(|samples| {
        let indices = match &palette {
            Some(palette) => palette.indices(samples, width, dither),
            None => samples.to_vec(),
        };
        let area = shown
            .as_ref()
            .map_or(Area::whole(width, height), |shown| Area::of_changes(shown, &indices, width));
        let frame = Frame {
            delay: delay(number, frames_per_second),
            dispose: DisposalMethod::Keep,
            transparent,
            left: side(area.left)?,
            top: side(area.top)?,
            width: side(area.width)?,
            height: side(area.height)?,
            buffer: Cow::Owned(area.cut(&indices, shown.as_deref(), width, transparent)),
            ..Frame::default()
        };
        encoder.write_frame(&frame).map_err(failed)?;
        number += 1;
        shown = Some(indices);
        Ok(())
    })?;
    // Writes the trailer.
    encoder.into_inner().map_err(failed)?;
    Ok(())
}

/// The colours of all frames.
fn palette(reel: &mut Reel<'_, '_>) -> io::Result<Palette> {
    let (width, height) = reel.size();
    let mut draw = Draw::new(reel.count() * width * height);
    reel.play(|samples| {
        draw.see(samples);
        Ok(())
    })?;
    Ok(draw.palette())
}

/// Delay of frame `number` \[1/100 s\].
fn delay(number: u64, frames_per_second: u16) -> u16 {
    let rate = u64::from(frames_per_second);
    let until = |frame: u64| (200 * frame + rate) / (2 * rate);
    u16::try_from(until(number + 1) - until(number)).unwrap_or(u16::MAX)
}

fn side(side: usize) -> io::Result<u16> {
    u16::try_from(side).map_err(io::Error::other)
}

/// Errors of the file stay what they are.
fn failed(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// A part of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Area {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Area {
    fn whole(width: usize, height: usize) -> Self {
        Self { left: 0, top: 0, width, height }
    }

    /// Where two pictures differ; one pixel, if nowhere.
    fn of_changes(old: &[u8], new: &[u8], width: usize) -> Self {
        let (mut left, mut right, mut top, mut bottom) = (width, 0, usize::MAX, 0);
        for (y, (old, new)) in old.chunks_exact(width).zip(new.chunks_exact(width)).enumerate() {
            let differs = |x: &usize| old[*x] != new[*x];
            let Some(first) = (0..width).find(differs) else { continue };
            let last = (first..width).rev().find(differs).unwrap_or(first);
            (left, right) = (left.min(first), right.max(last));
            (top, bottom) = (top.min(y), y);
        }
        if top == usize::MAX {
            return Self { left: 0, top: 0, width: 1, height: 1 };
        }
        Self { left, top, width: right - left + 1, height: bottom - top + 1 }
    }

    /// Its indices, transparent where nothing changed.
    fn cut(self, new: &[u8], old: Option<&[u8]>, row: usize, transparent: Option<u8>) -> Vec<u8> {
        let mut cut = Vec::with_capacity(self.width * self.height);
        for y in self.top..self.top + self.height {
            let columns = y * row + self.left..y * row + self.left + self.width;
            match (old, transparent) {
                (Some(old), Some(transparent)) => {
                    let pairs = new[columns.clone()].iter().zip(&old[columns]);
                    cut.extend(pairs.map(|(&n, &o)| if n == o { transparent } else { n }));
                }
                _ => cut.extend_from_slice(&new[columns]),
            }
        }
        cut
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_add_up_to_the_speed() {
        for rate in [1, 3, 7, 20, 24, 30, 50] {
            let frames = 10 * u64::from(rate);
            let sum: u64 = (0..frames).map(|f| u64::from(delay(f, rate))).sum();
            assert_eq!(sum, 1000, "{rate} per second");
            let shortest = (0..frames).map(|f| delay(f, rate)).min();
            assert!(shortest >= Some(2), "{rate} per second: browsers slow down shorter ones");
        }
        assert_eq!(delay(5, 20), 5);
    }

    #[test]
    fn only_what_changed_is_cut_out() {
        let old = [0, 0, 0, 0, 1, 1, 0, 0, 2, 0, 0, 0];
        let mut new = old;
        assert_eq!(Area::of_changes(&old, &new, 4), Area { left: 0, top: 0, width: 1, height: 1 });
        (new[5], new[10]) = (7, 8);
        let area = Area::of_changes(&old, &new, 4);
        assert_eq!(area, Area { left: 1, top: 1, width: 2, height: 2 });
        assert_eq!(area.cut(&new, Some(&old), 4, Some(9)), [7, 9, 9, 8]);
        assert_eq!(area.cut(&new, Some(&old), 4, None), [7, 0, 0, 8]);
        assert_eq!(Area::whole(4, 3).cut(&new, None, 4, Some(9)), new);
    }
}
