//! Which solution goes by which name: the one list that the tables are looked up in.
//!
//! A solution is a function of one deserialisable struct. Its line in [`SOLUTIONS`] gives the
//! name of its table, the class of its tolerance, and the function, or one function for each of
//! the quantities that the table distinguishes.

use crate::ballistic::ballistic_point_fluence;
use crate::beam_ray::{beam_ray_1d, beam_ray_2d_bins};
use crate::diffuse_sphere::{sphere_centre_radiance_bins, sphere_chords_cdf, sphere_chords_pdf};
use crate::error::{ReferenceError, Result};
use crate::expected_blur::{expected_blur_1d, expected_blur_1d_bins};
use crate::expected_blur_disc::{expected_blur_2d, expected_blur_2d_bins};
use crate::single_scattering::{
    once_scattered_fluence, single_scatter_radiance, single_scatter_radiance_bins,
};
use ToleranceClass::{ClosedForm, Quadrature};
use serde::de::{DeserializeOwned, Deserializer, Visitor};
use serde_json::{Map, Value};

/// Every solution of this crate.
pub static SOLUTIONS: &[Solution] = &[
    solution!("ballistic_point_fluence", ClosedForm, ballistic_point_fluence),
    solution!("single_scatter_radiance", ClosedForm, single_scatter_radiance),
    solution!("single_scatter_radiance_bins", Quadrature, single_scatter_radiance_bins),
    solution!("once_scattered_fluence", ClosedForm, once_scattered_fluence),
    solution!("beam_ray_1d", ClosedForm, beam_ray_1d),
    solution!("beam_ray_2d_bins", Quadrature, beam_ray_2d_bins),
    solution!("expected_blur_1d", Quadrature, expected_blur_1d),
    solution!("expected_blur_1d_bins", Quadrature, expected_blur_1d_bins),
    solution!("expected_blur_2d", ClosedForm, expected_blur_2d),
    solution!("expected_blur_2d_bins", Quadrature, expected_blur_2d_bins),
    solution!("sphere_chords", ClosedForm, "cdf" => sphere_chords_cdf, "pdf" => sphere_chords_pdf),
    solution!("sphere_centre_radiance_bins", Quadrature, sphere_centre_radiance_bins),
];

/// The solution of a name.
pub fn find(name: &str) -> Option<&'static Solution> {
    SOLUTIONS.iter().find(|solution| solution.name == name)
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
    /// A bin or another quadrature, to 1e-9.
    Quadrature,
}

impl ToleranceClass {
    /// The largest relative error that is allowed.
    pub fn relative(self) -> f64 {
        match self {
            Self::ClosedForm => 1e-12,
            Self::Quadrature => 1e-9,
        }
    }
}

impl Solution {
    /// The quantity that table rows call by this name, or the only one if they call none.
    pub fn quantity(&self, name: Option<&str>) -> Option<&'static Quantity> {
        self.quantities.iter().find(|quantity| quantity.name == name)
    }
}

/// One line of [`SOLUTIONS`].
macro_rules! solution {
    ($name:literal, $tolerance:expr, $function:path) => {
        solution!(@ $name, $tolerance, (None, $function))
    };
    ($name:literal, $tolerance:expr, $($quantity:literal => $function:path),+) => {
        solution!(@ $name, $tolerance, $((Some($quantity), $function)),+)
    };
    (@ $name:literal, $tolerance:expr, $(($quantity:expr, $function:path)),+) => {
        Solution {
            name: $name,
            tolerance: $tolerance,
            quantities: &[$(Quantity {
                name: $quantity,
                evaluate: |inputs| $function(&typed(inputs)?),
                keys: || fields_of_argument($function),
            }),+],
        }
    };
}
use solution;

/// The inputs of a table row as the struct of a solution.
fn typed<Inputs: DeserializeOwned>(inputs: &Map<String, Value>) -> Result<Inputs> {
    serde_json::from_value(Value::Object(inputs.clone())).map_err(ReferenceError::Inputs)
}

/// The names of the fields of the struct that a solution takes.
fn fields_of_argument<Inputs: DeserializeOwned>(
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
        for (i, solution) in SOLUTIONS.iter().enumerate() {
            assert!(SOLUTIONS[..i].iter().all(|other| other.name != solution.name));
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
