//! Floor 2: the pass loop, written once for every method.
//!
//! * [`Method`]: what a rendering method is — one pure function per pass.
//! * [`run`]: budget, progress, interruption.
//! * [`Report`]: what is written beside the arrays.

mod method;

pub use method::{Counts, Method, PassId, PassReport};
