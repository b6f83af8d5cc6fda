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

/// A positive time with a unit, in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let unit = UNITS.into_iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, unit)));
    let Some((number, unit)) = unit else {
        return Err("a time needs a unit: 20s, 500ms, 3m, 1h, 30ps".to_owned());
    };
    let number: f64 =
        number.trim().parse().map_err(|_| format!("'{}' is not a number", number.trim()))?;
    let seconds = number * unit;
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
}
