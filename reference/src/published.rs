//! Tables of third parties, in their own form, as rows of a solution.
//!
//! # Point source of Bennett and McClarren
//!
//! Data that accompany "Benchmarks for infinite medium, time dependent transport problems with isotropic scattering",
//! J. Comput. Theor. Transp. 51, 205 (2022): the collided scalar flux of a unit point pulse at c = 1, at r and t in mean
//! free paths, with all 16 digits. That is [`point_pulse_fluence`](crate::infinite_medium::point_pulse_fluence).
//!
//! Their digits are not all right. Towards the source the published values fall below the exact ones by a relative
//! 1e-12/r (4.3e-12 at r = 0.23, 1e-6 at r = 1e-6): the mark of a divisor r + 1e-12, which guards a division by
//! r. That is what such a row can be trusted to, and its tolerance where it exceeds that of the solution. A
//! test undoes the divisor, and then the values agree further.

use crate::error::Result;
use crate::tables::{Row, parse};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::{Map, Value};
use std::path::Path;

/// What their divisor adds to r, in mean free paths.
const GUARD: f64 = 1e-12;

/// The solution that a published table is compared with.
pub(crate) fn solution_of(table: &str) -> Option<&'static str> {
    table.starts_with("published_bennett_point_").then_some("point_pulse_fluence")
}

/// The rows of a published table of a point source.
pub(crate) fn rows(text: &str, path: &Path) -> Result<Vec<Row>> {
    Ok(parse::<Published>(text, path)?.rows.into_iter().map(PublishedRow::into_row).collect())
}

#[derive(Deserialize)]
struct Published {
    rows: Vec<PublishedRow>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PublishedRow {
    r: f64,
    t: f64,
    published: f64,
    #[serde(rename = "computed")]
    _computed: IgnoredAny,
    #[serde(rename = "relative_difference")]
    _relative_difference: IgnoredAny,
}

impl PublishedRow {
    fn into_row(self) -> Row {
        let inputs = [("r", self.r), ("time", self.t), ("albedo", 1.0)];
        Row {
            inputs: inputs
                .map(|(key, value)| (key.to_owned(), Value::from(value)))
                .into_iter()
                .collect::<Map<_, _>>(),
            quantity: None,
            value: self.published,
            relative_error_estimate: Some(GUARD / self.r),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::find;

    const TABLES: [&str; 2] = [
        include_str!("../../validation/tables/published_bennett_point_t5.json"),
        include_str!("../../validation/tables/published_bennett_point_t10.json"),
    ];

    #[test]
    fn the_divisor_explains_the_difference() {
        let quantity = find(solution_of("published_bennett_point_t5").unwrap()).unwrap();
        for text in TABLES {
            let rows = rows(text, Path::new("published")).unwrap();
            assert_eq!(rows.len(), 23);
            for row in rows {
                let exact = (quantity.quantities[0].evaluate)(&row.inputs).unwrap();
                let r = row.inputs["r"].as_f64().unwrap();
                let undone = row.value * (1.0 + GUARD / r);
                // What is left at 1e-6 is a divided difference of theirs.
                let left = if r < 1e-3 { 5e-9 } else { 1e-12 };
                assert!((undone / exact - 1.0).abs() < left, "{undone:e} for {exact:e} at {r}");
                assert!((row.value / exact - 1.0).abs() < 1e-9_f64.max(GUARD / r));
            }
        }
    }

    #[test]
    fn other_tables_are_none_of_these() {
        assert!(solution_of("point_pulse_fluence").is_none());
    }
}
