//! Where photon beams lose to path tracing at equal time, by measurement, and why.
//!
//! Judged are kinds of cells, windows of time, kinds within windows, and the pixels that see a lamp;
//! a part is lost if the 95 % interval of the factor lies below 1. Each is judged by itself: of many
//! parts that are even, one in forty is expected to be listed by chance.
//!
//! The reason is read off the split of the beams' error: *blur* if its squared bias is more than half
//! of it with its interval, *noise* if it is less with its interval. Where noise decides and both
//! methods find the light in the same way, by camera paths that see the lamp or connect to it, the
//! numbers of those paths are given: what beams spend on photons they do not spend on them.

use serde_json::Value;

use super::compare::{Comparison, Part};
use super::truth::Kind;
use crate::statistics::{Split, Winner};

/// A part that is lost.
#[derive(Clone, Debug, PartialEq)]
pub struct Loss {
    /// What it holds.
    pub label: String,
    /// Times less error of beams, below 1, with its interval.
    pub factor: String,
    /// Share of the signal.
    pub share: f64,
    /// Why.
    pub reason: String,
}

/// The parts that the first method of a comparison wins; the pixels that see a lamp come first, then
/// kinds, windows, and kinds within windows.
pub fn losses(comparison: &Comparison) -> Vec<Loss> {
    let Comparison { lamps, kinds, windows, kinds_in_windows, .. } = comparison;
    let parts = lamps.iter().chain(kinds).chain(windows).chain(kinds_in_windows);
    let lost = parts.filter(|part| part.factor.is_some() && part.winner() == Winner::First);
    lost.map(|part| Loss {
        label: part.label.clone(),
        factor: part.factor.map_or(String::new(), |factor| factor.text()),
        share: part.share,
        reason: reason(comparison, part),
    })
    .collect()
}

fn reason(comparison: &Comparison, part: &Part) -> String {
    let Some(Some(beams)) = part.splits.get(1) else { return "not known".to_owned() };
    let [low, high] = beams.squared_bias.interval.map(|end| 100.0 * end / beams.nmse.value);
    match cause(beams) {
        Cause::Blur => format!("blur: {low:.0} % of the beams' error at least is squared bias"),
        Cause::Open => "blur or noise, not resolved".to_owned(),
        Cause::Noise => {
            let noise = format!(
                "noise: {:.0} % of the beams' error at most is squared bias",
                high.max(0.0)
            );
            match paths(comparison) {
                Some(paths) if is_seen(comparison, part) => format!("{noise}; {paths}"),
                _ => noise,
            }
        }
    }
}

/// What most of an error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    Blur,
    Noise,
    Open,
}

fn cause(split: &Split) -> Cause {
    let half = 0.5 * split.nmse.value;
    let [low, high] = split.squared_bias.interval;
    if low > half {
        Cause::Blur
    } else if high < half {
        Cause::Noise
    } else {
        Cause::Open
    }
}

/// Whether camera paths alone find the light of a part, with either method.
fn is_seen(comparison: &Comparison, part: &Part) -> bool {
    let lamps = comparison.lamps.as_ref().is_some_and(|lamps| lamps.label == part.label);
    lamps || part.label.starts_with(Kind::Pure.label())
}

/// Camera paths of a pixel that end on surfaces, by each method in its time.
fn paths(comparison: &Comparison) -> Option<String> {
    let count = |index: usize, option: &str| -> Option<f64> {
        let of_pass = comparison.options.get(index)?.get(option).and_then(Value::as_f64)?;
        Some(of_pass * comparison.whole().methods.get(index)?.passes)
    };
    let (path, beams) = (count(0, "samples_per_pass")?, count(1, "surface_samples")?);
    Some(format!(
        "both find this light by camera paths, of which path tracing makes {path:.0} in a pixel in \
         this time, beams {beams:.0}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Factor;
    use crate::statistics::split::Estimate;

    fn split(nmse: f64, bias: [f64; 3]) -> Split {
        let estimate = |value: f64, low: f64, high: f64| Estimate {
            value,
            standard_error: 0.0,
            interval: [low, high],
        };
        Split {
            nmse: estimate(nmse, 0.9 * nmse, 1.1 * nmse),
            variance: estimate(nmse - bias[1], 0.0, nmse),
            squared_bias: estimate(bias[1], bias[0], bias[2]),
            p_no_bias: 0.5,
            replicates: vec![nmse; 5],
        }
    }

    fn part(label: &str, beams: Split, factor: f64) -> Part {
        let factor = Factor { value: Some(factor), low: 0.9 * factor, high: Some(1.1 * factor) };
        let splits = vec![Some(split(1.0, [0.0; 3])), Some(beams)];
        Part { label: label.into(), opl: [0.0, 1.0], share: 0.25, splits, factor: Some(factor) }
    }

    #[test]
    fn the_split_of_the_error_gives_the_reason() {
        let mut comparison = crate::reproduce::testing::comparison();
        comparison.options = vec![
            serde_json::json!({"samples_per_pass": 25}),
            serde_json::json!({"surface_samples": 8}),
        ];
        comparison.lamps = Some(part("pixels that see a lamp", split(4.0, [-0.1, 0.0, 0.1]), 0.2));
        comparison.kinds = vec![
            part("blurred", split(2.0, [1.5, 1.8, 2.1]), 0.5),
            part("won", split(0.1, [0.0, 0.0, 0.0]), 9.0),
            part("even", split(1.0, [0.0, 0.0, 0.0]), 1.0),
        ];
        comparison.windows = vec![part("open", split(2.0, [0.5, 1.0, 1.5]), 0.5)];
        comparison.kinds_in_windows = vec![part("noisy", split(2.0, [0.0, 0.1, 0.2]), 0.5)];
        let found = losses(&comparison);
        let labels: Vec<&str> = found.iter().map(|loss| loss.label.as_str()).collect();
        assert_eq!(labels, ["pixels that see a lamp", "blurred", "open", "noisy"]);
        assert_eq!(found[0].factor, "0.20 [0.18, 0.22]");
        // 4 passes of 25 and 2 of 8: see the comparison for tests.
        let counted = "path tracing makes 100 in a pixel in this time, beams 16";
        assert!(found[0].reason.contains(counted), "{}", found[0].reason);
        assert_eq!(found[1].reason, "blur: 75 % of the beams' error at least is squared bias");
        assert!(found[2].reason.starts_with("blur or noise"));
        assert_eq!(found[3].reason, "noise: 10 % of the beams' error at most is squared bias");
    }
}
