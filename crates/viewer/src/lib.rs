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
//! | `reduce` | exact box means over pixels, sums over bins |
//! | `pack` | logarithmic codes, prediction, deflate |
//! | `page` | the budget, the manifest, the HTML |
//! | `assets` | style and scripts of the page, one subject a file |
//! | `load` | result folders, `.npz`, `.npy` |
//!
//! Not handled: results of different shapes or time axes; progressive loading of large pages.

mod assets;
mod comparison;
mod error;
mod load;
mod manifest;
mod metrics;
mod pack;
mod page;
mod reduce;
#[cfg(test)]
mod testing;

pub use comparison::{Comparison, DEFAULT_BUDGET, Method};
pub use error::ViewerError;
pub use load::{Loaded, bring_together, load};
pub use metrics::{FrameCurves, Half, Metrics};
pub use pack::{SE_ERROR, VALUE_ERROR};
pub use page::{PageReport, page, write_comparison};
pub use reduce::{Factors, reduce};
