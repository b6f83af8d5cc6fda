//! Which solution goes by which name: what tables and programs look solutions up in.
//!
//! A solution is a function of one deserialisable struct. Each subject of this crate has a list of
//! its own, `SOLUTIONS` in its `mod.rs`; a line gives the name of the table, the class of its
//! tolerance, the function (or one for each of the quantities that the table distinguishes), what it
//! is, and in which unit. A solution is exact unless it says otherwise ([`field@Solution::approximate`]).
//!
//! The structs of the solutions are strict. Where a table leaves out inputs that it fixes, the
//! solution names them with these values ([`field@Solution::defaults`]), and [`Solution::complete`] fills
//! them in.

use crate::error::{ReferenceError, Result};
use crate::{
    ballistic, beams, diffuse_sphere, diffusion, dwell, infinite_medium, interfaces,
    single_scattering,
};
use serde::de::{DeserializeOwned, Deserializer, Visitor};
use serde_json::{Map, Value};

/// Every solution of this crate, subject by subject.
pub fn solutions() -> impl Iterator<Item = &'static Solution> {
    let subjects = [
        ballistic::SOLUTIONS,
        single_scattering::SOLUTIONS,
        infinite_medium::SOLUTIONS,
        diffusion::SOLUTIONS,
        diffuse_sphere::SOLUTIONS,
        interfaces::SOLUTIONS,
        beams::SOLUTIONS,
        dwell::SOLUTIONS,
    ];
    subjects.into_iter().flatten()
}

/// The solution of a name.
pub fn find(name: &str) -> Option<&'static Solution> {
    solutions().find(|solution| solution.name == name)
}

/// A solution, with its inputs as JSON.
#[derive(Debug)]
pub struct Solution {
    /// Its name, and that of its table.
    pub name: &'static str,
    /// How closely it must meet its table.
    pub tolerance: ToleranceClass,
    /// The quantities that it gives; a single one has no name.
    pub quantities: &'static [Quantity],
    /// What it is, in one line.
    pub summary: &'static str,
    /// The unit of its value, "1" for a pure number; see [`Solution::unit_of`].
    pub unit: &'static str,
    /// The units of its quantities, in their order, where they differ; else empty.
    pub units: &'static [&'static str],
    /// Units of its inputs where they are not those that the key has elsewhere.
    pub input_units: &'static [(&'static str, &'static str)],
    /// Inputs that may be left out, with the JSON text of their values.
    pub defaults: &'static [(&'static str, &'static str)],
    /// For an approximation, where and how well it holds; `None` for exact solutions.
    pub approximate: Option<&'static str>,
}

/// One quantity of a solution.
#[derive(Debug)]
pub struct Quantity {
    /// The name that table rows call it by.
    pub name: Option<&'static str>,
    /// Its value for the inputs of a table row.
    pub evaluate: fn(&Map<String, Value>) -> Result<f64>,
    /// The keys of its inputs.
    pub keys: fn() -> &'static [&'static str],
}

/// How closely a solution must meet its table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToleranceClass {
    /// A closed form, to 1e-12.
    ClosedForm,
    /// A diffusion formula, to 1e-10.
    Diffusion,
    /// A bin, a series or another quadrature, to 1e-9.
    Quadrature,
    /// A bin of light of all orders, to 1e-8.
    AllOrderBins,
}

impl ToleranceClass {
    /// The largest relative error that is allowed.
    pub fn relative(self) -> f64 {
        match self {
            Self::ClosedForm => 1e-12,
            Self::Diffusion => 1e-10,
            Self::Quadrature => 1e-9,
            Self::AllOrderBins => 1e-8,
        }
    }
}

impl Solution {
    /// The quantity of this name, or the only one if none is given.
    pub fn quantity(&self, name: Option<&str>) -> Option<&'static Quantity> {
        self.quantities.iter().find(|quantity| quantity.name == name)
    }

    /// The unit of one of its quantities.
    pub fn unit_of(&self, quantity: &Quantity) -> &'static str {
        let index = self.quantities.iter().position(|other| other.name == quantity.name);
        index.and_then(|index| self.units.get(index)).copied().unwrap_or(self.unit)
    }

    /// The inputs with defaults for those that may be left out.
    pub fn complete(&self, quantity: &Quantity, inputs: &Map<String, Value>) -> Map<String, Value> {
        let mut complete = inputs.clone();
        let keys = (quantity.keys)();
        for &(key, text) in self.defaults.iter().filter(|(key, _)| keys.contains(key)) {
            // A test parses every default.
            let value = || serde_json::from_str(text).unwrap_or(Value::Null);
            complete.entry(key).or_insert_with(value);
        }
        complete
    }

    /// With its summary and unit.
    pub(crate) const fn describe(mut self, summary: &'static str, unit: &'static str) -> Self {
        (self.summary, self.unit) = (summary, unit);
        self
    }

    /// With the unit of each quantity.
    pub(crate) const fn units(mut self, units: &'static [&'static str]) -> Self {
        self.units = units;
        self
    }

    /// With inputs in units of their own.
    pub(crate) const fn inputs(mut self, units: &'static [(&'static str, &'static str)]) -> Self {
        self.input_units = units;
        self
    }

    /// With inputs that may be left out, and the JSON text of their values.
    pub(crate) const fn defaults(
        mut self,
        defaults: &'static [(&'static str, &'static str)],
    ) -> Self {
        self.defaults = defaults;
        self
    }

    /// Marked as an approximation that holds as `validity` says.
    pub(crate) const fn approximate(mut self, validity: &'static str) -> Self {
        self.approximate = Some(validity);
        self
    }
}

/// One line of a subject's list.
macro_rules! solution {
    ($name:literal, $tolerance:expr, $function:path) => {
        $crate::registry::solution!(@ $name, $tolerance, (None, $function))
    };
    ($name:literal, $tolerance:expr, $($quantity:literal => $function:path),+) => {
        $crate::registry::solution!(@ $name, $tolerance, $((Some($quantity), $function)),+)
    };
    ($name:literal, $tolerance:expr, $function:path, $($quantity:literal => $other:path),+) => {
        $crate::registry::solution!(
            @ $name, $tolerance, (None, $function), $((Some($quantity), $other)),+
        )
    };
    (@ $name:literal, $tolerance:expr, $(($quantity:expr, $function:path)),+) => {
        $crate::registry::Solution {
            name: $name,
            tolerance: $tolerance,
            quantities: &[$($crate::registry::Quantity {
                name: $quantity,
                evaluate: |inputs| $function(&$crate::registry::typed(inputs)?),
                keys: || $crate::registry::fields_of_argument($function),
            }),+],
            summary: "",
            unit: "",
            units: &[],
            input_units: &[],
            defaults: &[],
            approximate: None,
        }
    };
}
pub(crate) use solution;

/// The inputs of a table row as the struct of a solution.
pub(crate) fn typed<Inputs: DeserializeOwned>(inputs: &Map<String, Value>) -> Result<Inputs> {
    serde_json::from_value(Value::Object(inputs.clone())).map_err(ReferenceError::Inputs)
}

/// The names of the fields of the struct that a solution takes.
pub(crate) fn fields_of_argument<Inputs: DeserializeOwned>(
    _: fn(&Inputs) -> Result<f64>,
) -> &'static [&'static str] {
    let mut fields: &[&str] = &[];
    // The probe always stops with an error, after it has seen the names.
    let _ = Inputs::deserialize(FieldNames(&mut fields));
    fields
}

/// A deserialiser that only notes which fields a struct asks for.
struct FieldNames<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for FieldNames<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> std::result::Result<V::Value, Self::Error> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    fn deserialize_any<V: Visitor<'de>>(
        self,
        _visitor: V,
    ) -> std::result::Result<V::Value, Self::Error> {
        Err(serde::de::Error::custom("only the names of the fields are wanted"))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
        unit unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let names: Vec<_> = solutions().map(|solution| solution.name).collect();
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name), "{name}");
        }
    }

    #[test]
    fn every_solution_says_what_it_is_and_in_which_unit() {
        for solution in solutions() {
            assert!(!solution.summary.is_empty() && !solution.unit.is_empty(), "{solution:?}");
            assert!([0, solution.quantities.len()].contains(&solution.units.len()), "{solution:?}");
        }
    }

    #[test]
    fn every_default_is_json_and_belongs_to_an_input() {
        for solution in solutions() {
            for (key, text) in solution.defaults {
                assert!(serde_json::from_str::<Value>(text).is_ok(), "{}: {key}", solution.name);
                let known = |quantity: &Quantity| (quantity.keys)().contains(key);
                assert!(solution.quantities.iter().any(known), "{}: {key}", solution.name);
            }
        }
    }

    #[test]
    fn the_keys_are_the_fields_of_the_inputs() {
        let quantity = find("ballistic_point_fluence").unwrap().quantity(None).unwrap();
        assert_eq!((quantity.keys)(), ["energy", "sigma_t", "r"]);
    }

    #[test]
    fn a_quantity_is_found_by_its_name_alone() {
        let chords = find("sphere_chords").unwrap();
        assert!(chords.quantity(Some("pdf")).is_some());
        assert!(chords.quantity(Some("mean")).is_none());
        assert!(chords.quantity(None).is_none());
    }

    #[test]
    fn inputs_of_another_solution_are_refused_by_name() {
        let Value::Object(inputs) = serde_json::json!({"energy": 1.0, "sigma_t": 1.0, "R": 2.0})
        else {
            panic!("an object was written")
        };
        let evaluate = find("ballistic_point_fluence").unwrap().quantities[0].evaluate;
        let Err(ReferenceError::Inputs(source)) = evaluate(&inputs) else { panic!("accepted") };
        assert!(source.to_string().contains("unknown field `R`"), "{source}");
    }
}
