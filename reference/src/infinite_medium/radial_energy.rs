//! How much scattered light is within a radius, or a shell, around a point pulse.
//!
//! # Any mean cosine
//!
//! The transform S(k, t) of the point pulse is known for any g (`angular_moments`), and there is no light beyond r = t
//! (v = 1). On an interval L > t the density is therefore exactly a sine series, and the energy within r
//!
//! > E(r) = (2/L) Σ Ŝₙ (sin(kₙ r)/kₙ − r cos(kₙ r)),   kₙ = nπ/L,   Ŝ = S − e^(−σt t) sin(kt)/(kt)
//!
//! (the idea of Liemert and Kienle, "Infinite space Green's function of the time-dependent radiative transfer equation",
//! Biomed. Opt. Express 3, 543, 2012). The density is smooth except on the front, so that the series, cut at
//! k = K by the filter of Vandeven and Boyd, ½ erfc(2√p θ √(−ln(1 − 4θ²)/4θ²)) with θ = k/K − ½, converges exponentially with
//! K (t − r). K is raised until two cuts agree; that takes longer close to the front, and is given up as
//! an error beyond r ≈ 0.95 t, or where E is too small a remainder of the sum (r ≪ t). From the front
//! on, E is 1 − e^(−t). [`scattered_energy_within_radius`] is for σs = 1 and σa = 0: lengths in mean free paths;
//! absorption is the factor e^(−σa v t).
//!
//! # Isotropic scattering
//!
//! [`scattered_shell_energy`] and [`scattered_shell_energy_by_order`] integrate 4πr² times the fluence rate of
//! `point_pulse` over r0 ≤ r < r1, up to the front and beyond, where the fourth root of
//! t − r removes its logarithm. v = σt = 1; order n is for albedo 1 and has the factor cⁿ otherwise.

use super::angular_moments::sinc_moment;
use super::point_pulse;
use crate::error::{ReferenceError, Result, finite_result, non_negative, positive, require};
use crate::numerics::quadrature::{RELATIVE_TOLERANCE, adaptive};
use crate::phase::check_mean_cosine;
use libm::erfc;
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of [`scattered_energy_within_radius`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnergyWithin {
    /// Mean cosine of the phase function, strictly between −1 and 1.
    pub g: f64,
    /// Time since the emission \[mean free times\], up to 1e3.
    pub time: f64,
    /// Radius \[mean free paths\].
    pub r: f64,
}

/// Inputs of [`scattered_shell_energy`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShellEnergy {
    /// Inner radius \[mean free paths\].
    pub r0: f64,
    /// Outer radius \[mean free paths\].
    pub r1: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Albedo c, at least 0.
    pub albedo: f64,
}

/// Inputs of [`scattered_shell_energy_by_order`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShellEnergyOrder {
    /// Inner radius \[mean free paths\].
    pub r0: f64,
    /// Outer radius \[mean free paths\].
    pub r1: f64,
    /// Time since the emission \[mean free times\].
    pub time: f64,
    /// Number of scatterings, at least 1.
    pub order: u32,
}

/// The share of a pulse that is scattered light within r, for any g, \[1\].
pub fn scattered_energy_within_radius(input: &EnergyWithin) -> Result<f64> {
    let &EnergyWithin { g, time, r } = input;
    check_mean_cosine(g)?;
    positive("time", time)?;
    non_negative("r", r)?;
    require(time <= LATEST, "time", time, "at most 1e3")?;
    if r == 0.0 {
        return Ok(0.0);
    }
    if r >= time {
        return Ok(-(-time).exp_m1());
    }
    let mut cut = FIRST_CUT / (time - r);
    let mut series = Series { g, time, length: LENGTH * time, coefficients: Vec::new() };
    require(series.terms(cut) <= MOST_TERMS, "r", r, "beyond the front or 5 % behind it")?;
    let mut before = f64::INFINITY;
    loop {
        let value = series.energy(r, cut);
        let error = (value - series.energy(r, COARSER * cut)).abs();
        if error <= TOLERANCE * value {
            return Ok(value);
        }
        cut *= 1.5;
        // An error that does not fall any more is rounding.
        if series.terms(cut) > MOST_TERMS || error > 0.1 * before {
            return Err(ReferenceError::NoConvergence { value, error });
        }
        before = error;
    }
}

/// The share of a pulse that is scattered light in a shell, for isotropic scattering, \[1\].
pub fn scattered_shell_energy(input: &ShellEnergy) -> Result<f64> {
    let &ShellEnergy { r0, r1, time, albedo } = input;
    non_negative("albedo", albedo)?;
    shell(r0, r1, time, |r, gap| point_pulse::scattered(r, gap, albedo))
}

/// The share of a pulse that is light scattered n times in a shell, for isotropic scattering, \[1\].
pub fn scattered_shell_energy_by_order(input: &ShellEnergyOrder) -> Result<f64> {
    let &ShellEnergyOrder { r0, r1, time, order } = input;
    require(order > 0, "order", 0.0, "at least 1; order 0 is ballistic light")?;
    shell(r0, r1, time, |r, gap| point_pulse::of_order(r, gap, order))
}

/// ∫ 4πr² φ dr from `r0` to `r1`; the fluence rate gets r and t − r.
fn shell(r0: f64, r1: f64, time: f64, fluence: impl Fn(f64, f64) -> f64) -> Result<f64> {
    non_negative("r0", r0)?;
    require(r1.is_finite() && r1 >= r0, "r1", r1, "finite and at least r0")?;
    positive("time", time)?;
    if r0 >= time || r0 == r1 {
        return Ok(0.0);
    }
    let density = |r: f64, gap: f64| 4.0 * PI * r * r * fluence(r, gap);
    // Far from the front in r, close to it in the fourth root of t − r.
    let middle = r1.min(0.9 * time).max(r0);
    let inner = adaptive(|r| density(r, time - r), &[r0, middle], RELATIVE_TOLERANCE)?.value;
    let fourth_root = |r: f64| (time - r).max(0.0).sqrt().sqrt();
    let integrand = |root: f64| {
        let gap = root.powi(4);
        if gap == 0.0 { 0.0 } else { density(time - gap, gap) * 4.0 * root.powi(3) }
    };
    let breaks = [fourth_root(r1), fourth_root(middle)];
    let outer = adaptive(integrand, &breaks, RELATIVE_TOLERANCE)?.value;
    finite_result("scattered_shell_energy", inner + outer)
}

/// The latest time, in mean free times, and the most terms of the series: what they cost.
const LATEST: f64 = 1e3;
const MOST_TERMS: usize = 800;
/// L in units of t.
const LENGTH: f64 = 1.02;
/// The first cut, in units of 1/(t − r), and that for comparison in units of the cut.
const FIRST_CUT: f64 = 120.0;
const COARSER: f64 = 0.8;
/// How well two cuts must agree; the finer is better by orders of magnitude.
const TOLERANCE: f64 = 1e-9;

/// The sine series, with its coefficients as far as they were needed.
struct Series {
    g: f64,
    time: f64,
    length: f64,
    /// Ŝₙ from n = 1.
    coefficients: Vec<f64>,
}

impl Series {
    /// How many wave numbers there are up to the cut.
    fn terms(&self, cut: f64) -> usize {
        (cut * self.length / PI) as usize
    }

    fn energy(&mut self, r: f64, cut: f64) -> f64 {
        let count = self.terms(cut);
        let order = cut * (self.time - r) / (2.0 * PI);
        let mut sum = 0.0;
        for n in 1..=count {
            let k = n as f64 * PI / self.length;
            let shape = (k * r).sin() / k - r * (k * r).cos();
            sum += filter(k / cut, order) * self.coefficient(n) * shape;
        }
        2.0 / self.length * sum
    }

    fn coefficient(&mut self, n: usize) -> f64 {
        while self.coefficients.len() < n {
            let phase = (self.coefficients.len() + 1) as f64 * PI * self.time / self.length;
            let ballistic = (-self.time).exp() * phase.sin() / phase;
            self.coefficients.push(sinc_moment(self.g, phase, self.time) - ballistic);
        }
        self.coefficients[n - 1]
    }
}

/// The filter at k/K, from 1 at 0 to 0 at 1.
fn filter(fraction: f64, order: f64) -> f64 {
    let offset = fraction - 0.5;
    let square = 4.0 * offset * offset;
    if square >= 1.0 {
        return if offset < 0.0 { 1.0 } else { 0.0 };
    }
    let stretch = if square > 1e-8 { (-(-square).ln_1p() / square).sqrt() } else { 1.0 };
    0.5 * erfc(2.0 * order.sqrt() * offset * stretch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::infinite_medium::{AliveOfOrder, energy_of_order};
    use proptest::prelude::*;

    fn within(g: f64, time: f64, r: f64) -> f64 {
        scattered_energy_within_radius(&EnergyWithin { g, time, r }).unwrap()
    }

    fn shells(r0: f64, r1: f64, time: f64) -> f64 {
        scattered_shell_energy(&ShellEnergy { r0, r1, time, albedo: 1.0 }).unwrap()
    }

    fn of_order(r0: f64, r1: f64, time: f64, order: u32) -> f64 {
        let input = ShellEnergyOrder { r0, r1, time, order };
        scattered_shell_energy_by_order(&input).unwrap()
    }

    fn close(value: f64, expected: f64, relative: f64) {
        assert!(
            (value - expected).abs() <= relative * expected.abs(),
            "{value:e} for {expected:e}"
        );
    }

    #[test]
    fn the_series_meets_the_point_pulse() {
        for time in [0.05, 1.0, 10.0] {
            for eta in [0.05, 0.3, 0.6, 0.9] {
                close(within(0.0, time, eta * time), shells(0.0, eta * time, time), 1e-9);
            }
        }
    }

    #[test]
    fn all_scattered_light_is_within_the_front() {
        for time in [1e-6, 1.0, 30.0_f64] {
            let scattered = -(-time).exp_m1();
            close(shells(0.0, 2.0 * time, time), scattered, 1e-10);
            for g in [-0.99, 0.5, 0.99] {
                assert_eq!(within(g, time, time), scattered);
                assert_eq!(within(g, time, 0.0), 0.0);
            }
            for order in [1, 2, 20] {
                let (sigma_s, sigma_t) = (1.0, 1.0);
                let input = AliveOfOrder { sigma_s, sigma_t, speed: 1.0, time, order };
                let expected = energy_of_order(&input).unwrap();
                close(of_order(0.0, 2.0 * time, time, order), expected, 1e-10);
            }
        }
    }

    #[test]
    fn shells_and_orders_add_up() {
        let time = 2.0;
        let parts = shells(0.0, 0.5, time) + shells(0.5, 1.99, time) + shells(1.99, 9.0, time);
        close(parts, shells(0.0, 2.0, time), 1e-10);
        let orders: f64 = (1..40).map(|n| of_order(0.3, 1.2, time, n)).sum();
        close(orders, shells(0.3, 1.2, time), 1e-10);
        assert_eq!((shells(2.0, 3.0, time), shells(1.0, 1.0, time)), (0.0, 0.0));
    }

    #[test]
    fn strong_peaks_leave_little_light_behind() {
        let mut before = 1.0;
        for g in [-0.99, -0.5, 0.0, 0.5, 0.9, 0.99] {
            let value = within(g, 3.0, 1.5);
            assert!(0.0 < value && value < before, "{value} at {g}");
            before = value;
        }
    }

    #[test]
    fn what_cannot_be_had_is_an_error() {
        let input = EnergyWithin { g: 0.0, time: 1.0, r: 0.5 };
        for r in [0.9999, -1.0, 1e-9] {
            assert!(scattered_energy_within_radius(&EnergyWithin { r, ..input }).is_err(), "{r}");
        }
        assert!(scattered_energy_within_radius(&EnergyWithin { time: 1e4, ..input }).is_err());
        assert!(scattered_energy_within_radius(&EnergyWithin { g: 1.0, ..input }).is_err());
        let shell = ShellEnergy { r0: 2.0, r1: 1.0, time: 1.0, albedo: 1.0 };
        assert!(scattered_shell_energy(&shell).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn wild_inputs_give_a_value_or_an_error(
            log_time in -300.0..0.5_f64, eta in 0.0..1.1_f64, g in -1.1..1.1_f64,
            albedo in -0.1..2.0_f64, order in 0..50_u32,
        ) {
            let time = 10.0_f64.powf(log_time);
            let (r0, r1) = (0.5 * eta * time, eta * time);
            for result in [
                scattered_energy_within_radius(&EnergyWithin { g, time, r: r1 }),
                scattered_shell_energy(&ShellEnergy { r0, r1, time, albedo }),
                scattered_shell_energy_by_order(&ShellEnergyOrder { r0, r1, time, order }),
            ] {
                prop_assert!(result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0), "{result:?}");
            }
        }
    }
}
