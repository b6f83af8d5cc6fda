//! Textures of diffuse surfaces.

use std::sync::Arc;

use glam::{DAffine2, DMat2, DVec3};

use super::Builder;
use crate::Reflector;
use crate::description::{self as words, Reflectance};
use crate::load::tree::Node;
use crate::load::trouble::{Outcome, Trouble};
use crate::load::{names, transform};
use crate::texture::{Bitmap, Coordinates, Filter, Pattern, Texture, TextureId, Wrap};

impl Builder<'_> {
    /// A Lambertian reflector on a shape with these texture coordinates; `None` for a BSDF that no
    /// shape has yet: its texture is only checked.
    pub(super) fn diffuse(
        &mut self,
        reflectance: &Reflectance,
        node: &Node,
        coordinates: Option<&Coordinates>,
    ) -> Outcome<Reflector> {
        let (pattern, to_uv) = match reflectance {
            Reflectance::Colour(colour) => return Ok(Reflector::Diffuse(colour.rgb())),
            Reflectance::Checkerboard(board) => {
                (Pattern::Checkerboard([board.color0.rgb(), board.color1.rgb()]), &board.to_uv)
            }
            Reflectance::Bitmap(bitmap) => (self.bitmap(bitmap, node)?, &bitmap.to_uv),
        };
        let to_uv = plane(to_uv, node.get_or_self("to_uv"))?;
        let id = TextureId(self.textures.len() as u32);
        if let Some(coordinates) = coordinates {
            let coordinates = coordinates.clone();
            self.textures.push(Texture { pattern, to_uv, coordinates });
        }
        Ok(Reflector::Textured(id))
    }

    fn bitmap(&mut self, bitmap: &words::Bitmap, node: &Node) -> Outcome<Pattern> {
        let key = (self.directory.join(&bitmap.filename), bitmap.raw);
        let image = if let Some(known) = self.images.get(&key) {
            known.clone()
        } else {
            let image = Bitmap::load(&key.0, key.1).map_err(|problem| {
                let name = names::shortened(&bitmap.filename);
                let hint = || format!("images are looked for in `{}`", self.directory.display());
                Trouble::new(format!("cannot use the image file `{name}`: {problem}"))
                    .at(node.get_or_self("filename"))
                    .maybe_hint((!key.0.exists()).then(hint))
            })?;
            let image = Arc::new(image);
            self.images.insert(key, image.clone());
            image
        };
        let filter = match bitmap.filter_type {
            words::FilterType::Bilinear => Filter::Bilinear,
            words::FilterType::Nearest => Filter::Nearest,
        };
        let wrap = match bitmap.wrap_mode {
            words::WrapMode::Repeat => Wrap::Repeat,
            words::WrapMode::Mirror => Wrap::Mirror,
            words::WrapMode::Clamp => Wrap::Clamp,
        };
        Ok(Pattern::Bitmap(image, filter, wrap))
    }
}

/// What the steps do to the plane of u and v.
fn plane(steps: &words::Transform, node: &Node) -> Outcome<DAffine2> {
    let space = transform::to_affine(steps, node)?;
    let [x, y] = [space.matrix3.x_axis, space.matrix3.y_axis].map(DVec3::truncate);
    let matrix = DMat2::from_cols(x, y);
    Ok(DAffine2::from_mat2_translation(matrix, space.translation.truncate()))
}
