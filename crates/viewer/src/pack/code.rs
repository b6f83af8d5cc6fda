//! Numbers as codes: logarithmic, zero exact.
//!
//! A value v ≠ 0 has the code `1 + round((log2|v| + 149) S)`, in bits 0 to 14; bit 15 is set for
//! v < 0. All of f32 is covered: 2^-149 has code 1. S = 35 steps an octave for cells (neighbouring
//! codes are 2.0 % apart, a value is off by at most 1.0 %), S = 100 for images (0.35 %). Code 0 is
//! 0, code 2^15 is "not finite".
//!
//! Standard errors are stored relative to their cell: `1 + round((log2(s/|v|) + 20) 4)` in 8 bits,
//! off by at most 9.1 %; 0 is none. Ratios below 2^-20 count as 2^-20. Code 255 says that the
//! ratio cannot be told: v is 0 and s is not, or either is not finite.

/// Steps an octave of cells.
pub(crate) const STEPS: f64 = 35.0;

/// Steps an octave of images.
pub(crate) const IMAGE_STEPS: f64 = 100.0;

/// Octaves below 1 of the smallest code.
pub(crate) const OFFSET: f64 = 149.0;

/// Steps an octave of standard errors.
pub(crate) const ERROR_STEPS: f64 = 4.0;

/// Octaves below 1 of the smallest relative standard error.
pub(crate) const ERROR_OFFSET: f64 = 20.0;

/// Most that a cell's value is off, relatively: 2^(1/70) − 1, rounded up.
pub const VALUE_ERROR: f64 = 0.01;

/// Most that a standard error is off, relative to itself, if it is above 2^-20 of its value:
/// 2^(1/8) − 1, rounded up.
pub const SE_ERROR: f64 = 0.091;

/// Not finite.
const NOT_FINITE: u16 = 1 << 15;

/// A standard error that cannot be told.
const UNKNOWN: u8 = 255;

fn logarithmic(value: f64, steps: f64) -> u16 {
    if value == 0.0 {
        return 0;
    }
    if !value.is_finite() {
        return NOT_FINITE;
    }
    let magnitude = 1.0 + ((value.abs().log2() + OFFSET) * steps).round();
    let sign = if value < 0.0 { NOT_FINITE } else { 0 };
    sign | magnitude.clamp(1.0, 32_767.0) as u16
}

/// The code of a cell.
pub(crate) fn value(value: f32) -> u16 {
    logarithmic(f64::from(value), STEPS)
}

/// The code of a pixel of an image; what f32 cannot hold is 0 or not finite.
pub(crate) fn image(value: f64) -> u16 {
    logarithmic(f64::from(value as f32), IMAGE_STEPS)
}

/// The code of the standard error of a cell.
pub(crate) fn error(value: f32, variance: f32) -> u8 {
    if variance == 0.0 {
        return 0;
    }
    let ratio = f64::from(variance).sqrt() / f64::from(value).abs();
    if !ratio.is_finite() {
        return UNKNOWN;
    }
    let code = 1.0 + ((ratio.log2() + ERROR_OFFSET) * ERROR_STEPS).round();
    if code >= f64::from(UNKNOWN) { UNKNOWN } else { code.max(1.0) as u8 }
}

#[cfg(test)]
fn exponential(code: u16, steps: f64) -> f64 {
    match code {
        0 => 0.0,
        NOT_FINITE => f64::NAN,
        _ => {
            let magnitude = ((f64::from(code & !NOT_FINITE) - 1.0) / steps - OFFSET).exp2();
            if code & NOT_FINITE == 0 { magnitude } else { -magnitude }
        }
    }
}

/// The value of a cell's code.
#[cfg(test)]
pub(crate) fn decode(code: u16) -> f64 {
    exponential(code, STEPS)
}

/// The value of a pixel's code.
#[cfg(test)]
pub(crate) fn decode_image(code: u16) -> f64 {
    exponential(code, IMAGE_STEPS)
}

/// The standard error of a code, relative to its cell.
#[cfg(test)]
pub(crate) fn decode_error(code: u8) -> f64 {
    match code {
        0 => 0.0,
        UNKNOWN => f64::NAN,
        _ => ((f64::from(code) - 1.0) / ERROR_STEPS - ERROR_OFFSET).exp2(),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn values_come_back_within_the_stated_error(bits in any::<u32>()) {
            let v = f32::from_bits(bits);
            let found = decode(value(v));
            let exact = f64::from(v);
            if v.is_finite() {
                prop_assert!((found - exact).abs() <= VALUE_ERROR * exact.abs(), "{v} {found}");
                prop_assert!((decode_image(image(exact)) - exact).abs() <= 3.5e-3 * exact.abs());
            } else {
                prop_assert!(found.is_nan());
            }
        }

        #[test]
        fn errors_come_back_within_the_stated_error(ratio in 1e-6..100.0_f64, v in 1e-10..1e10_f32) {
            let variance = ((ratio * f64::from(v)).powi(2)) as f32;
            prop_assume!(variance > 1e-30);
            let exact = f64::from(variance).sqrt() / f64::from(v);
            let found = decode_error(error(v, variance));
            prop_assert!((found / exact - 1.0).abs() <= SE_ERROR, "{ratio} {found}");
        }
    }

    #[test]
    fn extremes_have_codes() {
        assert_eq!((value(0.0), value(-0.0), value(f32::NAN)), (0, 0, NOT_FINITE));
        assert_eq!(value(f32::from_bits(1)), 1);
        assert!(value(f32::MAX) < 32_767 && value(f32::MIN) > NOT_FINITE);
        assert_eq!((image(1e-300), image(1e300)), (0, NOT_FINITE));
        assert_eq!(error(1.0, 0.0), 0);
        assert_eq!(error(1.0, 1e-30), 1, "smaller ratios are the smallest");
        assert_eq!((error(0.0, 1.0), error(1.0, f32::INFINITY)), (UNKNOWN, UNKNOWN));
        assert!(decode_error(error(-2.0, 1.0)) > 0.45);
    }
}
