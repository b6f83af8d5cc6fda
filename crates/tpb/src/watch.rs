//! Progress bar and ctrl-c.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use tpb_film::{Arrays, PictureOptions};
use tpb_render::{Budget, Control, Progress};

use crate::print;

/// The exit code of a program that SIGINT ended.
const INTERRUPTED: i32 = 130;

/// The bar is redrawn this often, so that time goes on while a pass is long.
const TICK: Duration = Duration::from_millis(200);

/// Shows progress on standard error, if that is a terminal, and listens to ctrl-c.
pub(crate) struct Watch {
    bar: ProgressBar,
    budget: Budget,
    stop: Arc<AtomicBool>,
    preview: Option<(PathBuf, PictureOptions)>,
}

impl Watch {
    /// Shows the bar and takes over ctrl-c: the first asks the run to end after its pass, the
    /// second ends the program at once.
    ///
    /// The steady image so far is left in the file `preview` after 1, 2, 4, … passes.
    pub(crate) fn new(budget: Budget, preview: Option<(PathBuf, PictureOptions)>) -> Self {
        let length = match budget {
            Budget::Passes(passes) => passes,
            Budget::Time(time) => milliseconds(time),
        };
        let bar = ProgressBar::new(length);
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {elapsed} {msg}") {
            bar.set_style(style);
        }
        bar.set_message("first pass");
        bar.enable_steady_tick(TICK);
        let stop = Arc::new(AtomicBool::new(false));
        let (asked, shown) = (Arc::clone(&stop), bar.clone());
        // Where the system refuses a handler, ctrl-c aborts as usual.
        let _ = ctrlc::set_handler(move || on_interrupt(&asked, &shown));
        Self { bar, budget, stop, preview }
    }

    /// A preview that cannot be written is no reason to end: the result will say why.
    fn preview(&self, passes: u64, steady: &dyn Fn() -> Arrays) {
        if let Some((path, options)) = &self.preview
            && passes.is_power_of_two()
        {
            let _ = steady().write_steady_png(path, options);
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

#[expect(clippy::exit, reason = "the second ctrl-c aborts, wherever the program is")]
fn on_interrupt(stop: &AtomicBool, bar: &ProgressBar) {
    if stop.swap(true, Ordering::Relaxed) {
        std::process::exit(INTERRUPTED);
    }
    bar.suspend(|| print::err("ending after this pass; ctrl-c again aborts"));
}

impl Control for Watch {
    fn interrupted(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn progress(&mut self, progress: &Progress, steady: &dyn Fn() -> Arrays) {
        let Progress { passes, elapsed, remaining, relative_error } = *progress;
        self.bar.set_position(match self.budget {
            Budget::Passes(_) => passes,
            Budget::Time(time) => milliseconds(elapsed.min(time)),
        });
        let error = relative_error
            .map_or_else(String::new, |e| format!(", error {:.3} % (median of pixels)", 100.0 * e));
        let left = HumanDuration(remaining);
        self.preview(passes, steady);
        let plural = if passes == 1 { "" } else { "es" };
        self.bar.set_message(format!("{passes} pass{plural}{error}, {left:#} left"));
    }
}

fn milliseconds(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
