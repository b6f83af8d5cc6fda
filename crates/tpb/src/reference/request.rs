//! What is asked of a solution, checked against what it takes.

use serde_json::{Map, Value, json};
use tpb_reference::registry::{Quantity, Solution};

use crate::cli::ReferenceArgs;
use crate::failure::Failure;

/// Values of a sweep that are not asked for otherwise.
const DEFAULT_COUNT: usize = 200;
/// More are a typing error.
const MAX_COUNT: usize = 1_000_000;

/// A solution with inputs.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) solution: &'static Solution,
    /// The quantities that are asked for.
    pub(super) quantities: Vec<&'static Quantity>,
    /// The inputs that do not vary, with defaults.
    pub(super) inputs: Map<String, Value>,
    pub(super) sweep: Option<Sweep>,
}

/// Inputs that vary together.
#[derive(Debug)]
pub(super) struct Sweep {
    /// One key, or the two edges of a bin.
    pub(super) keys: Vec<String>,
    /// The values of the keys, point by point.
    pub(super) points: Vec<Vec<f64>>,
}

impl Request {
    pub(super) fn new(solution: &'static Solution, args: &ReferenceArgs) -> Result<Self, Failure> {
        let quantities = quantities(solution, args.quantity.as_deref())?;
        let keys = keys(&quantities);
        let mut inputs = Map::new();
        for text in &args.set {
            let (key, value) = input(text)?;
            check_key(solution, &keys, &key)?;
            if inputs.insert(key.clone(), value).is_some() {
                return Err(Failure::input(format!("--set {key} is given twice")));
            }
        }
        let sweep = args.over.as_deref().map(|text| Sweep::new(text, args.log_x)).transpose()?;
        for key in sweep.iter().flat_map(|sweep| &sweep.keys) {
            check_key(solution, &keys, key)?;
            if inputs.contains_key(key) {
                return Err(Failure::input(format!("{key} is both set and varied")));
            }
        }
        for quantity in &quantities {
            inputs = solution.complete(quantity, &inputs);
        }
        for key in sweep.iter().flat_map(|sweep| &sweep.keys) {
            inputs.remove(key);
        }
        let varied = |key: &str| sweep.iter().any(|sweep| sweep.keys.iter().any(|k| k == key));
        let missing: Vec<_> =
            keys.iter().copied().filter(|key| !inputs.contains_key(*key) && !varied(key)).collect();
        if missing.is_empty() {
            return Ok(Self { solution, quantities, inputs, sweep });
        }
        let message = format!("{} also needs {}", solution.name, missing.join(", "));
        let example: Vec<_> = missing.iter().map(|key| format!("--set {key}=…")).collect();
        Err(Failure::with_help(message, example.join(" ")))
    }
}

/// The inputs that these quantities take.
pub(super) fn keys(quantities: &[&'static Quantity]) -> Vec<&'static str> {
    let mut keys: Vec<&'static str> = Vec::new();
    for key in quantities.iter().flat_map(|quantity| (quantity.keys)()) {
        if !keys.contains(key) {
            keys.push(key);
        }
    }
    keys
}

fn quantities(
    solution: &'static Solution,
    name: Option<&str>,
) -> Result<Vec<&'static Quantity>, Failure> {
    let Some(name) = name else { return Ok(solution.quantities.iter().collect()) };
    if let Some(quantity) = solution.quantity(Some(name)) {
        return Ok(vec![quantity]);
    }
    let names: Vec<_> = solution.quantities.iter().filter_map(|quantity| quantity.name).collect();
    let help = if names.is_empty() {
        "it has a single one: leave out --quantity".to_owned()
    } else {
        format!("it has {}", names.join(", "))
    };
    let message = format!("{} has no quantity '{name}'", solution.name);
    Err(Failure::with_help(message, help))
}

fn check_key(solution: &Solution, keys: &[&str], key: &str) -> Result<(), Failure> {
    if keys.contains(&key) {
        return Ok(());
    }
    let near = nearest(key, keys.iter().copied());
    let hint = near.map_or_else(String::new, |near| format!("did you mean {near}? "));
    Err(Failure::with_help(
        format!("{} has no input '{key}'", solution.name),
        format!("{hint}its inputs are {}", keys.join(", ")),
    ))
}

/// `KEY=VALUE`, the value as JSON or else as a word.
fn input(text: &str) -> Result<(String, Value), Failure> {
    let Some((key, value)) = text.split_once('=') else {
        return Err(Failure::input(format!("--set {text}: expected KEY=VALUE")));
    };
    let value = value.trim();
    let value = serde_json::from_str(value).or_else(|error| {
        let word = value.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let starts = value.starts_with(|c: char| c.is_ascii_alphabetic());
        if word && ["nan", "inf", "infinity"].contains(&value.to_ascii_lowercase().as_str()) {
            Err(Failure::input(format!("--set {text}: expected a finite number")))
        } else if word && starts {
            Ok(json!(value))
        } else {
            Err(Failure::input(format!("--set {text}: the value is not JSON: {error}")))
        }
    })?;
    Ok((key.trim().to_owned(), value))
}

/// Inputs that are whole numbers.
const COUNTS: [&str; 4] = ["order", "chords", "echo", "scatterings"];

impl Sweep {
    /// `KEY=A..B` or `KEY=A..B:N`.
    fn new(text: &str, logarithmic: bool) -> Result<Self, Failure> {
        let wrong = |what: &str| {
            Failure::with_help(
                format!("--over {text}: {what}"),
                "as in --over time=0..20:400, or --over bins=0..20:400 for bins of time",
            )
        };
        let (key, range) = text.split_once('=').ok_or_else(|| wrong("expected KEY=A..B:N"))?;
        let (range, count) = match range.rsplit_once(':') {
            None => (range, None),
            Some((range, count)) => {
                let count: Option<usize> = count.trim().parse().ok();
                let count = count.filter(|count| (1..=MAX_COUNT).contains(count));
                let wrong_count = || wrong("the number of values is from 1 to 1000000");
                (range, Some(count.ok_or_else(wrong_count)?))
            }
        };
        let (from, to) = range.split_once("..").ok_or_else(|| wrong("expected A..B"))?;
        let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let (Some(from), Some(to)) = (number(from), number(to)) else {
            return Err(wrong("the ends are not finite numbers"));
        };
        if logarithmic && (from <= 0.0 || to <= 0.0) {
            return Err(wrong("with --log-x, both ends must be positive"));
        }
        let key = key.trim();
        let steps = to - from;
        let whole = COUNTS.contains(&key) && steps == steps.trunc() && steps >= 0.0;
        let one_by_one = (steps as usize).saturating_add(1).min(MAX_COUNT);
        let count = count.unwrap_or(if whole { one_by_one } else { DEFAULT_COUNT });
        if key == "bins" {
            if to <= from {
                return Err(wrong("bins need a range that ascends"));
            }
            let edges = spaced(from, to, count + 1, logarithmic);
            let points = edges.windows(2).map(<[f64]>::to_vec).collect();
            return Ok(Self { keys: vec!["t0".to_owned(), "t1".to_owned()], points });
        }
        let values = if whole && count == one_by_one {
            (0..count).map(|i| from + i as f64).collect()
        } else {
            spaced(from, to, count, logarithmic)
        };
        let points = values.into_iter().map(|x| vec![x]).collect();
        Ok(Self { keys: vec![key.to_owned()], points })
    }
}

/// Values from one end to the other, both included.
fn spaced(from: f64, to: f64, count: usize, logarithmic: bool) -> Vec<f64> {
    let last = count.saturating_sub(1);
    let value = |i: usize| match i {
        0 => from,
        _ if i == last => to,
        _ => {
            let fraction = i as f64 / last as f64;
            if logarithmic {
                10.0_f64.powf(from.log10() * (1.0 - fraction) + to.log10() * fraction)
            } else {
                from * (1.0 - fraction) + to * fraction
            }
        }
    };
    (0..count).map(value).collect()
}

/// The candidate that a misspelt word most likely means.
pub(super) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let edits = |name: &str| strsim::damerau_levenshtein(&word.to_lowercase(), name);
    let near = |&(edits, name): &(usize, &'a str)| {
        edits <= name.len().max(word.len()) / 3
            || (word.len() >= 3 && name.contains(word))
            || (name.len() >= 4 && word.contains(name))
    };
    let candidates = candidates.into_iter().map(|name| (edits(name), name));
    candidates.filter(near).min_by_key(|&(edits, _)| edits).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_reach_both_ends() {
        assert_eq!(spaced(0.0, 1.0, 5, false), [0.0, 0.25, 0.5, 0.75, 1.0]);
        let logarithmic = spaced(1e-3, 1e3, 7, true);
        assert_eq!((logarithmic[0], logarithmic[6]), (1e-3, 1e3));
        assert!((logarithmic[3] - 1.0).abs() < 1e-14);
        assert_eq!(spaced(2.0, 3.0, 1, false), [2.0]);
        let sweep = Sweep::new("bins=0..1:4", false).unwrap();
        assert_eq!(sweep.points[3], [0.75, 1.0]);
        assert_eq!(Sweep::new("x=-3..-1e0", false).unwrap().points.len(), DEFAULT_COUNT);
        for bad in
            ["", "x", "x=1", "x=1..", "x=1..2:0", "x=1..nan", "x=a..b", "bins=1..1", "x=1..2:1e3"]
        {
            assert!(Sweep::new(bad, false).is_err(), "{bad}");
        }
        assert!(Sweep::new("x=0..1", true).is_err());
    }

    #[test]
    fn counts_are_swept_one_by_one() {
        let sweep = Sweep::new("order=1..3", false).unwrap();
        assert_eq!(sweep.points, [[1.0], [2.0], [3.0]]);
    }

    #[test]
    fn inputs_are_json_or_words() {
        assert_eq!(input("order=all").unwrap().1, json!("all"));
        assert_eq!(input("r = 2e-3").unwrap(), ("r".to_owned(), json!(2e-3)));
        assert_eq!(input("d=[0,0,1]").unwrap().1, json!([0, 0, 1]));
        for bad in ["r=NaN", "r=inf", "r", "r=", "r=1,2", "d=[0", "r=1e999", "r=1m"] {
            assert!(input(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn slips_find_their_name() {
        let names = ["sigma_t", "source_distance", "time"];
        assert_eq!(nearest("tiem", names), Some("time"));
        assert_eq!(nearest("distance", names), Some("source_distance"));
        assert_eq!(nearest("banana", names), None);
        assert_eq!(nearest("x", ["g", "r"]), None);
    }
}
