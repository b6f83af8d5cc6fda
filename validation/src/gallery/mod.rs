//! The gallery: scenes that show what the renderer can do, rendered and put on one page.
//!
//! * [`catalogue`]: the scenes under `scenes/`, what they are called and what is seen in them.
//! * [`meshes`]: the meshes that they use, made from formulas; [`compass`]: an image, likewise.
//! * [`card`]: what is known of one rendered scene; [`page`]: all of them as one HTML page.
//! * [`agreement`]: which methods render a scene, and do they agree on what they both render?
//! * [`order`]: what was asked for, so that it is not made twice.
//!
//! Not handled: rendering itself, which is done by the program `tpb`, as a user would.

pub mod agreement;
pub mod card;
pub mod catalogue;
pub mod compass;
pub mod meshes;
pub mod order;
pub mod page;
#[cfg(test)]
mod tests;

pub use card::Card;
pub use catalogue::{GalleryScene, scenes_in};
pub use order::{Beside, Order};
