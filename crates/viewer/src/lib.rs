//! Floor 2: results of one scene side by side: error numbers, and one self-contained HTML page.
//!
//! A [`Comparison`] names its [`Method`]s: arrays of one shape, one of them perhaps the reference.
//! [`write_comparison`] packs them into a page that opens from a file and asks the network for
//! nothing; [`Metrics`] are its error numbers, for other readers too; [`load()`] reads results, also
//! the cubes of other programs.
//!
//! | module | subject |
//! | --- | --- |
//! | [`comparison`](Comparison) | what is compared |
//! | [`metrics`](Metrics) | error numbers against the reference |
//! | [`ruling`](Ruling) | whether a few pixels rule them |
//! | [`interval`](Estimate) | 95 % intervals from few batches |
//! | `reduce` | exact box means over pixels, sums over bins |
//! | `pack` | logarithmic codes, prediction, deflate |
//! | `page` | the budget, the manifest, the HTML |
//! | `assets` | style and scripts of the page, one subject a file |
//! | `load` | result folders, `.npz`, `.npy` |
//!
//! ```no_run
//! use tpb_viewer::{Comparison, Method, write_comparison};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (path, long) = (tpb_viewer::load("path".as_ref())?, tpb_viewer::load("long".as_ref())?);
//! let mut reference = Method::new("reference", "path tracing, 1 h", &long.arrays);
//! reference.is_reference = true;
//! let mut method = Method::new("path", "path tracing, 20 s", &path.arrays);
//! method.provenance.push(("seed".into(), "7".into()));
//! method.command = Some("tpb render scene.json --method path --passes 12 --seed 7".into());
//! let comparison = Comparison::new("Cornell blocks", vec![method, reference]);
//! let report = write_comparison("page.html".as_ref(), &comparison)?;
//! assert!(report.bytes <= comparison.budget_bytes);
//! # Ok(())
//! # }
//! ```
//!
//! A link may say what is shown first: `page.html#method=path&view=error&bin=40&pixel=12,30`, also
//! `exposure` (stops), `curve` and `theme`; views are `frame`, `steady`, `xt`, `yt`, `arrival`, `mean`,
//! `peak`, `error`, `steady-error`, `before`, `after`.
//!
//! Bins, columns and rows count from 0, as in the arrays, in links, labels and everything that the
//! page says; they are those of the results, also where the cubes of the page are reduced.
//!
//! Not handled: results of different shapes or time axes; progressive loading of large pages.

mod assets;
mod comparison;
mod error;
mod interval;
mod load;
mod manifest;
mod metrics;
mod pack;
mod page;
mod reduce;
mod ruling;
#[cfg(test)]
mod testing;

pub use comparison::{Comparison, DEFAULT_BUDGET, Method};
pub use error::ViewerError;
pub use interval::Estimate;
pub use load::{Loaded, bring_together, load, load_mask};
pub use metrics::{FrameCurves, Half, Metrics};
pub use pack::{SE_ERROR, VALUE_ERROR};
pub use page::{PageReport, page, write_comparison};
pub use reduce::{Factors, PixelErrors, reduce};
pub use ruling::Ruling;
