//! The gallery: scenes that show what the renderer can do, rendered and put on one page.
//!
//! * [`catalogue`]: the scenes under `scenes/`, what they are called and what is seen in them.
//! * [`meshes`]: the meshes that they use, made from formulas; [`compass`]: an image, likewise.
//! * [`card`]: what is known of one rendered scene; [`page`]: all of them as one HTML page.
//! * [`agreement`]: do the methods agree on what they both render?
//!
//! Not handled: rendering itself, which is done by the program `tpb`, as a user would.

pub mod agreement;
pub mod card;
pub mod catalogue;
pub mod compass;
pub mod meshes;
pub mod page;
#[cfg(test)]
mod tests;

pub use card::Card;
pub use catalogue::{GalleryScene, scenes_in};
