//! Whether a few bright pixels rule error numbers of squares and sums.
//!
//! Σr² of an image that sees a lamp is nearly all in the pixels that see it: RMSE, NMSE and the bias
//! then tell of those alone, whatever the rest looks like. Relative measures weigh all cells alike.

use std::fmt;
use std::ops::RangeInclusive;

use rayon::prelude::*;
use tpb_film::Arrays;

/// The part of the pixels that may rule.
const FEW: f64 = 0.01;

/// The share of Σr² with which they do.
const RULE: f64 = 0.5;

/// A few pixels with most of Σr².
#[derive(Clone, Debug, PartialEq)]
pub struct Ruling {
    /// How many.
    pub pixels: usize,
    /// Of how many.
    pub of: usize,
    /// Their share of Σr².
    pub share: f64,
    /// The columns within which they lie, from 0.
    pub columns: RangeInclusive<usize>,
    /// The rows within which they lie, from 0.
    pub rows: RangeInclusive<usize>,
}

impl Ruling {
    /// Whether the brightest 1 % of the pixels (of those chosen) hold more than half of Σr², over
    /// bins or, of a steady film, over the image.
    pub fn of(r: &Arrays, judged: Option<&[bool]>) -> Option<Self> {
        let square = |value: f64| if value.is_finite() { value * value } else { 0.0 };
        let squares = |pixel: usize| -> f64 {
            if r.bins > 0 {
                r.pixel(pixel).iter().map(|&cell| square(f64::from(cell))).sum()
            } else {
                let cells = &r.steady[pixel * r.channels..(pixel + 1) * r.channels];
                cells.iter().map(|&cell| square(cell)).sum()
            }
        };
        let chosen = (0..r.pixels()).into_par_iter();
        let chosen = chosen.filter(|&pixel| judged.is_none_or(|judged| judged[pixel]));
        let mut all: Vec<(f64, usize)> = chosen.map(|pixel| (squares(pixel), pixel)).collect();
        // The brightest first; of equals, in their order.
        all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let pixels = (FEW * all.len() as f64) as usize;
        let sum = |part: &[(f64, usize)]| part.iter().map(|(squares, _)| squares).sum::<f64>();
        let few = &all[..pixels];
        let share = sum(few) / sum(&all);
        // Not in a black image either, where the share is none.
        let rules = share > RULE;
        if !rules {
            return None;
        }
        let within = |at: fn(usize, usize) -> usize| {
            let places = || few.iter().map(|&(_, pixel)| at(pixel, r.width));
            places().min().unwrap_or(0)..=places().max().unwrap_or(0)
        };
        Some(Self {
            pixels,
            of: all.len(),
            share,
            columns: within(|pixel, width| pixel % width),
            rows: within(|pixel, width| pixel / width),
        })
    }
}

impl fmt::Display for Ruling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} of {} pixels, within columns {} to {} and rows {} to {}, hold {:.1} % of the \
             reference's Σr²: RMSE, NMSE and bias are theirs; relMSE, MAPE and SMAPE weigh all \
             cells alike",
            self.pixels,
            self.of,
            self.columns.start(),
            self.columns.end(),
            self.rows.start(),
            self.rows.end(),
            100.0 * self.share
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::cube;

    #[test]
    fn a_lamp_rules_and_is_found() {
        let mut arrays = cube(20, 15, 6, 3);
        arrays.transient.fill(1.0);
        assert_eq!(Ruling::of(&arrays, None), None);
        for pixel in [4 * 20 + 7, 5 * 20 + 9] {
            arrays.transient[pixel * 18 + 5] = 100.0;
        }
        let found = Ruling::of(&arrays, None).unwrap();
        assert_eq!((found.pixels, found.of), (3, 300));
        // The two, and the first of all others, which are alike.
        assert_eq!((found.columns.clone(), found.rows.clone()), (0..=9, 0..=5));
        let (few, all) = (2.0 * 10_017.0 + 18.0, 300.0 * 18.0 + 2.0 * 9_999.0);
        assert!((found.share - few / all).abs() < 1e-12, "{found:?}");
        assert!(found.to_string().contains("columns 0 to 9 and rows 0 to 5, hold 79.0 %"));
        // Not of what the mask keeps.
        let mut judged = vec![true; 300];
        for pixel in [4 * 20 + 7, 5 * 20 + 9] {
            judged[pixel] = false;
        }
        assert_eq!(Ruling::of(&arrays, Some(&judged)), None);
        arrays.transient[0] = f32::INFINITY;
        assert!(Ruling::of(&arrays, None).is_some(), "cells that are not finite are left out");
    }

    #[test]
    fn few_pixels_black_images_and_steady_films_are_no_exception() {
        let mut arrays = cube(9, 11, 2, 1);
        arrays.transient[4] = 1e6;
        assert_eq!(Ruling::of(&arrays, None), None, "99 pixels have no hundredth");
        let mut arrays = cube(20, 20, 2, 1);
        arrays.transient.fill(0.0);
        assert_eq!(Ruling::of(&arrays, None), None);
        arrays.bins = 0;
        arrays.steady[25] = 10.0;
        let found = Ruling::of(&arrays, None).unwrap();
        assert!(found.share > 0.99 && found.columns.contains(&5) && found.rows.contains(&1));
    }
}
