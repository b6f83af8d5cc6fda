//! The matrix: scenes × methods × media, each against the exact values, or methods against each
//! other where there are none.
//!
//! * A **medium** is a line of [`MEDIA`]; a **player** is a line of [`PLAYERS`]: a method with the
//!   options that matter, and what it estimates without bias, the truth or a blur.
//! * A **case** is a file of [`cases`] and a line of [`cases::all`]: it builds the scene for a
//!   medium, says which scattering order counts, and gives the exact cube where there is one.
//! * A [`row::Row`] judges one player; a [`pair::Pair`] judges the difference of two where no exact
//!   cube exists.
//!
//! | case | orders | exact value |
//! | --- | --- | --- |
//! | `lamp` | 0: an area lamp seen through a medium | exp(−sigma_t d) in its bin |
//! | `floor` | 1 on a surface, through a medium that absorbs | reflected light of a point lamp |
//! | `fog` | 1 in a medium, camera inside | single scattering; expected blur of each kernel |
//! | `ball` | 1 in a medium, camera outside | quadrature along each ray of a fog ball |
//! | `room` | all: fog in a box, a diffuse floor in it | none: methods against each other |
//! | `interface` | 1 at rough glass with a lamp in it | textbook BTDF, averaged over pixels |
//! | `texture` | all: textures, a smooth mesh, directional light | none: methods against each other |
//! | `rough` | all: rough glass and rough metal in fog | none: methods against each other |

pub mod cases;
pub mod medium;
pub mod pair;
pub mod players;
pub mod row;
pub mod view;

use std::sync::Arc;

pub use medium::{MEDIA, MatrixMedium};
pub use players::{PLAYERS, Player};

use crate::experiment::Effort;
use crate::registry::Experiments;

/// All rows.
pub fn all(effort: Effort) -> Experiments {
    let mut list = Experiments::new();
    for case in cases::all() {
        for medium in MEDIA.iter().filter(|medium| case.takes(medium)) {
            let players = PLAYERS.iter().filter(|player| player.plays(&*case, medium));
            if case.has_exact_value() {
                list.extend(
                    players.map(|player| {
                        Arc::new(row::Row { case: case.clone(), medium, player }) as _
                    }),
                );
            } else {
                list.extend(players.filter(|player| !player.is_baseline()).map(|player| {
                    Arc::new(pair::Pair { case: case.clone(), medium, player }) as _
                }));
            }
        }
    }
    if effort == Effort::Quick {
        list.retain(|row| QUICK.contains(&row.name().as_str()));
    }
    list
}

/// The rows that the quick suite keeps: each case, method, and kind of medium once.
const QUICK: [&str; 9] = [
    "matrix/lamp/coloured/path",
    "matrix/floor/absorbing/path",
    "matrix/fog/forward/path",
    "matrix/fog/isotropic/beams-1d",
    "matrix/fog/backward/beams-2d",
    "matrix/ball/coloured/path",
    "matrix/ball/backward/light",
    "matrix/room/isotropic/beams-1d",
    "matrix/interface/absorbing/path",
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_case_medium_and_player_has_a_row() {
        let names: Vec<String> = all(Effort::Full).iter().map(|row| row.name()).collect();
        let parts = |index: usize| -> BTreeSet<&str> {
            names.iter().filter_map(|name| name.split('/').nth(index)).collect()
        };
        let of = |names: &[&'static str]| names.iter().copied().collect::<BTreeSet<_>>();
        assert_eq!(parts(1), cases::all().iter().map(|case| case.name()).collect());
        assert_eq!(parts(2), of(&MEDIA.map(|medium| medium.name)));
        assert_eq!(parts(3), PLAYERS.iter().map(|player| player.name).collect());
    }

    #[test]
    fn the_quick_rows_exist() {
        let names: BTreeSet<String> = all(Effort::Full).iter().map(|row| row.name()).collect();
        for name in QUICK {
            assert!(names.contains(name), "{name}");
        }
    }
}
