//! What can go wrong, and the checks of inputs that every solution shares.

use std::path::PathBuf;

/// Why a solution has no value, or why a table could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// An input lies outside the domain of the solution.
    #[error("{input} = {value} is outside the domain: it must be {requirement}")]
    Domain {
        /// The name of the input.
        input: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        requirement: &'static str,
    },
    /// The exact value is infinite or too large for `f64`.
    #[error("the value of {solution} is not a finite number")]
    NotFinite {
        /// The name of the solution.
        solution: &'static str,
    },
    /// An integrand had no finite value.
    #[error("the integrand is not finite at {abscissa}")]
    Integrand {
        /// Where.
        abscissa: f64,
    },
    /// A quadrature did not reach its tolerance.
    #[error("the quadrature stopped at {value} with an estimated error of {error}")]
    NoConvergence {
        /// The best value.
        value: f64,
        /// Its estimated absolute error.
        error: f64,
    },
    /// The inputs of a table row do not fit the solution.
    #[error("the inputs do not fit the solution")]
    Inputs(#[source] serde_json::Error),
    /// A file or directory of tables could not be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// Which one.
        path: PathBuf,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// A table is not well-formed; the source names line and column.
    #[error("{} is not a table", path.display())]
    Parse {
        /// Which file.
        path: PathBuf,
        /// Why and where.
        #[source]
        source: serde_json::Error,
    },
}

/// The result of a solution.
pub type Result<T> = std::result::Result<T, ReferenceError>;

/// `value` if it meets the requirement, and a [`ReferenceError::Domain`] otherwise.
pub(crate) fn require(
    met: bool,
    input: &'static str,
    value: f64,
    requirement: &'static str,
) -> Result<f64> {
    if met { Ok(value) } else { Err(ReferenceError::Domain { input, value, requirement }) }
}

pub(crate) fn finite(input: &'static str, value: f64) -> Result<f64> {
    require(value.is_finite(), input, value, "finite")
}

pub(crate) fn positive(input: &'static str, value: f64) -> Result<f64> {
    require(value.is_finite() && value > 0.0, input, value, "positive and finite")
}

pub(crate) fn non_negative(input: &'static str, value: f64) -> Result<f64> {
    require(value.is_finite() && value >= 0.0, input, value, "at least 0 and finite")
}

/// The edges of a bin, as path lengths `speed * t`.
pub(crate) fn path_bin(speed: f64, t0: f64, t1: f64) -> Result<(f64, f64)> {
    positive("speed", speed)?;
    finite("t0", t0)?;
    require(t1.is_finite() && t1 >= t0, "t1", t1, "finite and not before t0")?;
    Ok((finite("speed * t0", speed * t0)?, finite("speed * t1", speed * t1)?))
}

/// The path length `speed * time`.
pub(crate) fn path_length(speed: f64, time: f64) -> Result<f64> {
    positive("speed", speed)?;
    finite("time", time)?;
    finite("speed * time", speed * time)
}

/// `value` unless it is infinite or not a number.
pub(crate) fn finite_result(solution: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() { Ok(value) } else { Err(ReferenceError::NotFinite { solution }) }
}

/// Powers of ten for inputs: half of them anywhere in f64, half within [`COMMON_DECADES`].
#[cfg(test)]
pub(crate) fn decades<const N: usize>() -> impl proptest::strategy::Strategy<Value = [f64; N]> {
    use proptest::array::UniformArrayStrategy;
    proptest::prop_oneof![
        UniformArrayStrategy::new(-320.0..308.3),
        UniformArrayStrategy::new(-COMMON_DECADES..COMMON_DECADES),
    ]
}

/// Whether a result is not negative and finite, or an error; within [`COMMON_DECADES`], only one of the
/// domain or of a value beyond f64, not that of a quadrature that gave up.
#[cfg(test)]
pub(crate) fn is_sound(result: &Result<f64>, exponents: &[f64]) -> bool {
    use ReferenceError::{Domain, NotFinite};
    let common = exponents.iter().all(|exponent| exponent.abs() <= COMMON_DECADES);
    match result {
        Ok(value) => value.is_finite() && *value >= 0.0,
        Err(error) => !common || matches!(error, Domain { .. } | NotFinite { .. }),
    }
}

/// Micrometres in light-years have 22.
#[cfg(test)]
const COMMON_DECADES: f64 = 40.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_domain_error_names_the_input_its_value_and_the_domain() {
        let error = positive("radius", -2.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "radius = -2 is outside the domain: it must be positive and finite"
        );
    }

    #[test]
    fn no_check_lets_a_nan_pass() {
        for check in [finite, positive, non_negative] {
            assert!(check("input", f64::NAN).is_err());
            assert!(check("input", f64::INFINITY).is_err());
        }
        assert!(path_bin(1.0, 0.0, f64::NAN).is_err());
        assert!(path_bin(1.0, f64::NAN, 1.0).is_err());
        assert!(path_bin(1e300, 0.0, 1e300).is_err());
        assert!(path_bin(1.0, 2.0, 1.0).is_err());
    }
}
