//! The scenes of the matrix: one file each, and one line in [`all`].

mod ball;
mod floor;
mod fog;
mod fog_box;
mod interface;
mod lamp;
mod room;
mod rough;
mod texture;

use std::sync::Arc;

use tpb_scene::{IntegratorSpec, SceneParts};

use super::medium::{Channel, MatrixMedium};
use super::players::{Blur, Budget, Family, Kernels, Player};
use super::view::{Expected, Frame};
use crate::error::{Result, ValidationError};
use crate::experiment::Effort;
use crate::sabotage::Sabotage;
use crate::scenes::View;

/// A scene for every medium.
pub trait Case: Send + Sync {
    /// Its name in the names of rows.
    fn name(&self) -> &'static str;

    /// What is seen and compared, in a few words.
    fn question(&self) -> &'static str;

    /// Pixels and bins.
    fn frame(&self) -> Frame;

    /// Which depths count.
    fn integrator(&self) -> IntegratorSpec;

    /// Whether there is something to see in this medium.
    fn takes(&self, medium: &MatrixMedium) -> bool;

    /// Whether players of a family see what is seen here, with finite variance.
    fn admits(&self, family: Family) -> bool;

    /// Which kernels of beams play.
    fn kernels(&self) -> Kernels {
        Kernels::Alike
    }

    /// Whether what beams estimate is blurred.
    fn is_blurred(&self) -> bool {
        self.kernels() != Kernels::Alike
    }

    /// Whether [`Case::expected`] has a value.
    fn has_exact_value(&self) -> bool {
        true
    }

    /// The scene.
    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts;

    /// The exact cube of one channel: the truth, or what a kernel of this radius blurs it to.
    fn expected(&self, _: &Channel, _: Option<(Blur, f64)>) -> Result<Expected> {
        Err(ValidationError::unusable(self.name(), "has no exact value"))
    }

    /// What a player may do in a batch.
    fn budget(&self, player: &Player, medium: &MatrixMedium, effort: Effort) -> Budget;

    /// Blocks of pixels.
    fn groups(&self) -> Vec<(String, Vec<usize>)> {
        self.frame().quadrants()
    }

    /// Parts of equal energy in time.
    fn shares(&self) -> usize {
        6
    }

    /// The defects by which a player's row must be rejected.
    fn twins(&self, player: &Player, medium: &MatrixMedium) -> Vec<Sabotage>;

    /// What [`Sabotage::Cosine`] drops, pixel by pixel.
    fn dropped(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The view of its scene.
    fn view(&self) -> View {
        let Frame { side, fov, time } = self.frame();
        View { pixels: side, fov, time: Some(time), integrator: self.integrator() }
    }
}

/// All cases.
pub fn all() -> Vec<Arc<dyn Case>> {
    vec![
        Arc::new(lamp::Lamp),
        Arc::new(floor::Floor),
        Arc::new(fog::Fog),
        Arc::new(ball::Ball),
        Arc::new(room::Room),
        Arc::new(interface::Interface),
        Arc::new(rough::Rough),
        Arc::new(texture::Textured),
    ]
}
