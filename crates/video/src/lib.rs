//! Floor 2: videos of transient results.
//!
//! [`write_video`] paints the frames of [`Arrays`](tpb_film::Arrays) one after the other and hands
//! each to an encoder before the next is painted, so that memory does not grow with their number.
//! A video appears whole or not at all.
//!
//! | module | subject |
//! | --- | --- |
//! | `options` | what is shown, and how |
//! | `format` | file formats and their names |
//! | `exposure` | display white: one for all frames, or following them |
//! | `paint` | frames as samples: tone, hue of arrival, scale, label |
//! | `encode` | APNG, PNG, GIF; MP4 and WebM through the program ffmpeg |
//!
//! Bins count from 0, in ranges and labels, as in the arrays. Tone curves are those of
//! [`ToneMap`](tpb_film::ToneMap), as in pictures and in the viewer's pages. Frame k is the mean of the bins that it covers, so that brightness is energy per bin whatever
//! their number. Everything is deterministic but for what ffmpeg does.
//!
//! Not handled: unwarping. The film subtracts the leg to the first surface from each arrival as it
//! is deposited; rays of one pixel meet different surfaces, so bins cannot be shifted afterwards.

mod encode;
mod error;
mod exposure;
mod format;
mod options;
mod paint;
mod video;

pub use error::VideoError;
pub use format::Format;
pub use options::{MAX_FPS_GIF, MAX_SCALE, VideoOptions, White};
pub use video::{VideoReport, write_video};
