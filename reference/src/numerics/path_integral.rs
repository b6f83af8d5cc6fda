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
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive, tanh_sinh};

/// The integral above; the integrand gets q and q − q0.
pub(crate) fn decaying_integral(
    q0: f64,
    width: f64,
    sigma_t: f64,
    scales: &[f64],
    integrand: impl Fn(f64, f64) -> f64,
) -> Result<f64> {
    let log_start = q0.ln();
    // The ratio of two numbers can be above the range of f64, its logarithm not.
    let log_ratio = |offset: f64| match (offset / q0).ln_1p() {
        f64::INFINITY => offset.ln() - log_start,
        ratio => ratio,
    };
    let end = log_ratio(width);
    let decays = [1.0, 8.0, 40.0, 750.0].map(|lengths| log_ratio(lengths / sigma_t));
    let mut breaks = vec![0.0, end];
    breaks.extend(decays.into_iter().chain(scales.iter().map(|scale| scale.ln() - log_start)));
    breaks.retain(|y| (0.0..=end).contains(y));
    breaks.sort_by(f64::total_cmp);
    let in_logarithm = |y: f64| {
        let ratio = y.exp_m1();
        let offset = if ratio.is_finite() { q0 * ratio } else { (log_start + y).exp() };
        let q = q0 + offset;
        integrand(q, offset) * (-sigma_t * offset).exp() * q
    };
    Ok(adaptive(in_logarithm, &breaks, RELATIVE_TOLERANCE)?.value)
}

/// The same over the offset from a wavefront, from `start` ≥ 0 on; the integrand may have a
/// logarithm at the front and changes on the scales, which are above 0.
pub(crate) fn behind_front(
    start: f64,
    width: f64,
    sigma_t: f64,
    scales: &[f64],
    integrand: impl Fn(f64) -> f64 + Copy,
) -> Result<f64> {
    if start > 0.0 {
        return decaying_integral(start, width, sigma_t, scales, |offset, _| integrand(offset));
    }
    // Close to the front, where only the logarithm changes; then all the rest.
    let close = scales.iter().fold(width.min(1.0 / sigma_t), |close, scale| close.min(*scale));
    let near = |offset: f64| integrand(offset) * (-sigma_t * offset).exp();
    let first = tanh_sinh(|node| near(node.from_start), 0.0, close, RELATIVE_TOLERANCE)?.value;
    if close >= width {
        return Ok(first);
    }
    let rest = behind_front(close, width - close, sigma_t, scales, integrand)?;
    Ok(first + (-sigma_t * close).exp() * rest)
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
            for (q0, width) in [(1e-9, 1.0), (1.0, 1e-6), (0.3, 1e12), (1e-300, 1e200)] {
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

    #[test]
    fn a_logarithm_at_the_front_meets_the_closed_form() {
        // ∫ ln(1 + r/o) do = (r + o) ln(r + o) − o ln o − r ln r, from 0 to w.
        for (r, width) in [(1.0_f64, 1e-9_f64), (1.0, 2.0), (1e-3, 1e9)] {
            let value = behind_front(0.0, width, 0.0, &[r], |o| (r / o).ln_1p()).unwrap();
            close(value, r * (width / r).ln_1p() + width * (r / width).ln_1p());
        }
    }
}
