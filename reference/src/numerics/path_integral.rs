//! Integrals over the path length, for bins of singly scattered light.
//!
//! The time bins of all singly scattered quantities here are integrals
//!
//! > ∫ f(q) e^(−σt (q − q0)) dq,   q from q0 > 0 to q0 + width,
//!
//! over the path length less a constant, where f is a product of powers below and above some
//! lengths ("scales"), so that it changes by a factor over a factor in q. In y = ln(q/q0) such a
//! function is smooth on the scale of 1 wherever it lies; a bin of any width, up to infinite light
//! paths, then takes a few panels. The break points are the scales and a few decay lengths.

use crate::error::Result;
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};

/// The integral above; the integrand gets q and q − q0.
pub(crate) fn decaying_integral(
    q0: f64,
    width: f64,
    sigma_t: f64,
    scales: &[f64],
    integrand: impl Fn(f64, f64) -> f64,
) -> Result<f64> {
    let log_ratio = |offset: f64| (offset / q0).ln_1p();
    let end = log_ratio(width);
    let decays = [1.0, 8.0, 40.0, 750.0].map(|lengths| log_ratio(lengths / sigma_t));
    let mut breaks = vec![0.0, end];
    breaks.extend(decays.into_iter().chain(scales.iter().map(|scale| (scale / q0).ln())));
    breaks.retain(|y| (0.0..=end).contains(y));
    breaks.sort_by(f64::total_cmp);
    let in_logarithm = |y: f64| {
        let offset = q0 * y.exp_m1();
        let q = q0 + offset;
        integrand(q, offset) * (-sigma_t * offset).exp() * q
    };
    Ok(adaptive(in_logarithm, &breaks, RELATIVE_TOLERANCE)?.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-10, "{value} for {expected}");
    }

    #[test]
    fn decays_of_every_length_meet_the_closed_form() {
        for sigma_t in [1e-8, 1.0, 1e8] {
            for (q0, width) in [(1e-9, 1.0), (1.0, 1e-6), (0.3, 1e12)] {
                let value = decaying_integral(q0, width, sigma_t, &[], |_, _| 1.0).unwrap();
                close(value, -(-sigma_t * width).exp_m1() / sigma_t);
            }
        }
    }

    #[test]
    fn a_lorentzian_of_any_width_meets_the_arc_tangent() {
        for b in [1e-6, 1.0, 1e6] {
            let value =
                decaying_integral(1e-5, 1e7, 0.0, &[b], |q, _| b / (q * q + b * b)).unwrap();
            close(value, ((1e7 + 1e-5) / b).atan() - (1e-5 / b).atan());
        }
    }
}
