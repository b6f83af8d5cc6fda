//! Floor 2: the pass loop, written once for every method.
//!
//! * [`Method`]: what a rendering method is — one pure function per pass.
//! * [`run()`]: passes into a film, until a [`Budget`] is used up or a [`Control`] interrupts.
//! * [`RenderOptions`], [`FilmSetup`]: a render as data, and the film that scene, plan and options
//!   ask for.
//! * [`Report`]: what is written beside the arrays.
//!
//! A render is: start a [`Stopwatch`], prepare the method, make the film, [`run()`] within
//! [`with_threads`], [`FilmSetup::develop`]. Replicates are runs with other seeds into other films.

mod budget;
mod clock;
mod error;
mod job;
mod memory;
mod method;
mod report;
mod run;

pub use budget::Budget;
pub use clock::Stopwatch;
pub use error::RenderError;
pub use job::{FilmSetup, RenderOptions};
pub use memory::{amount, peak_memory};
pub use method::{Counts, Method, PassId, PassReport};
pub use report::{FilmRecord, MethodRecord, Outcome, Rates, Report, SceneRecord};
pub use run::{
    Control, LedgerRecord, Milestone, Progress, RunSettings, RunSummary, run, with_threads,
};
