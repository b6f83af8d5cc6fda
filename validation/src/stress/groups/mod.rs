//! All cases, one file for each subject.

pub mod light;
pub mod media;
pub mod places;
pub mod rough;
pub mod scale;
pub mod sizes;
pub mod time;

use crate::stress::case::Case;

/// All cases, in the order of the table.
pub fn all() -> Vec<Case> {
    let groups = [
        media::cases(),
        scale::cases(),
        time::cases(),
        places::cases(),
        light::cases(),
        sizes::cases(),
        rough::cases(),
    ];
    groups.into_iter().flatten().collect()
}
