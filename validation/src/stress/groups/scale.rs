//! The size of a metre: from below micrometres to above light-years.

use crate::error::Result;
use crate::stress::case::{Case, Method, Setup, Work};
use crate::stress::groups::media::effort;
use crate::stress::laws::{near, refused, same_to_the_bit};
use crate::stress::shot::{Image, Shot};
use crate::stress::single::Single;
use crate::stress::world::Unit;
use crate::stress::worlds::{FILM, everything};

/// Radii in units of the room: the defaults follow the room, these need not be found.
const WORK: Work = Work { radius: Some(0.05), surface_radius: Some(0.1), ..Work::LITTLE };

fn image(setup: &Setup, method: Method, unit: Unit, work: &Work) -> Result<Image> {
    Shot::new(&everything(unit, FILM), method, work)?.render(setup.seed, 3)
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    // Even ones: roots of lengths are taken, too.
    for exponent in [-60, -20, 54, 60] {
        let length = 2.0_f64.powi(exponent);
        cases.push(Case::new(
            format!("scale/room-{length:.0e}-m"),
            "lengths in f32, absolute tolerances, defaults in metres",
            move |setup, method| {
                let (unit, same) = (Unit::of_length(length), Work::LITTLE);
                let given = same_to_the_bit(
                    &image(setup, method, Unit::SI, &WORK)?,
                    &image(setup, method, unit, &WORK)?,
                    1.0,
                );
                let chosen = same_to_the_bit(
                    &image(setup, method, Unit::SI, &same)?,
                    &image(setup, method, unit, &same)?,
                    1.0,
                );
                Ok(given.and(chosen))
            },
        ));
    }
    for length in [1e-6, 1e16] {
        cases.push(Case::new(
            format!("scale/room-{length:e}-m-decimal"),
            "as above, where every number in the file is rounded anew",
            move |setup, method| {
                let usual = image(setup, method, Unit::SI, &WORK)?;
                Ok(near(&usual, &image(setup, method, Unit::of_length(length), &WORK)?, 1.0, 1e-9))
            },
        ));
        cases.push(Case::new(
            format!("scale/fog-{length:e}-m"),
            "the same relative error against the exact value as in metres",
            move |setup, method| {
                let (work, passes) = effort(method);
                let single = Single { unit: Unit::of_length(length), ..Single::USUAL };
                single.agrees(method, &work, (setup.seed, passes), 1.0)
            },
        ));
    }
    cases.push(Case::new(
        "scale/index-4",
        "time that follows lengths where it should follow optical path lengths",
        |setup, method| {
            let work = Work { photons: 2000, ..Work::LITTLE };
            let image =
                |eta| Single { eta, ..Single::USUAL }.shot(method, &work)?.render(setup.seed, 4);
            Ok(same_to_the_bit(&image(1.0)?, &image(4.0)?, 1.0))
        },
    ));
    cases.push(Case::of_no_method("scale/too-large", "overflow of squares without a word", |_| {
        Ok(refused(&everything(Unit::of_length(1e21), FILM), &["exceeds 1e20 m", "$.sensor"]))
    }));
    cases.push(Case::of_no_method(
        "scale/too-small",
        "underflow of squares without a word",
        |_| {
            let world = everything(Unit::of_length(1e-21), FILM);
            Ok(refused(&world, &["not between 1e-20 and 1e20 m"]))
        },
    ));
    cases
}
