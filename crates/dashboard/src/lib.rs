//! Floor 2: the dashboard, one self-contained folder, and the histories that feed it.
//!
//! [`write()`] reads what other programs left ([`Sources`]) and writes `index.html`, which opens from
//! a file and asks the network for nothing, `data.json` with the same data, and `pages` with copies of
//! the pages that it links: the folder can be moved, packed and sent. It runs nothing and
//! makes nothing up: where data are missing, the page names the command that makes them.
//!
//! | module | subject |
//! | --- | --- |
//! | [`lines`] | files of one JSON object per line that grow at their end |
//! | [`history`] | the format of the validation suite's runs |
//! | [`benchmarks`] | the format of benchmarks; what Criterion.rs left as lines of it |
//! | [`bench_runs`] | the format of runs of all benchmarks, and how they are compared |
//! | [`curves`] | errors against run time |
//! | `bench_rows` | cases of runs, each with its change |
//! | `overview` | every experiment with its latest result and its history |
//! | `shelves` | pages of other commands |
//! | `copies` | their copies |
//! | `page` | the files that are written |
//!
//! A link may say what is shown first: `index.html#tab=errors&scene=cornell-blocks&clock=wall`; also
//! `find`, `verdict`, `open` (an experiment), `metric`, `base`, `theme`; tabs are `overview`,
//! `errors`, `benchmarks`, `pages`.
//!
//! Not handled: watching files; several workspaces on one page.

mod assets;
mod bench_rows;
pub mod bench_runs;
pub mod benchmarks;
mod copies;
pub mod curves;
mod error;
pub mod history;
pub mod lines;
mod overview;
mod page;
mod shelves;

pub use error::DashboardError;
pub use overview::Planned;
pub use page::{DashboardReport, Sources, write};
pub use shelves::Shelf;
