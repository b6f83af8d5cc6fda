//! The values of a request.

use std::error::Error;

use serde_json::{Map, Value, json};
use tpb_reference::ReferenceError;
use tpb_reference::registry::Quantity;

use super::request::Request;
use crate::failure::Failure;

/// The values of each quantity, at each point.
#[derive(Debug)]
pub(super) struct Curve {
    /// By quantity and point; `None` where there is no value.
    pub(super) values: Vec<Vec<Option<f64>>>,
    /// How many values are missing, and why the first one is.
    missing: Option<(usize, String)>,
}

impl Curve {
    /// Fails if no point of any quantity has a value, or if the inputs are of a wrong kind.
    pub(super) fn evaluate(request: &Request) -> Result<Self, Failure> {
        let mut missing: Option<(usize, String)> = None;
        let mut values = Vec::new();
        let at_once = [vec![]];
        let points = request.sweep.as_ref().map_or(&at_once[..], |sweep| &sweep.points);
        for quantity in &request.quantities {
            let mut inputs = inputs_of(quantity, &request.inputs);
            let mut row = Vec::with_capacity(points.len());
            for point in points {
                vary(request, &mut inputs, point);
                match (quantity.evaluate)(&inputs) {
                    Ok(value) => row.push(Some(value)),
                    Err(error @ ReferenceError::Inputs(_)) => {
                        return Err(Failure::input(explain(&error)));
                    }
                    Err(error) => {
                        missing.get_or_insert_with(|| (0, explain(&error))).0 += 1;
                        row.push(None);
                    }
                }
            }
            values.push(row);
        }
        match missing {
            Some((_, reason)) if values.iter().flatten().all(Option::is_none) => {
                let help = format!("tpb reference --list {}", request.solution.name);
                Err(Failure::with_help(reason, help))
            }
            missing => Ok(Self { values, missing }),
        }
    }

    /// What to say of missing values.
    pub(super) fn note(&self) -> Option<String> {
        let (count, reason) = self.missing.as_ref()?;
        let total: usize = self.values.iter().map(Vec::len).sum();
        Some(format!("note: {count} of {total} values are missing; the first: {reason}"))
    }
}

/// The inputs that this quantity takes.
fn inputs_of(quantity: &Quantity, inputs: &Map<String, Value>) -> Map<String, Value> {
    let keys = (quantity.keys)();
    let own = inputs.iter().filter(|(key, _)| keys.contains(&key.as_str()));
    own.map(|(key, value)| (key.clone(), value.clone())).collect()
}

fn vary(request: &Request, inputs: &mut Map<String, Value>, point: &[f64]) {
    let keys = request.sweep.iter().flat_map(|sweep| &sweep.keys);
    for (key, &value) in keys.zip(point) {
        inputs.insert(key.clone(), number(value));
    }
}

/// A whole number where the value is one, for inputs that count.
fn number(value: f64) -> Value {
    let whole = value.fract() == 0.0 && value.abs() < 1e15;
    if whole { json!(value as i64) } else { json!(value) }
}

/// The message of an error with those of its sources.
fn explain(error: &dyn Error) -> String {
    match error.source() {
        None => error.to_string(),
        Some(source) => format!("{error}: {}", explain(source)),
    }
}
