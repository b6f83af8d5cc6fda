//! Participating media, and the regions of space that they fill.

use tpb_optics::{Coefficients, Phase};

/// Index into [`crate::Scene::media`].
#[cfg(not(feature = "vacuum"))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct MediumId(pub u32);

/// What a program without media has instead of an index: there is none. A `None` of it takes no room,
/// and the compiler leaves out all that a `Some` would lead to.
#[cfg(feature = "vacuum")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MediumId {}

impl MediumId {
    /// Of an index; `None` in a program without media.
    #[cfg(not(feature = "vacuum"))]
    #[expect(clippy::unnecessary_wraps, reason = "a program without media has none")]
    pub(crate) fn of_index(index: usize) -> Option<Self> {
        Some(Self(index as u32))
    }

    /// Of an index; `None` in a program without media.
    #[cfg(feature = "vacuum")]
    pub(crate) fn of_index(_: usize) -> Option<Self> {
        None
    }

    /// The index.
    #[cfg(not(feature = "vacuum"))]
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The index.
    #[cfg(feature = "vacuum")]
    #[inline]
    pub fn index(self) -> usize {
        match self {}
    }
}

/// A homogeneous medium.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Its id in the scene file, for messages.
    pub name: String,
    /// Coefficients \[1/m\].
    pub coefficients: Coefficients<3>,
    /// Phase function.
    pub phase: Phase,
    /// Refractive index given with the medium itself (extension), if any.
    pub eta: Option<f64>,
}

/// What a ray travels in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The medium, or vacuum.
    pub medium: Option<MediumId>,
    /// Refractive index.
    pub eta: f64,
}

impl Region {
    /// Empty space.
    pub const VACUUM: Self = Self { medium: None, eta: 1.0 };
}

/// The media on the two sides of a shape that bounds media; `None` is vacuum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MediumBoundary {
    /// Opposite to the normal.
    pub interior: Option<MediumId>,
    /// On the side of the normal.
    pub exterior: Option<MediumId>,
}

impl MediumBoundary {
    /// The medium on one side.
    #[inline]
    pub fn side(&self, front: bool) -> Option<MediumId> {
        if front { self.exterior } else { self.interior }
    }
}
