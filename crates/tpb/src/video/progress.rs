//! Progress of a video, and ctrl-c.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

/// Shows progress on standard error, if that is a terminal, and listens to ctrl-c.
pub(super) struct Bar {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
}

#[expect(clippy::exit, reason = "the second ctrl-c aborts, wherever the program is")]
fn on_interrupt(stop: &AtomicBool) {
    if stop.swap(true, Ordering::Relaxed) {
        std::process::exit(i32::from(super::INTERRUPTED));
    }
}

impl Bar {
    /// Shows the bar and takes over ctrl-c: the first ends the video at the next frame, the second
    /// ends the program at once.
    pub(super) fn new() -> Self {
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {elapsed} {pos}/{len} frames") {
            bar.set_style(style);
        }
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        // Where the system refuses a handler, ctrl-c aborts as usual.
        let _ = ctrlc::set_handler(move || on_interrupt(&asked));
        Self { bar, stop }
    }

    /// Shows how far it is.
    pub(super) fn show(&self, done: usize, total: usize) -> ControlFlow<()> {
        self.bar.set_length(total as u64);
        self.bar.set_position(done as u64);
        if self.interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Whether ctrl-c was pressed.
    pub(super) fn interrupted(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
