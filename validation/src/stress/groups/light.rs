//! The size of a watt: no light, hardly any, and far too much.

use crate::error::Result;
use crate::stress::case::{Case, Finding, Method, Setup, Work};
use crate::stress::laws::{near, refused, same_to_the_bit, says};
use crate::stress::shot::{Image, Shot};
use crate::stress::world::Unit;
use crate::stress::worlds::{FILM, everything};

fn image(setup: &Setup, method: Method, light: f64) -> Result<Image> {
    let unit = Unit { light, ..Unit::SI };
    Shot::new(&everything(unit, FILM), method, &Work::LITTLE)?.render(setup.seed, 2)
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = vec![Case::new(
        "light/0",
        "a choice among lamps of no power, 0/0 in reports",
        |setup, method| {
            let total = image(setup, method, 0.0)?.total();
            Ok(Finding::exact(total == 0.0, format!("sum {total:e}, exactly 0")))
        },
    )];
    for exponent in [-60, 90] {
        let factor = 2.0_f64.powi(exponent);
        cases.push(Case::new(
            format!("light/{factor:.0e}"),
            "thresholds in watts",
            move |setup, method| {
                let usual = image(setup, method, 1.0)?;
                Ok(same_to_the_bit(&usual, &image(setup, method, factor)?, factor))
            },
        ));
    }
    for factor in [1e30, 1e-30] {
        cases.push(Case::new(
            format!("light/{factor:e}-decimal"),
            "as above, where every number in the file is rounded anew",
            move |setup, method| {
                let usual = image(setup, method, 1.0)?;
                Ok(near(&usual, &image(setup, method, factor)?, factor, 1e-9))
            },
        ));
    }
    for (name, factor, part) in
        [("too-bright", 1e60, "lower all powers"), ("subnormal", 1e-60, "raise all powers")]
    {
        cases.push(Case::new(
            format!("light/{name}"),
            "cells are 32-bit floats: infinities, or zeros for light, without a word",
            move |setup, method| match image(setup, method, factor) {
                Ok(_) => Ok(Finding::exact(false, "not a word")),
                Err(error) => Ok(says(&error.to_string(), &[part, "32-bit"])),
            },
        ));
    }
    for light in [1e-320, 1e305] {
        cases.push(Case::of_no_method(
            format!("light/{light:e}-refused"),
            "powers whose products leave f64: black images, open ledgers",
            move |_| {
                let unit = Unit { light, ..Unit::SI };
                Ok(refused(&everything(unit, FILM), &["1e-100 to 1e100", "$."]))
            },
        ));
    }
    cases
}
