//! Encoders: frames in, files out.
//!
//! * [`png`]: PNG and APNG;
//! * [`gif`], with [`palette`]: 256 colours for all frames;
//! * [`ffmpeg`]: MP4 and WebM, by another program.

pub(crate) mod ffmpeg;
pub(crate) mod gif;
mod palette;
pub(crate) mod png;

use std::io;
use std::ops::ControlFlow;

use crate::paint::Painter;

/// Told how many frames of how many are done; may ask to stop.
pub(crate) type Progress<'p> = &'p mut dyn FnMut(usize, usize) -> ControlFlow<()>;

/// Frames as encoders see them.
pub(crate) struct Reel<'a, 'p> {
    painter: Painter<'a>,
    progress: Progress<'p>,
    /// Times that all frames will be painted, and frames painted so far.
    rounds: usize,
    painted: usize,
    stopped: bool,
}

impl<'a, 'p> Reel<'a, 'p> {
    pub(crate) fn new(painter: Painter<'a>, rounds: usize, progress: Progress<'p>) -> Self {
        Self { painter, progress, rounds, painted: 0, stopped: false }
    }

    /// Paints all frames in their order.
    ///
    /// # Errors
    /// Those of `each`, and any if [`Reel::stopped`].
    pub(crate) fn play(&mut self, mut each: impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        let total = self.rounds * self.painter.count();
        for frame in 0..self.painter.count() {
            if (self.progress)(self.painted, total).is_break() {
                self.stopped = true;
                return Err(io::Error::other("stopped"));
            }
            each(self.painter.paint(frame))?;
            self.painted += 1;
        }
        Ok(())
    }

    /// Whether the progress was asked to stop.
    pub(crate) fn stopped(&self) -> bool {
        self.stopped
    }

    /// How many frames there are.
    pub(crate) fn count(&self) -> usize {
        self.painter.count()
    }

    /// Width and height in pixels.
    pub(crate) fn size(&self) -> (usize, usize) {
        self.painter.size()
    }

    /// Samples of a pixel: 3, or 1 for greys.
    pub(crate) fn channels(&self) -> usize {
        self.painter.channels()
    }
}
