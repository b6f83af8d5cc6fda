//! Floor 4: experiments that compare the renderers with the analytic reference and with each
//! other, and the statistics that judge them.
//!
//! * [`statistics`]: batches, tests, equivalence, ratios, the split of an error.
//! * [`experiment`]: what an experiment is; [`sabotage`]: its sabotaged twins; [`registry`]: all.
//! * [`experiments`]: the questions themselves, one module for each subject.
//! * [`matrix`]: scenes, methods and media, each with each.
//! * [`cube`], [`contrasts`], [`measure`], [`comparison`]: time-resolved images as numbers, reduced to the few
//!   that are judged, batch by batch.
//! * [`memory`]: renders that are wanted again; [`microfacet`]: rough surfaces in textbook form.
//! * [`equal_time`]: methods against each other at equal time; [`judged`]: by whom, and in which
//!   pixels. [`long_render`]: the long render that they are compared with; [`reference_cube`]: the
//!   small file that ships of it. [`watch`]: who follows what takes long, and may end it.
//! * [`run_time`]: how the error of a method falls with the time it is given.
//! * [`peers`]: other programs side by side with ours.
//! * [`gallery`]: scenes that show what the renderer can do, and the page of them.
//! * [`reproduce`]: the source's figures made again, with errors.
//! * [`taps`]: photons at given optical path lengths, for what no camera sees.
//! * [`suite`]: running many; [`report`], [`pages`]: what is printed and what is kept of it;
//!   [`history`]: a run as a line for the dashboard.

mod artefacts;
pub mod comparison;
pub mod contrasts;
pub mod cube;
pub mod equal_time;
mod error;
pub mod expected;
pub mod experiment;
pub mod experiments;
pub mod gallery;
pub mod history;
pub mod judged;
pub mod long_render;
pub mod matrix;
pub mod measure;
pub mod memory;
pub mod microfacet;
pub mod pages;
pub mod peers;
pub mod reference_cube;
pub mod registry;
pub mod report;
pub mod reproduce;
pub mod run_time;
pub mod sabotage;
pub mod scenes;
pub mod statistics;
pub mod stress;
pub mod suite;
pub mod taps;
pub mod watch;

pub use error::{Result, ValidationError};
pub use tpb_render::with_threads;

pub use experiment::{Context, Effort, Experiment, Kind, Outcome, Verdict};
pub use sabotage::{Sabotage, Twin};
