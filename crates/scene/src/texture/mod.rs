//! Textures: reflectances that change over a surface.
//!
//! A [`Texture`] belongs to one shape: it holds a pattern, Mitsuba's texture coordinates of that
//! shape ([`Coordinates`]), and `to_uv`, which moves them. What a pattern says between its texels
//! needs no derivative and no filter over an area: pixels are sampled.

mod bitmap;
mod coordinates;

use std::sync::Arc;

use glam::{DAffine2, DVec2, DVec3};
use tpb_optics::Rgb;

use crate::Primitive;
pub use bitmap::{Bitmap, Filter, Wrap};
pub use coordinates::Coordinates;

/// Index into [`crate::Scene::textures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureId(pub u32);

/// A pattern on one shape.
#[derive(Clone, Debug)]
pub struct Texture {
    /// What is seen at which texture coordinates.
    pub pattern: Pattern,
    /// Moves texture coordinates before they are looked up.
    pub to_uv: DAffine2,
    /// Texture coordinates of a point of the shape.
    pub coordinates: Coordinates,
}

/// What is seen at which texture coordinates.
#[derive(Clone, Debug)]
pub enum Pattern {
    /// Squares of half a unit: the first colour where both coordinates are in the same half.
    Checkerboard([Rgb; 2]),
    /// An image over the unit square, its first row at v = 0.
    Bitmap(Arc<Bitmap>, Filter, Wrap),
}

impl Texture {
    /// The value at a point of a primitive of the shape.
    pub fn at(&self, primitive: &Primitive, position: DVec3) -> Rgb {
        let uv = self.coordinates.uv(primitive, position);
        let uv = self.to_uv.transform_point2(uv);
        match &self.pattern {
            Pattern::Checkerboard(colours) => colours[usize::from(is_odd(uv))],
            Pattern::Bitmap(image, filter, wrap) => image.at(uv, *filter, *wrap),
        }
    }

    /// The largest value of each channel.
    pub fn most(&self) -> Rgb {
        match &self.pattern {
            Pattern::Checkerboard([a, b]) => {
                tpb_optics::Spectrum(std::array::from_fn(|c| a[c].max(b[c])))
            }
            Pattern::Bitmap(image, ..) => image.most(),
        }
    }

    /// Whether it has no colour.
    pub fn is_achromatic(&self) -> bool {
        match &self.pattern {
            Pattern::Checkerboard(colours) => colours.iter().all(|c| c.is_achromatic()),
            Pattern::Bitmap(image, ..) => image.is_achromatic(),
        }
    }
}

/// Whether a point is on a square of the second colour.
fn is_odd(uv: DVec2) -> bool {
    let half = uv - uv.floor();
    (half.x > 0.5) != (half.y > 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_alternate_across_the_whole_plane() {
        for (u, v, odd) in [
            (0.2, 0.2, false),
            (0.7, 0.2, true),
            (0.2, 0.7, true),
            (0.7, 0.7, false),
            (-0.2, 0.2, true),
            (-0.7, 5.2, false),
        ] {
            assert_eq!(is_odd(DVec2::new(u, v)), odd, "{u} {v}");
        }
    }
}
