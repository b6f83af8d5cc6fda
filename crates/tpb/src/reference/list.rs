//! What solutions there are.

use std::fmt::Write;

use serde_json::{Value, json};
use tpb_reference::registry::{self, Quantity, Solution};

use super::request::keys;

fn chosen(only: Option<&'static Solution>) -> Vec<&'static Solution> {
    only.map_or_else(|| registry::solutions().collect(), |solution| vec![solution])
}

fn quantities(solution: &'static Solution) -> Vec<&'static Quantity> {
    solution.quantities.iter().collect()
}

/// For people: a paragraph for each.
pub(super) fn as_text(only: Option<&'static Solution>) -> String {
    let mut text = String::new();
    for solution in chosen(only) {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{}\n    {}", solution.name, solution.summary);
        let values: Vec<_> = quantities(solution).into_iter().map(|q| value(solution, q)).collect();
        let _ = writeln!(text, "    gives    {}", values.join(", "));
        let inputs =
            keys(&quantities(solution)).into_iter().map(|key| match default(solution, key) {
                Some(default) => format!("{} (default {default})", input(solution, key)),
                None => input(solution, key),
            });
        let _ = writeln!(text, "    inputs   {}", inputs.collect::<Vec<_>>().join(", "));
        if let Some(source) = solution.source() {
            let _ = writeln!(text, "    formula  {}", source.formula);
            let _ = writeln!(text, "    source   {}", source.origin);
        }
        let validity = solution.approximate.map_or_else(
            || format!("exact, to {:.0e}", solution.tolerance.relative()),
            |validity| format!("APPROXIMATE: {validity}"),
        );
        let _ = writeln!(text, "    validity {validity}\n");
    }
    text
}

fn value(solution: &Solution, quantity: &Quantity) -> String {
    let unit = solution.unit_of(quantity);
    quantity.name.map_or_else(|| format!("[{unit}]"), |name| format!("{name} [{unit}]"))
}

/// A key with its unit.
fn input(solution: &Solution, key: &str) -> String {
    match solution.unit_of_input(key) {
        None | Some("1") => key.to_owned(),
        Some(unit) => format!("{key} [{unit}]"),
    }
}

fn default(solution: &Solution, key: &str) -> Option<&'static str> {
    solution.defaults.iter().find(|(name, _)| *name == key).map(|&(_, text)| text)
}

/// For programs.
pub(super) fn as_json(only: Option<&'static Solution>) -> String {
    let entry = |solution: &'static Solution| {
        let values = solution.quantities.iter().map(|quantity| {
            let unit = solution.unit_of(quantity);
            json!({ "name": quantity.name, "unit": unit, "keys": (quantity.keys)() })
        });
        let defaults = solution.defaults.iter().map(|&(key, text)| {
            (key.to_owned(), serde_json::from_str(text).unwrap_or(Value::Null))
        });
        let units = keys(&quantities(solution))
            .into_iter()
            .map(|key| (key.to_owned(), json!(solution.unit_of_input(key))));
        json!({
            "name": solution.name,
            "summary": solution.summary,
            "formula": solution.source().map(|source| source.formula),
            "source": solution.source().map(|source| source.origin),
            "input_units": Value::Object(units.collect()),
            "exact": solution.approximate.is_none(),
            "validity": solution.approximate,
            "relative_tolerance": solution.tolerance.relative(),
            "quantities": values.collect::<Vec<_>>(),
            "defaults": Value::Object(defaults.collect()),
        })
    };
    let solutions: Vec<_> = chosen(only).into_iter().map(entry).collect();
    format!("{:#}", json!(solutions))
}
