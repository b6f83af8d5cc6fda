//! Moments of where the light is, for any mean cosine of the phase function.
//!
//! σt = σs and v = 1 serve for all media, because absorption acts on every path of a time alike: the
//! moments are conditional on survival. With λ1 = σs (1 − g) and λ2 = σs (1 − g²), and with ℒ⁻¹ the
//! inverse Laplace transform from s to t,
//!
//! > ⟨r²⟩ = 2 ℒ⁻¹\[1/(s² (s + λ1))\],
//! > ⟨r⁴⟩ = 120 ℒ⁻¹\[(1/9)/(s³ (s + λ1)²) + (4/45)/(s² (s + λ1)² (s + λ2))\],
//! > ⟨z⟩ = ℒ⁻¹\[1/(s (s + λ1))\],
//! > ⟨z²⟩ = (2/3) ℒ⁻¹\[1/(s² (s + λ1))\] + (4/3) ℒ⁻¹\[1/(s (s + λ1) (s + λ2))\].
//!
//! r is the distance from the source, for any emission; z is the distance along the direction in which
//! all light started. ⟨r²⟩ and ⟨z⟩ are those of Case and Zweifel (Linear Transport Theory, 1967) for
//! Henyey–Greenstein scattering; the others follow from the same expansion of the transport equation in
//! Legendre polynomials. Scaling: the moments of a medium with speed v are those at v t, with t in m
//! and σs in 1/m; the result is in m to the power of the moment.
//!
//! # Stable form
//!
//! ℒ⁻¹\[1/∏ (s + λi)\] of n factors is tⁿ⁻¹ times the divided difference of exp at the points −λi t. Partial
//! fractions cancel where the points are close (λ t ≪ 1, g → 0, g → 1). Instead the difference is
//! read off the exponential of the bidiagonal matrix with the points on its diagonal and ones above
//! (Opitz 1964), by a Taylor series and squaring: sums of positive numbers after the first.

use crate::error::{Result, finite_result, non_negative};
use crate::phase::check_mean_cosine;
use serde::Deserialize;

/// Inputs of the moments; speed 1.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// Length of the light's path \[m\], at least 0.
    pub time: f64,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Mean cosine of the phase function, strictly between −1 and 1.
    pub g: f64,
}

/// ⟨r²⟩ \[m²\].
pub fn mean_square_distance(input: &Moment) -> Result<f64> {
    let (rates, t) = Rates::new(input)?;
    result(2.0 * t * t * difference([0.0, 0.0, rates.first]))
}

/// ⟨r⁴⟩ \[m⁴\].
pub fn mean_fourth_power_of_distance(input: &Moment) -> Result<f64> {
    let (rates, t) = Rates::new(input)?;
    let (first, second) = (rates.first, rates.second);
    let same = difference([0.0, 0.0, 0.0, first, first]);
    let other = difference([0.0, 0.0, first, first, second]);
    result(120.0 * t.powi(4) * (same / 9.0 + other * (4.0 / 45.0)))
}

/// ⟨z⟩ \[m\] for light that starts along z.
pub fn mean_depth(input: &Moment) -> Result<f64> {
    let (rates, t) = Rates::new(input)?;
    result(t * difference([0.0, rates.first]))
}

/// ⟨z²⟩ \[m²\] for light that starts along z.
pub fn mean_square_depth(input: &Moment) -> Result<f64> {
    let (rates, t) = Rates::new(input)?;
    let isotropic = difference([0.0, 0.0, rates.first]);
    let forward = difference([0.0, rates.first, rates.second]);
    result(t * t * (2.0 * isotropic + 4.0 * forward) / 3.0)
}

fn result(value: f64) -> Result<f64> {
    finite_result("infinite_medium_moments", value)
}

/// λ1 t and λ2 t.
#[derive(Debug, Clone, Copy)]
struct Rates {
    first: f64,
    second: f64,
}

impl Rates {
    fn new(input: &Moment) -> Result<(Self, f64)> {
        let &Moment { time, sigma_s, g } = input;
        non_negative("time", time)?;
        non_negative("sigma_s", sigma_s)?;
        check_mean_cosine(g)?;
        let depth = finite_result("infinite_medium_moments", sigma_s * time)?;
        Ok((Self { first: depth * (1.0 - g), second: depth * (1.0 - g) * (1.0 + g) }, time))
    }
}

/// The divided difference of x ↦ e^(−x) up to its sign, at points of at least 0.
fn difference<const N: usize>(points: [f64; N]) -> f64 {
    let largest = points.into_iter().fold(0.0, f64::max);
    // 2^−halvings times the largest point is at most 1/2.
    let halvings = if largest > 0.5 { (2.0 * largest).log2().ceil() } else { 0.0 };
    let scale = (-halvings).exp2();
    let mut power = exponential(points.map(|point| -point * scale), scale);
    for _ in 0..halvings as u32 {
        power = square(&power);
    }
    power[0][N - 1]
}

/// The exponential of the bidiagonal matrix of a diagonal within [−1/2, 0] and `above` it.
fn exponential<const N: usize>(diagonal: [f64; N], above: f64) -> [[f64; N]; N] {
    let mut term = [[0.0; N]; N];
    for (i, row) in term.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    let mut sum = term;
    // An entry j − i above the diagonal starts with the power j − i; then 20 terms are 1e-19 of it.
    for k in 1..(N + 20) {
        let before = term;
        for i in 0..N {
            for j in i..N {
                let from_left = if j > i { before[i][j - 1] * above } else { 0.0 };
                term[i][j] = (before[i][j] * diagonal[j] + from_left) / k as f64;
                sum[i][j] += term[i][j];
            }
        }
    }
    sum
}

fn square<const N: usize>(matrix: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut product = [[0.0; N]; N];
    for i in 0..N {
        for j in i..N {
            product[i][j] = (i..=j).map(|k| matrix[i][k] * matrix[k][j]).sum();
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Solution = fn(&Moment) -> Result<f64>;

    const MOMENTS: [(Solution, i32); 4] = [
        (mean_square_distance, 2),
        (mean_fourth_power_of_distance, 4),
        (mean_depth, 1),
        (mean_square_depth, 2),
    ];

    fn close(value: f64, expected: f64, relative: f64) {
        assert!(
            (value - expected).abs() <= relative * expected.abs(),
            "{value:e} for {expected:e}"
        );
    }

    #[test]
    fn without_scattering_light_is_where_its_path_ends() {
        for time in [0.0, 1e-6, 1.0, 1e3, 1e60] {
            for (moment, power) in MOMENTS {
                let value = moment(&Moment { time, sigma_s: 0.0, g: 0.3 }).unwrap();
                close(value, time.powi(power), 1e-15);
            }
        }
    }

    #[test]
    fn the_closed_forms_hold_where_they_do_not_cancel() {
        for (time, sigma_s, g) in [(3.0, 1.0, 0.2), (40.0, 0.8, -0.6), (500.0, 1.3, 0.97)] {
            let input = Moment { time, sigma_s, g };
            let rate = sigma_s * (1.0 - g);
            let decayed = -(-rate * time).exp_m1();
            let square = 2.0 * (time / rate - decayed / (rate * rate));
            close(mean_square_distance(&input).unwrap(), square, 1e-13);
            close(mean_depth(&input).unwrap(), decayed / rate, 1e-14);
        }
    }

    #[test]
    fn late_light_diffuses() {
        // ⟨r²⟩ → 6 D t with D = 1/(3 λ1), ⟨r⁴⟩ → (5/3) ⟨r²⟩², ⟨z²⟩ → ⟨r²⟩/3; corrections of 1/(λ1 t).
        for time in [1e8, 1e14] {
            let input = Moment { time, sigma_s: 2.0, g: 0.5 };
            let square = mean_square_distance(&input).unwrap();
            close(square, 2.0 * time, 2.0 / time);
            close(
                mean_fourth_power_of_distance(&input).unwrap(),
                5.0 / 3.0 * square * square,
                1e-7,
            );
            close(mean_square_depth(&input).unwrap(), square / 3.0, 4.0 / time);
            close(mean_depth(&input).unwrap(), 1.0, 1e-15);
        }
    }

    #[test]
    fn values_without_meaning_are_errors() {
        let input = Moment { time: 1.0, sigma_s: 1.0, g: 0.0 };
        for (moment, _) in MOMENTS {
            assert!(moment(&Moment { time: -1.0, ..input }).is_err());
            assert!(moment(&Moment { g: 1.0, ..input }).is_err());
            assert!(moment(&Moment { sigma_s: f64::NAN, ..input }).is_err());
            assert!(moment(&Moment { time: 1e200, sigma_s: 1e200, ..input }).is_err());
        }
    }

    proptest! {
        #[test]
        fn lengths_scale(
            time in 1e-3..1e3_f64, sigma_s in 0.0..5.0_f64, g in -0.99..0.99_f64,
            scale in 1e-3..1e3_f64,
        ) {
            for (moment, power) in MOMENTS {
                let small = moment(&Moment { time, sigma_s, g }).unwrap();
                let large =
                    moment(&Moment { time: time * scale, sigma_s: sigma_s / scale, g }).unwrap();
                close(large, small * scale.powi(power), 1e-12);
            }
        }

        #[test]
        fn the_moments_are_those_of_a_distribution_within_the_front(
            log_time in -6.0..3.0_f64, sigma_s in 1e-3..5.0_f64, g in -0.99..0.99_f64,
        ) {
            let time = 10.0_f64.powf(log_time);
            let [r2, r4, z, z2] =
                MOMENTS.map(|(moment, _)| moment(&Moment { time, sigma_s, g }).unwrap());
            let almost = 1.0 + 1e-12;
            prop_assert!(0.0 < z && z * z <= z2 * almost && z2 <= r2 * almost);
            prop_assert!(r2 * r2 <= r4 * almost && r4 <= r2 * time * time * almost);
        }

        #[test]
        fn wild_inputs_give_a_value_or_an_error(
            exponents in prop::array::uniform2(-320.0..308.0_f64), g in -1.1..1.1_f64,
        ) {
            let [time, sigma_s] = exponents.map(|e| 10.0_f64.powf(e));
            for (moment, _) in MOMENTS {
                let result = moment(&Moment { time, sigma_s, g });
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
            }
        }
    }
}
