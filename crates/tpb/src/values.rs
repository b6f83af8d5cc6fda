//! Values with units on the command line.

use std::num::NonZeroUsize;
use std::time::Duration;

use tpb_film::Pulse;

/// More threads than this are a typing error.
const MAX_THREADS: usize = 1024;

/// Units of time, with their seconds; the longest names first.
const UNITS: [(&str, f64); 10] = [
    ("min", 60.0),
    ("ms", 1e-3),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("ns", 1e-9),
    ("ps", 1e-12),
    ("fs", 1e-15),
    ("s", 1.0),
    ("m", 60.0),
    ("h", 3600.0),
];

/// A number.
fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("'{}' is not a number", text.trim()))
}

/// A time with a unit, in seconds; perhaps not finite.
fn any_seconds(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let unit = UNITS.into_iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, unit)));
    let Some((count, unit)) = unit else {
        return Err("a time needs a unit: 20s, 500ms, 3m, 1h, 30ps".to_owned());
    };
    Ok(number(count)? * unit)
}

/// A positive time with a unit, in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = any_seconds(text)?;
    if seconds > 0.0 && seconds.is_finite() {
        Ok(seconds)
    } else {
        Err("a time must be positive and finite".to_owned())
    }
}

/// `20s`, `500ms`, `3m`, `1.5h`.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    Duration::try_from_secs_f64(seconds(text)?).map_err(|e| e.to_string())
}

/// `delta`, `gaussian:30ps`, `box:50ps`, `continuous`.
pub(crate) fn pulse(text: &str) -> Result<Pulse, String> {
    match text.split_once(':') {
        None if text == "delta" => Ok(Pulse::Delta),
        None if text == "continuous" => Ok(Pulse::Continuous),
        Some(("gaussian", time)) => Ok(Pulse::gaussian_fwhm(seconds(time)?)),
        Some(("box", time)) => Ok(Pulse::Box { width_s: seconds(time)? }),
        _ => Err("expected delta, gaussian:TIME, box:TIME or continuous".to_owned()),
    }
}

/// A depth; `None` is unlimited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MaxDepth(pub(crate) Option<u32>);

/// `-1` or a count.
pub(crate) fn max_depth(text: &str) -> Result<MaxDepth, String> {
    if text == "-1" {
        return Ok(MaxDepth(None));
    }
    let depth = text.parse().map_err(|_| "expected a count, or -1 for all".to_owned())?;
    Ok(MaxDepth(Some(depth)))
}

/// A number of threads.
pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let threads: Option<NonZeroUsize> = text.parse().ok();
    let threads = threads.filter(|threads| threads.get() <= MAX_THREADS);
    threads.ok_or_else(|| format!("expected a number from 1 to {MAX_THREADS}"))
}

/// Ends of a range; an open end is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds(pub(crate) Option<f64>, pub(crate) Option<f64>);

/// A range of bins, the last excluded; an open end is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bins(pub(crate) Option<usize>, pub(crate) Option<usize>);

/// The two ends of `A..B`, of which one may be missing.
fn ends<T: PartialOrd>(
    text: &str,
    example: &str,
    end: impl Fn(&str) -> Result<T, String>,
) -> Result<(Option<T>, Option<T>), String> {
    let expected = || format!("expected a range A..B such as {example}");
    let (from, to) = text.split_once("..").ok_or_else(expected)?;
    let end = |text: &str| match text.trim() {
        "" => Ok(None),
        text => end(text).map(Some).map_err(|reason| format!("{reason}; {}", expected())),
    };
    let (from, to) = (end(from)?, end(to)?);
    match (&from, &to) {
        (None, None) => Err(expected()),
        (Some(from), Some(to)) if from >= to => {
            Err(format!("the range is empty; {} with A below B", expected()))
        }
        _ => Ok((from, to)),
    }
}

/// A finite number.
fn finite(value: f64) -> Result<f64, String> {
    if value.is_finite() { Ok(value) } else { Err("the ends must be finite".to_owned()) }
}

/// `2ns..8ns`, `..8ns`, in seconds.
pub(crate) fn time_bounds(text: &str) -> Result<Bounds, String> {
    let (from, to) = ends(text, "2ns..8ns", |end| finite(any_seconds(end)?))?;
    Ok(Bounds(from, to))
}

/// `0.6..2.4`, `0.6..`, in metres.
pub(crate) fn opl_bounds(text: &str) -> Result<Bounds, String> {
    let metres = |end: &str| finite(number(end.strip_suffix('m').unwrap_or(end))?);
    let (from, to) = ends(text, "0.6..2.4, in metres", metres)?;
    Ok(Bounds(from, to))
}

/// `10..60`, `..60`.
pub(crate) fn bins(text: &str) -> Result<Bins, String> {
    let bin = |end: &str| end.parse::<usize>().map_err(|_| format!("'{end}' is not a bin"));
    let (from, to) = ends(text, "10..60", bin)?;
    Ok(Bins(from, to))
}

/// Stops of exposure.
pub(crate) fn stops(text: &str) -> Result<f64, String> {
    let stops: Option<f64> = text.parse().ok();
    let stops = stops.filter(|stops| (-100.0..=100.0).contains(stops));
    stops.ok_or_else(|| "expected a number of stops from -100 to 100: 1 doubles".to_owned())
}

/// What is shown white.
pub(crate) fn white(text: &str) -> Result<f64, String> {
    let white: Option<f64> = text.parse().ok();
    let white = white.filter(|white| *white > 0.0 && white.is_finite());
    white
        .ok_or_else(|| "expected a positive energy per bin, as another video printed it".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_units() {
        for (text, expected) in
            [("20s", 20.0), ("500ms", 0.5), ("3m", 180.0), ("1.5h", 5400.0), ("2min", 120.0)]
        {
            assert_eq!(duration(text).unwrap().as_secs_f64(), expected, "{text}");
        }
        assert!((seconds("30 ps").unwrap() - 30e-12).abs() < 1e-24);
        for bad in ["", "20", "s", "-1s", "0s", "NaNs", "infs", "1e300h", "20 parsec", "1e-999s"] {
            assert!(duration(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn pulses_have_durations() {
        assert_eq!(pulse("delta"), Ok(Pulse::Delta));
        assert_eq!(pulse("continuous"), Ok(Pulse::Continuous));
        assert_eq!(pulse("box:50ps"), Ok(Pulse::Box { width_s: 50.0 * 1e-12 }));
        let Ok(Pulse::Gaussian { sigma_s }) = pulse("gaussian:2.354820045ps") else {
            panic!("a Gaussian");
        };
        assert!((sigma_s / 1e-12 - 1.0).abs() < 1e-9);
        for bad in ["", "box", "gaussian:", "box:-1ps", "delta:1ps", "sech:1ps"] {
            assert!(pulse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn depths_and_threads_have_bounds() {
        assert_eq!(max_depth("-1"), Ok(MaxDepth(None)));
        assert_eq!(max_depth("7"), Ok(MaxDepth(Some(7))));
        assert!(max_depth("-2").is_err() && max_depth("99999999999").is_err());
        assert!(threads("0").is_err() && threads("100000").is_err() && threads("7").is_ok());
    }

    #[test]
    fn ranges_have_two_ends_one_of_them_open() {
        assert_eq!(time_bounds("2s..3min"), Ok(Bounds(Some(2.0), Some(180.0))));
        assert_eq!(time_bounds("..0s"), Ok(Bounds(None, Some(0.0))));
        assert_eq!(opl_bounds("-0.5..2.5m"), Ok(Bounds(Some(-0.5), Some(2.5))));
        assert_eq!(opl_bounds(" 1 .. "), Ok(Bounds(Some(1.0), None)));
        assert_eq!(bins("3..7"), Ok(Bins(Some(3), Some(7))));
        for bad in
            ["", "..", "5", "2ns", "3ns..2ns", "2ns..2ns", "2..3", "NaNs..", "a..b", "1e999s.."]
        {
            let message = time_bounds(bad).unwrap_err();
            assert!(message.contains("2ns..8ns") || message.contains("finite"), "{bad}: {message}");
        }
        for bad in ["1-2", "2..1", "x..3", "inf.."] {
            assert!(opl_bounds(bad).is_err(), "{bad}");
        }
        for bad in ["-1..3", "1.5..3", "3..3", "5"] {
            assert!(bins(bad).unwrap_err().contains("10..60"), "{bad}");
        }
    }

    #[test]
    fn exposures_are_numbers_within_reason() {
        assert_eq!((stops("-1.5"), white("2e-3")), (Ok(-1.5), Ok(2e-3)));
        assert!(["", "NaN", "101", "x"].into_iter().all(|bad| stops(bad).is_err()));
        assert!(["", "0", "-1", "inf", "NaN"].into_iter().all(|bad| white(bad).is_err()));
    }
}
