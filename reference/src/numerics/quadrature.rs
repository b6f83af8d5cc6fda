//! Two integrators of functions of one variable, each with an estimate of its error.
//!
//! [`adaptive`] bisects, wherever the estimated error is largest, between break points that the
//! caller names: the wavefronts and kinks that it knows of. Each panel has the 15 points of Kronrod
//! (1965) around the 7 of Gauss; the difference of the two is taken as the error of the better
//! one, which is pessimistic. It suits piecewise smooth functions of several scales.
//!
//! [`tanh_sinh`] is the double exponential rule of Takahasi and Mori (1974): with
//! x = tanh(π/2 sinh s), the trapezoidal rule in s converges exponentially even if the function
//! has an integrable singularity at an end, up to an inverse square root. The integrand gets
//! its distances to *both* ends ([`Node`]), because the nodes crowd there and a subtraction
//! would lose the distance. It suits functions that are analytic inside.
//!
//! The tolerance is relative to the integral. An integrand that cannot give a value returns a
//! NaN, and the integrator returns an error with the abscissa.

use crate::error::{ReferenceError, Result};
use std::f64::consts::PI;

/// The tolerance of the inner quadratures: two digits more than the 1e-9 that is promised.
pub const RELATIVE_TOLERANCE: f64 = 1e-11;

/// An integral and what is known of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The integral.
    pub value: f64,
    /// An estimate, normally pessimistic, of its absolute error.
    pub error: f64,
}

/// A node of [`tanh_sinh`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The abscissa.
    pub x: f64,
    /// Its distance from the lower end, to full relative precision.
    pub from_start: f64,
    /// Its distance from the upper end, to full relative precision.
    pub to_end: f64,
}

/// The integral from the first to the last of `breaks`, which ascend; adaptive G7-K15.
pub fn adaptive(
    integrand: impl FnMut(f64) -> f64,
    breaks: &[f64],
    relative_tolerance: f64,
) -> Result<Estimate> {
    adaptive_above(0.0, integrand, breaks, relative_tolerance)
}

/// [`adaptive`] of an integrand with rounding noise: an error up to `noise` is enough as well.
pub fn adaptive_above(
    noise: f64,
    mut integrand: impl FnMut(f64) -> f64,
    breaks: &[f64],
    relative_tolerance: f64,
) -> Result<Estimate> {
    let mut panels = breaks
        .windows(2)
        .filter(|ends| ends[0] < ends[1])
        .map(|ends| Panel::new(&mut integrand, ends[0], ends[1]))
        .collect::<Result<Vec<_>>>()?;
    loop {
        let total = Estimate {
            value: panels.iter().map(|panel| panel.integral.value).sum(),
            error: panels.iter().map(|panel| panel.integral.error).sum(),
        };
        if total.error <= noise.max(relative_tolerance * total.value.abs()) {
            return Ok(total);
        }
        let worst = (0..panels.len())
            .max_by(|&i, &j| panels[i].integral.error.total_cmp(&panels[j].integral.error));
        let Some((worst, middle)) = worst.and_then(|i| Some((i, panels[i].middle()?))) else {
            return Err(no_convergence(total));
        };
        if panels.len() >= MAX_PANELS {
            return Err(no_convergence(total));
        }
        let Panel { start, end, .. } = panels[worst];
        panels[worst] = Panel::new(&mut integrand, start, middle)?;
        panels.push(Panel::new(&mut integrand, middle, end)?);
    }
}

/// The integral from `start` to `end` by the 15 points of Kronrod alone, without an estimate: for
/// integrands that a polynomial of degree 22 matches to the last digit.
pub fn single_panel(mut integrand: impl FnMut(f64) -> f64, start: f64, end: f64) -> Result<f64> {
    Ok(Panel::new(&mut integrand, start, end)?.integral.value)
}

/// The integral from `start` to `end`, which may be singular points; tanh-sinh.
pub fn tanh_sinh(
    mut integrand: impl FnMut(Node) -> f64,
    start: f64,
    end: f64,
    relative_tolerance: f64,
) -> Result<Estimate> {
    let width = end - start;
    // The contribution of the nodes at ±s, weight included.
    let mut pair = |s: f64| -> Result<f64> {
        // Fractions of the width: `near` to the closer end, `far` to the other.
        let near = 1.0 / (1.0 + (PI * s.sinh()).exp());
        let far = 1.0 - near;
        let (close, distant) = (width * near, width * far);
        let low = Node { x: start + close, from_start: close, to_end: distant };
        let high = Node { x: end - close, from_start: distant, to_end: close };
        let mut sum = finite_value(integrand(high), high.x)?;
        if s > 0.0 {
            sum += finite_value(integrand(low), low.x)?;
        }
        Ok(sum * width * PI * s.cosh() * near * far)
    };
    let mut sum = pair(0.0)?;
    for k in 1..=LAST_ABSCISSA {
        sum += pair(f64::from(k))?;
    }
    let mut estimate = Estimate { value: sum, error: f64::INFINITY };
    for level in 1..=MAX_LEVEL {
        let step = 0.5_f64.powi(level);
        // The nodes that this level adds are the odd multiples of its step.
        for k in 0..LAST_ABSCISSA << (level - 1) {
            sum += pair(step * f64::from(2 * k + 1))?;
        }
        let value = sum * step;
        estimate = Estimate { value, error: (value - estimate.value).abs() };
        if level >= MIN_LEVEL && estimate.error <= relative_tolerance * value.abs() {
            return Ok(estimate);
        }
    }
    Err(no_convergence(estimate))
}

const MAX_PANELS: usize = 4000;
/// Beyond s = 4 the nodes are closer to an end than 1e-37 of the width.
const LAST_ABSCISSA: i32 = 4;
/// 64 intervals before convergence is believed.
const MIN_LEVEL: i32 = 3;
const MAX_LEVEL: i32 = 12;

/// Positive abscissae of K15 on [−1, 1], outermost first; every second one belongs to G7.
const NODES: [f64; 7] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_5,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_48,
];
/// Weights of K15; the last one is the centre's.
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_56,
    0.104_790_010_322_250_19,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_42,
    0.204_432_940_075_298_89,
    0.209_482_141_084_727_82,
];
/// Weights of G7; the last one is the centre's.
const GAUSS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
    0.417_959_183_673_469_4,
];

#[derive(Debug, Clone, Copy)]
struct Panel {
    start: f64,
    end: f64,
    integral: Estimate,
}

impl Panel {
    fn new(integrand: &mut impl FnMut(f64) -> f64, start: f64, end: f64) -> Result<Self> {
        let centre = 0.5 * (start + end);
        let half = 0.5 * (end - start);
        let mut at = |x: f64| finite_value(integrand(x), x);
        let middle = at(centre)?;
        let mut kronrod = KRONROD[7] * middle;
        let mut gauss = GAUSS[3] * middle;
        for (i, node) in NODES.iter().enumerate() {
            let pair = at(centre - half * node)? + at(centre + half * node)?;
            kronrod += KRONROD[i] * pair;
            if i % 2 == 1 {
                gauss += GAUSS[i / 2] * pair;
            }
        }
        let error = half * (kronrod - gauss).abs();
        Ok(Self { start, end, integral: Estimate { value: half * kronrod, error } })
    }

    /// Where to split, or `None` if the panel is as narrow as two neighbouring numbers.
    fn middle(&self) -> Option<f64> {
        let middle = 0.5 * (self.start + self.end);
        (self.start < middle && middle < self.end).then_some(middle)
    }
}

fn finite_value(value: f64, abscissa: f64) -> Result<f64> {
    if value.is_finite() { Ok(value) } else { Err(ReferenceError::Integrand { abscissa }) }
}

fn no_convergence(total: Estimate) -> ReferenceError {
    ReferenceError::NoConvergence { value: total.value, error: total.error }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(estimate: Estimate, expected: f64, relative: f64) {
        let error = (estimate.value - expected).abs();
        assert!(error <= relative * expected.abs(), "{} for {expected}", estimate.value);
        assert!(error <= estimate.error + 1e-14 * expected.abs(), "{estimate:?} for {expected}");
    }

    #[test]
    fn the_rule_is_exact_for_polynomials_of_degree_22_and_not_for_24() {
        let one_panel = |degree: i32| {
            Panel::new(&mut |x: f64| x.powi(degree), -1.0, 1.0).unwrap().integral.value
        };
        for degree in (0..=22).step_by(2) {
            let exact = 2.0 / f64::from(degree + 1);
            assert!((one_panel(degree) / exact - 1.0).abs() < 4e-15, "degree {degree}");
        }
        assert!((one_panel(24) / (2.0 / 25.0) - 1.0).abs() > 1e-12);
    }

    #[test]
    fn smooth_and_peaked_integrands_meet_their_closed_forms() {
        close(adaptive(f64::exp, &[0.0, 1.0], 1e-13).unwrap(), 1.0_f64.exp_m1(), 1e-13);
        // A Lorentz peak a million times narrower than the interval.
        let narrow = adaptive(|x| 1e-6 / (x * x + 1e-12), &[-1.0, 2.0], 1e-12).unwrap();
        close(narrow, 1e6_f64.atan() + 2e6_f64.atan(), 1e-12);
    }

    #[test]
    fn a_jump_at_a_break_point_costs_no_bisection() {
        let mut calls = 0;
        let step = |x: f64| {
            calls += 1;
            if x < 0.3 { 1.0 } else { 5.0 }
        };
        close(adaptive(step, &[0.0, 0.3, 1.0], 1e-13).unwrap(), 3.8, 1e-14);
        assert_eq!(calls, 30);
    }

    #[test]
    fn end_singularities_are_integrated_to_the_last_digits() {
        close(tanh_sinh(|n| n.from_start.ln(), 0.0, 1.0, 1e-13).unwrap(), -1.0, 1e-14);
        close(tanh_sinh(|n| n.to_end.powf(-0.5), 2.0, 6.0, 1e-13).unwrap(), 4.0, 1e-14);
        let half_circle = |n: Node| (n.from_start * n.to_end).sqrt();
        close(tanh_sinh(half_circle, -1.0, 1.0, 1e-13).unwrap(), PI / 2.0, 1e-14);
        close(
            tanh_sinh(|n| n.x.exp(), -1.0, 3.0, 1e-13).unwrap(),
            3_f64.exp() - (-1_f64).exp(),
            1e-14,
        );
    }

    #[test]
    fn the_two_integrators_agree() {
        let f = |x: f64| (3.0 * x).sin() / (0.1 + x * x);
        let a = adaptive(f, &[0.0, 2.0], 1e-12).unwrap();
        let b = tanh_sinh(|node| f(node.x), 0.0, 2.0, 1e-12).unwrap();
        assert!((a.value / b.value - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_failure_is_an_error_not_a_number() {
        let pole = adaptive(|x: f64| 1.0 / x, &[-1.0, 1.0], 1e-9);
        assert!(matches!(pole, Err(ReferenceError::Integrand { abscissa }) if abscissa == 0.0));
        let divergent = adaptive(|x: f64| 1.0 / x, &[0.0, 1.0], 1e-9);
        assert!(divergent.is_err());
        let wild = tanh_sinh(|node| (1e9 * node.x).sin(), 0.0, 1.0, 1e-9);
        assert!(matches!(wild, Err(ReferenceError::NoConvergence { .. })));
    }

    #[test]
    fn an_empty_interval_has_the_integral_zero() {
        assert_eq!(adaptive(|_| 1.0, &[2.0, 2.0], 1e-9).unwrap().value, 0.0);
        assert_eq!(tanh_sinh(|_| 1.0, 2.0, 2.0, 1e-9).unwrap().value, 0.0);
    }
}
