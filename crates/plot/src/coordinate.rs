//! An axis as `plotters` asks for it: where values lie, where ticks stand, how they read.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::Scale;

/// A range of values on an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coordinate {
    pub(crate) scale: Scale,
    pub(crate) ends: (f64, f64),
}

impl Coordinate {
    fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.log10(),
        }
    }
}

impl Ranged for Coordinate {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let (start, end) = (self.place(self.ends.0), self.place(self.ends.1));
        // Ends are halved first: their difference may be too large for a number.
        let part = (self.place(*value) / 2.0 - start / 2.0) / (end / 2.0 - start / 2.0);
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let most = hint.max_num_points().clamp(2, 9) as u8;
        match self.scale {
            Scale::Linear => multiples(self.ends, most),
            Scale::Logarithmic => decades(self.ends, most),
        }
    }

    fn range(&self) -> Range<f64> {
        self.ends.0..self.ends.1
    }
}

impl ValueFormatter<f64> for Coordinate {
    fn format(value: &f64) -> String {
        read(*value)
    }

    fn format_ext(&self, value: &f64) -> String {
        read(*value)
    }
}

/// A number as a tick's label: short, with an exponent if it is large or small.
fn read(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&size) {
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').into()
    } else {
        let text = format!("{value:.4e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        format!("{digits}e{exponent}")
    }
}

/// The multiples of 1, 2 or 5 times a power of ten in a range, at most so many.
fn multiples((start, end): (f64, f64), most: u8) -> Vec<f64> {
    let rough = end / f64::from(most) - start / f64::from(most);
    let power = 10.0_f64.powf(rough.log10().floor());
    let fits = |step: &f64| (end / step).floor() - (start / step).ceil() < f64::from(most);
    let steps = [1.0, 2.0, 5.0, 10.0, 20.0].map(|factor| factor * power);
    let Some(step) = steps.into_iter().find(fits) else { return vec![start, end] };
    // Ends that are multiples themselves count, whatever the rounding of the quotient.
    let (first, last) = ((start / step - 1e-9).ceil(), (end / step + 1e-9).floor());
    // A range that is narrow for its distance from 0 has no multiples that f64 could tell apart.
    if !(step > 0.0 && first.is_finite() && last.is_finite() && last - first < f64::from(most)) {
        return vec![start, end];
    }
    (0..=(last - first) as usize).map(|index| (first + index as f64) * step).collect()
}

/// The powers of ten in a range, at most so many; where they are few, twice and five times them too.
fn decades((start, end): (f64, f64), most: u8) -> Vec<f64> {
    let (first, last) = (start.log10().ceil() as i32, end.log10().floor() as i32);
    if last - first < 2 {
        let inside = |value: &f64| (start..=end).contains(value);
        let fine = |power: i32| [1.0, 2.0, 5.0].map(|factor| factor * 10.0_f64.powi(power));
        return (first - 1..=last).flat_map(fine).filter(inside).take(usize::from(most)).collect();
    }
    let step = (last - first) / i32::from(most) + 1;
    (first..=last).filter(|power| power % step == 0).map(|power| 10.0_f64.powi(power)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        assert_eq!(multiples((0.0, 10.0), 6), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(multiples((-0.3, 0.4), 9).len(), 8);
        assert_eq!(decades((3e-4, 2e3), 9).len(), 7);
        assert_eq!(decades((1.5, 8.0), 9), [2.0, 5.0]);
        assert_eq!(decades((0.15, 11.0), 9), [0.2, 0.5, 1.0, 2.0, 5.0, 10.0]);
    }

    #[test]
    fn extreme_ranges_have_finitely_many_ticks() {
        for ends in [(-1e308, 1e308), (0.0, 5e-324), (1e16, 1e16 + 2.0), (-1e-300, 1e300)] {
            assert!(multiples(ends, 9).len() <= 11, "{ends:?}");
        }
        assert!(decades((1e-300, 1e300), 9).len() <= 11);
    }

    #[test]
    fn labels_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (0.5, "0.5"),
            (1000.0, "1000"),
            (-2.5e-7, "-2.5e-7"),
            (1e6, "1e6"),
            (0.1 + 0.2, "0.3"),
        ] {
            assert_eq!(read(value), text);
        }
    }

    #[test]
    fn places_are_shares_of_the_range() {
        let axis = |scale, ends| Coordinate { scale, ends };
        assert_eq!(axis(Scale::Linear, (-1.0, 3.0)).map(&0.0, (0, 100)), 25);
        assert_eq!(axis(Scale::Logarithmic, (1e-2, 1e2)).map(&1.0, (0, 100)), 50);
        assert_eq!(axis(Scale::Linear, (-1e308, 1e308)).map(&0.0, (0, 100)), 50);
    }
}
